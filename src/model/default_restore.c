/*
 * default_restore.c: the levels of a decoded table (default_origin.h) of which cells are missing.
 *
 * Turn by turn the present values give coefficients, coefficients are drawn towards where they can have been, and what they say
 * of the missing cells are these cells' next values. Where a coefficient can have been: at 0 or at a level. What is near is set there, at first
 * only what is very near, at last everything; what is not, is drawn towards 0, the more the smaller it is (a penalty that grows as the
 * logarithm, as the bits of a level do). So of all the tables that agree with the present cells one is found that takes few bytes.
 *
 * Setting everything at once ends at wrong levels, at 2.6 to 4 times the error; without the drawing the levels take 0.3 to 3 % more
 * bytes than there is room for; with it they take 0 to 9 % fewer (surrogates; VARIANTS.md).
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "../memory.h"
#include "default_origin.h"
#include "spectrum_inverse.h"

enum { TURNS = 90, MOMENTUM_FROM = 10 }; /* the first turns' changes are not to be carried on: nothing takes them back far from all present cells */
static const float MOMENTUM = 0.9f;
static const float ZERO_FIRST = 0.3f, ZERO_LAST = 0.5f; /* what is set to 0, as a share of the least level's place */
static const float NEAR_LAST = 0.5f;                    /* what is set to a level: within so many steps; 0 at the first turn */
static const float DRAW_FIRST = 0.1f;                   /* a size of 1 is drawn towards 0 by so many steps; 0 at the last turn */

/* How a turn settles coefficients. */
struct turn {
	float zero, near, draw, momentum;
};

/* A coefficient that is not 0. */
struct settled {
	uint32_t row, lane;
	int32_t level;
	float value;
};

struct restoration {
	const struct lattice *lattice;
	const int *order;
	const struct default_origin *origin;
	struct spectrum *spectrum;
	struct spectrum_inverse *inverse;
	float *field[3];      /* the tables of the three fields, as they are now */
	float *before[3];     /* what missing cells were told in the turn before; owns the block */
	uint8_t *whole;       /* of the rows of phi_d: 1 where all cells are known */
	float *coefficient;   /* of one field */
	float *plane;
	struct settled *settled;
	uint32_t settled_count, settled_room;
	struct spectrum_term *term;
	uint32_t term_room, *start;
	/* Valid cells with a channel that is 0, where all that is known of it is that its logarithm was not above that. */
	uint32_t *dark, dark_count;
	float *dark_channel;  /* the channels' logarithms less base, three each */
};

static void restoration_free(struct restoration *r)
{
	free(r->before[0]);
	free(r->whole);
	free(r->coefficient);
	free(r->plane);
	free(r->settled);
	free(r->term);
	free(r->start);
	free(r->dark);
	free(r->dark_channel);
	spectrum_inverse_free(r->inverse);
}

static bp_status restoration_alloc(struct restoration *r, bp_error *error)
{
	const struct lattice_dims d = r->lattice->dims;
	const size_t cells = lattice_cells(d), rows = (size_t)d.theta_h * d.theta_d;
	size_t dark = 0;

	for (size_t i = 0; i < cells; i++)
		dark += r->lattice->valid[i] && !r->origin->known[i];
	r->before[0] = memory_alloc(3 * cells * sizeof(float));
	r->whole = malloc(rows);
	r->coefficient = memory_alloc(cells * sizeof(float));
	r->plane = memory_alloc(rows * SPECTRUM_BLOCK * sizeof(float));
	r->start = malloc(((size_t)d.phi_d + 2) * sizeof *r->start);
	r->dark = malloc((dark + 1) * sizeof *r->dark);
	r->dark_channel = malloc((dark + 1) * 3 * sizeof *r->dark_channel);
	if (!r->before[0] || !r->whole || !r->coefficient || !r->plane || !r->start || !r->dark || !r->dark_channel)
		return error_memory(error, 3 * cells * sizeof(float));
	r->before[1] = r->before[0] + cells;
	r->before[2] = r->before[1] + cells;
	return spectrum_inverse_create(d, &r->inverse, error);
}

/* The channels' logarithms become fields, in place; those of dark cells are kept. */
static void fields_start(struct restoration *r, float *const table[3])
{
	const struct default_origin *o = r->origin;
	const struct lattice_dims d = r->lattice->dims;
	const size_t cells = lattice_cells(d), rows = (size_t)d.theta_h * d.theta_d;

	for (size_t i = 0; i < cells; i++) {
		const float l[3] = {table[0][i] - o->base[0], table[1][i] - o->base[1], table[2][i] - o->base[2]};
		if (r->lattice->valid[i] && !o->known[i]) {
			memcpy(r->dark_channel + 3 * (size_t)r->dark_count, l, sizeof l);
			r->dark[r->dark_count++] = (uint32_t)i;
		}
		for (int f = 0; f < 3; f++)
			table[f][i] = o->grid.axis[f][0] * l[0] + o->grid.axis[f][1] * l[1] + o->grid.axis[f][2] * l[2];
	}
	for (int f = 0; f < 3; f++)
		r->field[f] = table[f];
	for (size_t row = 0; row < rows; row++)
		r->whole[row] = !memchr(o->known + row * d.phi_d, 0, d.phi_d);
}

static bp_status settled_add(struct restoration *r, struct settled settled, bp_error *error)
{
	if (r->settled_count == r->settled_room) {
		const uint32_t room = 2 * r->settled_room + 4096;
		struct settled *larger = realloc(r->settled, room * sizeof *larger);
		if (!larger)
			return error_memory(error, room * sizeof *larger);
		r->settled = larger;
		r->settled_room = room;
	}
	r->settled[r->settled_count++] = settled;
	return BP_OK;
}

/* The field's coefficients, as this turn settles them. */
static bp_status coefficients_settle(struct restoration *r, uint32_t f, const struct turn *turn, bp_error *error)
{
	const struct default_origin *o = r->origin;
	const struct lattice_dims d = r->lattice->dims;
	const uint32_t p = d.phi_d, rows = d.theta_h * d.theta_d;
	const float per = 1 / o->grid.step, least = turn->zero * (1 + fminf(o->grid.centre[0], o->grid.centre[2])) * o->grid.step;

	r->settled_count = 0;
	memcpy(r->coefficient, r->field[f], lattice_cells(d) * sizeof(float));
	spectrum_forward(r->spectrum, r->coefficient, 0);
	for (uint32_t row = 0; row < rows; row++)
		for (uint32_t q = 0; q < p; q++) {
			const float c = r->coefficient[(size_t)row * p + q];
			if (fabsf(c) < least)
				continue;
			const uint32_t low = f * p + spectrum_harmonic(p, q) >= o->grid.end;
			float size = fabsf(c) * per, at;
			const uint32_t level = default_grid_level(&o->grid, size, low, &at);
			if (size < turn->zero * (low ? 2 * (1 + o->grid.centre[2]) : 1 + o->grid.centre[0]))
				continue;
			if (fabsf(size - at) <= turn->near * (float)(1u << low))
				size = at;
			else
				size = fmaxf(size - turn->draw / fmaxf(size, 1), 0);
			if (size == 0)
				continue;
			const float value = size * o->grid.step;
			bp_status status = settled_add(r, (struct settled){row, q, c < 0 ? -(int32_t)level : (int32_t)level, c < 0 ? -value : value}, error);
			if (status)
				return status;
		}
	return BP_OK;
}

/* What was settled, by harmonics: terms for the inverse transform. */
static bp_status terms_order(struct restoration *r, bp_error *error)
{
	const uint32_t p = r->lattice->dims.phi_d;

	if (r->term_room < r->settled_room) {
		free(r->term);
		r->term_room = r->settled_room;
		r->term = malloc(r->term_room * sizeof *r->term);
		if (!r->term)
			return error_memory(error, r->term_room * sizeof *r->term);
	}
	/* start[m + 1] moves from the first of harmonic m to the end of it. */
	memset(r->start, 0, ((size_t)p + 2) * sizeof *r->start);
	for (uint32_t n = 0; n < r->settled_count; n++)
		r->start[spectrum_harmonic(p, r->settled[n].lane) + 2]++;
	for (uint32_t m = 0; m < p; m++)
		r->start[m + 2] += r->start[m + 1];
	for (uint32_t n = 0; n < r->settled_count; n++)
		r->term[r->start[spectrum_harmonic(p, r->settled[n].lane) + 1]++] = spectrum_term_make(r->inverse, r->settled[n].row, r->settled[n].value);
	return BP_OK;
}

/* What the terms say becomes the values of the field's missing cells. */
static void cells_update(struct restoration *r, uint32_t f, float momentum)
{
	const struct lattice_dims d = r->lattice->dims;
	const size_t p = d.phi_d, rows = (size_t)d.theta_h * d.theta_d;

	for (uint32_t k = 0; k < p; k += SPECTRUM_BLOCK) {
		const size_t width = p - k < SPECTRUM_BLOCK ? p - k : SPECTRUM_BLOCK;
		spectrum_inverse_block(r->inverse, r->term, r->start, k, r->plane);
		for (size_t row = 0; row < rows; row++) {
			if (r->whole[row])
				continue;
			const float *told = r->plane + row * SPECTRUM_BLOCK;
			const uint8_t *known = r->origin->known + row * p + k;
			float *restrict cell = r->field[f] + row * p + k, *restrict before = r->before[f] + row * p + k;
			for (size_t q = 0; q < width; q++) {
				const float next = momentum > 0 ? told[q] + momentum * (told[q] - before[q]) : told[q]; /* before: nothing yet */
				before[q] = told[q];
				cell[q] = known[q] ? cell[q] : next;
			}
		}
	}
}

/* The squares of what the terms miss the field's known cells by. */
static double cells_missed(struct restoration *r, uint32_t f)
{
	const struct lattice_dims d = r->lattice->dims;
	const size_t p = d.phi_d, rows = (size_t)d.theta_h * d.theta_d;
	double squares = 0;

	for (uint32_t k = 0; k < p; k += SPECTRUM_BLOCK) {
		const size_t width = p - k < SPECTRUM_BLOCK ? p - k : SPECTRUM_BLOCK;
		spectrum_inverse_block(r->inverse, r->term, r->start, k, r->plane);
		for (size_t row = 0; row < rows; row++)
			for (size_t q = 0; q < width; q++) {
				const size_t at = row * p + k + q;
				const double missed = r->origin->known[at] ? (double)(r->plane[row * SPECTRUM_BLOCK + q] - r->field[f][at]) : 0;
				squares += missed * missed;
			}
	}
	return squares;
}

/* Dark cells: channels that are known are as they were, the others what the fields say, but not above 0. */
static void dark_update(struct restoration *r)
{
	const struct default_origin *o = r->origin;

	for (uint32_t n = 0; n < r->dark_count; n++) {
		const uint32_t at = r->dark[n];
		float l[3];
		for (int c = 0; c < 3; c++) {
			l[c] = r->dark_channel[3 * (size_t)n + (size_t)c];
			if (r->lattice->rgb[r->order[c]][at] > 0)
				continue;
			const float now = o->grid.axis[0][c] * r->field[0][at] + o->grid.axis[1][c] * r->field[1][at] + o->grid.axis[2][c] * r->field[2][at];
			l[c] = fminf(now, l[c]);
		}
		for (int f = 0; f < 3; f++)
			r->field[f][at] = o->grid.axis[f][0] * l[0] + o->grid.axis[f][1] * l[1] + o->grid.axis[f][2] * l[2];
	}
}

static bp_status turn_take(struct restoration *r, const struct turn *turn, bp_error *error)
{
	for (uint32_t f = 0; f < 3; f++) {
		bp_status status = coefficients_settle(r, f, turn, error);
		if (!status)
			status = terms_order(r, error);
		if (status)
			return status;
		cells_update(r, f, turn->momentum);
	}
	dark_update(r);
	return BP_OK;
}

/* Every coefficient at its level: appends the levels, malloc'ed; squares of what they miss known cells by. */
static bp_status levels_take(struct restoration *r, struct default_level **levels, uint32_t *count, double *missed, bp_error *error)
{
	const struct turn last = {.zero = ZERO_LAST, .near = INFINITY};
	const size_t cells = lattice_cells(r->lattice->dims), p = r->lattice->dims.phi_d;

	for (uint32_t f = 0; f < 3; f++) {
		bp_status status = coefficients_settle(r, f, &last, error);
		if (!status)
			status = terms_order(r, error);
		if (status)
			return status;
		struct default_level *larger = realloc(*levels, (*count + (size_t)r->settled_count + 1) * sizeof *larger);
		if (!larger)
			return error_memory(error, (*count + (size_t)r->settled_count) * sizeof *larger);
		*levels = larger;
		for (uint32_t n = 0; n < r->settled_count; n++)
			larger[(*count)++] = (struct default_level){
				.at = (uint32_t)(f * cells + r->settled[n].row * p + r->settled[n].lane), .level = r->settled[n].level};
		*missed += cells_missed(r, f);
	}
	return BP_OK;
}

static void model_set(const struct default_grid *grid, uint32_t harmonics, struct default_level *levels, uint32_t count, struct default_model *model)
{
	uint32_t sizes = 0;

	for (uint32_t n = 0; n < count; n++)
		sizes |= (uint32_t)abs(levels[n].level);
	for (model->planes = 0; sizes >> model->planes;)
		model->planes++;
	model->step = grid->step;
	memcpy(model->centre, grid->centre, sizeof model->centre);
	model->end[0] = (model->planes - 1) * 3 * harmonics + grid->end;
	model->levels = levels;
	model->level_count = count;
}

bp_status default_origin_restore(const struct lattice *lattice, const int order[3], const struct default_origin *origin, struct spectrum *spectrum,
                                 float *const table[3], struct default_model *model, bp_error *error)
{
	struct restoration r = {.lattice = lattice, .order = order, .origin = origin, .spectrum = spectrum};
	const size_t cells = lattice_cells(lattice->dims);
	struct default_level *levels = NULL;
	uint32_t count = 0;
	size_t known = 0;
	double missed = 0;
	bp_status status = restoration_alloc(&r, error);

	for (size_t i = 0; i < cells; i++)
		known += origin->known[i];
	if (!status)
		fields_start(&r, table);
	for (int n = 0; !status && known < cells && n < TURNS; n++) {
		const float way = (float)n / (TURNS - 1), part = way * way * way; /* late: what is set early may be wrong */
		const struct turn turn = {
			.zero = ZERO_FIRST + part * (ZERO_LAST - ZERO_FIRST), .near = part * NEAR_LAST, .draw = DRAW_FIRST * (1 - part) * (1 - part),
			.momentum = n < MOMENTUM_FROM ? 0 : MOMENTUM,
		};
		status = turn_take(&r, &turn, error);
	}
	if (!status)
		status = levels_take(&r, &levels, &count, &missed, error);
	restoration_free(&r);
	if (status || !count) {
		free(levels);
		return status;
	}
	model_set(&origin->grid, lattice->dims.phi_d, levels, count, model);
	model->missed = missed * (double)cells / (double)known;
	return BP_OK;
}
