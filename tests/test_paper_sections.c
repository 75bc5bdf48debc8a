#include "archive_fixture.h"

#include "codec/profile_codec.h"
#include "codec/paper/paper_fields.h"
#include "model/paper/paper.h"

static uint64_t random_state = 88172645463325252u;
static uint32_t random_below(uint32_t n)
{
	random_state ^= random_state << 13;
	random_state ^= random_state >> 7;
	random_state ^= random_state << 17;
	return (uint32_t)(random_state >> 32) % n;
}

/* `count` coefficients at random places of the plane, levels up to `largest`. */
static void field_fill(struct lattice_dims dims, enum paper_field kind, uint32_t count, uint32_t largest,
                       struct sparse_field *field)
{
	uint32_t cells = paper_plane_cells(dims, kind), index = 0;
	*field = (struct sparse_field){.count = count, .step = count ? PAPER_STEP_ONE - 8 * 256 : 0};
	if (!count)
		return;
	field->index = malloc(count * sizeof *field->index);
	field->level = malloc(count * sizeof *field->level);
	for (uint32_t i = 0; i < count; i++) {
		index += i ? 1 + random_below(2 * (cells / count) - 1) : 0;
		if (index >= cells)
			index = cells - (count - i);
		field->index[i] = index;
		field->level[i] = (int32_t)(1 + random_below(largest));
		if (random_below(2))
			field->level[i] = -field->level[i];
	}
	for (uint32_t i = count; i-- > 1;) /* the clamp above may have made neighbours equal */
		if (field->index[i - 1] >= field->index[i])
			field->index[i - 1] = field->index[i] - 1;
}

/* Shares of the fields' cells, 0: none. */
static struct model *model_make(struct lattice_dims dims, uint32_t divisor_pair, uint32_t divisor_slice, uint32_t largest)
{
	struct model *model = calloc(1, sizeof *model);
	struct paper_model *paper = calloc(1, sizeof *paper);
	uint32_t extents[3] = {dims.theta_h, dims.theta_d, dims.phi_d};
	model->profile = PROFILE_PAPER;
	model->dims = dims;
	model->paper = paper;
	paper->dims = dims;
	for (int c = 0; c < 3; c++) {
		struct paper_channel *channel = &paper->channel[c];
		channel->scale = 0.123456789 * (c + 1);
		assert_int_equal(paper_marginals_alloc(dims, channel, NULL), BP_OK);
		for (size_t i = 0; i < paper_marginal_values(dims); i++)
			channel->marginal[0][i] = paper_coded((uint16_t)random_below(65536));
		field_fill(dims, PAPER_HD, divisor_pair ? extents[0] * extents[1] / divisor_pair : 0, largest, &channel->hd);
		field_fill(dims, PAPER_HPHI, divisor_pair ? extents[0] * extents[2] / divisor_pair : 0, largest, &channel->hphi);
		channel->slice_count = paper_shared_from(dims.theta_h) + 1;
		channel->slice = calloc(channel->slice_count, sizeof *channel->slice);
		for (uint32_t i = 0; i < channel->slice_count; i++)
			field_fill(dims, PAPER_SLICE, divisor_slice ? extents[1] * extents[2] / divisor_slice : 0, largest,
			           &channel->slice[i]);
	}
	return model;
}

static void model_drop(struct model *model) { model_free(model); }

static void assert_fields_equal(const struct sparse_field *a, const struct sparse_field *b)
{
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
	struct encode_request request = {.name_bytes = 11, .record_bytes_max = budget};
	struct model *decoded = NULL;
	memset(out, 0, sizeof *out);
	bp_status status =
		paper_encode(model, &request, &out->sections, &out->head.layer_count, &out->head.left_out, &decoded, error);
	if (status)
		return status;
	out->record_bytes = record_head_size(11, out->head.layer_count, out->sections.count);
	for (uint32_t i = 0; i < out->sections.count; i++) {
		out->sections.entry[i].bytes = (uint32_t)out->sections.bytes[i].count;
		out->record_bytes += out->sections.entry[i].bytes;
	}
	return BP_OK;
}

static uint32_t wanted_channels = 7;

/* Decodes sections of layers below `layers`, as record_decode would. */
static bp_status unpack(const struct packed *from, struct lattice_dims dims, uint32_t layers, struct model **out, bp_error *error)
{
	struct section_bytes sections[RECORD_SECTIONS_MAX];
	uint32_t count = 0, failed = UINT32_MAX;
	struct model *model = calloc(1, sizeof *model);
	model->dims = dims;
	for (; count < from->sections.count && from->sections.entry[count].layer < layers; count++)
		sections[count] = (struct section_bytes){&from->sections.entry[count], from->sections.bytes[count].bytes};
	model->profile = PROFILE_PAPER;
	struct record_head head = from->head;
	head.channels = wanted_channels;
	bp_status status = PAPER_CODEC.decode(&head, sections, count, model, &failed, error);
	if (status) {
		model_drop(model);
		return status;
	}
	*out = model;
	return BP_OK;
}

static void assert_channels_equal(const struct paper_channel *a, const struct paper_channel *b, struct lattice_dims dims)
{
	assert_true(a->scale == b->scale);
	assert_memory_equal(a->marginal[0], b->marginal[0], dims.theta_h * sizeof(float));
	assert_memory_equal(a->marginal[1], b->marginal[1], dims.theta_d * sizeof(float));
	assert_memory_equal(a->marginal[2], b->marginal[2], dims.phi_d * sizeof(float));
	assert_fields_equal(&a->hd, &b->hd);
	assert_fields_equal(&a->hphi, &b->hphi);
	assert_int_equal(a->slice_count, b->slice_count);
	for (uint32_t i = 0; i < a->slice_count; i++)
		assert_fields_equal(&a->slice[i], &b->slice[i]);
}

static void a_model_comes_back_equal(void **state)
{
	struct lattice_dims dims = {90, 90, 180};
	struct model *model = model_make(dims, 16, 64, 60), *again = NULL;
	struct packed packed;
	(void)state;
	assert_int_equal(pack(model, 200000, &packed, NULL), BP_OK);
	assert_int_equal(packed.head.layer_count, 3);
	assert_int_equal(packed.head.left_out, 0);
	assert_int_equal(packed.sections.count, 12);
	assert_int_equal(unpack(&packed, dims, 3, &again, NULL), BP_OK);
	for (int c = 0; c < 3; c++) {
		assert_int_equal(again->paper->channel[c].slice_count, 61);
		assert_channels_equal(&again->paper->channel[c], &model->paper->channel[c], dims);
	}
	model_drop(again);
	section_list_free(&packed.sections);
	model_drop(model);
}

/* Sections say whose they are; with those of one channel alone the others are empty, and a table has its values in all three. */
static void a_channel_decodes_alone(void **state)
{
	struct lattice_dims dims = {8, 9, 10};
	struct model *model = model_make(dims, 4, 4, 30), *again = NULL;
	struct packed packed, alone = {.head = {.layer_count = 3}};
	struct expansion all, one;
	(void)state;
	for (int c = 0; c < 3; c++)
		model->colour[c] = (struct colour_fit){0.25 * c, 1 + c, 1, 1, 0};
	assert_int_equal(pack(model, 200000, &packed, NULL), BP_OK);
	assert_int_equal(expansion_alloc(dims, &all, NULL), BP_OK);
	assert_int_equal(expansion_alloc(dims, &one, NULL), BP_OK);
	model->layer_count = 3;
	assert_int_equal(model_expand(model, 0, &all, NULL), BP_OK);
	for (uint32_t c = 0; c < 3; c++) {
		alone.sections.count = 0;
		for (uint32_t i = 0; i < packed.sections.count; i++)
			if (packed.sections.entry[i].flags & SECTION_ONLY_R << c) {
				alone.sections.entry[alone.sections.count] = packed.sections.entry[i];
				alone.sections.bytes[alone.sections.count++] = packed.sections.bytes[i];
			}
		assert_int_equal(alone.sections.count, 4);
		wanted_channels = 7;
		assert_int_equal(unpack(&alone, dims, 3, &again, NULL), BP_ERROR_CORRUPT);
		wanted_channels = 1u << c;
		assert_int_equal(unpack(&alone, dims, 3, &again, NULL), BP_OK);
		wanted_channels = 7;
		assert_channels_equal(&again->paper->channel[c], &model->paper->channel[c], dims);
		memcpy(again->colour, model->colour, sizeof again->colour);
		again->layer_count = 3;
		assert_int_equal(model_expand(again, 0, &one, NULL), BP_OK);
		for (int k = 0; k < 3; k++)
			for (size_t i = 0; i < lattice_cells(dims); i++)
				assert_true(fabs(one.unit * (double)one.rgb[k][i] - all.unit * (double)all.rgb[c][i]) <=
				            1e-6 * all.unit * (double)all.rgb[c][i]);
		model_drop(again);
	}
	expansion_free(&all);
	expansion_free(&one);
	section_list_free(&packed.sections);
	model_drop(model);
}

/* The largest record: every coefficient that the fractions allow, at random places, with random levels of 20 bits. */
static void the_hardest_model_fits_the_papers_size(void **state)
{
	struct lattice_dims dims = {90, 90, 180};
	struct model *model = model_make(dims, 16, 64, PAPER_LEVEL_MAX);
	struct packed packed;
	(void)state;
	assert_int_equal(pack(model, 60400, &packed, NULL), BP_OK);
	assert_true(packed.record_bytes <= 60400 && packed.record_bytes > 59000);
	section_list_free(&packed.sections);
	model_drop(model);
}

static void pairs_that_are_1_take_no_bytes(void **state)
{
	struct lattice_dims dims = {8, 8, 8};
	struct model *model = model_make(dims, 0, 0, 100), *again = NULL;
	struct packed packed;
	(void)state;
	assert_int_equal(pack(model, 60400, &packed, NULL), BP_OK);
	assert_int_equal(packed.sections.count, 3);
	assert_int_equal(packed.head.layer_count, 1);
	assert_int_equal(packed.head.left_out, 7);
	assert_int_equal(unpack(&packed, dims, 1, &again, NULL), BP_OK);
	assert_int_equal(again->paper->channel[1].hd.count, 0);
	assert_int_equal(again->paper->channel[1].slice_count, 0);
	model_drop(again);
	section_list_free(&packed.sections);
	model_drop(model);
}

static void the_second_layer_adds_the_pairs_only(void **state)
{
	struct lattice_dims dims = {8, 8, 8};
	struct model *model = model_make(dims, 4, 4, 100), *again = NULL;
	struct packed packed;
	(void)state;
	assert_int_equal(pack(model, 60400, &packed, NULL), BP_OK);
	assert_int_equal(unpack(&packed, dims, 2, &again, NULL), BP_OK);
	assert_fields_equal(&again->paper->channel[2].hd, &model->paper->channel[2].hd);
	assert_int_equal(again->paper->channel[2].slice_count, 0);
	model_drop(again);
	section_list_free(&packed.sections);
	model_drop(model);
}

/* Steps grow by one factor in every slice, so the smallest levels go first and none is coarser than half a step. */
static void a_small_budget_coarsens_all_alike(void **state)
{
	struct lattice_dims dims = {90, 90, 180};
	struct model *model = model_make(dims, 16, 64, 3000), *again = NULL;
	static const uint32_t budgets[] = {60400, 30000, 10000, 4000};
	struct packed packed;
	bp_error error;
	(void)state;
	for (int i = 0; i < 4; i++) {
		assert_int_equal(pack(model, budgets[i], &packed, NULL), BP_OK);
		assert_true(packed.record_bytes <= budgets[i]);
		assert_true(packed.record_bytes >= budgets[i] - budgets[i] / 5); /* random levels of one size go all at once */
		assert_int_equal(unpack(&packed, dims, 3, &again, NULL), BP_OK);
		for (uint32_t s = 0; s < again->paper->channel[0].slice_count; s++) {
			const struct sparse_field *from = &model->paper->channel[0].slice[s], *to = &again->paper->channel[0].slice[s];
			const double old = (double)paper_step(from->step), new = to->count ? (double)paper_step(to->step) : INFINITY;
			uint32_t at = 0;
			for (uint32_t k = 0; to->count && k < from->count; k++) {
				const bool kept = at < to->count && to->index[at] == from->index[k];
				assert_true(fabs(from->level[k] * old - (kept ? to->level[at] * new : 0)) <= 0.5000001 * new);
				at += kept;
			}
			assert_int_equal(at, to->count);
		}
		model_drop(again);
		section_list_free(&packed.sections);
	}
	assert_int_equal(pack(model, 2000, &packed, &error), BP_ERROR_LIMIT);
	assert_non_null(strstr(error.message, "at least 2"));
	section_list_free(&packed.sections);
	model_drop(model);
}

/* A marginal comes back to a third of a thousandth, 0 as 0, and the ends of the range stay in it. */
static void marginals_are_stored_to_a_third_of_a_thousandth(void **state)
{
	(void)state;
	assert_true(paper_coded(0) == 0 && paper_code(0) == 0 && paper_coded(PAPER_STEP_ONE) == 1);
	assert_int_equal(paper_code(1e-30f), 1);
	assert_int_equal(paper_code(1e30f), 65535);
	for (float v = 1e-9f; v < 1e9f; v *= 1.037f)
		assert_true(fabsf(paper_coded(paper_code(v)) / v - 1) < 3.4e-4f);
	for (uint32_t code = 1; code < 65536; code += 7)
		assert_int_equal(paper_code(paper_coded((uint16_t)code)), code);
}

static void damaged_sections_never_crash_the_decoder(void **state)
{
	struct lattice_dims dims = {8, 8, 8};
	struct model *model = model_make(dims, 4, 4, 100), *again = NULL;
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

static void a_level_is_refused_beyond_the_largest(void **state)
{
	const struct lattice_dims dims = {8, 9, 10};
	(void)state;
	for (int beyond = 0; beyond < 2; beyond++)
		for (int sign = -1; sign <= 1; sign += 2) {
			uint32_t index = 3;
			int32_t level = sign * (PAPER_LEVEL_MAX + beyond);
			const struct sparse_field field = {.count = 1, .index = &index, .level = &level, .step = PAPER_STEP_ONE};
			struct sparse_field read = {.count = 0};
			struct sparse_coder *coder = NULL;
			struct range_encoder encoder;
			struct range_decoder decoder;
			struct byte_buffer out = {0};
			range_encoder_start(&encoder, &out);
			assert_int_equal(sparse_coder_create(dims, PAPER_HD, &coder, NULL), BP_OK);
			sparse_encode(&encoder, coder, &field);
			range_encoder_end(&encoder);
			free(coder);
			assert_int_equal(sparse_coder_create(dims, PAPER_HD, &coder, NULL), BP_OK);
			range_decoder_start(&decoder, out.bytes, out.count);
			assert_int_equal(sparse_decode(&decoder, coder, 100, &read, NULL), beyond ? BP_ERROR_CORRUPT : BP_OK);
			assert_true(beyond || (read.count == 1 && read.index[0] == 3 && read.level[0] == level));
			sparse_field_free(&read);
			free(coder);
			byte_buffer_free(&out);
		}
}

static void a_claim_of_millions_of_coefficients_allocates_nothing(void **state)
{
	struct lattice_dims dims = {256, 256, 256};
	struct packed packed;
	struct model *model = model_make(dims, 0, 0, 1), *again = NULL;
	(void)state;
	assert_int_equal(pack(model, 60400, &packed, NULL), BP_OK);
	packed.head.left_out = 6;
	struct byte_buffer *out = section_add(&packed.sections, SECTION_PAIR_HD, 2, 1, 0, 1, NAN);
	write_u16(out, PAPER_STEP_ONE);
	write_u32(out, UINT32_MAX);
	write_zeros(out, 100);
	packed.sections.entry[3].bytes = (uint32_t)out->count;
	assert_int_equal(unpack(&packed, dims, 1, &again, NULL), BP_ERROR_CORRUPT);
	section_list_free(&packed.sections);
	model_drop(model);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_model_comes_back_equal),
		cmocka_unit_test(a_channel_decodes_alone),
		cmocka_unit_test(the_hardest_model_fits_the_papers_size),
		cmocka_unit_test(pairs_that_are_1_take_no_bytes),
		cmocka_unit_test(the_second_layer_adds_the_pairs_only),
		cmocka_unit_test(a_small_budget_coarsens_all_alike),
		cmocka_unit_test(marginals_are_stored_to_a_third_of_a_thousandth),
		cmocka_unit_test(damaged_sections_never_crash_the_decoder),
		cmocka_unit_test(a_level_is_refused_beyond_the_largest),
		cmocka_unit_test(a_claim_of_millions_of_coefficients_allocates_nothing),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
