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
#include "default_planes.h"
#include "default_rate.h"
#include "profile_codec.h"

enum { CODEC_FIELDS = 0, CODEC_PLANES = 1, FIELDS_BYTES = 8 + 3 * 4 + 9 * 4 + 4 + 3 * 4 + 4, FIELDS_VERSION = 2, PLANES_VERSION = 2 };

static const struct section_kind KINDS[] = {
	{ SECTION_FIELDS, CODEC_FIELDS, FIELDS_VERSION },
	{ SECTION_PLANES, CODEC_PLANES, PLANES_VERSION },
};

/* Records up to these many bytes are previews of larger ones. */
static const uint32_t PREVIEWS[] = { 4096, 16384, 65536, 262144, 1048576 };
enum { PREVIEW_COUNT = sizeof PREVIEWS / sizeof *PREVIEWS };

enum { FORESEEABLE = 2000 }; /* bytes of the higher planes below which too little is known to foresee the rest */
static const float ROUNDING = 0.4f;      /* a level is rounded down up to 0.6: what is rare costs more than it is worth */
static const double RATE_ROUNDING = 0.3; /* what default_rate was measured with; thinned levels are about as many */
static const float CENTRE_BELOW = 0.4f;  /* where a level lies whose lower planes are missing, as a share of them */

/* ---- encoding ---- */

/* How near the bytes of all units must come to the budget, as ratios, and what is aimed at; how often a step may be tried. */
struct search {
	double low, high, aim;
	int attempts;
};

static struct search search_for(int effort)
{
	static const struct search searches[9] = {
		{0.991, 1.25, 1.10, 2}, {0.991, 1.15, 1.06, 3}, {0.991, 1.10, 1.04, 3}, {0.991, 1.06, 1.02, 4}, {0.991, 1.04, 1.013, 5},
		{0.991, 1.03, 1.01, 5}, {0.994, 1.02, 1.007, 6}, {0.996, 1.012, 1.004, 8}, {0.998, 1.008, 1.003, 10},
	};
	return searches[effort < 1 ? 0 : effort > 9 ? 8 : effort - 1];
}

struct encoding {
	const struct default_model *model;
	struct planes *planes;
	float step, centre[2];
	uint32_t layers;
	uint64_t head_bytes;         /* of the record, without any SECTION_PLANES */
	uint32_t limit[LAYERS_MAX];  /* record bytes at the end of every layer; the last is the budget */
	struct byte_buffer stream[LAYERS_MAX];
	uint32_t end[LAYERS_MAX];
	struct rate rate;
	uint64_t bytes;  /* of the record */
	double wanted;   /* record bytes but for the head that all units would have taken */
	double foreseen; /* the same as foreseen before the lowest plane; 0 where it was not */
	double bias;     /* what was wanted for each byte foreseen in the last attempt that was complete; 1 before */
};

static void encoding_clear(struct encoding *e)
{
	for (uint32_t l = 0; l < LAYERS_MAX; l++)
		byte_buffer_free(&e->stream[l]);
}

/*
 * Everything with e->step, as far as the limits allow. Where `search` is given and planes 1 and up show that the bytes will not be
 * what it asks for, the lowest plane, half of the work, is not begun: *complete becomes 0.
 */
static bp_status encode_once(struct encoding *e, const struct search *search, int *complete, bp_error *error)
{
	struct range_encoder encoder, kept;
	struct mixed_coder coder = { .encoder = &encoder, .tables = mixer_tables_get() };
	const double room = (double)e->limit[e->layers - 1] - (double)e->head_bytes;
	uint64_t bytes = e->head_bytes, largest_unit = 0;
	double taken[RATE_PLANES] = { 0 };
	uint32_t unit = 0, units;

	encoding_clear(e);
	planes_quantise(e->planes, e->model->coefficient, e->step, ROUNDING, e->centre);
	planes_start(e->planes, planes_thin(e->planes, ROUNDING, e->centre));
	units = planes_units(e->planes);
	e->foreseen = 0;
	*complete = 1;
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
			const uint32_t plane = planes_unit_plane(e->planes, unit);
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
			if (plane > 0 && plane < RATE_PLANES)
				taken[plane] = (double)(now - e->head_bytes);
			if (plane == 1 && unit < units && planes_unit_plane(e->planes, unit) == 0 && search && taken[2] > FORESEEABLE) {
				e->foreseen = rate_foresee(&e->rate, (double)e->step, RATE_ROUNDING, taken);
				e->wanted = e->foreseen * e->bias;
				if (e->wanted < search->low * room || e->wanted > search->high * room) {
					*complete = 0;
					return BP_OK;
				}
			}
		}
		e->wanted = (double)(now - e->head_bytes);
		out->count = kept_count;
		encoder = kept;
		range_encoder_end(&encoder);
		if (out->failed)
			return error_memory(error, out->count);
		store_u32(out->bytes, e->end[l]);
		bytes += out->count;
	}
	e->bytes = bytes;
	return BP_OK;
}

/* The step that a budget needs; leaves the encoding with it. */
static bp_status step_search(struct encoding *e, struct lattice_dims d, int effort, bp_error *error)
{
	const struct search search = search_for(effort);
	const double room = (double)e->limit[e->layers - 1] - (double)e->head_bytes, rounding = RATE_ROUNDING;
	double per_bit = e->model->noisy ? 1.3 : 1.03; /* bits by the coder for each that rate_bits tells */
	float fitting = 0; /* the step that filled the record best */
	uint64_t most = 0;
	int complete = 0;
	bp_status status;

	rate_measure(e->model, d, &e->rate);
	const float least = fmaxf(e->rate.largest * 0x1p-23f, 0x1p-22f); /* finer than the rounding of float in the fields */
	for (int attempt = 0; attempt < search.attempts; attempt++) {
		/* A record whose last unit left a gap is filled by a slightly finer step; the gaps of small records are wide. */
		const double finer = complete && fitting == e->step && attempt > 0 ? 1 + 0.004 * attempt : 1;
		e->step = (float)rate_step(&e->rate, finer * search.aim * room * 8 / per_bit, rounding, (double)least);
		status = encode_once(e, attempt + 1 < search.attempts ? &search : NULL, &complete, error);
		if (status)
			return status;
		const double ratio = e->wanted / room;
		const int full = complete && (double)e->bytes >= 0.991 * (double)e->limit[e->layers - 1];
		if (complete && ((full && ratio >= search.low && ratio <= search.high) || (ratio < 1 && e->step <= least)))
			return BP_OK;
		if (complete && e->foreseen > 0)
			e->bias = e->wanted / e->foreseen;
		if (complete && ratio >= search.low && e->bytes > most) {
			fitting = e->step;
			most = e->bytes;
		}
		const double told = rate_bits(&e->rate, (double)e->step, rounding, 0);
		per_bit = fmin(fmax(told > 0 ? e->wanted * 8 / told : per_bit, 0.1), 10);
	}
	/* Not met: a record that is cut off early is better than one that is not full. */
	if (fitting > 0 && e->step != fitting) {
		e->step = fitting;
		return encode_once(e, NULL, &complete, error);
	}
	return BP_OK;
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
	struct encoding e = { .model = model->log_density, .bias = 1 };
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
