/*
 * locate.inc.h: what the kernels of both memory forms share: pairs of directions -> where to look.
 * The including file defines KERNEL(name); include once per file.
 */
#include "table.h"

/* One look-up: four rows of phi_d in memory, and the weights. Both forms use offset to p; the compact form all. */
struct lookup {
	uint32_t offset, step_h, step_d; /* from the table's start; to the next row along theta_h, along theta_d (0 at the end) */
	uint32_t residual, share;
	float h, d, p; /* fractions; at the end of theta_h and theta_d the step is 0, so any value will do */
	float place;
};

/* The lattice cell of a point, and the fractions beyond its lower corner. */
struct cell {
	int32_t i, j, k;
	float h, d, p;
};

static inline struct cell KERNEL(cell)(const struct table *t, struct lattice_point at)
{
	int32_t last_h = (int32_t)t->dims.theta_h - 1, last_d = (int32_t)t->dims.theta_d - 1, period = (int32_t)t->dims.phi_d;
	int32_t i = (int32_t)at.h, j = (int32_t)at.d, k = (int32_t)at.p;
	i = i < last_h ? i : last_h;
	j = j < last_d ? j : last_d;
	return (struct cell){i, j, k < period ? k : k - period, at.h - (float)i, at.d - (float)j, at.p - (float)k};
}

/* Pairs that are located together: the loop vectorises over them, and their cells are on the way to the cache while others are evaluated. */
enum { BLOCK = 64 };

struct lookups {
	uint32_t offset[BLOCK], step_h[BLOCK], step_d[BLOCK], residual[BLOCK], share[BLOCK];
	float h[BLOCK], d[BLOCK], p[BLOCK], place[BLOCK];
	float usable[BLOCK]; /* 1, or 0: the value is 0 */
};

/* Points of pairs first..first+n-1; returns n, at most BLOCK. The point of an unusable pair is 0, 0, 0. */
static size_t KERNEL(locate)(const struct table *t, size_t count, const float *const wi[3], const float *const wo[3], size_t first,
                             struct lookups *restrict to)
{
	const float *restrict ix = wi[0] + first, *restrict iy = wi[1] + first, *restrict iz = wi[2] + first;
	const float *restrict ox = wo[0] + first, *restrict oy = wo[1] + first, *restrict oz = wo[2] + first;
	const struct lattice_scale scale = t->scale;
	size_t n = count - first < BLOCK ? count - first : BLOCK;

	for (size_t m = 0; m < n; m++) {
		float squared_i = ix[m] * ix[m] + iy[m] * iy[m] + iz[m] * iz[m];
		float squared_o = ox[m] * ox[m] + oy[m] * oy[m] + oz[m] * oz[m];
		float ni = direction_normaliser(squared_i), no = direction_normaliser(squared_o);
		struct direction_arguments a =
			direction_arguments(ix[m] * ni, iy[m] * ni, iz[m] * ni, ox[m] * no, oy[m] * no, oz[m] * no);
		struct lattice_point at = direction_point(scale, quarter_turns(a.y[0], a.x[0]), quarter_turns(a.y[1], a.x[1]),
		                                          quarter_turns(a.y[2], a.x[2]), a.reflected);
		bool ok = direction_usable(iz[m], squared_i, oz[m], squared_o);
		to->h[m] = ok ? at.h : 0;
		to->d[m] = ok ? at.d : 0;
		to->p[m] = ok ? at.p : 0;
		to->usable[m] = ok ? 1 : 0;
	}
	return n;
}

/* Replaces the points by look-ups; FIND is inlined, and the loop vectorises. */
#define FIND_ALL(t, FIND, n, to)                                                                                             \
	for (size_t m = 0; m < n; m++) {                                                                                         \
		struct lookup l = FIND(t, KERNEL(cell)(t, (struct lattice_point){to->h[m], to->d[m], to->p[m]}));                    \
		to->offset[m] = l.offset;                                                                                            \
		to->step_h[m] = l.step_h;                                                                                            \
		to->step_d[m] = l.step_d;                                                                                            \
		to->residual[m] = l.residual;                                                                                        \
		to->share[m] = l.share;                                                                                              \
		to->h[m] = l.h;                                                                                                      \
		to->d[m] = l.d;                                                                                                      \
		to->p[m] = l.p;                                                                                                      \
		to->place[m] = l.place;                                                                                              \
	}

/* offset and steps count units of `unit` bytes */
static inline void KERNEL(fetch)(const struct table *t, const struct lookups *l, size_t m, size_t unit)
{
	const uint8_t *cell = t->store + unit * l->offset[m], *above = cell + unit * l->step_h[m];
	size_t step_d = unit * l->step_d[m];
	__builtin_prefetch(cell);
	__builtin_prefetch(cell + step_d);
	__builtin_prefetch(above);
	__builtin_prefetch(above + step_d);
}

/* evaluate, nearest and batch of one form: FIND(table, cell) -> lookup, VALUE(table, lookup, rgb), offsets in UNIT bytes. */
#define TABLE_FORMS(name, FIND, VALUE, UNIT)                                                                                 \
	static void KERNEL(name##_evaluate)(const struct table *t, const float wi[3], const float wo[3], float rgb[3])           \
	{                                                                                                                        \
		struct lattice_point at;                                                                                             \
		if (direction_locate(t->scale, wi, wo, &at)) {                                                                       \
			struct lookup lookup = FIND(t, KERNEL(cell)(t, at));                                                             \
			VALUE(t, &lookup, rgb);                                                                                          \
		} else {                                                                                                             \
			rgb[0] = rgb[1] = rgb[2] = 0;                                                                                    \
		}                                                                                                                    \
	}                                                                                                                        \
	static void KERNEL(name##_nearest)(const struct table *t, const float wi[3], const float wo[3], float rgb[3])            \
	{                                                                                                                        \
		struct lattice_point at;                                                                                             \
		if (direction_locate(t->scale, wi, wo, &at)) {                                                                       \
			struct cell cell = KERNEL(cell)(t, at);                                                                          \
			cell.h = cell.d = cell.p = 0;                                                                                    \
			struct lookup lookup = FIND(t, cell);                                                                            \
			VALUE(t, &lookup, rgb);                                                                                          \
		} else {                                                                                                             \
			rgb[0] = rgb[1] = rgb[2] = 0;                                                                                    \
		}                                                                                                                    \
	}                                                                                                                        \
	static size_t KERNEL(name##_locate)(const struct table *t, size_t count, const float *const wi[3],                       \
	                                    const float *const wo[3], size_t first, struct lookups *restrict to)                 \
	{                                                                                                                        \
		const struct table copy = *t; /* known not to change while *to is written */                                         \
		size_t n = KERNEL(locate)(t, count, wi, wo, first, to);                                                              \
		FIND_ALL((&copy), FIND, n, to)                                                                                       \
		return n;                                                                                                            \
	}                                                                                                                        \
	static void KERNEL(name##_batch)(const struct table *t, size_t count, const float *const wi[3], const float *const wo[3], \
	                                 float *const rgb[3])                                                                    \
	{                                                                                                                        \
		struct lookups both[2];                                                                                              \
		struct lookups *now = &both[0], *next = &both[1];                                                                    \
		size_t first = 0, n = count ? KERNEL(name##_locate)(t, count, wi, wo, 0, now) : 0, later = 0;                        \
		for (size_t m = 0; m < n; m++)                                                                                       \
			KERNEL(fetch)(t, now, m, UNIT);                                                                                  \
		for (; n; first += n, n = later) {                                                                                   \
			later = first + n < count ? KERNEL(name##_locate)(t, count, wi, wo, first + n, next) : 0;                        \
			for (size_t m = 0; m < n; m++) {                                                                                 \
				if (m < later)                                                                                               \
					KERNEL(fetch)(t, next, m, UNIT);                                                                         \
				struct lookup lookup = {now->offset[m], now->step_h[m], now->step_d[m], now->residual[m], now->share[m],     \
				                        now->h[m],      now->d[m],      now->p[m],      now->place[m]};                      \
				float value[3];                                                                                              \
				VALUE(t, &lookup, value);                                                                                    \
				for (int c = 0; c < 3; c++)                                                                                  \
					rgb[c][first + m] = value[c] * now->usable[m];                                                           \
			}                                                                                                                \
			struct lookups *swap = now;                                                                                      \
			now = next;                                                                                                      \
			next = swap;                                                                                                     \
		}                                                                                                                    \
	}
