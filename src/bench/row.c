#include "row.h"

#include <math.h>

#include "model/math/select.h"

/* The columns after material and method. */
struct column {
	const char *name, *format;
	size_t offset;
};

#define AT(field) offsetof(struct row, field)
static const struct column COLUMNS[] = {
	{"budget_bytes", "%.0f", AT(budget)},
	{"effort", "%.0f", AT(effort)},
	{"bytes", "%.0f", AT(bytes)},
	{"parameters", "%.0f", AT(parameters)},
	{"fit_s", "%.4g", AT(fit_seconds)},
	{"decode_s", "%.4g", AT(decode_seconds)},
	{"evaluate_ns", "%.4g", AT(evaluate_ns)},
	{"psnr8_key_db", "%.2f", AT(figures.psnr[LIGHTING_KEY].eight_bit)},
	{"psnr_key_db", "%.2f", AT(figures.psnr[LIGHTING_KEY].real)},
	{"psnr8_env_db", "%.2f", AT(figures.psnr[LIGHTING_ENV].eight_bit)},
	{"psnr_env_db", "%.2f", AT(figures.psnr[LIGHTING_ENV].real)},
	{"psnr8_point_db", "%.2f", AT(figures.psnr[LIGHTING_POINT].eight_bit)},
	{"psnr_point_db", "%.2f", AT(figures.psnr[LIGHTING_POINT].real)},
	{"log_rmse", "%.5g", AT(figures.fidelity.log_rmse)},
	{"seen_log_rmse", "%.5g", AT(figures.fidelity.seen_log_rmse)},
	{"cube_root_rmse", "%.5g", AT(figures.fidelity.cube_root_rmse)},
	{"largest_relative", "%.4g", AT(figures.fidelity.largest_relative)},
};
/* What 0 means that there is none of. */
static bool zero_is_absent(size_t offset) { return offset == AT(budget) || offset == AT(effort) || offset == AT(parameters); }
enum { COLUMN_COUNT = sizeof COLUMNS / sizeof *COLUMNS };

static double *cell(struct row *row, int column) { return (double *)(void *)((char *)row + COLUMNS[column].offset); }

void row_print_header(FILE *out)
{
	fputs("material\tmethod", out);
	for (int n = 0; n < COLUMN_COUNT; n++)
		fprintf(out, "\t%s", COLUMNS[n].name);
	fputs("\tevaluated\n", out);
}

void row_print(FILE *out, const char *material, const char *method, const struct row *row)
{
	static const char *const EVALUATED[] = {"-", "model", "table"};
	struct row copy = *row;

	fprintf(out, "%s\t%s", material, method);
	for (int n = 0; n < COLUMN_COUNT; n++) {
		double value = *cell(&copy, n);
		bool absent = !isfinite(value) || (value == 0 && zero_is_absent(COLUMNS[n].offset));
		fputc('\t', out);
		if (absent)
			fputc('-', out);
		else
			fprintf(out, COLUMNS[n].format, value);
	}
	fprintf(out, "\t%s\n", EVALUATED[row->evaluated]);
}

int row_compare(const void *a, const void *b)
{
	const struct row *x = a, *y = b;

	if (x->method != y->method)
		return x->method < y->method ? -1 : 1;
	if (x->budget < y->budget || x->budget > y->budget)
		return x->budget < y->budget ? -1 : 1;
	if (x->effort < y->effort || x->effort > y->effort)
		return x->effort < y->effort ? -1 : 1;
	return (x->material > y->material) - (x->material < y->material);
}

bool row_same_setting(const struct row *a, const struct row *b)
{
	struct row other = *b;

	other.material = a->material;
	return row_compare(a, &other) == 0;
}

struct row row_median(const struct row *rows, int count)
{
	double values[ROW_MEDIAN_MAX];
	struct row median = rows[0];

	if (count > ROW_MEDIAN_MAX)
		count = ROW_MEDIAN_MAX;
	for (int n = 0; n < COLUMN_COUNT; n++) {
		size_t finite = 0;
		for (int r = 0; r < count; r++) {
			struct row copy = rows[r];
			if (isfinite(*cell(&copy, n)))
				values[finite++] = *cell(&copy, n);
		}
		if (!finite)
			continue; /* stays what it is: not finite */
		*cell(&median, n) = (select_kth(values, finite, (finite - 1) / 2) + select_kth(values, finite, finite / 2)) / 2;
	}
	return median;
}
