#include "figure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "error.h"

static const struct colour BLACK = {0, 0, 0}, GREY = {225, 225, 225}, DIM = {90, 90, 90};
static const struct colour BEFORE = {31, 119, 180}, AFTER = {214, 39, 40};

/* Heights of text; multiples of the bitmap font's 7 pixels. */
enum { SMALL = 7, LARGE = 14 };
enum { LEFT = 96, RIGHT = 110, TITLE = 56, PLOT = 300, PLOT_FOOT = 76 };
enum { PANEL = 180, PANEL_STEP = 216, PANEL_HEAD = 58, PANEL_FOOT = 52 };

/* log2 of a density is shown from -SPAN to SPAN: a quarter to four. */
static const double SPAN = 2;

/* theta_h of a cell's centre */
static double cell_degrees(struct lattice_dims dims, uint32_t cell)
{
	double root = (cell + 0.5) / dims.theta_h;
	return root * root * 90;
}

static void line_draw(struct canvas *canvas, double x0, double y0, double x1, double y1, struct colour colour)
{
	const double points[2][2] = {{x0 + 0.5, y0 + 0.5}, {x1 + 0.5, y1 + 0.5}};
	canvas_line(canvas, points, 2, 1, colour);
}

static void frame_draw(struct canvas *canvas, double x, double y, double width, double height)
{
	line_draw(canvas, x - 1, y - 1, x + width, y - 1, DIM);
	line_draw(canvas, x - 1, y + height, x + width, y + height, DIM);
	line_draw(canvas, x - 1, y - 1, x - 1, y + height, DIM);
	line_draw(canvas, x + width, y - 1, x + width, y + height, DIM);
}

/* Blue below 1, white at 1, red above: by the logarithm. NaN is grey. */
static struct colour density_colour(double density)
{
	if (isnan(density))
		return (struct colour){160, 160, 160};
	double t = fmax(-1, fmin(1, log2(fmax(density, 1e-30)) / SPAN));
	double fade = sqrt(fabs(t)); /* small deviations from 1 are what one looks for */
	uint8_t low = (uint8_t)(255 - 235 * fade), middle = (uint8_t)(255 - 190 * fade), high = (uint8_t)(255 - 60 * fade);
	return t < 0 ? (struct colour){low, middle, high} : (struct colour){high, middle, low};
}

/* Decades that hold all positive values of both lines; as they were when there are none. */
static void decades_find(const struct figure *figure, int *low, int *high)
{
	double least = INFINITY, most = 0;
	const double *lines[2] = {figure->error_before, figure->error_after};
	for (int l = 0; l < 2; l++)
		for (uint32_t i = 0; lines[l] && i < figure->dims.theta_h; i++)
			if (lines[l][i] > 0 && isfinite(lines[l][i])) {
				least = fmin(least, lines[l][i]);
				most = fmax(most, lines[l][i]);
			}
	if (!(most > 0))
		return;
	*low = (int)floor(log10(least));
	*high = (int)ceil(log10(most));
	*low = *low < *high - 8 ? *high - 8 : *low; /* exact zeros and rounding noise need no room */
	*high = *high > *low ? *high : *low + 1;
}

/* Absolute error over theta_h; the horizontal axis has the lattice's spacing, dense near the highlight. */
static bp_status errors_draw(struct canvas *canvas, const struct figure *figure, double y0, double width, bp_error *error)
{
	static const double TICKS[] = {0, 0.5, 2, 5, 10, 20, 30, 40, 50, 60, 70, 80, 90};
	const uint32_t count = figure->dims.theta_h;
	int low = -3, high = 0;
	char text[64];
	decades_find(figure, &low, &high);
	for (size_t t = 0; t < sizeof TICKS / sizeof *TICKS; t++) {
		double x = LEFT + floor(sqrt(TICKS[t] / 90) * width);
		line_draw(canvas, x, y0, x, y0 + PLOT + 5, GREY);
		snprintf(text, sizeof text, "%g", TICKS[t]);
		canvas_text(canvas, x, y0 + PLOT + 24, LARGE, ANCHOR_MIDDLE, false, BLACK, text);
	}
	for (int d = low; d <= high; d++) {
		double y = y0 + PLOT - floor((double)(d - low) / (high - low) * PLOT);
		line_draw(canvas, LEFT - 5, y, LEFT + width, y, GREY);
		snprintf(text, sizeof text, "1e%d", d);
		canvas_text(canvas, LEFT - 10, y + 6, LARGE, ANCHOR_RIGHT, false, BLACK, text);
		for (int m = 2; d < high && m < 10; m++) {
			y = y0 + PLOT - floor((d - low + log10(m)) / (high - low) * PLOT);
			line_draw(canvas, LEFT - 3, y, LEFT + 2, y, DIM);
		}
	}
	frame_draw(canvas, LEFT, y0, width, PLOT);
	canvas_text(canvas, LEFT + width / 2, y0 + PLOT + 52, LARGE, ANCHOR_MIDDLE, false, BLACK,
	            "theta_h (degrees, spaced as the lattice)");
	canvas_text(canvas, 22, y0 + PLOT / 2.0, LARGE, ANCHOR_MIDDLE, true, BLACK, "mean |error| (1/sr)");

	double(*points)[2] = malloc(count * sizeof *points);
	if (!points)
		return error_memory(error, count * sizeof *points);
	const double *lines[2] = {figure->error_before, figure->error_after};
	const struct colour colours[2] = {BEFORE, AFTER};
	const char *const labels[2] = {"before coding (colour regression only)", "after coding"};
	double legend = y0 + 22;
	for (int l = 0; l < 2; l++) {
		if (!lines[l])
			continue;
		for (uint32_t i = 0; i < count; i++) {
			double decade = lines[l][i]; /* NaN interrupts the line; 0 lies on the axis */
			if (!isnan(decade))
				decade = fmin(high, fmax(low, decade > 0 ? log10(decade) : low));
			points[i][0] = LEFT + (i + 0.5) / count * width;
			points[i][1] = y0 + PLOT - (decade - low) / (high - low) * PLOT;
		}
		canvas_line(canvas, (const double(*)[2])points, count, 2, colours[l]);
		const double key[2][2] = {{LEFT + width - 540, legend - 5}, {LEFT + width - 510, legend - 5}};
		canvas_line(canvas, key, 2, 2, colours[l]);
		canvas_text(canvas, LEFT + width - 500, legend, LARGE, ANCHOR_LEFT, false, BLACK, labels[l]);
		legend += 24;
	}
	free(points);
	return BP_OK;
}

/* One density: theta_d downwards from the top would hide the highlight's end, so 0 is at the bottom. */
static bp_status panel_draw(struct canvas *canvas, const struct figure *figure, const struct figure_row *row, uint32_t cell,
                            uint32_t x, uint32_t y, bool first, bp_error *error)
{
	const uint32_t rows = figure->dims.theta_d, columns = figure->dims.phi_d;
	struct picture picture = {0};
	char text[64];
	float *density = malloc((size_t)rows * columns * sizeof *density);
	if (!density)
		return error_memory(error, (size_t)rows * columns * sizeof *density);
	bp_status status = picture_alloc(columns, rows, &picture, error);
	if (status != BP_OK)
		goto out;
	double spread = density_slice(row->source, cell, density);
	for (uint32_t j = 0; j < rows; j++)
		for (uint32_t k = 0; k < columns; k++) {
			struct colour colour = density_colour((double)density[k + columns * j]);
			uint8_t *rgb = picture.rgb + 3 * (k + (size_t)columns * (rows - 1 - j));
			rgb[0] = colour.r;
			rgb[1] = colour.g;
			rgb[2] = colour.b;
		}
	canvas_picture(canvas, x, y, PANEL, PANEL, &picture);
	frame_draw(canvas, x, y, PANEL, PANEL);
	snprintf(text, sizeof text, "theta_h %.1f deg", cell_degrees(figure->dims, cell));
	canvas_text(canvas, x + PANEL / 2.0, y - 28, LARGE, ANCHOR_MIDDLE, false, BLACK, text);
	snprintf(text, sizeof text, "rms of log2 c: %.3f", spread);
	canvas_text(canvas, x + PANEL / 2.0, y - 10, SMALL, ANCHOR_MIDDLE, false, DIM, text);
	for (int t = 0; t <= 2; t++) {
		double at = x + t * PANEL / 2.0;
		line_draw(canvas, at, y + PANEL, at, y + PANEL + 4, DIM);
		snprintf(text, sizeof text, "%d", 90 * t);
		canvas_text(canvas, at, y + PANEL + 16, SMALL, ANCHOR_MIDDLE, false, BLACK, text);
		at = y + PANEL - t * PANEL / 2.0;
		line_draw(canvas, x - 5, at, x - 1, at, DIM);
		snprintf(text, sizeof text, "%d", 45 * t);
		canvas_text(canvas, x - 8, at + 3, SMALL, ANCHOR_RIGHT, false, BLACK, text);
	}
	canvas_text(canvas, x + PANEL / 2.0, y + PANEL + 34, LARGE, ANCHOR_MIDDLE, false, BLACK, "phi_d (deg)");
	if (first)
		canvas_text(canvas, x - 30, y + PANEL / 2.0, LARGE, ANCHOR_MIDDLE, true, BLACK, "theta_d (deg)");
out:
	picture_free(&picture);
	free(density);
	return status;
}

static void scale_draw(struct canvas *canvas, double x, double y)
{
	enum { STEPS = 90, WIDTH = 18 };
	char text[16];
	for (int s = 0; s < STEPS; s++)
		canvas_rectangle(canvas, x, y + 2 * s, WIDTH, 2, density_colour(exp2(SPAN - 2 * SPAN * (s + 0.5) / STEPS)));
	frame_draw(canvas, x, y, WIDTH, 2 * STEPS);
	for (int t = -2; t <= 2; t++) {
		double at = y + STEPS - t * STEPS / SPAN;
		line_draw(canvas, x + WIDTH, at, x + WIDTH + 4, at, DIM);
		snprintf(text, sizeof text, "%g", exp2(t));
		canvas_text(canvas, x + WIDTH + 8, at + 3, SMALL, ANCHOR_LEFT, false, BLACK, text);
	}
	canvas_text(canvas, x + WIDTH / 2.0, y - 10, LARGE, ANCHOR_MIDDLE, false, BLACK, "c");
}

bp_status figure_write(const char *path, bool svg, const struct figure *figure, bp_error *error)
{
	const bool errors = figure->error_before || figure->error_after;
	const int columns = figure->slice_count > 5 ? figure->slice_count : 5;
	const uint32_t panels = (uint32_t)(columns * PANEL_STEP), width = LEFT + panels + RIGHT - (PANEL_STEP - PANEL);
	const uint32_t top = TITLE + (errors ? PLOT + PLOT_FOOT : 0), step = PANEL_HEAD + 24 + PANEL + PANEL_FOOT;
	const uint32_t height = top + (uint32_t)figure->row_count * step + 10;
	struct canvas *canvas;
	bp_status status = canvas_make(width, height, svg, &canvas, error);
	if (status != BP_OK)
		return status;
	canvas_text(canvas, 22, 32, LARGE, ANCHOR_LEFT, false, BLACK, figure->title);
	if (errors)
		status = errors_draw(canvas, figure, TITLE, width - LEFT - 40, error);
	for (int r = 0; status == BP_OK && r < figure->row_count; r++) {
		uint32_t y = top + (uint32_t)r * step;
		canvas_text(canvas, 22, y + 22, LARGE, ANCHOR_LEFT, false, BLACK, figure->rows[r].label);
		for (int s = 0; status == BP_OK && s < figure->slice_count; s++)
			status = panel_draw(canvas, figure, &figure->rows[r], figure->slices[s], LEFT + (uint32_t)(s * PANEL_STEP),
			                    y + PANEL_HEAD + 24, s == 0, error);
		scale_draw(canvas, width - RIGHT + 36, y + PANEL_HEAD + 24);
	}
	if (status == BP_OK)
		status = canvas_write(canvas, path, error);
	canvas_free(canvas);
	return status;
}
