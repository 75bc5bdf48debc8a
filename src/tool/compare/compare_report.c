#include "compare.h"

#include <stdlib.h>

#include "error.h"
#include "model/math/select.h"
#include "tool/facts.h"
#include "tool/json.h"
#include "tool/report.h"

/* The columns, and the keys of the JSON members. */
enum figure {
	FIGURE_SPHERE, /* three per lighting: PSNR 8-bit, float, and dE ITP */
	FIGURES_PER_SPHERE = 3,
	FIGURE_LOG = FIGURES_PER_SPHERE * LIGHTING_COUNT,
	FIGURE_SEEN,
	FIGURE_CUBE_ROOT,
	FIGURE_RELATIVE,
	FIGURE_ALBEDO_MEASURED,
	FIGURE_ALBEDO,
	FIGURE_BYTES,
	FIGURE_COUNT
};

static const struct {
	const char *key, *head[2]; /* two lines */
	int width, digits;         /* with the blank before it */
	bool low_is_bad;
} FIGURES[FIGURE_COUNT] = {
	{"psnr8_key", {"PSNR", "8-bit"}, 7, 2, true},
	{"psnr_key", {" key   ", "float"}, 7, 2, true},
	{"delta_itp_key", {"dE ITP", "mean"}, 8, 4, false},
	{"psnr8_env", {"PSNR", "8-bit"}, 7, 2, true},
	{"psnr_env", {" env   ", "float"}, 7, 2, true},
	{"delta_itp_env", {"dE ITP", "mean"}, 8, 4, false},
	{"psnr8_point", {"PSNR", "8-bit"}, 7, 2, true},
	{"psnr_point", {" point ", "float"}, 7, 2, true},
	{"delta_itp_point", {"dE ITP", "mean"}, 8, 4, false},
	{"log_rmse", {"", "all"}, 8, 5, false},
	{"seen_log_rmse", {"log RMSE", "seen"}, 8, 5, false},
	{"cube_root_rmse", {"cube-root", "RMSE"}, 10, 6, false},
	{"largest_relative", {"  largest relative error, at    ", "     value theta_h theta_d phi_d"}, 10, 4, false},
	{"albedo_measured", {"", "measured"}, 9, 4, false},
	{"albedo", {"albedo", "decoded"}, 9, 4, false},
	{"bytes", {"record", "bytes"}, 9, 0, false},
};

/*
 * The table has two blocks of at most 76 columns beside the names, so that a terminal of 100 holds it: spheres and bytes as the
 * materials are measured, errors and albedos after them.
 */
enum block { BLOCK_SPHERES, BLOCK_ERRORS };

/* Whether its lighting is one of those that were asked for. */
static bool figure_shown(const struct compare_report *report, int figure)
{
	return figure >= FIGURE_LOG || (report->lightings >> (figure / FIGURES_PER_SPHERE) & 1);
}

static bool figure_is_of(const struct compare_report *report, enum block block, int figure)
{
	return figure_shown(report, figure) && (block == BLOCK_SPHERES) == (figure < FIGURE_LOG || figure == FIGURE_BYTES);
}

static void figures_of(const struct compare_item *item, double values[FIGURE_COUNT])
{
	const struct comparison *comparison = &item->result.comparison;
	for (int l = 0; l < LIGHTING_COUNT; l++) {
		double *sphere = &values[FIGURE_SPHERE + FIGURES_PER_SPHERE * l];
		sphere[0] = comparison->psnr[l].eight_bit;
		sphere[1] = comparison->psnr[l].real;
		sphere[2] = comparison->itp[l];
	}
	values[FIGURE_LOG] = comparison->fidelity.log_rmse;
	values[FIGURE_SEEN] = comparison->fidelity.seen_log_rmse;
	values[FIGURE_CUBE_ROOT] = comparison->fidelity.cube_root_rmse;
	values[FIGURE_RELATIVE] = comparison->fidelity.largest_relative;
	values[FIGURE_ALBEDO_MEASURED] = comparison->measured.largest;
	values[FIGURE_ALBEDO] = comparison->decoded.largest;
	values[FIGURE_BYTES] = item->result.record_bytes;
}

static void block_head(const struct compare_report *report, enum block block)
{
	for (int line = 0; line < 2; line++) {
		printf("%-*s", report->name_width, line ? "material" : "");
		for (int f = 0; f < FIGURE_COUNT; f++)
			if (figure_is_of(report, block, f))
				printf("%*s", FIGURES[f].width, FIGURES[f].head[line]);
		putchar('\n');
	}
}

static void text_row(const struct compare_report *report, enum block block, const char *name, const double values[FIGURE_COUNT],
                     const struct worst_cell *worst)
{
	text_print(name, report->name_width);
	for (int f = 0; f < FIGURE_COUNT; f++) {
		if (!figure_is_of(report, block, f))
			continue;
		if (f == FIGURE_RELATIVE) /* of any magnitude */
			printf("%*.4g", FIGURES[f].width, values[f]);
		else
			printf("%*.*f", FIGURES[f].width, FIGURES[f].digits, values[f]);
		if (f == FIGURE_RELATIVE && worst)
			printf(" %7.2f %7.2f %5.1f", worst->theta_h, worst->theta_d, worst->phi_d);
		else if (f == FIGURE_RELATIVE)
			printf(" %21s", "");
	}
	putchar('\n');
}

static void figures_json(struct json *json, const struct compare_report *report, const double values[FIGURE_COUNT])
{
	for (int f = 0; f < FIGURE_COUNT; f++)
		if (figure_shown(report, f))
			json_number(json, FIGURES[f].key, values[f]);
}

static void json_row(const struct compare_report *report, const struct compare_item *item, const double values[FIGURE_COUNT])
{
	const struct worst_cell *worst = &item->result.comparison.worst;
	const struct energy *decoded = &item->result.comparison.decoded;
	struct json json = json_begin(stdout, false);
	json_string(&json, "name", item->name);
	figures_json(&json, report, values);
	json_string(&json, "recorded_errors", item->result.confirmed ? "confirmed" : "of another file");
	json_object(&json, "largest_relative_at");
	json_string(&json, "channel", CHANNEL_NAMES[worst->channel]);
	json_integer(&json, "i", worst->i);
	json_integer(&json, "j", worst->j);
	json_integer(&json, "k", worst->k);
	json_number(&json, "theta_h", worst->theta_h);
	json_number(&json, "theta_d", worst->theta_d);
	json_number(&json, "phi_d", worst->phi_d);
	json_close(&json);
	json_object(&json, "albedo_at");
	json_string(&json, "channel", CHANNEL_NAMES[decoded->channel]);
	json_number(&json, "theta_o", decoded->theta_o);
	json_close(&json);
	json_finish(&json);
}

void compare_report_row(struct compare_report *report, const struct compare_item *item)
{
	double values[FIGURE_COUNT];
	figures_of(item, values);
	if (report->json) {
		json_row(report, item, values);
		return;
	}
	if (!report->headed)
		block_head(report, BLOCK_SPHERES);
	report->headed = true;
	text_row(report, BLOCK_SPHERES, item->name, values, NULL);
}

enum { MEDIAN, WORST, MEAN, SUMMARY_ROWS };
static const char *const SUMMARY_NAMES[SUMMARY_ROWS] = {"median", "worst", "mean"};

/* Rearranges the values. */
static void summarise(double *values, size_t count, bool low_is_bad, double out[SUMMARY_ROWS])
{
	double sum = 0;
	for (size_t n = 0; n < count; n++)
		sum += values[n];
	out[MEDIAN] = (select_kth(values, count, (count - 1) / 2) + select_kth(values, count, count / 2)) / 2;
	out[WORST] = select_kth(values, count, low_is_bad ? 0 : count - 1);
	out[MEAN] = sum / (double)count;
}

static void summary_json(const struct compare_report *report, double rows[SUMMARY_ROWS][FIGURE_COUNT], size_t used,
                         size_t confirmed, size_t failed)
{
	struct json json = json_begin(stdout, false);
	json_bool(&json, "summary", true);
	json_integer(&json, "materials", used);
	json_integer(&json, "confirmed", confirmed);
	json_integer(&json, "failed", failed);
	for (int r = 0; used && r < SUMMARY_ROWS; r++) {
		json_object(&json, SUMMARY_NAMES[r]);
		figures_json(&json, report, rows[r]);
		json_close(&json);
	}
	json_finish(&json);
}

static void summary_rows(const struct compare_report *report, enum block block, double rows[SUMMARY_ROWS][FIGURE_COUNT])
{
	for (int r = 0; r < SUMMARY_ROWS; r++)
		text_row(report, block, SUMMARY_NAMES[r], rows[r], NULL);
}

bp_status compare_report_summary(const struct compare_report *report, const struct compare_item *items, size_t count,
                                 size_t failed_count, bp_error *error)
{
	double rows[SUMMARY_ROWS][FIGURE_COUNT] = {{0}}, values[FIGURE_COUNT], out[SUMMARY_ROWS];
	size_t used = 0, confirmed = 0;
	double *column = malloc((count + 1) * sizeof *column);
	if (!column)
		return error_memory(error, count * sizeof *column);
	for (size_t n = 0; n < count; n++)
		confirmed += items[n].done && !items[n].error.status && items[n].result.confirmed;
	for (int f = 0; f < FIGURE_COUNT; f++) {
		used = 0;
		for (size_t n = 0; n < count; n++)
			if (items[n].done && !items[n].error.status) {
				figures_of(&items[n], values);
				column[used++] = values[f];
			}
		if (!used)
			break;
		summarise(column, used, FIGURES[f].low_is_bad, out);
		for (int r = 0; r < SUMMARY_ROWS; r++)
			rows[r][f] = out[r];
	}
	free(column);
	if (report->json) {
		summary_json(report, rows, used, confirmed, failed_count);
		return BP_OK;
	}
	if (!used)
		return BP_OK;
	summary_rows(report, BLOCK_SPHERES, rows);
	putchar('\n');
	block_head(report, BLOCK_ERRORS);
	for (size_t n = 0; n < count; n++)
		if (items[n].done && !items[n].error.status) {
			figures_of(&items[n], values);
			text_row(report, BLOCK_ERRORS, items[n].name, values, &items[n].result.comparison.worst);
		}
	summary_rows(report, BLOCK_ERRORS, rows);
	if (confirmed == count)
		printf("The errors that the records tell of their layers are confirmed.\n");
	else
		printf("The errors that the records tell of their layers are confirmed for %zu of %zu materials; "
		       "the others were packed from other files, or failed.\n",
		       confirmed, count);
	return BP_OK;
}
