/*
 * spectral_denoise.c: what noise alone would explain is drawn towards 0 (block shrinkage: Cai and Silverman 2001).
 *
 *     kept = c max(0, 1 - LAMBDA sigma^2 / mean square of the coefficients around c)
 *
 * The noise is estimated from the table itself, by medians of the finest diagonal band, in which smooth materials
 * have next to nothing: sigma = scale(theta_d) * factor(harmonic), because measurements grow noisy towards grazing angles.
 * Faults that are constant along phi_d are in the first harmonic only, and do not: there sigma^2 = scale(theta_d)^2 + streak^2.
 * An orthonormal transform spreads white noise evenly over its bands, so the estimate serves all of them. It is made where rows
 * are whole: what is cut has fewer coefficients, and its noise is that of grazing light.
 *
 * All of it is done to the spectrum of the turned table too (spectrum_turn.h); the mean of both is what is kept.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "memory.h"
#include "spans.h"
#include "spectral.h"
#include "model/math/fast_math.h"
#include "spectral_kernels.h"
#include "model/math/select.h"
#include "spectrum_turn.h"
#include "watch.h"

enum { LANES = 16 };

static const float LAMBDA = 1.6f;           /* VARIANTS.md, "Noise" */
static const double NORMAL_MEDIAN = 0.6745; /* of |x| for a standard normal x */
static const float NOISE_LEAST = 0.008f;    /* in log2 units: below this sigma nothing is done */

struct noise {
	float *scale;  /* per theta_d column of the finest bands */
	float *factor; /* per lane; squared, once all is known; lane 0: of the column at hand */
	float streak;  /* squared: what the first harmonic has besides, in every column */
	float level;   /* three quarters of the scales are below; 0: nothing is done */
};

/* The one of n sizes >= 0 that `rank` of them are below; few: room for as many of them. */
static double ranked(const float *size, size_t n, size_t rank, double *few)
{
	enum { SHIFT = 20, BINS = 1 << (31 - SHIFT) }; /* eight to the octave */
	uint32_t bins[BINS] = {0}, bin = 0;
	size_t below = 0, kept = 0;

	if (!n)
		return 0;
	for (size_t i = 0; i < n; i++)
		bins[bits_of_float(size[i]) >> SHIFT]++;
	while (below + bins[bin] <= rank)
		below += bins[bin++];
	for (size_t i = 0; i < n; i++)
		if (bits_of_float(size[i]) >> SHIFT == bin)
			few[kept++] = (double)size[i];
	return select_kth(few, kept, rank - below);
}

static double median(const float *size, size_t n, double *few) { return ranked(size, n, n / 2, few); }

/* The finest diagonal band of a spectrum, and room for medians of it. */
struct finest {
	struct lattice_dims dims;
	const uint16_t *span;
	const float *band;
	uint32_t rows, columns;
	float *sample;
	double *few;
};

/* The lanes of its detail (y, x), or NULL where the row in whose middle that lies is not a whole one. */
static const float *detail_lanes(const struct finest *f, uint32_t y, uint32_t x)
{
	const struct lattice_dims d = f->dims;
	return f->span[(2 * y + 1) * d.theta_d + 2 * x + 1] == d.phi_d ? f->band + ((size_t)y * d.theta_d + x) * d.phi_d : NULL;
}

/* The scale of every column, from a quarter of its coefficients of the higher harmonics. */
static void scale_estimate(const struct finest *f, float *scale)
{
	const uint32_t lanes = f->dims.phi_d, even = (lanes + 1) / 2, low = even / 5; /* lanes low.. of either kind */

	for (uint32_t x = 0; x < f->columns; x++) {
		size_t n = 0;
		for (uint32_t y = 0; y < f->rows; y++) {
			const float *row = detail_lanes(f, y, x);
			for (uint32_t q = (4 - y % 4) % 4; row && q < lanes; q += 4)
				if ((q < even ? q : q - even) >= low)
					f->sample[n++] = fabsf(row[q]);
		}
		scale[x] = (float)(median(f->sample, n, f->few) / NORMAL_MEDIAN) + 1e-12f;
	}
}

/* The factor of every lane, from every second of its coefficients; LANES lanes at a time, which stand side by side in memory. */
static void factor_estimate(const struct finest *f, struct noise *noise)
{
	const size_t room = (size_t)f->rows * f->columns;

	for (uint32_t q0 = 0; q0 < f->dims.phi_d; q0 += LANES) {
		const uint32_t count = f->dims.phi_d - q0 < LANES ? f->dims.phi_d - q0 : LANES;
		size_t n[LANES] = {0};
		for (uint32_t y = 0; y < f->rows; y++)
			for (uint32_t x = 0; x < f->columns; x++) {
				const float *row = detail_lanes(f, y, x), per = 1 / noise->scale[x];
				for (uint32_t q = (x + y + q0) % 2; row && q < count; q += 2)
					f->sample[q * room + n[q]++] = fabsf(row[q0 + q]) * per;
			}
		for (uint32_t q = 0; q < count; q++)
			noise->factor[q0 + q] = (float)(median(f->sample + q * room, n[q], f->few) / NORMAL_MEDIAN);
	}
}

/* The level, and the streaks: by how much the first harmonic's noise is above it. */
static void streak_estimate(const struct finest *f, struct noise *noise)
{
	float *first = f->sample, *scale = f->sample + (size_t)f->rows * f->columns;
	size_t n = 0;

	for (uint32_t y = 0; y < f->rows; y++)
		for (uint32_t x = 0; x < f->columns; x++) {
			const float *row = detail_lanes(f, y, x);
			if (!row)
				continue;
			first[n] = fabsf(row[0]);
			scale[n++] = noise->scale[x];
		}
	const double all = median(first, n, f->few) / NORMAL_MEDIAN, white = median(scale, n, f->few);
	noise->streak = (float)fmax(all * all - white * white, 0);
	noise->level = (float)ranked(scale, n, n / 4 * 3, f->few);
}

static bp_status noise_estimate(struct lattice_dims d, const uint16_t *span, const float *c, struct noise *noise, bp_error *error)
{
	struct finest f = {.dims = d, .span = span, .rows = d.theta_h / 2, .columns = d.theta_d / 2};
	const size_t room = (size_t)f.rows * (d.phi_d > LANES * f.columns ? d.phi_d : LANES * f.columns);
	float largest = 0;

	f.band = c + ((size_t)(d.theta_h - f.rows) * d.theta_d + d.theta_d - f.columns) * d.phi_d;
	f.few = malloc(room * (sizeof *f.few + sizeof *f.sample));
	if (!f.few)
		return error_memory(error, room * (sizeof *f.few + sizeof *f.sample));
	f.sample = (float *)(f.few + room);
	scale_estimate(&f, noise->scale);
	for (uint32_t x = 0; x < f.columns; x++)
		largest = noise->scale[x] > largest ? noise->scale[x] : largest;
	noise->level = 0;
	if (largest >= NOISE_LEAST) {
		factor_estimate(&f, noise);
		streak_estimate(&f, noise);
		for (uint32_t q = 0; q < d.phi_d; q++)
			noise->factor[q] *= noise->factor[q];
	}
	free(f.few);
	return BP_OK;
}

/* A band of wavelet coefficients as a rectangle of rows and columns. */
struct rectangle {
	uint32_t row, column, rows, columns;
};

/*
 * Squares of three rows of a band, of which the middle one is being shrunk, in place: what it needs of the others is here.
 * A row is [columns + 2][P + 2]; its first and last cells are 0, as the first and last lanes are.
 */
struct squares {
	float *row[3], *nothing; /* nothing: a row of zeros, for those beyond the band */
	void *block;
};

static bp_status squares_alloc(struct lattice_dims d, struct squares *out, bp_error *error)
{
	const size_t row = ((size_t)d.theta_d + 2) * (d.phi_d + 2);
	float *block = out->block = calloc(4 * row, sizeof *block);
	if (!block)
		return error_memory(error, 4 * row * sizeof *block);
	for (int r = 0; r < 3; r++)
		out->row[r] = block + (size_t)r * row;
	out->nothing = block + 3 * row;
	return BP_OK;
}

static void squares_fill(struct lattice_dims d, const float *c, struct rectangle band, uint32_t y, float *out)
{
	const float *from = c + ((size_t)(band.row + y) * d.theta_d + band.column) * d.phi_d;
	for (size_t x = 0; x < band.columns; x++)
		for (size_t q = 0; q < d.phi_d; q++)
			out[(x + 1) * (d.phi_d + 2) + q + 1] = from[x * d.phi_d + q] * from[x * d.phi_d + q];
	memset(out + ((size_t)band.columns + 1) * (d.phi_d + 2), 0, (d.phi_d + 2) * sizeof *out);
}

static void band_shrink(struct lattice_dims d, float *c, struct rectangle band, struct noise *noise, struct squares *squares)
{
	const struct spectral_kernels *kernels = spectral_kernels_get();
	const uint32_t columns = d.theta_d / 2, p = d.phi_d;

	squares_fill(d, c, band, 0, squares->row[0]);
	for (uint32_t y = 0; y < band.rows; y++) {
		const float *const row[3] = {y ? squares->row[(y + 2) % 3] : squares->nothing, squares->row[y % 3],
		                             y + 1 < band.rows ? squares->row[(y + 1) % 3] : squares->nothing};
		const int high = 1 + (y > 0) + (y + 1 < band.rows);
		if (y + 1 < band.rows)
			squares_fill(d, c, band, y + 1, squares->row[(y + 1) % 3]);
		for (uint32_t x = 0; x < band.columns; x++) {
			const float sigma = noise->scale[(uint64_t)x * columns / band.columns];
			const int count = high * (1 + (x > 0) + (x + 1 < band.columns)) + 1; /* the two halves */
			const size_t at = (size_t)x * (p + 2) + 1;
			noise->factor[0] = 1 + noise->streak / (sigma * sigma);
			const float *const around[3] = {row[0] + at, row[1] + at, row[2] + at};
			kernels->spectral_shrink(c + ((size_t)(band.row + y) * d.theta_d + band.column + x) * p, around, (size_t)p + 2,
			                         noise->factor, LAMBDA * sigma * sigma * (float)count, p);
		}
	}
}

/* The coarsest band is kept as it is. */
static void spectrum_shrink(struct lattice_dims d, float *c, struct noise *noise, struct squares *squares)
{
	uint32_t rows = d.theta_h, columns = d.theta_d;

	for (uint32_t l = spectrum_levels(rows, columns); l > 0; l--) {
		const uint32_t high = (rows + 1) / 2, wide = (columns + 1) / 2;
		band_shrink(d, c, (struct rectangle){0, wide, high, columns - wide}, noise, squares);
		band_shrink(d, c, (struct rectangle){high, 0, rows - high, wide}, noise, squares);
		band_shrink(d, c, (struct rectangle){high, wide, rows - high, columns - wide}, noise, squares);
		rows = high;
		columns = wide;
	}
}

/* What is needed once noise has been found. */
struct denoiser {
	struct squares squares;
	struct spectrum_turn *turn;
	float *turned;
};

static bp_status denoiser_create(struct spectrum *spectrum, struct lattice_dims d, struct denoiser *out, bp_error *error)
{
	const size_t bytes = lattice_cells(d) * sizeof(float);
	bp_status status = squares_alloc(d, &out->squares, error);

	if (!status)
		status = spectrum_turn_create(spectrum, d, &out->turn, error);
	if (status)
		return status;
	out->turned = memory_alloc(bytes);
	return out->turned ? BP_OK : error_memory(error, bytes);
}

static void field_shrink(struct denoiser *denoiser, struct lattice_dims d, float *c, struct noise *noise)
{
	const size_t cells = lattice_cells(d), columns = d.theta_d / 2;
	float *turned = denoiser->turned;

	spectrum_turned(denoiser->turn, c, turned);
	spectrum_shrink(d, c, noise, &denoiser->squares);
	for (size_t x = 0; x < columns / 2; x++) {
		const float scale = noise->scale[x];
		noise->scale[x] = noise->scale[columns - 1 - x];
		noise->scale[columns - 1 - x] = scale;
	}
	spectrum_shrink(d, turned, noise, &denoiser->squares);
	spectrum_turned(denoiser->turn, turned, turned);
	for (size_t i = 0; i < cells; i++)
		c[i] = 0.5f * (c[i] + turned[i]);
}

bp_status spectral_denoise(struct spectrum *spectrum, struct lattice_dims d, const struct watch *watch, float *const field[3],
                           float *level, bp_error *error)
{
	struct noise noise = {.scale = calloc(d.theta_d, sizeof(float)), .factor = calloc(d.phi_d, sizeof(float))};
	struct denoiser denoiser = {.turn = NULL};
	bp_status status = noise.scale && noise.factor ? BP_OK : error_memory(error, d.phi_d * sizeof(float));

	*level = 0;
	for (int f = 0; f < 3 && !status && spectrum_levels(d.theta_h, d.theta_d); f++) {
		status = watch_tell(watch, 0.4 + 0.05 * f, error);
		if (!status)
			status = noise_estimate(d, spectrum_spans(spectrum), field[f], &noise, error);
		if (!status && noise.level > 0 && !denoiser.turned)
			status = denoiser_create(spectrum, d, &denoiser, error);
		if (!status && noise.level > 0)
			field_shrink(&denoiser, d, field[f], &noise);
		*level = noise.level > *level ? noise.level : *level;
	}
	free(denoiser.squares.block);
	spectrum_turn_free(denoiser.turn);
	free(denoiser.turned);
	free(noise.scale);
	free(noise.factor);
	return status;
}
