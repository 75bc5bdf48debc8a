#include "archive_fixture.h"

#include "codec/profile_codec.h"
#include "codec/paper/sparse_code.h"
#include "model/paper/paper.h"

static uint64_t random_state = 88172645463325252u;
static uint32_t random_below(uint32_t n)
{
	random_state ^= random_state << 13;
	random_state ^= random_state >> 7;
	random_state ^= random_state << 17;
	return (uint32_t)(random_state >> 32) % n;
}

/* `count` coefficients at random places of the first 90x90 (or fewer) cells' plane, levels up to `largest`. */
static void field_fill(struct sparse_field *field, uint32_t rows, uint32_t columns, uint32_t count, uint32_t largest)
{
	uint32_t cells = rows * columns, index = 0;
	*field = (struct sparse_field){ .rows = rows, .columns = columns, .count = count, .step = 1.0f / 256 };
	if (!count) {
		field->step = 0;
		return;
	}
	field->index = malloc(count * sizeof *field->index);
	field->level = malloc(count * sizeof *field->level);
	for (uint32_t i = 0; i < count; i++) {
		index += i ? 1 + random_below(2 * (cells / count) - 1) : 0;
		if (index >= cells)
			index = cells - (count - i);
		field->index[i] = index;
		field->level[i] = (int16_t)(1 + random_below(largest));
		if (random_below(2))
			field->level[i] = (int16_t)-field->level[i];
	}
	for (uint32_t i = count; i-- > 1;) /* the clamp above may have made neighbours equal */
		if (field->index[i - 1] >= field->index[i])
			field->index[i - 1] = field->index[i] - 1;
}

static struct model *model_make(struct lattice_dims dims, uint32_t slices, uint32_t divisor_hd, uint32_t divisor_slice, uint32_t largest)
{
	struct model *model = calloc(1, sizeof *model);
	struct paper_model *paper = calloc(1, sizeof *paper);
	uint32_t extents[3] = { dims.theta_h, dims.theta_d, dims.phi_d };
	model->profile = PROFILE_PAPER;
	model->dims = dims;
	model->paper = paper;
	paper->dims = dims;
	paper->scale = 0.123456789;
	for (int axis = 0; axis < 3; axis++) {
		paper->marginal[axis] = malloc(extents[axis] * sizeof(float));
		for (uint32_t i = 0; i < extents[axis]; i++)
			paper->marginal[axis][i] = (float)(1 + random_below(1000)) / 500.0f;
	}
	field_fill(&paper->hd, extents[0], extents[1], divisor_hd ? extents[0] * extents[1] / divisor_hd : 0, largest);
	field_fill(&paper->hphi, extents[0], extents[2], divisor_hd ? extents[0] * extents[2] / divisor_hd : 0, largest);
	paper->slice_count = slices;
	paper->slice = calloc(slices, sizeof *paper->slice);
	for (uint32_t i = 0; i < slices; i++)
		field_fill(&paper->slice[i], extents[1], extents[2], divisor_slice ? extents[1] * extents[2] / divisor_slice : 0, largest);
	return model;
}

static void model_drop(struct model *model)
{
	struct paper_model *paper = model->paper;
	for (int axis = 0; paper && axis < 3; axis++)
		free(paper->marginal[axis]);
	if (paper) {
		free(paper->hd.index);
		free(paper->hd.level);
		free(paper->hphi.index);
		free(paper->hphi.level);
		for (uint32_t i = 0; i < paper->slice_count; i++) {
			free(paper->slice[i].index);
			free(paper->slice[i].level);
		}
		free(paper->slice);
	}
	free(paper);
	free(model);
}

static void assert_fields_equal(const struct sparse_field *a, const struct sparse_field *b)
{
	assert_int_equal(a->rows, b->rows);
	assert_int_equal(a->columns, b->columns);
	assert_int_equal(a->count, b->count);
	if (!a->count)
		return;
	assert_true(a->step == b->step);
	assert_memory_equal(a->index, b->index, a->count * sizeof *a->index);
	assert_memory_equal(a->level, b->level, a->count * sizeof *a->level);
}

struct packed {
	struct section_list sections;
	struct record_head head;
	uint32_t record_bytes;
};

static bp_status pack(const struct model *model, uint32_t budget, struct packed *out, bp_error *error)
{
	struct encode_request request = { .name_bytes = 11, .record_bytes_max = budget };
	struct model *decoded = NULL;
	bp_status status;
	memset(out, 0, sizeof *out);
	status = PAPER_ENCODER.encode(model, &request, &out->sections, &out->head.layer_count, &out->head.left_out, &decoded, error);
	if (status)
		return status;
	out->record_bytes = record_head_size(11, out->head.layer_count, out->sections.count);
	for (uint32_t i = 0; i < out->sections.count; i++) {
		out->sections.entry[i].bytes = (uint32_t)out->sections.bytes[i].count;
		out->record_bytes += out->sections.entry[i].bytes;
	}
	return BP_OK;
}

/* Decodes sections of layers below `layers`, as record_decode would. */
static bp_status unpack(const struct packed *from, struct lattice_dims dims, uint32_t layers, struct model **out, bp_error *error)
{
	struct section_bytes sections[RECORD_SECTIONS_MAX];
	uint32_t count = 0, failed = UINT32_MAX;
	struct model *model = calloc(1, sizeof *model);
	bp_status status;
	model->dims = dims;
	for (; count < from->sections.count && from->sections.entry[count].layer < layers; count++)
		sections[count] = (struct section_bytes){ &from->sections.entry[count], from->sections.bytes[count].bytes };
	status = PAPER_CODEC.decode(&from->head, sections, count, model, &failed, error);
	if (status) {
		model_drop(model);
		return status;
	}
	*out = model;
	return BP_OK;
}

static void a_model_comes_back_equal(void **state)
{
	struct lattice_dims dims = { 90, 90, 180 };
	struct model *model = model_make(dims, 61, 16, 64, 3000), *again = NULL;
	struct packed packed;
	(void)state;
	assert_int_equal(pack(model, 60400, &packed, NULL), BP_OK);
	assert_int_equal(packed.head.layer_count, 3);
	assert_int_equal(packed.head.left_out, 0);
	assert_int_equal(unpack(&packed, dims, 3, &again, NULL), BP_OK);
	assert_true(again->paper->scale == model->paper->scale);
	assert_memory_equal(again->paper->marginal[0], model->paper->marginal[0], 90 * sizeof(float));
	assert_memory_equal(again->paper->marginal[2], model->paper->marginal[2], 180 * sizeof(float));
	assert_fields_equal(&again->paper->hd, &model->paper->hd);
	assert_fields_equal(&again->paper->hphi, &model->paper->hphi);
	assert_int_equal(again->paper->slice_count, 61);
	for (int i = 0; i < 61; i++)
		assert_fields_equal(&again->paper->slice[i], &model->paper->slice[i]);
	model_drop(again);
	section_list_free(&packed.sections);
	model_drop(model);
}

/* The largest record: every coefficient that the fractions allow, at random places, with random levels of 15 bits. */
static void the_hardest_model_fits_the_papers_size(void **state)
{
	struct lattice_dims dims = { 90, 90, 180 };
	struct model *model = model_make(dims, 61, 16, 64, 32767);
	struct packed packed;
	(void)state;
	assert_int_equal(pack(model, 60400, &packed, NULL), BP_OK);
	assert_true(packed.record_bytes <= 60400);
	section_list_free(&packed.sections);
	model_drop(model);
}

static void pairs_that_are_1_take_no_bytes(void **state)
{
	struct lattice_dims dims = { 8, 8, 8 };
	struct model *model = model_make(dims, 8, 0, 0, 100), *again = NULL;
	struct packed packed;
	(void)state;
	assert_int_equal(pack(model, 60400, &packed, NULL), BP_OK);
	assert_int_equal(packed.sections.count, 1);
	assert_int_equal(packed.head.layer_count, 1);
	assert_int_equal(packed.head.left_out, 7);
	assert_int_equal(unpack(&packed, dims, 1, &again, NULL), BP_OK);
	assert_int_equal(again->paper->hd.count, 0);
	assert_int_equal(again->paper->slice_count, 1);
	assert_int_equal(again->paper->slice[0].count, 0);
	model_drop(again);
	section_list_free(&packed.sections);
	model_drop(model);
}

static void the_second_layer_adds_the_pairs_only(void **state)
{
	struct lattice_dims dims = { 8, 8, 8 };
	struct model *model = model_make(dims, 5, 4, 4, 100), *again = NULL;
	struct packed packed;
	(void)state;
	assert_int_equal(pack(model, 60400, &packed, NULL), BP_OK);
	assert_int_equal(unpack(&packed, dims, 2, &again, NULL), BP_OK);
	assert_fields_equal(&again->paper->hd, &model->paper->hd);
	assert_int_equal(again->paper->slice_count, 1);
	model_drop(again);
	section_list_free(&packed.sections);
	model_drop(model);
}

static void a_small_budget_drops_the_smallest_levels(void **state)
{
	struct lattice_dims dims = { 90, 90, 180 };
	struct model *model = model_make(dims, 61, 16, 64, 3000), *again = NULL;
	static const uint32_t budgets[] = { 30000, 10000, 4000 };
	struct packed packed;
	bp_error error;
	(void)state;
	for (int i = 0; i < 3; i++) {
		uint32_t at = 0;
		int least = INT16_MAX;
		assert_int_equal(pack(model, budgets[i], &packed, NULL), BP_OK);
		assert_true(packed.record_bytes <= budgets[i]);
		assert_true(packed.record_bytes >= budgets[i] - budgets[i] / 20);
		assert_int_equal(unpack(&packed, dims, 3, &again, NULL), BP_OK);
		for (uint32_t k = 0; k < again->paper->hphi.count; k++)
			if (abs(again->paper->hphi.level[k]) < least)
				least = abs(again->paper->hphi.level[k]);
		for (uint32_t k = 0; k < model->paper->hphi.count; k++) {
			if (at < again->paper->hphi.count && again->paper->hphi.index[at] == model->paper->hphi.index[k])
				assert_int_equal(again->paper->hphi.level[at++], model->paper->hphi.level[k]);
			else
				assert_true(abs(model->paper->hphi.level[k]) <= least);
		}
		assert_int_equal(at, again->paper->hphi.count);
		model_drop(again);
		section_list_free(&packed.sections);
	}
	assert_int_equal(pack(model, 1000, &packed, &error), BP_ERROR_LIMIT);
	assert_non_null(strstr(error.message, "at least 1"));
	section_list_free(&packed.sections);
	model_drop(model);
}

static void damaged_sections_never_crash_the_decoder(void **state)
{
	struct lattice_dims dims = { 8, 8, 8 };
	struct model *model = model_make(dims, 5, 4, 4, 100), *again = NULL;
	struct packed packed;
	(void)state;
	assert_int_equal(pack(model, 60400, &packed, NULL), BP_OK);
	for (uint32_t s = 0; s < packed.sections.count; s++)
		for (size_t i = 0; i < packed.sections.bytes[s].count; i++)
			for (int value = 0; value < 256; value += i < 16 ? 1 : 17) {
				uint8_t *byte = &packed.sections.bytes[s].bytes[i], kept = *byte;
				*byte = (uint8_t)value;
				if (unpack(&packed, dims, 3, &again, NULL) == BP_OK)
					model_drop(again);
				*byte = kept;
			}
	for (uint32_t s = 0; s < packed.sections.count; s++)
		for (uint32_t count = packed.sections.entry[s].bytes; count-- > 0;) {
			packed.sections.entry[s].bytes = count;
			assert_int_equal(unpack(&packed, dims, 3, &again, NULL), BP_ERROR_CORRUPT);
			packed.sections.entry[s].bytes = (uint32_t)packed.sections.bytes[s].count;
		}
	section_list_free(&packed.sections);
	model_drop(model);
}

static void a_claim_of_millions_of_coefficients_allocates_nothing(void **state)
{
	struct lattice_dims dims = { 256, 256, 256 };
	struct packed packed;
	struct model *model = model_make(dims, 1, 0, 0, 1), *again = NULL;
	struct byte_buffer *out;
	(void)state;
	assert_int_equal(pack(model, 60400, &packed, NULL), BP_OK);
	packed.head.left_out = 6;
	out = section_add(&packed.sections, SECTION_PAIR_HD, 1, 1, 0, 1, NAN);
	write_u32(out, 60000);
	write_f32(out, 1);
	write_zeros(out, 100);
	packed.sections.entry[1].bytes = (uint32_t)out->count;
	assert_int_equal(unpack(&packed, dims, 1, &again, NULL), BP_ERROR_CORRUPT);
	section_list_free(&packed.sections);
	model_drop(model);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_model_comes_back_equal),
		cmocka_unit_test(the_hardest_model_fits_the_papers_size),
		cmocka_unit_test(pairs_that_are_1_take_no_bytes),
		cmocka_unit_test(the_second_layer_adds_the_pairs_only),
		cmocka_unit_test(a_small_budget_drops_the_smallest_levels),
		cmocka_unit_test(damaged_sections_never_crash_the_decoder),
		cmocka_unit_test(a_claim_of_millions_of_coefficients_allocates_nothing),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
