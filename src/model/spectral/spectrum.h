/*
 * spectrum.h: the transform of the spectral profile, on tables of any legal extents.
 *
 * Along phi_d: an orthonormal cosine transform (DCT-II). With k + 1/2 as the abscissa, even harmonics are
 * symmetric about phi_d = pi/2, odd ones antisymmetric. What a material measures is nearly symmetric (it has a plane
 * of incidence), and the odd cosines stay small where sines of a Fourier series would have to build a step at 0 = pi.
 *
 *     c_m = s_m sum_k x_k cos(pi m (k + 1/2) / P)        s_0 = sqrt(1/P), s_m = sqrt(2/P)
 *
 * Where rows are cut at the horizon, of those cells of a row that can be seen (spans.h).
 *
 * Along theta_d and theta_h: for every harmonic the biorthogonal 9/7 wavelet of Cohen, Daubechies and Feauveau
 * (lifting steps of Daubechies and Sweldens 1998), with whole-sample symmetric extension; spectrum_levels(H, D) levels,
 * theta_d before theta_h at each.
 *
 * A table is [theta_h][theta_d][phi_d]; its spectrum takes its place as [row][column][lane]: rows and columns of wavelet
 * coefficients, coarse ones first; lane q < (P + 1)/2 holds harmonic 2 q, lane (P + 1)/2 + q holds harmonic 2 q + 1.
 */
#ifndef MODEL_SPECTRAL_SPECTRUM_H
#define MODEL_SPECTRAL_SPECTRUM_H

#include "merl/lattice.h"

enum { SPECTRUM_LEVELS_MAX = 7 };
#define SPECTRUM_GAIN 1.149604398860241f /* K of the 9/7 wavelet */

struct spectrum; /* tables and scratch for tables of one size; one thread at a time */

/* limit: rows of phi_d are cut there (spans.h), and their harmonics are those of their spans; 0: they are whole. */
bp_status spectrum_create(struct lattice_dims dims, float limit, struct spectrum **out, bp_error *error);
void spectrum_free(struct spectrum *spectrum); /* NULL is allowed */

/* The rows' spans (spans.h), [theta_h theta_d]. The spectrum's own. */
const uint16_t *spectrum_spans(const struct spectrum *spectrum);

/* Levels of the wavelet: as long as the shorter axis keeps at least 8 coarse cells, each level halving it (rounding up). */
uint32_t spectrum_levels(uint32_t theta_h, uint32_t theta_d);

/* Coefficients of an axis of n cells that step l of the wavelet works on: halved l times, rounding up. */
static inline uint32_t spectrum_extent(uint32_t n, uint32_t l) { return (n + (1u << l) - 1) >> l; }

static inline uint32_t spectrum_lane(uint32_t phi_d, uint32_t harmonic)
{
	return harmonic / 2 + (harmonic % 2 ? (phi_d + 1) / 2 : 0);
}

static inline uint32_t spectrum_harmonic(uint32_t phi_d, uint32_t lane)
{
	const uint32_t even = (phi_d + 1) / 2;
	return lane < even ? 2 * lane : 2 * (lane - even) + 1;
}

/* Of table - base, in place. The inverse: spectrum_inverse.h; where rows are cut, spectrum_rows.h. */
void spectrum_forward(struct spectrum *spectrum, float *table, float base);

/* The wavelets alone, in place: of harmonics [theta_h][theta_d][lane]. */
void spectrum_wavelets(struct spectrum *spectrum, float *harmonics);

#endif
