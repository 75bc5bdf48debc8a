/*
 * kernels.h: the hot loops, compiled twice and chosen once.
 *
 * The loops stand in the files NAME.inc.h as static functions KERNEL(name). kernels.c includes them all for
 * any x86-64 (or other) processor, kernels_avx2.c the same text with AVX2; each ends in one table of
 * function pointers. To add a loop: write KERNEL(loop) in an .inc.h, include that in kernels.inc.h, add a
 * member here and an initialiser there.
 *
 * Both tables give the same bits: no fused multiply-add, no reassociation by the compiler, and sums run over
 * a fixed number of lanes (vector.h) whatever the machine's vectors are.
 */
#ifndef MODEL_KERNELS_H
#define MODEL_KERNELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct fidelity_sums {
	double log_squares;      /* of log2 ratios */
	double cube_root_squares;
	double largest_relative;
};

/* One channel of a decoded table, and where its sums go. */
struct fidelity_table {
	const float *e;
	double unit;
	struct fidelity_sums *sums;
};

/* Observations of one regression; see robust.h. excess = 1/sqrt(1 - leverage) - 1. */
struct robust_sample {
	const double *x, *y;
	const double *excess;
	size_t n;
};

/* y = centre_y + rest_y + slope (x - centre_x) */
struct robust_line {
	double centre_x, centre_y, slope;
	double rest_y; /* what rounding took from centre_y; 0 where that is nothing beside the residuals. Anchors know none. */
};

/* Sums over the sample: dx = x - centre_x, r = y - line, w = q^2 the bisquare weight. */
struct robust_sums {
	double root; /* of q = max(0, 1 - u^2) */
	double w, wx, wxx, wr, wxr;
	size_t rejected; /* observations of weight 0 */
};

/* How far the line and the scale may move from an anchor, and the bounds that follow; see robust_anchor.h. */
struct anchor_reach {
	double centre_y, slope;          /* largest changes of the line, its centre_x held */
	double median_low, median_high;  /* the median stays between these */
	double limit_low, limit_high;    /* and the residual from which on a weight is 0 between these */
};

/* Copies of some observations: `capacity` places, of which `count` are taken. */
struct anchor_list {
	double *x, *y;
	double *excess;
	size_t count, capacity;
};

enum { ANCHOR_R = 6, ANCHOR_T = 7 };
struct anchor_sums {
	/*
	 * moment[k][p][i] = sum of l^(2k) r^p t^i, l = 1 + excess, r = y - line, t = x - centre_x, over the observations whose
	 * weight stays above 0; for p + i <= 2 + 2k, p <= 1 + 2k or k = 0, else 0.
	 */
	double moment[3][ANCHOR_R][ANCHOR_T];
	size_t below;   /* observations that stay below the median */
	size_t outside; /* observations whose weight stays 0 */
	struct anchor_list *near; /* those that may cross the median */
	struct anchor_list *edge; /* those whose weight may become or leave 0 */
};

/* One level of the pyramid of fill.h. */
struct fill_level {
	uint32_t rows, columns;
	float *value;
	uint8_t *valid;
};

struct spectrum_term;
struct compact_rows_plan;

struct kernels {
	/*
	 * Adds the n cells of one channel of one theta_h slice to the sums of every table: b measured, unit * e decoded, in 1/sr;
	 * cosine >= 0; cells with valid = 0 add nothing.
	 */
	void (*fidelity_slice)(const double *b, const uint8_t *valid, const float *cosine, size_t n, const struct fidelity_table *tables,
	                       size_t count);

	/* out = row column dphi (NULL: 1), of paper_expand.c; and rgb = max(0, diffuse + specular achromatic). */
	void (*paper_row)(float row, const float *column, const float *dphi, size_t n, float *out);
	void (*paper_colour)(const float *achromatic, size_t n, const float diffuse[3], const float specular[3], float limit,
	                     float *const rgb[3]);

	/*
	 * With v = |y - line| (1 + excess) of every observation: *below = how many are < low; copies those in [low, high] to
	 * inside (n + 1 long) and returns how many they are.
	 */
	size_t (*robust_scale)(const struct robust_sample *sample, const struct robust_line *line, double low, double high,
	                       double *inside, size_t *below);
	/* The weighted sums with u = (y - line) (1 + excess) inverse_scale. Blocks of 512 in four lanes, blocks compensated. */
	void (*robust_sums)(const struct robust_sample *sample, const struct robust_line *line, double inverse_scale,
	                    struct robust_sums *out);

	/*
	 * All of *out for one line; blocks of 256 in four lanes, blocks compensated. False, with *out unspecified, when a list
	 * has no room for another 256.
	 */
	bool (*robust_anchor)(const struct robust_sample *sample, const struct robust_line *line, const struct anchor_reach *reach,
	                      struct anchor_sums *out);

	/*
	 * value = factor (r + g + b) where valid, else 0, for the n cells of a row; adds them to column_sum and the valid
	 * ones to column_count; *count = the valid ones. Returns their sum, in four lanes.
	 */
	double (*density_row)(const double *const rgb[3], const uint8_t *valid, size_t n, double factor, double *value,
	                      double *column_sum, uint32_t *column_count, uint32_t *count);

	/* The steps of fill.h; scratch holds two rows and four cells. */
	size_t (*fill_halve)(const struct fill_level *fine, const struct fill_level *coarse);
	void (*fill_interpolate)(const struct fill_level *coarse, const struct fill_level *fine, int wrap_rows, int wrap_columns,
	                         float *scratch);
	void (*fill_smooth)(const struct fill_level *level, int wrap_rows, int wrap_columns, unsigned sweeps, float *scratch);

	/*
	 * out[r][c] = sum over k < count of in[r][k] matrix[k][c], for `columns` (a multiple of 16) columns. The out rows are
	 * out_stride >= columns apart.
	 */
	void (*cosine_product)(const float *in, size_t in_stride, size_t rows, size_t count, const float *matrix, size_t columns,
	                       float *out, size_t out_stride);
	/* The steps of cosines.h; rows of 16 values. */
	void (*cosine_fold)(const float *x, size_t n, float *sum, float *difference);
	void (*cosine_rotate)(const float *x, size_t n, const float *angle, float *a, float *b);
	void (*cosine_join)(const float *a, const float *b, size_t n, float *out, size_t stride);
	/* 16 rows of n values, less `base`, to out[n][16]; and every second of in[2 count][16] to the first values of 16 rows. */
	void (*cosine_gather)(const float *rows, size_t n, float base, float *out);
	void (*cosine_scatter)(const float *in, size_t count, size_t n, float *rows);
	/* One level along one axis of n >= 2 rows of `width` values, `stride` apart, coarse rows first; scratch: 12 n. */
	void (*cdf97_forward)(float *x, size_t n, size_t stride, size_t width, float *scratch);
	/* plane[place] += value cosine, 16 values each, for every term; the steps of cdf97_plane: spectrum_inverse.h. */
	void (*spectrum_spread)(const struct spectrum_term *terms, size_t count, const float *cosine, float *plane);
	/*
	 * The inverse wavelets of a plane [rows][columns][16], whose coefficients stand in their places. `half`: only cells of even row
	 * and column come out, the others mean nothing.
	 */
	void (*cdf97_plane)(float *plane, size_t rows, size_t columns, unsigned levels, int half);

	/* out = log2(1 + factor b) where valid, else 0; returns their sum. */
	double (*spectral_logs)(const double *b, const uint8_t *valid, size_t n, double factor, float *out);
	/* The largest valid b; 0 where none is above 0. */
	double (*spectral_largest)(const double *b, const uint8_t *valid, size_t n);
	/* Adds w x_i x_j with w = 1/(1 + x_0^2 + x_1^2 + x_2^2) to sums, ij = 00, 01, 02, 11, 12, 22. */
	void (*spectral_moments)(const float *const x[3], size_t n, double sums[6]);
	/*
	 * rgb_c = max(0, 2^l - 1) with l = min(most, base[c] + sum over f of rotation[f][c] field_f), for `rows` rows of `width`
	 * cells, `stride` apart in the fields (where it is 16, of at most 16 cells) and rgb_stride apart in rgb.
	 */
	void (*spectral_values)(const float *const field[3], size_t rows, size_t width, size_t stride, const float base[3],
	                       const float rotation[3][3], float most, float *const rgb[3], size_t rgb_stride);
	/*
	 * The same as 16-bit floats of table.h's expanded form, in units of 2^39 (that of l = 40 is 65535): `channels` of them for
	 * every cell, or 1, the channels' mean; rows of `width` cells are out_stride codes apart.
	 */
	void (*spectral_codes)(const float *const field[3], size_t rows, size_t width, size_t stride, const float base[3],
	                      const float rotation[3][3], float most, int channels, uint16_t *out, size_t out_stride);
	/*
	 * A row of values in the compact form, its first block at `block`, but for the shares' codes: three of R and three of B for every block
	 * go to knots, as they are.
	 */
	void (*compact_row)(const struct compact_rows_plan *plan, const float *const rgb[3], uint8_t *block, float *const knots[2]);
	/* field_f = sum over c of rotation[f][c] x_c, in place. */
	void (*spectral_rotate)(float *const x[3], size_t n, const float rotation[3][3]);
	/*
	 * A piece of a row of the fill: where filled = 1, a cell becomes the weighted mean of its six neighbours (phi_d counts four times:
	 * along it the field is smoothest, and its basis has the fewest coefficients); where it is 0, it stays. Along phi_d the
	 * neighbours are the old values, with one before and one after the piece.
	 */
	void (*spectral_smooth)(float *x, const float *filled, const float *const neighbour[4], size_t n, float before, float after);
	/*
	 * x_q times max(0, 1 - threshold factor_q / e_q), e being the sum of the squares of the 3 x 3 coefficients around and, half as much
	 * each, of the lanes before and after. square[r] + q + s stride: those of row r - 1 and column s - 1.
	 */
	void (*spectral_shrink)(float *x, const float *const square[3], size_t stride, const float *factor, float threshold, size_t n);
};

/* The table for this processor. Thread-safe; never NULL. */
const struct kernels *kernels_get(void);

extern const struct kernels kernels_plain, kernels_avx2; /* kernels_avx2: only where kernels_avx2_usable() */
int kernels_avx2_usable(void);

#endif
