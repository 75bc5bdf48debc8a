/*
 * energy.h: how much of the light a table sends back.
 */
#ifndef RENDER_ENERGY_H
#define RENDER_ENERGY_H

#include "lookup.h"

/*
 * Energy: the largest directional albedo, the share of the light from one direction that the surface sends back,
 *
 *     albedo(theta_o) = integral over the upper hemisphere of f cos(theta_i) d omega_i
 *
 * (Nicodemus et al. 1977, directional-hemispherical reflectance), over theta_o = 0, 5, ... 85 degrees and the three
 * channels. More than 1 means that energy is made. Beyond 85 degrees measured tables hold next to nothing.
 *
 * Quadrature over the half vector, d omega_i = 4 cos(theta_d) d omega_h (Torrance and Sparrow 1967), so that narrow
 * highlights are met: midpoints of 180 steps of sqrt(theta_h/(pi/2)), two per cell of MERL, by 90 of half a turn
 * of phi_h; f is looked up as lookup.h says. Cells that are 0 because they are invalid add nothing, so the figure
 * of a measured table is a lower bound. A constant f = 1/pi gives 1 to within 5e-4.
 */
enum { ENERGY_DIRECTIONS = 18, ENERGY_STEP_DEGREES = 5 };
struct energy {
	double albedo[ENERGY_DIRECTIONS][3]; /* [theta_o / 5 degrees][channel] */
	double largest;
	double theta_o; /* degrees, of the largest */
	int channel;    /* of the largest */
};
struct energy_plan;
bp_status energy_plan_make(struct lattice_dims dims, struct energy_plan **out, bp_error *error); /* freed with free() */
void energy_measure(const struct energy_plan *plan, const struct lookup_table *table, struct energy *out);

#endif
