/*
 * metrics.h: error figures of rendered images and of tables.
 *
 * Figures of tables over valid cells (log RMSE, cube-root RMSE, largest relative error) are
 * fidelity_measure's (model/fidelity.h); what stands here needs the angles or an image.
 */
#ifndef RENDER_METRICS_H
#define RENDER_METRICS_H

#include "image.h"

/*
 * Peak signal to noise ratio in dB of two images of one size and unit, over covered pixels and three channels,
 * both exposed by the reference's exposure (image_exposure) and brought to sRGB:
 *
 *     real       10 log10(1 / max(1e-12, mean (a - b)^2))                                   at most 120 dB
 *     eight_bit  10 log10(255^2 / max(1e-6, mean (round(255 a) - round(255 b))^2))       at most 108.13 dB
 *
 * Cells that are invalid in the reference are 0 in both tables (lookup.h), so what a coder puts there
 * does not count. A value of the estimate that is not finite counts as 1 - a.
 */
struct psnr {
	double eight_bit, real;
};
bp_status metrics_psnr(const struct sphere_image *reference, const struct sphere_image *estimate, struct psnr *out,
                       bp_error *error);

/*
 * Where |e - b|/(b + 1e-2) is largest, over valid cells and the three channels; e decoded, b measured, in 1/sr
 * (the same figure as fidelity.largest_relative; offset as in the project's published figures). The first such cell
 * in storage order, channels R, G, B in turn. Angles in degrees, of the cell's centre. value 0 and cell 0 when
 * the tables agree everywhere.
 */
struct worst_cell {
	double value;
	uint32_t i, j, k;
	int channel;
	double theta_h, theta_d, phi_d;
};
void metrics_worst_cell(const struct lattice *truth, const struct expansion *table, struct worst_cell *out);

#endif
