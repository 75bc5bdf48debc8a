/*
 * lattice.h: the measured side: one isotropic material as a table over
 * (theta_h, theta_d, phi_d), its validity, and its geometry.
 *
 * Cell (i, j, k) has index k + P (j + D i) for H x D x P cells. It starts at
 *
 *     theta_h = (i/H)^2 pi/2      theta_d = (j/D) pi/2      phi_d = (k/P) pi
 *
 * (Rusinkiewicz 1998; the square root spacing of theta_h is the MERL database's), and its centre is
 * at the same for i + 1/2, j + 1/2, k + 1/2.
 *
 * Three conventions, on which readers of MERL files disagree:
 *
 * - A stored value stands for its cell's centre. Interpolation runs between centres, linear in i, j
 *   and k; before the first and beyond the last centre of theta_h and theta_d the value stays, and
 *   phi_d goes on from the last centre to the first. The database itself says so, by the pattern of
 *   its measured cells: "both cosines above -0.061" at centres gives that pattern but for 2 of
 *   1,458,000 cells, and at lower corners no limit does but for 3,934; it is symmetric under
 *   k -> P - 1 - k without exception, as centres are, and broken in 4,874 cells under k -> P - k.
 * - phi_d is periodic with period pi: a negative phi_d is folded by adding pi. That is
 *   reciprocity (exchange of the two directions) and exact; phi_d is not mirrored.
 * - A cell in which any channel is below 0 was not measured: all its channels are invalid.
 *
 * With td, th, pd for theta_d, theta_h, phi_d, the cosines of the two directions are
 *
 *     cos theta_i, cos theta_o = cos td cos th -/+ sin td cos pd sin th
 *
 * and the smaller of them is cos td cos th - |sin td cos pd sin th|.
 */
#ifndef MERL_LATTICE_H
#define MERL_LATTICE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "brdfpack.h"

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
	double *rgb[3]; /* planes of lattice_cells(dims) values in 1/sr; unspecified (finite) where !valid */
	uint8_t *valid; /* 1: measured, in all three channels; 0: takes part in nothing */
	size_t valid_count;
	size_t nonfinite_count; /* cells that were refused because a channel was NaN or infinite */
	double most;            /* no valid value is larger; 0 where that is not known */
	void *block;            /* the one allocation behind the planes, each aligned to 64 bytes */
};

bool lattice_dims_legal(struct lattice_dims dims);
size_t lattice_cells(struct lattice_dims dims);
static inline bool lattice_dims_equal(struct lattice_dims a, struct lattice_dims b)
{
	return a.theta_h == b.theta_h && a.theta_d == b.theta_d && a.phi_d == b.phi_d;
}
static inline size_t lattice_index(struct lattice_dims dims, uint32_t i, uint32_t j, uint32_t k)
{
	return k + (size_t)dims.phi_d * (j + (size_t)dims.theta_d * i);
}

/* Nothing valid, the planes not set: whoever allocates fills all of them. BP_ERROR_LIMIT where the extents are not legal. */
bp_status lattice_alloc(struct lattice_dims dims, struct lattice *out, bp_error *error);
void lattice_free(struct lattice *lattice); /* a zeroed struct is allowed, as in expansion_free */

/*
 * Sets valid, the counts and `most` from the planes: a cell is valid when all
 * three channels are finite and not below 0 (-0.0 counts as 0).
 */
void lattice_validate(struct lattice *lattice);

/* The largest valid value of all channels, in 1/sr; 0 where there is none. */
double lattice_largest(const struct lattice *lattice);

/*
 * lattice_validate in steps, for a reader that works on data while it is in the cache. state = lattice.valid,
 * zeroed. lattice_scan: notes in state[count] what is wrong with the values, scales them, and
 * stores 0 for those that cannot be used; once per plane. Returns the largest of what it stored. lattice_scan_finish: state
 * becomes valid; `most` is the reader's to set.
 */
double lattice_scan(double *restrict values, size_t count, double scale, uint8_t *restrict state);
void lattice_scan_finish(struct lattice *lattice);

/* Cosine and sine of t quarter turns, t in [0, 1]: exact at 0 and 1, within 2e-16, the same on every machine. */
void quarter_cos_sin(double t, double *cosine, double *sine);

/* Cosines and sines of one place in each cell along theta_h, theta_d and phi_d: 40 KB, which the stack bears. */
struct lattice_cosines {
	double cos_h[LATTICE_EXTENT_MAX], sin_h[LATTICE_EXTENT_MAX];
	double cos_d[LATTICE_EXTENT_MAX], sin_d[LATTICE_EXTENT_MAX];
	double cos_p[LATTICE_EXTENT_MAX];
};

/* Of the centres. */
void lattice_centres(struct lattice_dims dims, struct lattice_cosines *out);

/* Of the lower corners, but |cos phi_d| at its least in the cell: together they give the largest smaller cosine in it. */
void lattice_highest(struct lattice_dims dims, struct lattice_cosines *out);

/*
 * The horizon: which cells extraction writes as negative values.
 *
 * A cell is *below the horizon* when all of it is (the smaller cosine nowhere exceeds 0; it falls
 * with theta_h and theta_d and rises towards phi_d = pi/2), and the smaller cosine at the cell's
 * centre is below a limit. In the MERL database the limit is -0.061 (3.5 degrees): the cells that
 * hold a value are those above it, and this rule gives back the database's pattern to the cell,
 * provided the centre's angles are taken with pi = 3.1416. Every other cell gets a value, measured or not.
 *
 * lattice_horizon_limit: the limit of one material: the lowest smaller cosine at the centre of a
 * valid cell that lies wholly below, in [-sin 5 degrees, 0] (never below -0.0872). It is one float, rounded down, so that a
 * record may store it as float or double and no cell changes sides.
 *
 * lattice_below_horizon: fills below[cells]: 1 below the horizon, 0 elsewhere.
 *
 * Dims must be legal here and in what follows, as those of every lattice, expansion, model and record's head are.
 */
#define LATTICE_MERL_HORIZON -0.061003               /* the database's own limit */
#define LATTICE_DEEPEST_HORIZON -0.08715574274765817 /* -sin 5 degrees */
double lattice_horizon_limit(const struct lattice *lattice);
void lattice_below_horizon(struct lattice_dims dims, double limit, uint8_t *below);

/*
 * What both are made of. lattice_lowest_below: the lowest smaller cosine at the centre of a cell that lies wholly below and
 * has mask[cell] != 0; 0 where there is none. lattice_centre_below: fills below[cells], 1 where the smaller cosine at the centre
 * is below the limit, whether or not a part of the cell lies above the horizon.
 */
double lattice_lowest_below(struct lattice_dims dims, const uint8_t *mask);
void lattice_centre_below(struct lattice_dims dims, double limit, uint8_t *below);

/*
 * Which cells can be seen: fills seen[cells], 1 where both directions are above the horizon somewhere in the cell. The others
 * reach a picture only as neighbours in interpolation, by less than a half.
 */
void lattice_seen(struct lattice_dims dims, uint8_t *seen);

/*
 * The smaller of the two cosines, max(0, min(cos theta_i, cos theta_o)) at the cell's lower corner:
 * fills cosine[theta_d phi_d] for one index of theta_h. It is the weight of the
 * cube-root figure (model/fidelity.h) as that is defined, in records too; at centres the figure
 * of surrogates would be 2 to 5 % smaller.
 */
void lattice_corner_cosines(struct lattice_dims dims, uint32_t theta_h, float *cosine);

/*
 * A decoded table: planes of float, in units of `unit` (1/sr): value = unit * rgb[c][cell].
 * The unit keeps tables of 1e300 and of 1e-300 in range. Every value is finite and >= 0.
 */
struct expansion {
	struct lattice_dims dims;
	double unit;
	float *rgb[3];
	void *block;
};
/* The planes are not set. */
bp_status expansion_alloc(struct lattice_dims dims, struct expansion *out, bp_error *error);
void expansion_free(struct expansion *expansion);

#endif
