/* spectral_expand.c: levels become coefficients, and these a table, some rows of phi_d at a time; inverse of spectral_fit.c. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "spectral_kernels.h"
#include "spectral.h"
#include "spectrum_rows.h"

/* ---- coefficients ---- */

uint32_t spectral_lowest_plane(uint32_t planes, uint32_t harmonics, uint32_t end, uint32_t field, uint32_t harmonic)
{
	const uint32_t first = field * harmonics + harmonic,
				   period = 3 * harmonics; /* in the highest plane, and from plane to plane */
	return end > first ? planes - 1 - (end - 1 - first) / period : planes;
}

float spectral_level_value(const struct spectral_model *model, int32_t level, uint32_t lowest, uint32_t quantiser)
{
	const uint32_t magnitude = (uint32_t)(level < 0 ? -level : level) >> lowest << lowest;
	float value;

	if (!magnitude)
		return 0;
	if (lowest) /* of the second quantiser as often as of the first */
		value = (float)magnitude + model->centre[3] * (float)(1u << lowest) - (model->dependent ? 0.25f : 0);
	else
		value = (float)magnitude + model->centre[magnitude > 1 ? 2 : quantiser] - (quantiser ? 0.5f : 0);
	value *= model->step;
	return level < 0 ? -value : value;
}

/* The coefficients that are not 0, ready for the inverse transform. */
struct terms {
	struct spectrum_term *term;
	uint32_t *start;    /* start[f P + m]: of field f, harmonic m; 3 P + 1 of them */
	uint32_t harmonics; /* one more than the highest with a term; 0 before they are made */
};

/* What the first `layers` layers hold; the caller frees both arrays, also after a failure. */
static bp_status terms_make(const struct spectral_model *model, const struct spectrum_inverse *inverse, uint32_t layers,
                            struct terms *out, bp_error *error)
{
	const uint32_t p = inverse->dims.phi_d, cells = (uint32_t)lattice_cells(inverse->dims);
	uint32_t n = 0, unit = 0; /* units below this one have their start */
	uint32_t lowest = 0, state = 0;

	out->term = malloc(((size_t)model->level_count + 1) * sizeof *out->term);
	out->start = malloc((3 * (size_t)p + 1) * sizeof *out->start);
	if (!out->term || !out->start)
		return error_memory(error, model->level_count * sizeof *out->term);
	for (uint32_t i = 0; i < model->level_count; i++) {
		const struct spectral_level level = model->levels[i];
		const uint32_t field = level.at < cells ? 0 : level.at < 2 * cells ? 1 : 2, at = level.at - field * cells;
		const uint32_t row = at / p, harmonic = spectrum_harmonic(p, at - row * p);
		if (unit <= field * p + harmonic) {
			while (unit <= field * p + harmonic)
				out->start[unit++] = n;
			lowest = spectral_lowest_plane(model->planes, p, model->end[layers - 1], field, harmonic);
			state = 0;
		}
		const float value = spectral_level_value(model, level.level, lowest, dependent_quantiser(state));
		if (model->dependent && !lowest)
			state = dependent_next(state, (uint32_t)level.level & 1);
		if (value != 0) {
			out->term[n++] = spectrum_term_make(inverse, row, harmonic, value);
			out->harmonics = harmonic < out->harmonics ? out->harmonics : harmonic + 1;
		}
	}
	while (unit <= 3 * p)
		out->start[unit++] = n;
	return BP_OK;
}

/* ---- rows ---- */

/*
 * Cells column..column + width - 1 of row `row` (theta_h * D + theta_d): three fields, which may be read up to 15 cells past
 * the last. The row's other cells, on either side, have the value of the one beside them.
 */
struct spectral_row {
	const float *field[3];
	size_t row;
	uint32_t column, width;
};

/* Where rows of `cells` values go: to codes, or, where these are NULL, to planes of floats. */
struct target {
	const struct spectral_model *model;
	uint32_t cells;
	float *rgb[3];
	uint16_t *codes;
	int channels;
	size_t stride; /* of a row of codes */
};

/* The largest logarithm that is decoded: 40, less where unit 2^40 would be above 2^1011. */
static float most_of(double unit)
{
	int exponent;
	frexp(unit, &exponent);
	return exponent > 1011 - 40 ? (float)(1011 - exponent) : 40;
}

/* `bytes` bytes of values of `size` bytes, each as the one at `value`; twice as many from step to step. */
static void repeat(uint8_t *to, const uint8_t *value, size_t size, size_t bytes)
{
	for (size_t done = 0, here = size; done < bytes; done += here) {
		here = done ? done : size;
		here = here < bytes - done ? here : bytes - done;
		memcpy(to + done, done ? to : value, here);
	}
}

/* The cells on either side of what is there of a row of p values of `size` bytes. */
static void sides_fill(const struct spectral_row *from, void *row, size_t size, uint32_t p)
{
	const uint32_t end = from->column + from->width;
	uint8_t *own = (uint8_t *)row + from->column * size, *behind = (uint8_t *)row + end * size;

	repeat(row, own, size, from->column * size);
	repeat(behind, behind - size, size, (p - end) * size);
}

static void row_take(const struct target *to, const struct spectral_row *row)
{
	const struct spectral_kernels *kernels = spectral_kernels_get();
	const struct spectral_model *m = to->model;
	const float(*rotation)[3] = (const float(*)[3])m->rotation;

	if (to->codes) {
		const size_t channels = (size_t)to->channels;
		uint16_t *out = to->codes + row->row * to->stride;
		kernels->spectral_codes(row->field, row->width, m->base, rotation, most_of(m->unit), to->channels,
		                        out + row->column * channels);
		sides_fill(row, out, channels * sizeof *out, to->cells);
		return;
	}
	float *const out[3] = {to->rgb[0] + row->row * to->cells, to->rgb[1] + row->row * to->cells,
	                       to->rgb[2] + row->row * to->cells};
	float *const seen[3] = {out[0] + row->column, out[1] + row->column, out[2] + row->column};
	kernels->spectral_values(row->field, row->width, m->base, rotation, most_of(m->unit), seen);
	for (int c = 0; c < 3; c++) {
		const float first = seen[c][0], last = seen[c][row->width - 1];
		for (uint32_t k = 0; k < row->column; k++)
			out[c][k] = first;
		for (uint32_t k = row->column + row->width; k < to->cells; k++)
			out[c][k] = last;
	}
}

/* All rows, or those of the table of every second value. */
static bp_status expand(const struct spectral_model *model, uint32_t layers, bool half, const struct target *to, bp_error *error)
{
	const struct lattice_dims d = model->dims;
	const uint32_t count = d.theta_h * d.theta_d / (half ? 4 : 1);
	const size_t stride = d.phi_d + 15, piece = SPECTRUM_BLOCK * stride;
	struct spectrum_inverse *inverse = NULL;
	struct spectrum_rows *rows = NULL;
	struct terms terms = {0};

	if (model->coefficient[0])
		return error_argument(error, "a model that was fitted has no levels; its record has");
	float *fields = calloc(3 * piece, sizeof *fields);
	bp_status status =
		fields ? spectral_inverse_create(d, &model->weights, &inverse, error) : error_memory(error, 3 * piece * sizeof *fields);
	if (!status)
		status = terms_make(model, inverse, layers, &terms, error);
	if (!status)
		status = spectrum_rows_create(inverse, model->limit, terms.harmonics, half, &rows, error);
	for (int f = 0; !status && f < 3; f++)
		status = spectrum_rows_field(rows, f, terms.term, terms.start + (size_t)f * d.phi_d, error);
	for (uint32_t r = 0; !status && r < count; r += SPECTRUM_BLOCK) {
		const uint32_t here = count - r < SPECTRUM_BLOCK ? count - r : SPECTRUM_BLOCK;
		for (int f = 0; f < 3; f++)
			spectrum_rows_cells(rows, f, r, here, fields + (size_t)f * piece, stride);
		for (uint32_t n = 0; n < here; n++) {
			struct spectral_row row = {.row = r + n};
			spectrum_rows_seen(rows, r + n, &row.column, &row.width);
			for (int f = 0; f < 3; f++)
				row.field[f] = fields + (size_t)f * piece + n * stride + row.column;
			row_take(to, &row);
		}
	}
	free(terms.term);
	free(terms.start);
	spectrum_rows_free(rows);
	free(inverse);
	free(fields);
	return status;
}

bp_status spectral_expand(const struct spectral_model *model, uint32_t layers, bool half, struct expansion *out, bp_error *error)
{
	const struct target target = {.model = model, .cells = out->dims.phi_d, .rgb = {out->rgb[0], out->rgb[1], out->rgb[2]}};
	out->unit = model->unit;
	return expand(model, layers, half, &target, error);
}

bp_status spectral_expand_codes(const struct spectral_model *model, uint32_t layers, bool half, int channels, uint16_t *out,
                                size_t stride, bp_error *error)
{
	const struct target target = {
		.model = model, .cells = model->dims.phi_d / (half ? 2 : 1), .codes = out, .channels = channels, .stride = stride};
	return expand(model, layers, half, &target, error);
}
