/*
 * lattice.h: the measured side: one isotropic material as a table over
 * (theta_h, theta_d, phi_d), its validity, and its geometry.
 *
 * Cell (i, j, k) has index k + P (j + D i) for H x D x P cells. It starts at
 *
 *     theta_h = (i/H)^2 pi/2      theta_d = (j/D) pi/2      phi_d = (k/P) pi
 *
 * (Rusinkiewicz 1998; the square root spacing of theta_h is the MERL database's).
 * phi_d is periodic with period pi: that is reciprocity.
 */
#ifndef MERL_LATTICE_H
#define MERL_LATTICE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "../brdfpack.h"

enum { LATTICE_EXTENT_MIN = 4, LATTICE_EXTENT_MAX = 1024, LATTICE_CELLS_MAX = 1 << 24 };

/* Cells along each axis; 4 to 1024 each, at most 2^24 in all. MERL: 90, 90, 180. */
struct lattice_dims {
	uint32_t theta_h, theta_d, phi_d;
};

extern const struct lattice_dims LATTICE_MERL;

/* Radiometric scale of MERL's planes R, G, B: stored value times this is 1/sr. */
extern const double MERL_SCALE[3];

/* One measured material. Owned by whoever called lattice_alloc or lattice_read. */
struct lattice {
	struct lattice_dims dims;
	double *rgb[3];      /* planes of lattice_cells(dims) values in 1/sr; unspecified (finite) where !valid */
	uint8_t *valid;      /* 1: measured, in all three channels; 0: takes part in nothing */
	size_t valid_count;
	size_t nonfinite_count; /* cells that were refused because a channel was NaN or infinite */
};

bool lattice_dims_legal(struct lattice_dims dims);
size_t lattice_cells(struct lattice_dims dims);
static inline size_t lattice_index(struct lattice_dims dims, uint32_t i, uint32_t j, uint32_t k)
{
	return k + (size_t)dims.phi_d * (j + (size_t)dims.theta_d * i);
}

/* All planes zero, nothing valid. */
bp_status lattice_alloc(struct lattice_dims dims, struct lattice *out, bp_error *error);
void lattice_free(struct lattice *lattice); /* NULL and a zeroed struct are allowed */

/*
 * Sets valid, valid_count and nonfinite_count from the planes: a cell is valid when all
 * three channels are finite and not below 0 (-0.0 counts as 0).
 */
void lattice_validate(struct lattice *lattice);

/*
 * The horizon.
 *
 * lattice_horizon_limit: the lowest cosine (the smaller of cos theta_i and cos theta_o, taken at
 * the cell's centre) at which anything was measured, clamped to [-sin 5 degrees, 0]. In the MERL
 * database the cells that hold a value are exactly those above -sin 3.5 degrees.
 *
 * lattice_below_horizon: fills below[cells]: 1 where the whole cell lies below the horizon and
 * its centre lies below `limit`. Extraction writes -1 there and the model's value everywhere else.
 */
double lattice_horizon_limit(const struct lattice *lattice);
bp_status lattice_below_horizon(struct lattice_dims dims, double limit, uint8_t *below, bp_error *error);

/*
 * The smaller of the two cosines, max(0, min(cos theta_i, cos theta_o)) at the cell's lower corner
 * (the metrics' convention), for every cell; cosine[cells].
 */
bp_status lattice_corner_cosine(struct lattice_dims dims, float *cosine, bp_error *error);

/*
 * A decoded table: planes of float, in units of `unit` (1/sr): value = unit * rgb[c][cell].
 * The unit keeps tables of 1e300 and of 1e-300 in range. Every value is finite and >= 0.
 */
struct expansion {
	struct lattice_dims dims;
	double unit;
	float *rgb[3];
};
bp_status expansion_alloc(struct lattice_dims dims, struct expansion *out, bp_error *error);
void expansion_free(struct expansion *expansion);

#endif
