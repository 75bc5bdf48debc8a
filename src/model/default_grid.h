/*
 * default_grid.h: the grid on which the coefficients of a decoded table lie.
 *
 * Along each of three axes a coefficient is 0 or (level + centre) step; in the units of the lowest plane that were not there, it is
 * (level + centre) 2 step (FORMAT.md, "From levels to values").
 */
#ifndef MODEL_DEFAULT_GRID_H
#define MODEL_DEFAULT_GRID_H

#include "default_model.h"
#include "spectrum.h"

struct default_grid {
	float axis[3][3];     /* orthonormal; of the channels in the order of the spectra */
	float step, centre[3];
	uint32_t end;         /* how many of the 3 P units of the lowest plane were there */
	float offset[3];      /* of the fields' coefficients in harmonic 0's coarsest band: what a constant in the table makes of them */
};

/* The spectra of three channels, and the rows of theta_h * D + theta_d whose coefficients count. */
struct grid_evidence {
	struct lattice_dims dims;
	float *const *spectrum;
	const uint8_t *exact;
};

/*
 * The grid from vectors of coefficients of which most that are not 0 have one level of 1 and nothing else: `length` is theirs, to a
 * hundredth, `guess` a guess at the axes. False where it could not be one of a record.
 */
bp_status default_grid_find(const struct grid_evidence *evidence, float length, const float guess[3][3], struct default_grid *out, bool *found,
                            bp_error *error);

/* The squares by which the evidence misses the grid, as a share of what a quantiser errs by; INFINITY where too few lie on it. */
double default_grid_missed(const struct grid_evidence *evidence, const struct default_grid *grid);

/*
 * By how much log2 of the unit is too large, from what the evidence misses the grid by: slope holds the spectra of the derivatives of the
 * three channels' logarithms by it. Coefficients that an error of `reach` would carry far from their levels do not count.
 */
double default_grid_unit_error(const struct grid_evidence *evidence, const struct default_grid *grid, float *const slope[3], double reach);

/* The level of a coefficient of that size >= 0, in steps, and in *at where it lies. low: the lowest plane that is known, 0 or 1. */
uint32_t default_grid_level(const struct default_grid *grid, float size, uint32_t low, float *at);

#endif
