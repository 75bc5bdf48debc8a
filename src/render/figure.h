/*
 * figure.h: the pictures of one material after Bilgili, Ozturk and Kurt (2012): absolute error per theta_h
 * before and after coding (their figures 1 and 2), and the conditional pair-copula densities of theta_d and
 * phi_d for some theta_h side by side (their figure 3).
 */
#ifndef RENDER_FIGURE_H
#define RENDER_FIGURE_H

#include "canvas.h"
#include "density.h"

enum { FIGURE_ROWS_MAX = 2, FIGURE_SLICES_MAX = 12, FIGURE_TEXT_BYTES = 320 };

/* One row of densities: the same slices of one table. */
struct figure_row {
	char label[64];
	const struct density_source *source;
};

struct figure {
	char title[FIGURE_TEXT_BYTES];
	struct lattice_dims dims;
	const double *error_before, *error_after; /* [dims.theta_h], see density.h; NULL: not drawn; both NULL: no plot */
	int row_count, slice_count;
	struct figure_row rows[FIGURE_ROWS_MAX];
	uint32_t slices[FIGURE_SLICES_MAX]; /* cells of theta_h */
};

/* Draws and writes to `path`: SVG or PNG. The axes are labelled in degrees. */
bp_status figure_write(const char *path, bool svg, const struct figure *figure, bp_error *error);

#endif
