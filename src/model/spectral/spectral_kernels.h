/* spectral_kernels.h: transforms, and the loops of fit and expansion, compiled twice (math/kernels.h). */
#ifndef MODEL_SPECTRAL_SPECTRAL_KERNELS_H
#define MODEL_SPECTRAL_SPECTRAL_KERNELS_H

#include <stddef.h>
#include <stdint.h>

#include "model/math/kernels.h"

/* So many lights of one strength, where white is 1. */
struct spectral_light {
	double radiance, count;
};

struct spectral_kernels {
	/*
	 * out[r][c] = sum over k < count of in[r][k] matrix[k][c], for `columns` (a multiple of 16) columns. The out rows are
	 * out_stride >= columns apart.
	 */
	void (*cosine_product)(const float *in, size_t in_stride, size_t rows, size_t count, const float *matrix, size_t columns,
	                       float *out, size_t out_stride);

	/* n values from n/2 sums x_k + x_{n-1-k} and differences, where n is odd one more sum: the middle value. out is neither. */
	void (*span_unfold)(const float *sum, const float *difference, size_t n, float *out);

	/* The steps of cosines.h; rows of 16 values. */
	void (*cosine_fold)(const float *x, size_t n, float *sum, float *difference);
	void (*cosine_rotate)(const float *x, size_t n, const float *angle, float *a, float *b);
	void (*cosine_join)(const float *a, const float *b, size_t n, float *out, size_t stride);

	/* 16 rows of n values, less `base`, to out[n][16]; and every second of in[2 count][16] to the first values of 16 rows. */
	void (*cosine_gather)(const float *rows, size_t n, float base, float *out);
	void (*cosine_scatter)(const float *in, size_t count, size_t n, float *rows);

	/* One level along one axis of n >= 2 rows of `width` values, `stride` apart, coarse rows first; scratch: 24 n. */
	void (*cdf97_forward)(float *x, size_t n, size_t stride, size_t width, float *scratch);

	/*
	 * The inverse wavelets of a plane [rows][columns][16], whose coefficients stand in their places. `half`: only cells of even
	 * row and column come out, the others mean nothing.
	 */
	void (*cdf97_plane)(float *plane, size_t rows, size_t columns, unsigned levels, int half);

	/* out = log2(1 + factor b) where valid, else 0; returns their sum. */
	double (*spectral_logs)(const double *b, const uint8_t *valid, size_t n, double factor, float *out);

	/* Adds w x_i x_j with w = 1/(1 + x_0^2 + x_1^2 + x_2^2) to sums, ij = 00, 01, 02, 11, 12, 22. */
	void (*spectral_moments)(const float *const x[3], size_t n, double sums[6]);

	/* rgb_c = max(0, 2^l - 1) with l = min(most, base[c] + sum over f of rotation[f][c] field_f), for `width` cells. */
	void (*spectral_values)(const float *const field[3], size_t width, const float base[3], const float rotation[3][3],
	                        float most, float *const rgb[3]);

	/*
	 * The same as 16-bit floats of table.h's expanded form, in units of 2^39 (that of l = 40 is 65535): `channels` of them for
	 * every cell, or 1, the channels' mean.
	 */
	void (*spectral_codes)(const float *const field[3], size_t width, const float base[3], const float rotation[3][3], float most,
	                       int channels, uint16_t *out);

	/* field_f = sum over c of rotation[f][c] x_c, in place. */
	void (*spectral_rotate)(float *const x[3], size_t n, const float rotation[3][3]);

	/*
	 * A piece of a row of the fill: where filled = 1, a cell becomes the weighted mean of its six neighbours (phi_d counts four
	 * times: along it the field is smoothest, and its basis has the fewest coefficients); where it is 0, it stays. Along phi_d
	 * the neighbours are the old values, with one before and one after the piece.
	 */
	void (*spectral_smooth)(float *x, const float *filled, const float *const neighbour[4], size_t n, float before, float after);

	/*
	 * x_q times max(0, 1 - threshold factor_q / e_q), e being the sum of the squares of the 3 x 3 coefficients around and, half
	 * as much each, of the lanes before and after. square[r] + q + s stride: those of row r - 1 and column s - 1.
	 */
	void (*spectral_shrink)(float *x, const float *const square[3], size_t stride, const float *factor, float threshold,
	                        size_t n);

	/* x = log2 x, of normal positive numbers. */
	void (*spectral_log2s)(double *x, size_t n);

	/*
	 * out: the worth of a relative error of n values, each times its cosine, but for the other direction's cosine: the square of
	 * what the error does to a pixel after the sRGB curve, summed over the lights; `ambient` is what else the pixel holds.
	 */
	void (*spectral_worths)(const double *radiance, size_t n, const struct spectral_light *lights, size_t light_count,
	                        double ambient, double *out);
};

KERNELS_OF_THREE(spectral)

#endif
