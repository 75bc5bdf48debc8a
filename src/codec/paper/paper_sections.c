/*
 * The paper's model as sections (FORMAT.md, "Paper profile"): nothing is lost, unless the budget is
 * smaller than what the model takes; then the smallest levels of every field are left out.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "model/paper/paper.h"
#include "codec/profile_codec.h"
#include "sparse_code.h"

enum { CODEC_RAW = 0, CODEC_SPARSE = 1 };
enum { LEFT_OUT_HD = 1, LEFT_OUT_HPHI = 2, LEFT_OUT_SLICES = 4 };

static const struct section_kind KINDS[] = {
	{ SECTION_MARGINALS, CODEC_RAW, 1 },
	{ SECTION_PAIR_HD, CODEC_SPARSE, 1 },
	{ SECTION_PAIR_HPHI, CODEC_SPARSE, 1 },
	{ SECTION_SLICES, CODEC_SPARSE, 1 },
};

static uint32_t marginal_count(struct lattice_dims dims, int axis)
{
	return axis == 0 ? dims.theta_h : axis == 1 ? dims.theta_d : dims.phi_d;
}

/* ---- encoding ---- */

static void marginals_write(const struct model *model, struct section_list *sections)
{
	struct byte_buffer *out = section_add(sections, SECTION_MARGINALS, CODEC_RAW, 1, PAPER_LAYER_MARGINALS, SECTION_REQUIRED, NAN);
	write_f64(out, model->paper->scale);
	for (int axis = 0; axis < 3; axis++)
		for (uint32_t i = 0; i < marginal_count(model->dims, axis); i++)
			write_f32(out, model->paper->marginal[axis][i]);
}

static bp_status fields_write(const struct sparse_field *fields, uint32_t count, struct byte_buffer *out, bp_error *error)
{
	struct sparse_models *models = malloc(sizeof *models);
	struct range_encoder encoder;
	if (!models)
		return error_memory(error, sizeof *models);
	sparse_models_reset(models);
	for (uint32_t i = 0; i < count; i++) {
		write_u32(out, fields[i].count);
		write_f32(out, fields[i].count ? fields[i].step : 0);
	}
	range_encoder_start(&encoder, out);
	for (uint32_t i = 0; i < count; i++)
		sparse_encode(&encoder, models, &fields[i]);
	range_encoder_end(&encoder);
	free(models);
	return out->failed ? error_memory(error, out->count) : BP_OK;
}

static bp_status model_write(const struct model *model, struct section_list *sections, uint32_t *layer_count,
                             uint32_t *left_out, bp_error *error)
{
	const struct paper_model *paper = model->paper;
	bp_status status = BP_OK;
	uint32_t slices_kept = 0, omitted = 0;

	for (uint32_t i = 0; i < paper->slice_count; i++)
		slices_kept += paper->slice[i].count > 0;
	marginals_write(model, sections);
	if (paper->hd.count)
		status = fields_write(&paper->hd, 1, section_add(sections, SECTION_PAIR_HD, CODEC_SPARSE, 1, PAPER_LAYER_PAIRS, SECTION_REQUIRED, NAN), error);
	else
		omitted |= LEFT_OUT_HD;
	if (!status && paper->hphi.count)
		status = fields_write(&paper->hphi, 1, section_add(sections, SECTION_PAIR_HPHI, CODEC_SPARSE, 1, PAPER_LAYER_PAIRS, SECTION_REQUIRED, NAN), error);
	else if (!paper->hphi.count)
		omitted |= LEFT_OUT_HPHI;
	if (!status && slices_kept) {
		struct byte_buffer *out = section_add(sections, SECTION_SLICES, CODEC_SPARSE, 1, PAPER_LAYER_SLICES, SECTION_REQUIRED, NAN);
		write_u32(out, paper->slice_count);
		status = fields_write(paper->slice, paper->slice_count, out, error);
	} else if (!slices_kept) {
		omitted |= LEFT_OUT_SLICES;
	}
	*layer_count = slices_kept ? PAPER_LAYERS : paper->hd.count || paper->hphi.count ? PAPER_LAYER_PAIRS + 1 : 1;
	*left_out = omitted;
	return status;
}

static uint64_t record_bytes(const struct section_list *sections, uint32_t layer_count, size_t name_bytes)
{
	uint64_t bytes = record_head_size(name_bytes, layer_count, sections->count);
	for (uint32_t i = 0; i < sections->count; i++)
		bytes += sections->bytes[i].count;
	return bytes;
}

/* ---- fitting a budget ---- */

enum { KEEP_ALL = 1024 };

static int magnitude_descending(const void *a, const void *b)
{
	int x = abs(*(const int16_t *)a), y = abs(*(const int16_t *)b);
	return (x < y) - (x > y);
}

/* The largest keep/KEEP_ALL of a field's coefficients, by magnitude, ties by place. */
static bp_status field_thin(const struct sparse_field *from, uint32_t keep, struct sparse_field *to, bp_error *error)
{
	uint32_t wanted = (uint32_t)((uint64_t)from->count * keep / KEEP_ALL), above = 0;
	int16_t *sorted;
	int threshold;
	*to = *from;
	to->count = 0;
	to->index = NULL;
	to->level = NULL;
	if (wanted == 0)
		return BP_OK;
	sorted = malloc(from->count * sizeof *sorted);
	to->index = malloc(wanted * sizeof *to->index);
	to->level = malloc(wanted * sizeof *to->level);
	if (!sorted || !to->index || !to->level) {
		free(sorted);
		return error_memory(error, from->count * sizeof *sorted);
	}
	memcpy(sorted, from->level, from->count * sizeof *sorted);
	qsort(sorted, from->count, sizeof *sorted, magnitude_descending);
	threshold = abs(sorted[wanted - 1]);
	for (uint32_t i = 0; i < wanted && abs(sorted[i]) > threshold; i++)
		above++;
	free(sorted);
	for (uint32_t i = 0, ties = wanted - above; i < from->count; i++) {
		int magnitude = abs(from->level[i]);
		if (magnitude < threshold || (magnitude == threshold && ties == 0))
			continue;
		ties -= magnitude == threshold;
		to->index[to->count] = from->index[i];
		to->level[to->count++] = from->level[i];
	}
	return BP_OK;
}

static void field_free(struct sparse_field *field)
{
	free(field->index);
	free(field->level);
}

/* Encodes keep/KEEP_ALL of every field; *bytes is what the whole record would take. */
static bp_status thinned_write(const struct model *model, const struct encode_request *request, uint32_t keep,
                               struct section_list *sections, uint32_t *layer_count, uint32_t *left_out, uint64_t *bytes,
                               bp_error *error)
{
	struct paper_model thin = *model->paper;
	struct model shell = *model;
	bp_status status;
	shell.paper = &thin;
	memset(&thin.hd, 0, sizeof thin.hd);
	memset(&thin.hphi, 0, sizeof thin.hphi);
	thin.slice = calloc(thin.slice_count ? thin.slice_count : 1, sizeof *thin.slice);
	if (!thin.slice)
		return error_memory(error, thin.slice_count * sizeof *thin.slice);
	status = field_thin(&model->paper->hd, keep, &thin.hd, error);
	if (!status)
		status = field_thin(&model->paper->hphi, keep, &thin.hphi, error);
	for (uint32_t i = 0; !status && i < thin.slice_count; i++)
		status = field_thin(&model->paper->slice[i], keep, &thin.slice[i], error);
	if (!status)
		status = model_write(&shell, sections, layer_count, left_out, error);
	if (!status)
		*bytes = record_bytes(sections, *layer_count, request->name_bytes);
	field_free(&thin.hd);
	field_free(&thin.hphi);
	for (uint32_t i = 0; i < thin.slice_count; i++)
		field_free(&thin.slice[i]);
	free(thin.slice);
	return status;
}

static bp_status paper_encode(const struct model *model, const struct encode_request *request, struct section_list *sections,
                              uint32_t *layer_count, uint32_t *left_out, struct model **decoded, bp_error *error)
{
	(void)decoded;
	uint64_t bytes;
	uint32_t low = 0, high = KEEP_ALL; /* low fits, high does not */
	bp_status status = model_write(model, sections, layer_count, left_out, error);
	if (status || record_bytes(sections, *layer_count, request->name_bytes) <= request->record_bytes_max)
		return status;
	section_list_free(sections);
	status = thinned_write(model, request, 0, sections, layer_count, left_out, &bytes, error);
	if (!status && bytes > request->record_bytes_max)
		return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "the budget of %u bytes is too small: this record takes at least %llu",
		                 request->record_bytes_max, (unsigned long long)bytes);
	while (!status && high - low > 1) {
		uint32_t middle = (low + high) / 2;
		section_list_free(sections);
		status = thinned_write(model, request, middle, sections, layer_count, left_out, &bytes, error);
		if (bytes <= request->record_bytes_max)
			low = middle;
		else
			high = middle;
	}
	section_list_free(sections);
	return status ? status : thinned_write(model, request, low, sections, layer_count, left_out, &bytes, error);
}

/* ---- decoding ---- */

static bp_status marginals_read(const struct section_bytes *section, struct model *model, bp_error *error)
{
	struct byte_reader in = byte_reader_over(section->bytes, section->entry->bytes);
	struct paper_model *paper = model->paper;
	paper->scale = read_f64(&in);
	if (!(paper->scale >= 0) || !isfinite(paper->scale))
		return error_set(error, BP_ERROR_CORRUPT, 0, "the scale is %g", paper->scale);
	for (int c = 0; c < 3; c++)
		if (!isfinite(model->colour[c].specular * paper->scale))
			return error_set(error, BP_ERROR_CORRUPT, 0, "channel %d: the scale %g and the specular parameter %g overflow", c,
			                 paper->scale, model->colour[c].specular);
	for (int axis = 0; axis < 3; axis++) {
		uint32_t count = marginal_count(model->dims, axis);
		paper->marginal[axis] = malloc(count * sizeof(float));
		if (!paper->marginal[axis])
			return error_memory(error, count * sizeof(float));
		for (uint32_t i = 0; i < count; i++) {
			float value = read_f32(&in);
			if (!(value >= 0) || !isfinite(value))
				return error_set(error, BP_ERROR_CORRUPT, in.at - 4, "marginal %d has the value %g at cell %u", axis,
				                 (double)value, i);
			paper->marginal[axis][i] = value;
		}
	}
	if (in.failed || byte_reader_left(&in))
		return error_set(error, BP_ERROR_CORRUPT, 0, "marginals of %ux%ux%u cells do not take %u bytes", model->dims.theta_h,
		                 model->dims.theta_d, model->dims.phi_d, section->entry->bytes);
	return BP_OK;
}

/*
 * Reads `count` fields of rows x columns cells, which are zeroed. Every coefficient takes at least the bit of
 * its sign, so the bytes that are there bound what is allocated.
 */
static bp_status fields_read(struct byte_reader *in, uint32_t rows, uint32_t columns, struct sparse_field *fields,
                             uint32_t count, bp_error *error)
{
	uint32_t cells = paper_plane_cells(rows, columns);
	uint64_t total = 0;
	struct sparse_models *models = NULL;
	struct range_decoder decoder;
	bp_status status = BP_OK;

	for (uint32_t i = 0; i < count; i++) {
		uint32_t kept = read_u32(in);
		float step = read_f32(in);
		fields[i].rows = rows;
		fields[i].columns = columns;
		fields[i].step = step;
		total += kept;
		if (in->failed || kept > cells || !(kept ? step > 0 && isfinite(step) : step == 0))
			return error_set(error, BP_ERROR_CORRUPT, in->at, "field %u: %u coefficients of step %g", i, kept, (double)step);
		fields[i].count = kept;
	}
	if (total > 8 * (uint64_t)byte_reader_left(in))
		return error_set(error, BP_ERROR_CORRUPT, in->at, "%llu coefficients cannot be in %zu bytes", (unsigned long long)total,
		                 byte_reader_left(in));
	models = malloc(sizeof *models);
	if (!models)
		return error_memory(error, sizeof *models);
	sparse_models_reset(models);
	range_decoder_start(&decoder, in->bytes + in->at, byte_reader_left(in));
	for (uint32_t i = 0; !status && i < count; i++) {
		struct sparse_field *field = &fields[i];
		if (field->count == 0)
			continue;
		field->index = malloc(field->count * sizeof *field->index);
		field->level = malloc(field->count * sizeof *field->level);
		if (!field->index || !field->level)
			status = error_memory(error, field->count * sizeof *field->index);
		else
			status = sparse_decode(&decoder, models, cells, field, error);
	}
	if (!status && !range_decoder_ended(&decoder))
		status = error_set(error, BP_ERROR_CORRUPT, in->at, "the coefficients take %zu bytes, %zu are there", decoder.at,
		                   decoder.count);
	free(models);
	return status;
}

static bp_status pair_read(const struct section_bytes *section, uint32_t rows, uint32_t columns, struct sparse_field *field,
                           bp_error *error)
{
	struct byte_reader in = byte_reader_over(section->bytes, section->entry->bytes);
	return fields_read(&in, rows, columns, field, 1, error);
}

static bp_status slices_read(const struct section_bytes *section, struct model *model, bp_error *error)
{
	struct byte_reader in = byte_reader_over(section->bytes, section->entry->bytes);
	struct paper_model *paper = model->paper;
	uint32_t count = read_u32(&in);
	struct sparse_field *slices;
	if (count < 1 || count > model->dims.theta_h)
		return error_set(error, BP_ERROR_CORRUPT, 0, "%u slices; 1 to %u are possible", count, model->dims.theta_h);
	slices = calloc(count, sizeof *slices);
	if (!slices)
		return error_memory(error, count * sizeof *slices);
	free(paper->slice);
	paper->slice = slices;
	paper->slice_count = count;
	return fields_read(&in, model->dims.theta_d, model->dims.phi_d, slices, count, error);
}

static bp_status section_read(const struct section_bytes *section, struct model *model, bp_error *error)
{
	struct lattice_dims dims = model->dims;
	switch (section->entry->type) {
	case SECTION_MARGINALS: return marginals_read(section, model, error);
	case SECTION_PAIR_HD: return pair_read(section, dims.theta_h, dims.theta_d, &model->paper->hd, error);
	case SECTION_PAIR_HPHI: return pair_read(section, dims.theta_h, dims.phi_d, &model->paper->hphi, error);
	case SECTION_SLICES: return slices_read(section, model, error);
	}
	return BP_OK;
}

/* Where slices are left out, or in a layer that was not asked for, one that is 1 stands for all. */
static bp_status paper_start(struct model *model, bp_error *error)
{
	struct lattice_dims dims = model->dims;
	struct paper_model *paper = calloc(1, sizeof *paper);
	if (!paper)
		return error_memory(error, sizeof *paper);
	model->paper = paper;
	paper->dims = dims;
	paper->hd = (struct sparse_field){ .rows = dims.theta_h, .columns = dims.theta_d };
	paper->hphi = (struct sparse_field){ .rows = dims.theta_h, .columns = dims.phi_d };
	paper->slice = calloc(1, sizeof *paper->slice);
	if (!paper->slice)
		return error_memory(error, sizeof *paper->slice);
	paper->slice[0] = (struct sparse_field){ .rows = dims.theta_d, .columns = dims.phi_d };
	paper->slice_count = 1;
	return BP_OK;
}

static bp_status paper_decode(const struct record_head *head, const struct section_bytes *sections, uint32_t count,
                              struct model *model, uint32_t *failed, bp_error *error)
{
	uint32_t seen = 0;
	bp_status status = paper_start(model, error);
	(void)head;
	for (uint32_t i = 0; !status && i < count; i++) {
		uint32_t bit = 1u << sections[i].entry->type;
		*failed = i;
		if (seen & bit)
			return error_set(error, BP_ERROR_CORRUPT, 0, "a second section of type %u", sections[i].entry->type);
		seen |= bit;
		status = section_read(&sections[i], model, error);
	}
	if (status)
		return status;
	*failed = UINT32_MAX;
	if (!(seen & 1u << SECTION_MARGINALS))
		return error_set(error, BP_ERROR_CORRUPT, 0, "the section of the marginals is missing");
	return BP_OK;
}

const struct profile_codec PAPER_CODEC = {
	.profile = PROFILE_PAPER, .version = 3, .kinds = KINDS, .kind_count = sizeof KINDS / sizeof *KINDS,
	.decode = paper_decode,
};

const struct profile_encoder PAPER_ENCODER = { .profile = PROFILE_PAPER, .encode = paper_encode };
