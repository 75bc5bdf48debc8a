/*
 * spans.h: rows of phi_d cut at the horizon or where measurements end, and cosine transforms of what is left of them.
 *
 * A direction below the horizon is never asked for, so of the row of a (theta_h, theta_d) only the cells that can be seen need a
 * value: `span` of them, around pi/2. Their cosine transform has as many coefficients (Sikora and Makai 1995, "Shape-adaptive
 * DCT"), where that of the whole row would have to shape what was never measured, and a kink where it begins. Half of a table's
 * rows are cut.
 *
 *     X_m = g s_m sum_k x_k cos(pi m (k + 1/2) / n), k and m = 0..n - 1     s_0 = sqrt(1/n), s_m = sqrt(2/n), g = sqrt(P/n)
 *
 * g makes the coefficients of equal rows alike whatever their span, so that wavelets over theta_h and theta_d find no edge.
 */
#ifndef MODEL_SPECTRAL_SPANS_H
#define MODEL_SPECTRAL_SPANS_H

#include "merl/lattice.h"

/*
 * span[theta_h theta_d], each of P's parity: the cells k with cos theta_h cos theta_d - sin theta_h sin theta_d |cos phi_d| above
 * `limit`, the angles at their lower end and |cos phi_d| at its least in the cell; at least 1, or 2 where P is even: a
 * row that cannot be seen keeps its middle, which those beside it are interpolated with. limit 0: rows are whole.
 */
#define SPAN_MARGIN 0x1p-30f /* the least limit: so that no rounding decides where a corner lies on the horizon itself */
void spans_find(struct lattice_dims dims, float limit, uint16_t *span);

/* A part in 65,536 below the highest limit that leaves every valid cell in its row; SPAN_MARGIN to below 1. */
float spans_limit(const struct lattice *lattice);

/* The cosines of rows of every span in use. */
struct span_cosines;

/*
 * For rows of p cells of the given spans. inverse: for span_inverse, otherwise for span_forward; harmonics: more are not worked
 * with, p for all.
 */
bp_status span_cosines_create(uint32_t p, const uint16_t *span, size_t rows, uint32_t harmonics, bool inverse,
                              struct span_cosines **out, bp_error *error);
void span_cosines_free(struct span_cosines *cosines); /* NULL is allowed */

/* One row of n cells less `base`, in place of its P values: coefficients in the order of spectrum_lane(P, m), 0 from m = n on. */
void span_forward(struct span_cosines *cosines, uint32_t n, float base, float *row);

/* Coefficients of rows that stand `stride` apart: of even harmonics and of odd ones, and how many of either may differ from 0. */
struct span_lanes {
	const float *even, *odd;
	size_t stride;
	uint32_t even_count, odd_count;
};

/*
 * `rows` rows of span n, at most SPAN_ROWS: P values each, `out_stride` apart; cells beyond the span get the value beside them.
 */
enum { SPAN_ROWS = 16 };
void span_inverse(struct span_cosines *cosines, uint32_t n, const struct span_lanes *in, size_t rows, float *out,
                  size_t out_stride);

#endif
