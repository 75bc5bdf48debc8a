/*
 * spectral_project.c: better values for invalid cells, at the price of a pair of transforms: what the coefficients that a record
 * can hold say about them (projections onto convex sets, as Papoulis and Gerchberg did it for band-limited signals).
 *
 * A step takes the spectrum, drops what is below a threshold, and sets the invalid cells to what is left; measured cells stay.
 * The threshold falls to the one that leaves as many coefficients as the budget has bytes for.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "spectral.h"
#include "model/math/fast_math.h"
#include "spectrum_rows.h"

/* ---- which coefficients a record has room for ---- */

enum {
	BIN_SHIFT = 19, /* of a float's bits: 16 bins to the octave */
	BINS = 1 << (31 - BIN_SHIFT),
};
static const double BITS_EACH = 4.3; /* of a record, for each coefficient that is not 0: 3.8 to 4.9 on surrogates */

double spectral_places(double budget_bytes) { return budget_bytes * 8 / BITS_EACH; }

float spectral_size_of_rank(const float *coefficient, size_t rows, size_t lanes, size_t every, double count)
{
	uint32_t bins[BINS] = {0}, bin = BINS;
	double above = 0;

	for (size_t r = every / 2; r < rows; r += every)
		for (size_t k = r * lanes; k < (r + 1) * lanes; k++)
			bins[(bits_of_float(coefficient[k]) & 0x7fffffff) >> BIN_SHIFT]++;
	while (bin > 1 && above + (double)every * bins[bin - 1] <= count)
		above += (double)every * bins[--bin];
	return float_of_bits(bin << BIN_SHIFT < 0x7f800000 ? bin << BIN_SHIFT : 0x7f7fffff);
}

/* ---- projections ---- */

struct projection {
	struct lattice_dims dims;
	struct spectrum_inverse *inverse;
	struct spectral_factors factors;
	float *spectrum; /* of one channel, which are much alike */
	struct spectrum_rows *rows;
	float *cells; /* of some rows */
	struct spectrum_term *term;
	uint32_t *start;
	uint32_t room; /* terms */
};

static bp_status projection_create(struct lattice_dims d, const struct spectral_weights *weights, float limit, uint32_t room,
                                   struct projection *out, bp_error *error)
{
	const size_t cells = lattice_cells(d);

	*out = (struct projection){.dims = d, .room = room};
	out->spectrum = memory_alloc(cells * sizeof(float));
	out->cells = malloc(SPECTRUM_BLOCK * (size_t)d.phi_d * sizeof(float));
	out->term = malloc(((size_t)room + 1) * sizeof *out->term);
	out->start = malloc(((size_t)d.phi_d + 1) * sizeof *out->start);
	if (!out->spectrum || !out->cells || !out->term || !out->start)
		return error_memory(error, cells * sizeof(float));
	bp_status status = spectral_factors_create(d, weights, &out->factors, error);
	if (!status)
		status = spectral_inverse_create(d, weights, &out->inverse, error);
	return status ? status : spectrum_rows_create(out->inverse, limit, d.phi_d, false, &out->rows, error);
}

static void projection_free(struct projection *p)
{
	free(p->factors.row);
	free(p->spectrum);
	free(p->cells);
	spectrum_rows_free(p->rows);
	free(p->term);
	free(p->start);
	free(p->inverse);
}

/* One step on one channel's table. */
static bp_status channel_project(const struct projection *p, const uint8_t *valid, float base, float threshold, float *table,
                                 bp_error *error)
{
	const size_t lanes = p->dims.phi_d, rows = (size_t)p->dims.theta_h * p->dims.theta_d;
	uint32_t n = 0;

	for (uint32_t m = 0; m < lanes; m++) {
		const float *lane = p->spectrum + spectrum_lane(p->dims.phi_d, m);
		p->start[m] = n;
		for (uint32_t r = 0; r < rows && n < p->room; r++)
			if (fabsf(lane[r * lanes]) >= threshold)
				p->term[n++] = spectrum_term_make(p->inverse, r, m, lane[r * lanes]);
	}
	p->start[lanes] = n;
	const bp_status status = spectrum_rows_field(p->rows, 0, p->term, p->start, error);
	for (uint32_t r = 0; !status && r < rows; r += SPECTRUM_BLOCK) {
		const uint32_t count = rows - r < SPECTRUM_BLOCK ? (uint32_t)rows - r : SPECTRUM_BLOCK;
		spectrum_rows_cells(p->rows, 0, r, count, p->cells, lanes);
		for (size_t k = 0; k < count * lanes; k++)
			if (!valid[r * lanes + k])
				table[r * lanes + k] = p->cells[k] + base;
	}
	return status;
}

bp_status spectral_project(struct spectrum *spectrum, struct lattice_dims d, const uint8_t *valid, const float base[3],
                           const struct spectral_weights *weights, float limit, double budget_bytes, int steps,
                           float *const table[3], bp_error *error)
{
	const size_t cells = lattice_cells(d);
	const size_t rows = (size_t)d.theta_h * d.theta_d;
	const double wanted = spectral_places(budget_bytes) / 4; /* of one channel, which are much alike */
	struct projection p;
	bp_status status =
		projection_create(d, weights, limit, (uint32_t)fmin(fmin(wanted, (double)cells) * 2, (double)cells), &p, error);

	for (int c = 0; !status && c < 3; c++)
		for (int s = 0; !status && s < steps; s++) {
			memcpy(p.spectrum, table[c], cells * sizeof(float));
			spectrum_forward(spectrum, p.spectrum, base[c]);
			spectral_factors_divide(d, &p.factors, p.spectrum);
			/* Four times the last threshold at first where there are steps enough. */
			const float last = spectral_size_of_rank(p.spectrum, rows, d.phi_d, 1, wanted);
			const double factor = steps > 1 ? fast_exp2(2.0 * (steps - 1 - s) / (steps - 1)) : 1;
			status = channel_project(&p, valid, base[c], last * (float)factor, table[c], error);
		}
	projection_free(&p);
	return status;
}
