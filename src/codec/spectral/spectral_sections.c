/*
 * The spectral profile's model as sections (FORMAT.md, "Profile 2: spectral"): one for the fields, and one per layer with
 * the next bit planes of the levels.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "encoding.h"
#include "weights_code.h"
#include "codec/profile_codec.h"

enum {
	CODEC_FIELDS = 0,
	CODEC_PLANES = 1,
	FIELDS_VERSION = 3,        /* rows of phi_d are whole */
	FIELDS_VERSION_CUT = 4,    /* they are cut at the horizon: spans.h */
	FIELDS_VERSION_GRADED = 5, /* cut there or before, and steps go by frequency too: spectral_weights.h */
	FIELDS_DEPENDENT = 3,      /* added: two quantisers take turns: dependent.h. Versions without are read only */
	PLANES_VERSION = 2
};

static bool spectral_reads(const struct record_section *entry)
{
	if (entry->type == SECTION_FIELDS)
		return entry->codec == CODEC_FIELDS && entry->version >= FIELDS_VERSION &&
		       entry->version <= FIELDS_VERSION_GRADED + FIELDS_DEPENDENT;
	return entry->type == SECTION_PLANES && entry->codec == CODEC_PLANES && entry->version == PLANES_VERSION;
}

/* Records up to these many bytes are previews of larger ones. */
static const uint32_t PREVIEWS[] = {4096, 16384, 65536, 262144, 1048576};
enum { PREVIEW_COUNT = sizeof PREVIEWS / sizeof *PREVIEWS };

/*
 * What the model is says how its fields are written. All three are in use: rows are whole where an error was asked for or nothing
 * can be seen, cut at the horizon where a table is too small to be graded; all else is graded.
 */
static uint16_t fields_version(const struct spectral_model *model)
{
	if (model->weights.graded)
		return FIELDS_VERSION_GRADED;
	return model->limit > 0 ? FIELDS_VERSION_CUT : FIELDS_VERSION;
}

/* Bytes of the fields' section before the weights; version: without FIELDS_DEPENDENT. */
static uint32_t fields_bytes(uint32_t version, bool dependent)
{
	return 8 + 3 * 4 + 9 * 4 + 4 + (dependent ? 4u : 3u) * 4 + 4 + (version == FIELDS_VERSION_GRADED ? 4 : 0);
}

/* ---- encoding ---- */

static void fields_write(const struct encoding *e, const struct byte_buffer *weights, struct section_list *sections)
{
	const uint16_t version = fields_version(e->model);
	struct byte_buffer *out =
		section_add(sections, SECTION_FIELDS, CODEC_FIELDS, version + FIELDS_DEPENDENT, 0, SECTION_REQUIRED, NAN);
	write_f64(out, e->model->unit);
	for (int c = 0; c < 3; c++)
		write_f32(out, e->model->base[c]);
	for (int f = 0; f < 3; f++)
		for (int c = 0; c < 3; c++)
			write_f32(out, e->model->rotation[f][c]);
	write_f32(out, e->step);
	for (int i = 0; i < 3; i++)
		write_f32(out, e->centre[i]);
	write_f32(out, SPECTRAL_CENTRE_BELOW);
	write_u32(out, e->planes->planes);
	if (version == FIELDS_VERSION_GRADED)
		write_f32(out, e->model->limit);
	write_bytes(out, weights->bytes, weights->count);
}

/* What decoding the sections would give. */
static bp_status decoded_build(const struct encoding *e, const struct model *model, struct model **out, bp_error *error)
{
	struct model *copy = malloc(sizeof *copy);
	struct spectral_model *decoded = calloc(1, sizeof *decoded);

	if (!copy || !decoded) {
		free(copy);
		free(decoded);
		return error_memory(error, sizeof *decoded);
	}
	*copy = *model;
	copy->layer_count = e->layers;
	copy->spectral = decoded;
	*decoded = *e->model;
	for (int f = 0; f < 3; f++)
		decoded->coefficient[f] = NULL;
	decoded->noise = 0;
	decoded->step = e->step;
	decoded->dependent = true;
	memcpy(decoded->centre, e->centre, sizeof e->centre);
	decoded->centre[3] = SPECTRAL_CENTRE_BELOW;
	decoded->planes = e->planes->planes;
	memcpy(decoded->end, e->end, sizeof decoded->end);
	*out = copy;
	return planes_collect(e->planes, e->end[e->layers - 1], &decoded->levels, &decoded->level_count, error);
}

bp_status spectral_encode(const struct model *model, const struct encode_request *request, struct section_list *sections,
                          uint32_t *layer_count, uint32_t *left_out, struct model **decoded, bp_error *error)
{
	struct encoding e = {.model = model->spectral, .watch = request->options->watch};
	const uint32_t budget = request->record_bytes_max;
	struct byte_buffer weights = {0};
	bp_status status;

	if (!e.model->coefficient[0])
		return error_argument(error, "a decoded model cannot be encoded again: its coefficients are gone");
	for (int i = 0; i < PREVIEW_COUNT && PREVIEWS[i] + PREVIEWS[i] / 4 < budget; i++)
		e.limit[e.layers++] = PREVIEWS[i];
	e.limit[e.layers++] = budget;
	weights_encode(&e.model->weights, &weights);
	e.head_bytes = record_head_size(request->name_bytes, e.layers, e.layers + 1) + fields_bytes(fields_version(e.model), true) +
	               weights.count;
	const uint64_t least = e.head_bytes + e.layers * 8;
	if (weights.failed)
		status = error_memory(error, SPECTRAL_WEIGHTS);
	else if (least > budget)
		status =
			error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "the budget of %u bytes is too small: this record takes at least %llu",
		              budget, (unsigned long long)least);
	else
		status = planes_create(model->dims, 1, &e.planes, error);
	if (!status)
		status = encoding_make(&e, request->options->effort, error);
	if (!status) {
		/* A short material may be complete before its last layers. */
		while (e.layers > 1 && e.end[e.layers - 1] == e.end[e.layers - 2])
			e.layers--;
		fields_write(&e, &weights, sections);
		for (uint32_t l = 0; l < e.layers; l++) {
			struct byte_buffer *out =
				section_add(sections, SECTION_PLANES, CODEC_PLANES, PLANES_VERSION, l, SECTION_REQUIRED, NAN);
			write_bytes(out, e.stream[l].bytes, e.stream[l].count);
		}
		*layer_count = e.layers;
		*left_out = 0;
		status = decoded_build(&e, model, decoded, error);
	}
	byte_buffer_free(&weights);
	encoding_clear(&e);
	planes_free(e.planes);
	return status;
}

/* ---- decoding ---- */

static bp_status fields_read(const struct section_bytes *section, struct spectral_model *model, bp_error *error)
{
	struct byte_reader in = byte_reader_over(section->bytes, section->entry->bytes);
	const bool dependent = section->entry->version >= FIELDS_VERSION + FIELDS_DEPENDENT;
	const uint32_t version = section->entry->version - (dependent ? (uint32_t)FIELDS_DEPENDENT : 0);
	const uint32_t before_weights = fields_bytes(version, dependent),
				   planes_at = before_weights - (version == FIELDS_VERSION_GRADED ? 8 : 4);
	if (section->entry->bytes < before_weights)
		return error_set(error, BP_ERROR_CORRUPT, 0, "the fields' section has %u bytes, not %u and weights",
		                 section->entry->bytes, before_weights);
	model->dependent = dependent;
	model->weights.graded = version == FIELDS_VERSION_GRADED;
	model->unit = read_f64(&in);
	for (int c = 0; c < 3; c++)
		model->base[c] = read_f32(&in);
	for (int f = 0; f < 3; f++)
		for (int c = 0; c < 3; c++)
			model->rotation[f][c] = read_f32(&in);
	model->step = read_f32(&in);
	for (int i = 0; i < 4; i++)
		if (i != 1 || dependent)
			model->centre[i] = read_f32(&in);
	model->planes = read_u32(&in);
	model->limit = model->weights.graded ? read_f32(&in) : version == FIELDS_VERSION_CUT ? SPAN_MARGIN : 0;
	if (!(model->unit >= SPECTRAL_UNIT_LEAST && model->unit <= SPECTRAL_UNIT_MOST))
		return error_set(error, BP_ERROR_CORRUPT, 0, "the unit is %g, not from %g to %g", model->unit, SPECTRAL_UNIT_LEAST,
		                 SPECTRAL_UNIT_MOST);
	for (int c = 0; c < 3; c++)
		if (!(fabsf(model->base[c]) <= 64))
			return error_set(error, BP_ERROR_CORRUPT, 8, "a base is %g", (double)model->base[c]);
	for (int f = 0; f < 3; f++)
		for (int c = 0; c < 3; c++)
			if (!(fabsf(model->rotation[f][c]) <= 1.001f))
				return error_set(error, BP_ERROR_CORRUPT, 20, "the rotation holds %g", (double)model->rotation[f][c]);
	if (!(model->step > 0 && model->step <= 0x1p40f))
		return error_set(error, BP_ERROR_CORRUPT, 56, "the step is %g", (double)model->step);
	for (int i = 0; i < 4; i++)
		if (!(fabsf(model->centre[i]) <= 1))
			return error_set(error, BP_ERROR_CORRUPT, 60, "a centre is %g", (double)model->centre[i]);
	if (model->planes > SPECTRAL_PLANES_MAX)
		return error_set(error, BP_ERROR_CORRUPT, planes_at, "%u planes: %d at most", model->planes, SPECTRAL_PLANES_MAX);
	if (model->weights.graded && !(model->limit >= SPAN_MARGIN && model->limit < 1))
		return error_set(error, BP_ERROR_CORRUPT, planes_at + 4, "rows are cut at %g, not from 2^-30 to 1", (double)model->limit);
	const char *fault = weights_decode(section->bytes + before_weights, section->entry->bytes - before_weights, &model->weights);
	return fault ? error_set(error, BP_ERROR_CORRUPT, before_weights, "%s", fault) : BP_OK;
}

static bp_status layer_decode(const struct section_bytes *section, struct planes *planes, uint32_t from, uint32_t *end,
                              bp_error *error)
{
	struct mixed_coder coder = {.tables = mixer_tables_get()};
	const uint32_t units = planes_units(planes);
	if (section->entry->bytes < 4)
		return error_set(error, BP_ERROR_CORRUPT, 0, "a section of planes has %u bytes", section->entry->bytes);
	*end = load_u32(section->bytes);
	if (*end < from || *end > units)
		return error_set(error, BP_ERROR_CORRUPT, 0, "planes end at unit %u, not from %u to %u", *end, from, units);
	range_decoder_start(&coder.decoder, section->bytes + 4, section->entry->bytes - 4);
	for (uint32_t unit = from; unit < *end && coder.decoder.at <= coder.decoder.count; unit++) {
		const bp_status status = planes_decode_unit(planes, &coder, unit, error);
		if (status)
			return status;
	}
	if (!range_decoder_ended(&coder.decoder))
		return error_set(error, BP_ERROR_CORRUPT, section->entry->bytes, "planes do not end where their section does");
	return BP_OK;
}

static bp_status spectral_decode(const struct record_head *head, const struct section_bytes *sections, uint32_t count,
                                 struct model *model, uint32_t *failed, bp_error *error)
{
	struct spectral_model *decoded = model->spectral = calloc(1, sizeof *decoded);
	struct planes *planes = NULL;
	uint32_t end = 0;

	if (!decoded)
		return error_memory(error, sizeof *decoded);
	if (count != model->layer_count + 1 || sections[0].entry->type != SECTION_FIELDS)
		return error_set(error, BP_ERROR_CORRUPT, head->head_bytes, "%u sections where fields and planes of %u layers belong",
		                 count, model->layer_count);
	decoded->dims = head->dims;
	*failed = 0;
	bp_status status = fields_read(&sections[0], decoded, error);
	if (!status)
		status = planes_create(head->dims, 0, &planes, error);
	if (status)
		return status;
	planes_start(planes, decoded->planes);
	for (uint32_t l = 0; !status && l < model->layer_count; l++) {
		*failed = l + 1;
		if (sections[l + 1].entry->type != SECTION_PLANES || sections[l + 1].entry->layer != l)
			status = error_set(error, BP_ERROR_CORRUPT, 0, "the planes of layer %u are not where they belong", l);
		else
			status = layer_decode(&sections[l + 1], planes, end, &end, error);
		decoded->end[l] = end;
	}
	if (!status)
		status = planes_collect(planes, end, &decoded->levels, &decoded->level_count, error);
	planes_free(planes);
	return status;
}

const struct profile_codec SPECTRAL_CODEC = {.version = 7, .reads = spectral_reads, .decode = spectral_decode};
