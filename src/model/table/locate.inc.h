/*
 * locate.inc.h: what the kernels of both memory forms share: pairs of directions -> where to look.
 * The including file defines KERNEL(name); include once per file.
 */
#include "clones.h"
#include "table_parts.h"

/* One look-up of many: four rows of phi_d in memory, and the weights. */
struct lookup {
	uint32_t offset;         /* from the table's start to the first neighbours along the three axes */
	uint32_t step_h, step_d; /* to the others along theta_h and theta_d */
	float h, d, p;           /* fractions of the way there, 0 to 1 */

	/* compact only */
	uint32_t residual, share; /* bytes from the block's start */
	float place;              /* between the two share codes */
};

/* The cell of the first neighbours, which may be the others too (table_parts.h), and the fractions of the way to those. */
struct cell {
	uint32_t i, j, k;
	uint32_t has_h, has_d; /* all bits, or none: the other neighbour is the first */
	float h, d, p;
};

/* The same for a single look-up: numbers of table_pair and table_place, fractions (h, ...) and (meaningless, d, p, 0). */
struct cell_x4 {
	uint32_t i, j, k;
	f32x4 h, beyond;
};

/*
 * From what direction_locate_squared gives: no number is out of range, since that is within the lattice. By more operations than
 * h in the same vector would take, but j and k, by which more is looked up, are there before the root is.
 */
static inline struct cell_x4 KERNEL(cell)(const struct table *t, f32x4 squared, f32x4 at)
{
	const f32x4 root = sqrt_x4(squared) + t->shift;
	at += t->shift;
	const i32x4 cell = __builtin_convertvector(at, i32x4), h = __builtin_convertvector(root, i32x4);
	return (struct cell_x4){
		.i = (uint32_t)h[0],
		.j = (uint32_t)cell[1],
		.k = (uint32_t)cell[2],
		.h = root - __builtin_convertvector(h, f32x4),
		.beyond = at - __builtin_convertvector(cell, f32x4),
	};
}

/* The cell that the point is in, and nothing of the next. */
static inline struct cell_x4 KERNEL(cell_nearest)(const struct table *t, f32x4 squared, f32x4 at)
{
	const f32x4 none = {0, 0, 0, 0};
	const i32x4 cell = __builtin_convertvector(min_x4(at, t->last), i32x4) + 1;
	const i32x4 h = __builtin_convertvector(min_x4(sqrt_x4(squared), t->last), i32x4) + 1;
	return (struct cell_x4){(uint32_t)h[0], (uint32_t)cell[1], (uint32_t)cell[2], none, none};
}

/* Pairs that are located together: loops vectorise over them, and their cells are on the way while others are evaluated. */
enum { BLOCK = 64 };

struct lookups {
	uint32_t offset[BLOCK], step_h[BLOCK], step_d[BLOCK], residual[BLOCK], share[BLOCK];
	float h[BLOCK], d[BLOCK], p[BLOCK], place[BLOCK];
	int32_t usable[BLOCK]; /* all bits, or none: the value is 0 */
	bool all_usable;
	size_t count;
};

/* Three components of n directions. */
struct components {
	const float *x, *y, *z;
};

/* The points of n usable pairs; where `unit`, they are unit vectors already. */
static ALWAYS_INLINE void KERNEL(points)(const struct table *t, size_t n, bool unit, struct components i, struct components o,
                                         struct lookups *restrict to)
{
	const float *restrict ix = i.x, *restrict iy = i.y, *restrict iz = i.z, *restrict ox = o.x, *restrict oy = o.y,
						  *restrict oz = o.z;
	const float scale[3] = {t->scale[0], t->scale[1], t->scale[2]};
	for (size_t m = 0; m < n; m++) {
		float ni = unit ? 1 : direction_normaliser(ix[m] * ix[m] + iy[m] * iy[m] + iz[m] * iz[m]);
		float no = unit ? 1 : direction_normaliser(ox[m] * ox[m] + oy[m] * oy[m] + oz[m] * oz[m]);
		struct direction_arguments a =
			direction_arguments(ix[m] * ni, iy[m] * ni, iz[m] * ni, ox[m] * no, oy[m] * no, oz[m] * no);
		struct lattice_point at = direction_point(&a, scale);
		to->h[m] = at.h;
		to->d[m] = at.d;
		to->p[m] = at.p;
	}
}

/* Points of the pairs from `first` on, at most BLOCK. The point of an unusable pair is 0, 0, 0. */
static void KERNEL(locate)(const struct table *t, size_t count, const float *const wi[3], const float *const wo[3], size_t first,
                           struct lookups *restrict to)
{
	const struct components i = {wi[0] + first, wi[1] + first, wi[2] + first}, o = {wo[0] + first, wo[1] + first, wo[2] + first};
	size_t n = count - first < BLOCK ? count - first : BLOCK;
	int32_t unit = -1, usable = -1; /* of all */

	for (size_t m = 0; m < n; m++) {
		float squared_i = i.x[m] * i.x[m] + i.y[m] * i.y[m] + i.z[m] * i.z[m];
		float squared_o = o.x[m] * o.x[m] + o.y[m] * o.y[m] + o.z[m] * o.z[m];
		bool both = (fabsf(squared_i - 1) < DIRECTION_UNIT_SLACK) & (fabsf(squared_o - 1) < DIRECTION_UNIT_SLACK);
		unit &= both ? -1 : 0;
		to->usable[m] = direction_usable(i.z[m], squared_i, o.z[m], squared_o) ? -1 : 0;
		usable &= to->usable[m];
	}
	if (unit)
		KERNEL(points)(t, n, true, i, o, to);
	else
		KERNEL(points)(t, n, false, i, o, to);
	to->all_usable = usable != 0;
	to->count = n;
	for (size_t m = 0; !usable && m < n; m++) {
		to->h[m] = to->usable[m] ? to->h[m] : 0;
		to->d[m] = to->usable[m] ? to->d[m] : 0;
		to->p[m] = to->usable[m] ? to->p[m] : 0;
	}
}

/* The cell of one of many points, for a loop that vectorises. */
static inline struct cell KERNEL(cell_of)(struct lattice_dims dims, float shift, float h, float d, float p)
{
	h += shift;
	d += shift;
	p += shift;
	const int32_t i = (int32_t)h, j = (int32_t)d, k = (int32_t)p;
	return (struct cell){
		.i = (uint32_t)(i - (i > 0)),
		.j = (uint32_t)(j - (j > 0)),
		.k = (uint32_t)(k > 0 ? k : (int32_t)dims.phi_d) - 1,
		.has_h = ((i > 0) & (i < (int32_t)dims.theta_h)) ? UINT32_MAX : 0,
		.has_d = ((j > 0) & (j < (int32_t)dims.theta_d)) ? UINT32_MAX : 0,
		.h = h - (float)i,
		.d = d - (float)j,
		.p = p - (float)k,
	};
}

/*
 * Look-up m of the block after this one, if there is: its four rows are on the way while others are evaluated.
 * Always inline: gcc takes a function that only prefetches for one without effects, and drops calls of it.
 */
static ALWAYS_INLINE void KERNEL(fetch)(const struct table *t, const struct lookups *next, size_t m, size_t unit)
{
	if (m >= next->count)
		return;
	const size_t step_h = unit * next->step_h[m], step_d = unit * next->step_d[m];
	const uint8_t *cell = t->store + unit * next->offset[m];
	__builtin_prefetch(cell);
	__builtin_prefetch(cell + step_d);
	__builtin_prefetch(cell + step_h);
	__builtin_prefetch(cell + step_h + step_d);
}

/* What one memory form and number of channels is made of. Constant where it is used, so that the calls below become inline. */
struct KERNEL(form) {
	void (*one)(const struct table *t, const struct cell_x4 *at, float rgb[3]);
	struct lookup (*find)(const struct table *t, struct cell cell);             /* for a loop that vectorises */
	void (*value)(const struct table *t, const struct lookup *l, float rgb[3]); /* of one of many, to the same bits as `one` */
	void (*values)(const struct table *t, const struct lookups *l, const struct lookups *next, float *restrict r,
	               float *restrict g, float *restrict b); /* in place of `value`, where not NULL */
	size_t unit;                                          /* bytes to which offsets count */
	bool compact;                                         /* residual, share and place are in use */
};

static ALWAYS_INLINE void KERNEL(form_evaluate)(const struct KERNEL(form) form, bool nearest, const struct table *t,
                                                const float wi[3], const float wo[3], float rgb[3])
{
	f32x4 squared, at;
	if (direction_locate_squared(t->scale, wi, wo, &squared, &at)) {
		const struct cell_x4 cell = nearest ? KERNEL(cell_nearest)(t, squared, at) : KERNEL(cell)(t, squared, at);
		form.one(t, &cell, rgb);
	} else {
		rgb[0] = rgb[1] = rgb[2] = 0;
	}
}

static ALWAYS_INLINE void KERNEL(form_locate)(const struct KERNEL(form) form, const struct table *t, size_t count,
                                              const float *const wi[3], const float *const wo[3], size_t first,
                                              struct lookups *restrict to)
{
	const struct table copy = *t; /* known not to change while *to is written */
	const float shift = t->shift[0];
	KERNEL(locate)(t, count, wi, wo, first, to);
	for (size_t m = 0, n = to->count; m < n; m++) {
		const struct lookup l = form.find(&copy, KERNEL(cell_of)(copy.dims, shift, to->h[m], to->d[m], to->p[m]));
		to->offset[m] = l.offset;
		to->step_h[m] = l.step_h;
		to->step_d[m] = l.step_d;
		to->h[m] = l.h;
		to->d[m] = l.d;
		to->p[m] = l.p;
		if (form.compact) {
			to->residual[m] = l.residual;
			to->share[m] = l.share;
			to->place[m] = l.place;
		}
	}
}

static ALWAYS_INLINE void KERNEL(form_values)(const struct KERNEL(form) form, const struct table *t, const struct lookups *l,
                                              const struct lookups *next, float *restrict r, float *restrict g, float *restrict b)
{
	for (size_t m = 0; m < l->count; m++) {
		KERNEL(fetch)(t, next, m, form.unit);
		struct lookup lookup = {
			.offset = l->offset[m], .step_h = l->step_h[m], .step_d = l->step_d[m], .h = l->h[m], .d = l->d[m], .p = l->p[m]};
		if (form.compact)
			lookup.residual = l->residual[m];
		float value[3];
		form.value(t, &lookup, value);
		r[m] = value[0];
		g[m] = value[1];
		b[m] = value[2];
	}
}

static ALWAYS_INLINE void KERNEL(form_batch)(const struct KERNEL(form) form, const struct table *t, size_t count,
                                             const float *const wi[3], const float *const wo[3], float *const rgb[3])
{
	struct lookups both[2];
	struct lookups *now = &both[0], *next = &both[1];
	KERNEL(form_locate)(form, t, count, wi, wo, 0, now);
	for (size_t m = 0; m < now->count; m++)
		KERNEL(fetch)(t, now, m, form.unit);
	for (size_t first = 0; now->count;) {
		struct lookups *done = now;
		float *const r = rgb[0] + first, *const g = rgb[1] + first, *const b = rgb[2] + first;
		KERNEL(form_locate)(form, t, count, wi, wo, first + now->count, next);
		if (form.values)
			form.values(t, now, next, r, g, b);
		else
			KERNEL(form_values)(form, t, now, next, r, g, b);
		for (size_t m = 0; m < now->count && !now->all_usable; m++)
			r[m] = now->usable[m] ? r[m] : 0, g[m] = now->usable[m] ? g[m] : 0, b[m] = now->usable[m] ? b[m] : 0;
		first += now->count;
		now = next;
		next = done;
	}
}

/* The three entries of a form for struct table_kernels: name_evaluate, name_nearest, name_batch. */
#define FORM_ENTRIES(name) \
	static void KERNEL(name##_evaluate)(const struct table *t, const float wi[3], const float wo[3], float rgb[3]) \
	{ \
		KERNEL(form_evaluate)(KERNEL(name), false, t, wi, wo, rgb); \
	} \
	static void KERNEL(name##_nearest)(const struct table *t, const float wi[3], const float wo[3], float rgb[3]) \
	{ \
		KERNEL(form_evaluate)(KERNEL(name), true, t, wi, wo, rgb); \
	} \
	static void KERNEL(name##_batch)(const struct table *t, size_t count, const float *const wi[3], const float *const wo[3], \
	                                 float *const rgb[3]) \
	{ \
		KERNEL(form_batch)(KERNEL(name), t, count, wi, wo, rgb); \
	}
