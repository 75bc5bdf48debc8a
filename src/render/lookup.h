/*
 * lookup.h: one material as a renderer reads it, and places in it.
 *
 * A table is looked up trilinearly in cell coordinates
 *
 *     H sqrt(theta_h/(pi/2))      D theta_d/(pi/2)      P phi_d/pi
 *
 * A stored value stands for its cell's centre, 1/2 beyond its index; phi_d is periodic, the other two are clamped
 * at the first and at the last centre. Where a direction pair looks does not depend on the material: *places* are made once and
 * used for every material.
 */
#ifndef RENDER_LOOKUP_H
#define RENDER_LOOKUP_H

#include "merl/lattice.h"

/*
 * One material. Cells are stored [theta_d][theta_h][phi_d] with one more of each, so that the upper neighbour
 * always lies at a fixed distance; the extra ones repeat the last (theta_d, theta_h) or the first (phi_d) cell.
 */
struct lookup_table {
	struct lattice_dims dims;
	double unit;  /* 1/sr: value = unit * cell */
	float *cells; /* (D + 1)(H + 1)(P + 1) cells of 4 floats: R, G, B, 0; aligned to 64 bytes */
};

/*
 * The measured table; cells that are not valid become 0. The unit is 1, but the largest valid value where that
 * lies outside 1e-20 .. 1e20, so that tables of any magnitude keep in the range of a float.
 */
bp_status lookup_table_measured(const struct lattice *lattice, struct lookup_table *out, bp_error *error);

/*
 * A decoded table in a given unit. Where valid[cell] is 0, cells become 0, as in the measured table it stands
 * beside. unit 0: the expansion's own.
 */
bp_status lookup_table_decoded(const struct expansion *table, const uint8_t *valid, double unit, struct lookup_table *out,
                               bp_error *error);
void lookup_table_free(struct lookup_table *table); /* a zeroed struct is allowed */

/* A place: the cell whose centre is before it along each axis, fractions of the way to the next in 1/65535, and a factor. */
struct place {
	uint32_t cell; /* index into lookup_table.cells / 4 */
	float gain;
	uint16_t theta_h, theta_d, phi_d;
};

/*
 * Tables behind place_make instead of inverse trigonometric functions. The interpolated angles are off by
 * 2e-6 cells of 90 or less, below the 8e-6 cells that 16 bits of fraction keep.
 */
struct angle_tables;
struct angle_tables *angle_tables_make(void); /* NULL: out of memory; free() it */

/*
 * The place of half-angle and difference-angle cosines and of phi_d = atan2(y, x), folded to [0, pi) by adding pi
 * (reciprocity). Cosines are clamped to [0, 1]; x = y = 0 gives phi_d = 0.
 */
struct place place_make(const struct angle_tables *angles, struct lattice_dims dims, double cos_theta_h, double cos_theta_d,
                        double y, double x, double gain);

/* Four floats that compilers keep in one register. */
typedef float float4 __attribute__((vector_size(16)));

/* gain * value of the table at a place, in units. */
static inline float4 place_look_up(const struct place *place, const struct lookup_table *table)
{
	const float scale = 1 / 65535.0f;
	const size_t p = 1, h = table->dims.phi_d + 1, d = h * (table->dims.theta_h + 1);
	const float4 *low = (const float4 *)(const void *)table->cells + place->cell, *high = low + d;
	float a1 = (float)place->theta_h * scale, b1 = (float)place->theta_d * scale, c1 = (float)place->phi_d * scale;
	float a0 = 1 - a1, c0 = 1 - c1, g1 = place->gain * b1, g0 = place->gain - g1;
	float w00 = a0 * c0, w01 = a0 * c1, w10 = a1 * c0, w11 = a1 * c1;
	float4 v0 = low[0] * w00 + low[p] * w01 + low[h] * w10 + low[h + p] * w11;
	float4 v1 = high[0] * w00 + high[p] * w01 + high[h] * w10 + high[h + p] * w11;
	return v0 * g0 + v1 * g1;
}

#endif
