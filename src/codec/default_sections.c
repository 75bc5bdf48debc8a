/*
 * The default profile's model as sections (FORMAT.md, "Profile 2: default"): one for the fields, and one per layer with
 * the next bit planes of the levels.
 *
 * The budget is met in two ways. A step is sought whose planes take a little more than there is room for, then the lowest
 * plane is cut off at a harmonic. Either alone would do; together they need two or three attempts and waste next to nothing.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "../model/fast_math.h"
#include "default_planes.h"
#include "profile_codec.h"

enum { CODEC_FIELDS = 0, CODEC_PLANES = 1, FIELDS_BYTES = 8 + 3 * 4 + 9 * 4 + 4 + 3 * 4 + 4, FIELDS_VERSION = 2, PLANES_VERSION = 2 };

static const struct section_kind KINDS[] = {
	{ SECTION_FIELDS, CODEC_FIELDS, FIELDS_VERSION },
	{ SECTION_PLANES, CODEC_PLANES, PLANES_VERSION },
};

/* Records up to these many bytes are previews of larger ones. */
static const uint32_t PREVIEWS[] = { 4096, 16384, 65536, 262144, 1048576 };
enum { PREVIEW_COUNT = sizeof PREVIEWS / sizeof *PREVIEWS };

static const float ROUNDING = 0.3f;      /* a level is rounded down up to 0.7: what is rare costs more than it is worth */
static const float CENTRE_BELOW = 0.4f;  /* where a level lies whose lower planes are missing, as a share of them */

/* ---- encoding ---- */

struct encoding {
	const struct default_model *model;
	struct planes *planes;
	float step, centre[2];
	uint32_t layers;
	uint64_t head_bytes;         /* of the record, without any SECTION_PLANES */
	uint32_t limit[LAYERS_MAX];  /* record bytes at the end of every layer; the last is the budget */
	struct byte_buffer stream[LAYERS_MAX];
	uint32_t end[LAYERS_MAX];
	uint64_t wanted; /* record bytes that all units would have taken */
};

static void encoding_clear(struct encoding *e)
{
	for (uint32_t l = 0; l < LAYERS_MAX; l++)
		byte_buffer_free(&e->stream[l]);
}

/* Everything with e->step, as far as the limits allow. */
static bp_status encode_once(struct encoding *e, bp_error *error)
{
	struct range_encoder encoder, kept;
	struct mixed_coder coder = { .encoder = &encoder, .tables = mixer_tables_get() };
	uint64_t bytes = e->head_bytes, largest_unit = 0;
	uint32_t unit = 0, units;

	encoding_clear(e);
	planes_start(e->planes, planes_quantise(e->planes, e->model->coefficient, e->step, ROUNDING, e->centre));
	units = planes_units(e->planes);
	for (uint32_t l = 0; l < e->layers; l++) {
		struct byte_buffer *out = &e->stream[l];
		const int last = l + 1 == e->layers;
		uint64_t now;
		size_t kept_count;
		write_u32(out, 0); /* the end, stored below */
		range_encoder_start(&encoder, out);
		kept = encoder;
		kept_count = out->count;
		e->end[l] = unit;
		now = bytes + range_encoder_bytes(&encoder, 0);
		while (unit < units && !out->failed) {
			const uint64_t before = now;
			if (!last && now + 2 * largest_unit + 16 > e->limit[l])
				break;
			if (last && now > 3 * (uint64_t)e->limit[l])
				break;
			planes_encode_unit(e->planes, &coder, unit++);
			now = bytes + range_encoder_bytes(&encoder, 0);
			largest_unit = now - before > largest_unit ? now - before : largest_unit;
			if (!last || now <= e->limit[l]) {
				kept = encoder;
				kept_count = out->count;
				e->end[l] = unit;
			}
		}
		e->wanted = now;
		out->count = kept_count;
		encoder = kept;
		range_encoder_end(&encoder);
		if (out->failed)
			return error_memory(error, out->count);
		store_u32(out->bytes, e->end[l]);
		bytes += out->count;
	}
	return BP_OK;
}

/*
 * A first guess at the step, from how many coefficients have which size: a level costs about 3.4 bits to place, with its
 * sign, and one more for every bit below its highest; 4 where noise has scattered them. A third of the rows is looked at.
 */
static float step_guess(const struct default_model *model, struct lattice_dims d, double bytes, float least)
{
	enum { PER_OCTAVE = 8, BINS = 256 * PER_OCTAVE };
	uint32_t *bins = calloc(BINS, sizeof *bins);
	const size_t rows = (size_t)d.theta_h * d.theta_d;
	double count = 0, finer = 0, bits = 0;
	int bin = BINS - 1;

	if (!bins)
		return least;
	for (int f = 0; f < 3; f++)
		for (size_t r = 1; r < rows; r += 3)
			for (size_t k = r * d.phi_d; k < (r + 1) * d.phi_d; k++) {
				uint32_t u;
				memcpy(&u, &model->coefficient[f][k], sizeof u);
				bins[(u & 0x7fffffff) >> 20]++;
			}
	/* One bin finer: what is in costs an eighth of a bit more, what comes in pays its place. */
	while (bin > 0 && bits < bytes * 8) {
		finer += count / PER_OCTAVE;
		count += bins[bin--] * 3.0;
		bits = count * (model->noisy ? 4.0 : 3.4) + finer;
	}
	free(bins);
	const uint32_t edge = (uint32_t)(bin + 1) << 20;
	float step;
	memcpy(&step, &edge, sizeof step);
	step /= 1 - ROUNDING;
	return step > least ? step : least;
}

/* The step that a budget needs; leaves the encoding with it. */
static bp_status step_search(struct encoding *e, struct lattice_dims d, int effort, bp_error *error)
{
	const uint32_t limit = e->limit[e->layers - 1];
	const double high = effort <= 2 ? 1.25 : effort <= 4 ? 1.1 : effort <= 6 ? 1.04 : 1.012, aim = effort <= 2 ? 1.1 : effort <= 4 ? 1.03 : 1.004;
	const int attempts = effort <= 2 ? 3 : effort <= 6 ? 5 : 8;
	const size_t cells = lattice_cells(d);
	float largest = 0, least, fitting = 0;
	double slope = 0.78, /* what surrogates need: 0.66 to 0.92 */ last_ratio = 0, last_step = 0;
	bp_status status = BP_OK;

	for (int f = 0; f < 3; f++)
		for (size_t i = 0; i < cells; i++) {
			const float size = fabsf(e->model->coefficient[f][i]);
			largest = size > largest ? size : largest;
		}
	least = fmaxf(largest * 0x1p-23f, 0x1p-22f); /* finer than the rounding of float in the fields */
	e->step = step_guess(e->model, d, (double)limit - (double)e->head_bytes, least);
	for (int attempt = 0; attempt < attempts; attempt++) {
		status = encode_once(e, error);
		if (status)
			return status;
		const double ratio = (double)e->wanted / limit, step = (double)e->step;
		if ((ratio >= 0.991 && ratio <= high) || (ratio < 1 && e->step <= least))
			return BP_OK;
		if (last_ratio > 0 && fabs(fast_log2(step / last_step)) > 1e-4) {
			slope = -fast_log2(ratio / last_ratio) / fast_log2(step / last_step);
			slope = slope < 0.15 ? 0.15 : slope > 2 ? 2 : slope;
		}
		last_ratio = ratio;
		last_step = step;
		if (ratio >= 0.991 && (fitting == 0 || e->step > fitting))
			fitting = e->step; /* the coarsest step that fills the record */
		if (attempt + 1 < attempts)
			e->step = fmaxf((float)(step * fast_exp2(fmin(fmax(fast_log2(ratio / aim) / slope, -4), 4))), least);
	}
	/* Not met: a record that is cut off early is better than one that is not full. */
	if (fitting > 0 && e->step != fitting) {
		e->step = fitting;
		status = encode_once(e, error);
	}
	return status;
}

static void fields_write(const struct encoding *e, struct section_list *sections)
{
	struct byte_buffer *out = section_add(sections, SECTION_FIELDS, CODEC_FIELDS, FIELDS_VERSION, 0, SECTION_REQUIRED, NAN);
	write_f64(out, e->model->unit);
	for (int c = 0; c < 3; c++)
		write_f32(out, e->model->base[c]);
	for (int f = 0; f < 3; f++)
		for (int c = 0; c < 3; c++)
			write_f32(out, e->model->rotation[f][c]);
	write_f32(out, e->step);
	write_f32(out, e->centre[0]);
	write_f32(out, e->centre[1]);
	write_f32(out, CENTRE_BELOW);
	write_u32(out, e->planes->planes);
}

/* What decoding the sections would give. */
static bp_status decoded_build(const struct encoding *e, const struct model *model, struct model **out, bp_error *error)
{
	struct model *copy = malloc(sizeof *copy);
	struct default_model *decoded = calloc(1, sizeof *decoded);

	if (!copy || !decoded) {
		free(copy);
		free(decoded);
		return error_memory(error, sizeof *decoded);
	}
	*copy = *model;
	copy->layer_count = e->layers;
	copy->log_density = decoded;
	decoded->unit = e->model->unit;
	memcpy(decoded->base, e->model->base, sizeof decoded->base);
	memcpy(decoded->rotation, e->model->rotation, sizeof decoded->rotation);
	decoded->step = e->step;
	decoded->centre[0] = e->centre[0];
	decoded->centre[1] = e->centre[1];
	decoded->centre[2] = CENTRE_BELOW;
	decoded->planes = e->planes->planes;
	memcpy(decoded->end, e->end, sizeof decoded->end);
	*out = copy;
	return planes_collect(e->planes, e->end[e->layers - 1], &decoded->levels, &decoded->level_count, error);
}

static bp_status default_encode(const struct model *model, const struct encode_request *request, struct section_list *sections,
                                uint32_t *layer_count, uint32_t *left_out, struct model **decoded, bp_error *error)
{
	struct encoding e = { .model = model->log_density };
	const uint32_t budget = request->record_bytes_max;
	uint64_t least;
	bp_status status;

	if (!e.model->coefficient[0])
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "a decoded model cannot be encoded again: its coefficients are gone");
	for (int i = 0; i < PREVIEW_COUNT && PREVIEWS[i] + PREVIEWS[i] / 4 < budget; i++)
		e.limit[e.layers++] = PREVIEWS[i];
	e.limit[e.layers++] = budget;
	e.head_bytes = record_head_size(request->name_bytes, e.layers, e.layers + 1) + FIELDS_BYTES;
	least = e.head_bytes + e.layers * 8;
	if (least > budget)
		return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "the budget of %u bytes is too small: this record takes at least %llu",
		                 budget, (unsigned long long)least);
	status = planes_create(model->dims, 1, &e.planes, error);
	if (status)
		return status;
	status = step_search(&e, model->dims, request->options->effort, error);
	if (!status) {
		/* A short material may be complete before its last layers. */
		while (e.layers > 1 && e.end[e.layers - 1] == e.end[e.layers - 2])
			e.layers--;
		fields_write(&e, sections);
		for (uint32_t l = 0; l < e.layers; l++) {
			struct byte_buffer *out = section_add(sections, SECTION_PLANES, CODEC_PLANES, PLANES_VERSION, l, SECTION_REQUIRED, NAN);
			write_bytes(out, e.stream[l].bytes, e.stream[l].count);
		}
		*layer_count = e.layers;
		*left_out = 0;
		status = decoded_build(&e, model, decoded, error);
	}
	encoding_clear(&e);
	planes_free(e.planes);
	return status;
}

/* ---- decoding ---- */

static bp_status fields_read(const struct section_bytes *section, struct default_model *model, bp_error *error)
{
	struct byte_reader in = byte_reader_over(section->bytes, section->entry->bytes);
	if (section->entry->bytes != FIELDS_BYTES)
		return error_set(error, BP_ERROR_CORRUPT, 0, "the fields' section has %u bytes, not %d", section->entry->bytes, FIELDS_BYTES);
	model->unit = read_f64(&in);
	for (int c = 0; c < 3; c++)
		model->base[c] = read_f32(&in);
	for (int f = 0; f < 3; f++)
		for (int c = 0; c < 3; c++)
			model->rotation[f][c] = read_f32(&in);
	model->step = read_f32(&in);
	for (int i = 0; i < 3; i++)
		model->centre[i] = read_f32(&in);
	model->planes = read_u32(&in);
	if (!(model->unit >= DEFAULT_UNIT_LEAST && model->unit <= DEFAULT_UNIT_MOST))
		return error_set(error, BP_ERROR_CORRUPT, 0, "the unit is %g, not from %g to %g", model->unit, DEFAULT_UNIT_LEAST, DEFAULT_UNIT_MOST);
	for (int c = 0; c < 3; c++)
		if (!(fabsf(model->base[c]) <= 64))
			return error_set(error, BP_ERROR_CORRUPT, 8, "a base is %g", (double)model->base[c]);
	for (int f = 0; f < 3; f++)
		for (int c = 0; c < 3; c++)
			if (!(fabsf(model->rotation[f][c]) <= 1.001f))
				return error_set(error, BP_ERROR_CORRUPT, 20, "the rotation holds %g", (double)model->rotation[f][c]);
	if (!(model->step > 0 && model->step <= 0x1p40f))
		return error_set(error, BP_ERROR_CORRUPT, 56, "the step is %g", (double)model->step);
	for (int i = 0; i < 3; i++)
		if (!(fabsf(model->centre[i]) <= 1))
			return error_set(error, BP_ERROR_CORRUPT, 60, "a centre is %g", (double)model->centre[i]);
	if (model->planes > DEFAULT_PLANES_MAX)
		return error_set(error, BP_ERROR_CORRUPT, 72, "%u planes: %d at most", model->planes, DEFAULT_PLANES_MAX);
	return BP_OK;
}

static bp_status planes_read(const struct section_bytes *section, struct planes *planes, uint32_t from, uint32_t *end, bp_error *error)
{
	struct mixed_coder coder = { .tables = mixer_tables_get() };
	const uint32_t units = planes_units(planes);
	if (section->entry->bytes < 4)
		return error_set(error, BP_ERROR_CORRUPT, 0, "a section of planes has %u bytes", section->entry->bytes);
	*end = load_u32(section->bytes);
	if (*end < from || *end > units)
		return error_set(error, BP_ERROR_CORRUPT, 0, "planes end at unit %u, not from %u to %u", *end, from, units);
	range_decoder_start(&coder.decoder, section->bytes + 4, section->entry->bytes - 4);
	for (uint32_t unit = from; unit < *end && coder.decoder.at <= coder.decoder.count; unit++)
		planes_decode_unit(planes, &coder, unit);
	if (!range_decoder_ended(&coder.decoder))
		return error_set(error, BP_ERROR_CORRUPT, section->entry->bytes, "planes do not end where their section does");
	return BP_OK;
}

static bp_status default_decode(const struct record_head *head, const struct section_bytes *sections, uint32_t count,
                                struct model *model, uint32_t *failed, bp_error *error)
{
	struct default_model *decoded = model->log_density = calloc(1, sizeof *decoded);
	struct planes *planes = NULL;
	uint32_t end = 0;
	bp_status status;

	if (!decoded)
		return error_memory(error, sizeof *decoded);
	if (count != model->layer_count + 1 || sections[0].entry->type != SECTION_FIELDS)
		return error_set(error, BP_ERROR_CORRUPT, head->head_bytes, "%u sections where fields and planes of %u layers belong", count,
		                 model->layer_count);
	*failed = 0;
	status = fields_read(&sections[0], decoded, error);
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
			status = planes_read(&sections[l + 1], planes, end, &end, error);
		decoded->end[l] = end;
	}
	if (!status)
		status = planes_collect(planes, end, &decoded->levels, &decoded->level_count, error);
	planes_free(planes);
	return status;
}

const struct profile_codec DEFAULT_CODEC = {
	.profile = PROFILE_DEFAULT,
	.version = 2,
	.kinds = KINDS,
	.kind_count = sizeof KINDS / sizeof *KINDS,
	.encode = default_encode,
	.decode = default_decode,
};
