#include "encoding.h"

#include <math.h>

#include "error.h"
#include "model/math/fast_math.h"
#include "rate.h"

enum { FORESEEABLE = 2000 };             /* bytes of the higher planes below which too little is known to foresee the rest */
static const double RATE_ROUNDING = 0.3; /* what rate.h was measured with; thinned levels are about as many */

/* Where the step is below so many times the noise, a finer one tells of the noise alone: bytes may be this share further off. */
static const double NOISE_STEPS = 1.5, NOISE_SLACK = 0.02;

/* How near the bytes of all units must come to the budget, as ratios, and what is aimed at; how often a step may be tried. */
struct search {
	double low, high, aim;
	int attempts;
};

static struct search search_for(int effort)
{
	static const struct search searches[9] = {
		{0.991, 1.25, 1.10, 2},   {0.991, 1.15, 1.06, 3},   {0.991, 1.10, 1.04, 3},
		{0.991, 1.06, 1.02, 4},   {0.992, 1.020, 1.004, 5}, {0.992, 1.016, 1.003, 5},
		{0.993, 1.013, 1.002, 6}, {0.994, 1.009, 1.001, 8}, {0.996, 1.006, 1.001, 10},
	};
	return searches[effort < 1 ? 0 : effort > 9 ? 8 : effort - 1];
}

/* One try with a step. Bytes are those of the record but for its head. */
struct attempt {
	double low, high; /* ratios of `wanted` to `room` that will do */
	bool last;        /* code all units, whatever they take */
	const struct rate *rate;
	double bias;               /* what was wanted for each byte foreseen in the last attempt that was complete */
	double room;               /* bytes */
	uint32_t units;            /* to be coded at most */
	double taken[RATE_PLANES]; /* at the ends of planes */
	double foreseen;           /* what all units will take, foreseen before the lowest plane; 0 where it was not */
	double wanted;             /* what they took, or will where the attempt is not complete */
	bool complete;
	bp_status status; /* what the watch said */
};

void encoding_clear(struct encoding *e)
{
	for (uint32_t l = 0; l < LAYERS_MAX; l++)
		byte_buffer_free(&e->stream[l]);
}

/* Before the lowest plane, half of the work, is begun: will the bytes be what the search asks for? */
static bool worth_going_on(const struct encoding *e, struct attempt *a)
{
	if (a->last || a->taken[2] <= FORESEEABLE)
		return true;
	a->foreseen = rate_foresee(a->rate, (double)e->step, RATE_ROUNDING, a->taken);
	a->wanted = a->foreseen * a->bias;
	return a->wanted >= a->low * a->room && a->wanted <= a->high * a->room;
}

/* Units from *unit on until layer l is full; `bytes` of the record come before it. False: given up, or ended by the watch. */
static bool layer_encode(struct encoding *e, struct attempt *a, uint32_t l, struct mixed_coder *coder, uint64_t bytes,
                         uint32_t *unit, uint64_t *largest_unit, bp_error *error)
{
	struct range_encoder *encoder = coder->encoder, kept;
	struct byte_buffer *out = &e->stream[l];
	const uint32_t units = a->units;
	const bool last = l + 1 == e->layers;

	write_u32(out, 0); /* the end, stored below */
	range_encoder_start(encoder, out);
	kept = *encoder;
	size_t kept_count = out->count;
	uint64_t now = bytes + range_encoder_bytes(encoder);
	e->end[l] = *unit;
	while (*unit < units && !out->failed &&
	       (last ? now <= 3 * (uint64_t)e->limit[l] : now + 2 * *largest_unit + 16 <= e->limit[l])) {
		const uint64_t before = now;
		const uint32_t plane = planes_unit_plane(e->planes, *unit);
		a->status = watch_tell(e->watch, 0.6 + 0.2 * *unit / units, error);
		if (a->status)
			return false;
		planes_encode_unit(e->planes, coder, (*unit)++);
		now = bytes + range_encoder_bytes(encoder);
		*largest_unit = now - before > *largest_unit ? now - before : *largest_unit;
		if (!last || now <= e->limit[l]) {
			kept = *encoder;
			kept_count = out->count;
			e->end[l] = *unit;
		}
		if (plane > 0 && plane < RATE_PLANES)
			a->taken[plane] = (double)(now - e->head_bytes);
		if (plane == 1 && *unit < units && planes_unit_plane(e->planes, *unit) == 0 && !worth_going_on(e, a))
			return false;
	}
	a->wanted = (double)(now - e->head_bytes);
	out->count = kept_count;
	*encoder = kept;
	range_encoder_end(encoder);
	if (!out->failed)
		store_u32(out->bytes, e->end[l]);
	return true;
}

/* The levels that are at hand, as far as the limits allow. */
static bp_status levels_encode(struct encoding *e, struct attempt *a, bp_error *error)
{
	struct range_encoder encoder;
	struct mixed_coder coder = {.encoder = &encoder, .tables = mixer_tables_get()};
	uint64_t largest_unit = 0;
	uint32_t unit = 0;

	encoding_clear(e);
	a->foreseen = 0;
	a->complete = true;
	e->bytes = e->head_bytes;
	for (uint32_t l = 0; l < e->layers && a->complete; l++) {
		a->complete = layer_encode(e, a, l, &coder, e->bytes, &unit, &largest_unit, error);
		if (a->status)
			return a->status;
		if (e->stream[l].failed)
			return error_memory(error, e->stream[l].count);
		e->bytes += e->stream[l].count;
	}
	return BP_OK;
}

/* Everything with e->step. */
static bp_status encode_once(struct encoding *e, struct attempt *a, bp_error *error)
{
	const bp_status status = planes_quantise(e->planes, e->model->coefficient, e->step, error);
	if (status)
		return status;
	planes_start(e->planes, planes_settle(e->planes, e->centre));
	a->units = planes_units(e->planes);
	return levels_encode(e, a, error);
}

bp_status encoding_make(struct encoding *e, int effort, bp_error *error)
{
	const struct search search = search_for(effort);
	const uint32_t limit = e->limit[e->layers - 1];
	struct rate rate;
	const double room = (double)limit - (double)e->head_bytes;
	/* More than foreseen take, at 60,400 and 16,000 bytes, 50 noisy surrogates 2.1 and -0.1 %, 50 clean ones 0.3 and 0.5 %. */
	struct attempt a = {.rate = &rate, .room = room, .bias = e->model->noise > 0 ? 1.015 : 1};
	double bits = search.aim * room * 8 / rate_each(fmax(room, 1), e->model->noise > 0); /* by rate_bits */
	float fitting = 0; /* the step that filled the record best */
	uint64_t most = 0;

	rate_measure(e->model, e->planes->dims, &rate);
	const float least = fmaxf(rate.largest * 0x1p-23f, 0x1p-22f); /* finer than the rounding of float in the fields */
	for (int n = 0; n < search.attempts; n++) {
		/* A record whose last unit left a gap is filled by a slightly finer step; the gaps of small records are wide. */
		const double finer = n > 0 && a.complete && fitting == e->step ? 1 + 0.004 * n : 1;
		e->step = (float)rate_step(&rate, finer * bits, RATE_ROUNDING, (double)least);
		const double slack = (double)e->step < NOISE_STEPS * (double)e->model->noise ? NOISE_SLACK : 0;
		a.low = search.low - slack;
		a.high = search.high + slack;
		a.last = n + 1 == search.attempts;
		bp_status status = encode_once(e, &a, error);
		if (status)
			return status;
		const double ratio = a.wanted / room;
		const bool full = (double)e->bytes >= fmin(0.991, a.low) * (double)limit;
		if (a.complete && ((full && ratio >= a.low && ratio <= a.high) || (ratio < 1 && e->step <= least)))
			return BP_OK;
		if (a.complete && a.foreseen > 0)
			a.bias = a.wanted / a.foreseen;
		if (a.complete && ratio >= search.low && e->bytes > most) {
			fitting = e->step;
			most = e->bytes;
		}
		/* Where the guess was far off, the bytes change more than rate_bits does. */
		const double factor = ratio > 0 ? fast_exp2(0.9 * fast_log2(search.aim / ratio)) : 16;
		bits = fmax(rate_bits(&rate, (double)e->step, RATE_ROUNDING, 0), 1) * fmin(fmax(factor, 1.0 / 16), 16);
	}
	/* Not met: a record that is cut off early is better than one that is not full. */
	if (fitting > 0 && e->step != fitting) {
		a.last = true;
		e->step = fitting;
		return encode_once(e, &a, error);
	}
	return BP_OK;
}
