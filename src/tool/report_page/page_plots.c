#include "page_plots.h"

#include <math.h>

#include "page_html.h"
#include "tool/facts.h"

static const double DEGREE = M_PI / 180;

static const int INCIDENT[] = {0, 30, 60, 80};
enum { INCIDENT_COUNT = sizeof INCIDENT / sizeof *INCIDENT, DECADES = 5, RADIUS = 150, SAMPLES_MAX = 256 };

static double scattered(const struct table *table, double theta_i, double theta_o)
{
	/* the mirror direction is at +theta_i: the light comes from the other side */
	const float wi[3] = {(float)-sin(theta_i), 0, (float)cos(theta_i)}, wo[3] = {(float)sin(theta_o), 0, (float)cos(theta_o)};
	float rgb[3];
	table_evaluate(table, wi, wo, rgb);
	return ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3 * cos(theta_o);
}

/* theta_o in degrees, ascending. */
static int samples_place(double incident, double *degrees)
{
	int count = 0;
	for (int d = -89; d <= 89; d++) {
		if (fabs(d - incident) > 2.5) {
			degrees[count++] = d;
			continue;
		}
		for (int t = -5; t < 5; t++)
			if (d + 0.1 * t <= 89)
				degrees[count++] = d + 0.1 * t;
	}
	return count;
}

/* A line's key below its plot. */
static void key_write(FILE *out, const char *line, int number, const char *text)
{
	fprintf(out,
	        " <span class=key><svg viewBox=\"0 0 24 8\" aria-hidden=true>"
	        "<path class=\"line %s%d\" d=\"M0 4H24\"/></svg>%s</span>",
	        line, number, text);
}

static void polar_grid(FILE *out, int top)
{
	fprintf(out, "<path class=axis d=\"M%d %d H%d\"/>", -RADIUS, 0, RADIUS);
	for (int decade = 1; decade <= DECADES; decade++) {
		double r = (double)RADIUS * decade / DECADES;
		fprintf(out, "<path class=grid d=\"M%.1f 0 A%.1f %.1f 0 0 1 %.1f 0\"/><text class=tick x=%.1f y=12>1e%d</text>", -r, r, r,
		        r, r, top - DECADES + decade);
	}
	for (int d = -60; d <= 60; d += 30)
		fprintf(out, "<path class=grid d=\"M0 0 L%.1f %.1f\"/><text class=tick x=%.1f y=%.1f>%d°</text>",
		        RADIUS * sin(d * DEGREE), -RADIUS * cos(d * DEGREE), (RADIUS + 12) * sin(d * DEGREE),
		        -(RADIUS + 6) * cos(d * DEGREE), d);
}

void plot_polar(FILE *out, const struct table *table)
{
	struct curve {
		int count;
		double degrees[SAMPLES_MAX], value[SAMPLES_MAX], peak, peak_at;
	} curves[INCIDENT_COUNT];
	double largest = 1e-30;
	for (int i = 0; i < INCIDENT_COUNT; i++) {
		struct curve *curve = &curves[i];
		curve->peak = curve->peak_at = 0;
		curve->count = samples_place(INCIDENT[i], curve->degrees);
		for (int n = 0; n < curve->count; n++) {
			curve->value[n] = scattered(table, INCIDENT[i] * DEGREE, curve->degrees[n] * DEGREE);
			if (curve->value[n] > curve->peak) {
				curve->peak = curve->value[n];
				curve->peak_at = curve->degrees[n];
			}
		}
		largest = fmax(largest, curve->peak);
	}
	const int top = (int)ceil(log10(largest));
	fputs("<figure class=plot><svg viewBox=\"-175 -170 350 190\" role=img aria-label=\"Polar plot of f cos theta_o, logarithmic.",
	      out);
	for (int i = 0; i < INCIDENT_COUNT; i++)
		fprintf(out, " Light from %d degrees: largest %.3g per steradian at %.1f degrees.", INCIDENT[i], curves[i].peak,
		        curves[i].peak_at);
	fputs("\">", out);
	polar_grid(out, top);
	for (int i = 0; i < INCIDENT_COUNT; i++) {
		fprintf(out, "<path class=\"line l%d\" d=\"", i);
		for (int n = 0; n < curves[i].count; n++) {
			const double value = curves[i].value[n], angle = curves[i].degrees[n] * DEGREE;
			const double r = value > 0 ? RADIUS * fmax(0, (log10(value) - top + DECADES) / DECADES) : 0;
			fprintf(out, "%s%.1f %.1f", n ? "L" : "M", r * sin(angle), -r * cos(angle));
		}
		fputs("\"/>", out);
	}
	fputs("</svg><figcaption>f cos θ<sub>o</sub> in 1/sr, mean of the channels; light from θ<sub>i</sub> =", out);
	for (int i = 0; i < INCIDENT_COUNT; i++) {
		char text[16];
		snprintf(text, sizeof text, "%d°", INCIDENT[i]);
		key_write(out, "l", i, text);
	}
	fputs("</figcaption></figure>", out);
}

void plot_albedo(FILE *out, const struct energy *energy)
{
	const double top = fmax(1, ceil(energy->largest * 5) / 5), width = 300, height = 150;
	fputs("<figure class=plot><svg viewBox=\"-30 -10 345 185\" role=img aria-label=\"Directional albedo.", out);
	for (int c = 0; c < 3; c++)
		fprintf(out, " %s: %.3f at 0 degrees, %.3f at 60, %.3f at 85.", CHANNEL_NAMES[c], energy->albedo[0][c],
		        energy->albedo[60 / ENERGY_STEP_DEGREES][c], energy->albedo[ENERGY_DIRECTIONS - 1][c]);
	fputs("\">", out);
	for (int n = 0; n <= 4; n++)
		fprintf(out, "<path class=grid d=\"M0 %.1fH%.0f\"/><text class=\"tick end\" x=-4 y=%.1f>%.2f</text>",
		        height * (1 - n / 4.0), width, height * (1 - n / 4.0) + 3, top * n / 4);
	if (top > 1)
		fprintf(out, "<path class=limit d=\"M0 %.1fH%.0f\"/>", height * (1 - 1 / top), width);
	for (int d = 0; d <= 90; d += 30)
		fprintf(out, "<text class=tick x=%.1f y=%.0f>%d°</text>", width * d / 90, height + 14, d);
	for (int c = 0; c < 3; c++) {
		fprintf(out, "<path class=\"line c%d\" d=\"", c);
		for (int n = 0; n < ENERGY_DIRECTIONS; n++)
			fprintf(out, "%s%.1f %.1f", n ? "L" : "M", width * n * ENERGY_STEP_DEGREES / 90,
			        height * (1 - energy->albedo[n][c] / top));
		fputs("\"/>", out);
	}
	fputs("</svg><figcaption>directional albedo over θ<sub>o</sub>:", out);
	for (int c = 0; c < 3; c++)
		key_write(out, "c", c, CHANNEL_NAMES[c]);
	fputs("</figcaption></figure>", out);
}

/* A logarithmic axis from one of 1, 2, 5 times a power of ten to another. */
struct axis {
	double low, high; /* log10 */
};

/* The n-th of ..., 0.5, 1, 2, 5, 10, ...; 0 is 1. */
static double axis_step(int n)
{
	static const double STEP[3] = {1, 2, 5};
	const int decade = (n + 300) / 3 - 100;
	return STEP[n - 3 * decade] * pow(10, decade);
}

static struct axis axis_over(double least, double most, int *first, int *last)
{
	*first = 3 * (int)floor(log10(least)) - 1;
	while (axis_step(*first + 1) <= least)
		++*first;
	*last = *first + 1;
	while (axis_step(*last) < most)
		++*last;
	return (struct axis){log10(axis_step(*first)), log10(axis_step(*last))};
}

static double axis_at(struct axis axis, double value) { return (log10(value) - axis.low) / (axis.high - axis.low); }

void plot_ladders(FILE *out, const struct plot_ladder *ladders, size_t count)
{
	const double width = 620, height = 300;
	double bytes_least = INFINITY, bytes_most = 0, error_least = INFINITY, error_most = 0;
	for (size_t m = 0; m < count; m++)
		for (uint32_t l = 0; l < ladders[m].count; l++) {
			bytes_least = fmin(bytes_least, ladders[m].bytes[l]);
			bytes_most = fmax(bytes_most, ladders[m].bytes[l]);
			if (ladders[m].error[l] > 0) {
				error_least = fmin(error_least, ladders[m].error[l]);
				error_most = fmax(error_most, ladders[m].error[l]);
			}
		}
	if (bytes_most == 0 || error_most == 0)
		return;
	error_least = fmax(error_least, error_most * 1e-6);
	int x_first, x_last, y_first, y_last;
	const struct axis x = axis_over(bytes_least, bytes_most, &x_first, &x_last),
					  y = axis_over(error_least, error_most, &y_first, &y_last);
	fprintf(out,
	        "<figure class=plot><svg class=wide viewBox=\"-50 -10 700 345\" role=img "
	        "aria-label=\"Bytes against log RMSE of %zu materials, both logarithmic: %.0f to %.0f bytes, log RMSE %.3g to %.3g. "
	        "The figures are in the table of each material.\">",
	        count, bytes_least, bytes_most, error_least, error_most);
	for (int n = x_first; n <= x_last; n++) {
		const double at = width * axis_at(x, axis_step(n));
		fprintf(out, "<path class=grid d=\"M%.1f 0V%.0f\"/><text class=tick x=%.1f y=%.0f>%.0f</text>", at, height, at,
		        height + 14, axis_step(n));
	}
	for (int n = y_first; n <= y_last; n++) {
		const double at = height * (1 - axis_at(y, axis_step(n)));
		fprintf(out, "<path class=grid d=\"M0 %.1fH%.0f\"/><text class=\"tick end\" x=-6 y=%.1f>%g</text>", at, width, at + 3,
		        axis_step(n));
	}
	fprintf(out, "<text class=tick x=%.0f y=%.0f>bytes</text><text class=\"tick start\" x=4 y=10>log RMSE</text>", width / 2,
	        height + 30);
	for (size_t m = 0; m < count; m++) {
		const struct plot_ladder *ladder = &ladders[m];
		bool open = false;
		fputs("<g class=ladder><title>", out);
		html_text(out, ladder->name);
		fputs("</title><path class=\"line faint\" d=\"", out);
		for (int marks = 0; marks < 2; marks++) {
			for (uint32_t l = 0; l < ladder->count; l++) {
				const double at = width * axis_at(x, ladder->bytes[l]),
							 up = height * (1 - axis_at(y, fmax(error_least, ladder->error[l])));
				if (!(ladder->error[l] > 0))
					continue;
				fprintf(out, marks ? "<circle class=mark cx=%.1f cy=%.1f r=2.5 />" : open ? "L%.1f %.1f" : "M%.1f %.1f", at, up);
				open = true;
			}
			fputs(marks ? "</g>" : "\"/>", out);
		}
	}
	fputs("</svg><figcaption>bytes against error of every material: a line goes from layer to layer</figcaption></figure>", out);
}
