/*
 * page_plots.h: line plots as SVG inside the page. Colours and dashes are classes of page.css, so that they follow dark and light
 * and stay apart without colour.
 */
#ifndef TOOL_REPORT_PAGE_PAGE_PLOTS_H
#define TOOL_REPORT_PAGE_PAGE_PLOTS_H

#include "model/table/table.h"
#include "render/energy.h"
#include <stdio.h>

/*
 * Polar plot in the plane of incidence: mean over the channels of f cos theta_o for light from theta_i = 0, 30, 60, 80 degrees,
 * theta_o in steps of 1 degree and of 0.1 around the mirror direction; the radius is its logarithm, five decades below the
 * largest.
 */
void plot_polar(FILE *out, const struct table *table);

/* Directional albedo of the three channels over theta_o, 0 to 85 degrees. */
void plot_albedo(FILE *out, const struct energy *energy);

/* One material's line in the plot of all: bytes of its layers and their log RMSE over what can be seen. */
struct plot_ladder {
	const char *name;
	uint32_t count;
	const uint32_t *bytes;
	const double *error;
};

/* Both axes logarithmic; a material is a line from layer to layer, with a mark at each. ladders[count]. */
void plot_ladders(FILE *out, const struct plot_ladder *ladders, size_t count);

#endif
