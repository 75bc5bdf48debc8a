#include "stress_checks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/robust/robust.h"
#include "robust_oracle.h"
#include "stress_reference.h"

static const double SCALES[] = {1e-12, 3.3e-7, 1e-3, 0.7, 1024, 7.7e8, 1e12};

static double largest_of(const double *value, size_t n)
{
	double largest = 0;
	for (size_t i = 0; i < n; i++)
		largest = fmax(largest, value[i]);
	return largest;
}

/*
 * The largest |factor a - b| relative to the value, of one channel's n values. Values count as at least `floor` (before the
 * factor): the paper's are a difference of two terms in single precision, which is exact to 1e-7 of the terms only.
 */
static double value_deviation(const double *a, const double *b, double factor, size_t n, double floor)
{
	double worst = 0;
	for (size_t i = 0; i < n; i++)
		worst = fmax(worst, relative_deviation(b[i], factor * a[i], factor * floor));
	return worst;
}

static double value_floor(const struct packed_table *base, size_t c)
{
	const size_t cells = lattice_cells(base->head.dims);
	if (base->head.profile == PROFILE_SPECTRAL)
		return 0;
	return fmax(1e-6 * largest_of(base->value + c * cells, cells), fabs(base->head.colour[c].diffuse));
}

/* An empty lattice of the same extents and validity. */
static struct lattice lattice_like(const struct lattice *lattice)
{
	struct lattice out = {0};
	if (lattice_alloc(lattice->dims, &out, NULL) != BP_OK)
		exit(1);
	memcpy(out.valid, lattice->valid, lattice_cells(lattice->dims));
	out.valid_count = lattice->valid_count;
	return out;
}

static void check_scale(const struct trial *trial, const struct packed_table *base)
{
	const size_t cells = lattice_cells(trial->lattice->dims);
	for (size_t s = 0; s < sizeof SCALES / sizeof *SCALES; s++) {
		struct lattice scaled = lattice_like(trial->lattice);
		struct packed_table packed;
		double largest = 0;
		for (int c = 0; c < 3; c++) {
			for (size_t i = 0; i < cells; i++)
				scaled.rgb[c][i] = SCALES[s] * trial->lattice->rgb[c][i];
			largest = fmax(largest, largest_of(scaled.rgb[c], cells));
		}
		if (largest > 1e-290 && largest < 1e300) { /* beyond, digits are lost before the library sees them */
			packed_make(&scaled, NULL, trial->name, &trial->options, &packed);
			if (packed.status)
				note(trial, WRONG, 1);
			for (size_t c = 0; !packed.status && c < 3; c++)
				note(trial, SCALE,
				     value_deviation(base->value + c * cells, packed.value + c * cells, SCALES[s], cells, value_floor(base, c)));
			packed_free(&packed);
		}
		lattice_free(&scaled);
	}
}

/* Channel c of the lattice goes to place[c]. */
static void check_permutation(const struct trial *trial, const struct packed_table *base, const size_t place[3])
{
	const size_t cells = lattice_cells(trial->lattice->dims);
	struct lattice permuted = lattice_like(trial->lattice);
	struct packed_table packed;
	for (size_t c = 0; c < 3; c++)
		memcpy(permuted.rgb[place[c]], trial->lattice->rgb[c], cells * sizeof(double));
	packed_make(&permuted, NULL, trial->name, &trial->options, &packed);
	if (packed.status)
		note(trial, WRONG, 1);
	for (size_t c = 0; !packed.status && c < 3; c++)
		note(trial, PERMUTE,
		     value_deviation(base->value + c * cells, packed.value + place[c] * cells, 1, cells, value_floor(base, c)));
	packed_free(&packed);
	lattice_free(&permuted);
}

static double last_error(const struct packed_table *packed)
{
	return packed->head.layers[packed->head.layer_count - 1].fidelity.log_rmse;
}

/* phi_d -> pi - phi_d: the centre of cell k goes to that of cell P - 1 - k. */
static size_t mirrored(struct lattice_dims d, size_t n)
{
	const size_t k = n % d.phi_d;
	return n - k + (d.phi_d - 1 - k);
}

static void check_mirror(const struct trial *trial, const struct packed_table *base)
{
	const struct lattice_dims d = trial->lattice->dims;
	const size_t cells = lattice_cells(d);
	struct lattice mirror = lattice_like(trial->lattice);
	struct packed_table packed;
	double squares = 0;
	for (size_t n = 0; n < cells; n++) {
		for (int c = 0; c < 3; c++)
			mirror.rgb[c][mirrored(d, n)] = trial->lattice->rgb[c][n];
		mirror.valid[mirrored(d, n)] = trial->lattice->valid[n];
	}
	packed_make(&mirror, NULL, trial->name, &trial->options, &packed);
	if (packed.status) {
		note(trial, WRONG, 1);
	} else {
		for (size_t c = 0; c < 3; c++)
			for (size_t n = 0; n < cells; n++) {
				const double a = base->value[c * cells + n], b = packed.value[c * cells + mirrored(d, n)];
				const double l = trial->lattice->valid[n] ? log10((a + 1e-3) / (b + 1e-3)) : 0;
				squares += l * l;
			}
		note(trial, MIRROR,
		     sqrt(squares / (3.0 * (double)mirror.valid_count)) / fmax(1e-6, fmax(last_error(base), last_error(&packed))));
	}
	packed_free(&packed);
	lattice_free(&mirror);
}

/* The original, without the cells that extraction writes as below the horizon: they are not there to be packed again. */
static struct lattice above_horizon(const struct trial *trial, const struct lattice *extracted)
{
	const size_t cells = lattice_cells(extracted->dims);
	struct lattice out = lattice_like(trial->lattice);
	out.valid_count = 0;
	for (size_t i = 0; i < cells; i++) {
		out.valid[i] &= extracted->valid[i];
		out.valid_count += out.valid[i];
	}
	for (int c = 0; c < 3; c++)
		memcpy(out.rgb[c], trial->lattice->rgb[c], cells * sizeof(double));
	return out;
}

/* Once and `generations` times, noted in `once` and the property after it. Where no record is carried there is nothing to say of that. */
static void check_generations(const struct trial *trial, const struct packed_table *base, enum decoded_form form,
                              enum property once)
{
	struct lattice next = {0};
	struct carried carried = {0};
	packed_to_lattice(base, form, &next, &carried);
	struct lattice original = above_horizon(trial, &next);
	struct packed_table packed = {.status = BP_OK};
	struct fidelity figures;
	double first = 0;

	lattice_free(&next);
	free(carried.bytes);
	carried = (struct carried){0};
	for (unsigned g = 0; g <= trial->generations && original.valid_count; g++) {
		packed_make(g ? &next : &original, g ? &carried : NULL, trial->name, &trial->options, &packed);
		lattice_free(&next);
		free(carried.bytes);
		carried = (struct carried){0};
		if (packed.status) {
			note(trial, WRONG, 1);
			break;
		}
		reference_fidelity(&original, &packed.table, &figures);
		if (g == 0)
			first = fmax(1e-3, figures.log_rmse);
		else
			note(trial, g == 1 ? once : (enum property)(once + 1), 20 * log10(fmax(1e-3, figures.log_rmse) / first));
		packed_to_lattice(&packed, form, &next, &carried);
		packed_free(&packed);
		if (g == 0 && form == DECODED_FILE) {
			if (!carried.bytes)
				break;
			trial->figures->carried++;
		}
	}
	lattice_free(&next);
	free(carried.bytes);
	lattice_free(&original);
}

/*
 * A figure is the size of differences of terms, and each term has been rounded: what four half units of their last places explain,
 * the terms being of that size, does not count. What is more is relative to the figure. Cube roots below 1e-90 count as 0.
 */
static double figure_deviation(double told, double slow, double terms)
{
	const double beyond = fabs(told - slow) - 4 * 0x1p-53 * terms;
	return beyond > 0 ? beyond / slow : 0;
}

static void check_layer(const struct trial *trial, const struct fidelity *told, const struct expansion *table, double largest)
{
	struct fidelity slow;
	reference_fidelity(trial->lattice, table, &slow);
	/* Differences of nearly equal logarithms and cube roots: below these floors they are rounding errors of the terms. */
	note(trial, RECORDED, relative_deviation(told->log_rmse, slow.log_rmse, 1e-6));
	note(trial, RECORDED, relative_deviation(told->cube_root_rmse, slow.cube_root_rmse, fmax(1e-90, 1e-6 * cbrt(largest))));
	note(trial, RECORDED, relative_deviation(told->largest_relative, slow.largest_relative, 1e-6));
	note(trial, FIGURES, figure_deviation(told->log_rmse, slow.log_rmse, 1));
	note(trial, FIGURES, figure_deviation(told->cube_root_rmse, slow.cube_root_rmse, fmax(cbrt(largest), 0x1p51 * 1e-90)));
	note(trial, FIGURES, figure_deviation(told->largest_relative, slow.largest_relative, 1 + slow.largest_relative));
}

static void check_recorded(const struct trial *trial, const struct packed_table *base)
{
	const struct record_head *head = &base->head;
	struct expansion table;
	double largest = 0;
	for (int c = 0; c < 3; c++)
		largest = fmax(largest, largest_of(trial->lattice->rgb[c], lattice_cells(trial->lattice->dims)));
	if (expansion_alloc(head->dims, &table, NULL) != BP_OK)
		exit(1);
	for (uint32_t layers = 1; layers < head->layer_count; layers++) {
		struct model *model;
		if (record_decode_whole(head, layers, base->record, &model, NULL) != BP_OK ||
		    model_expand(model, 0, &table, NULL) != BP_OK)
			exit(1);
		check_layer(trial, &head->layers[layers - 1].fidelity, &table, largest);
		model_free(model);
	}
	check_layer(trial, &head->layers[head->layer_count - 1].fidelity, &base->table, largest);
	expansion_free(&table);
}

/*
 * A deviation of two regressions as it counts: 1e-12 may always be; what is more, over what the data's condition explains.
 * `units`: rounding errors act as if each observation were moved by so many half units of its last place. How far the line
 * then moves is tried in long double; four times the most of four trials may be, since rounding errors need not be as random,
 * and not less than as many half units of the line. And where the two stopped at different steps, the one may be off by what is
 * left to go: four times the reference's last step.
 */
static double deviation_counted(const struct trial *trial, double deviation, double units, bool same_stop,
                                const struct oracle *slow, const double *x, const double *y, size_t n)
{
	uint64_t random = 1;
	double moved = 0;
	if (!(deviation > 1e-12))
		return deviation;
	for (int turn = 0; turn < 4; turn++) {
		const struct oracle shaken = slow_fit_shaken(x, y, n, (long double)units * 0x1p-53L, &random);
		if (isfinite(shaken.slope))
			moved = fmax(moved, oracle_deviation(shaken.intercept, shaken.slope, slow, x, n));
	}
	if (!same_stop)
		moved += oracle_deviation(slow->intercept - slow->step[0], slow->slope - slow->step[1], slow, x, n);
	const double may_be = fmax(4 * moved, units * 0x1p-53);
	if (trial->verbose)
		fprintf(stderr, "a regression deviates by %.3g where %.3g may be\n", deviation, may_be);
	return deviation * fmin(1, 1e-12 / may_be);
}

static bool is_constant(const double *x, size_t n)
{
	for (size_t i = 1; i < n; i++)
		if (x[i] != x[0])
			return false;
	return true;
}

/* The regression alone: every channel on the sum of the channels, in single precision as the achromatic model is. */
static void check_regression(const struct trial *trial)
{
	const struct lattice *l = trial->lattice;
	const size_t cells = lattice_cells(l->dims);
	double *x = malloc(cells * sizeof *x), *y = malloc(cells * sizeof *y);
	double unit = 0;
	for (int c = 0; c < 3; c++)
		unit = fmax(unit, largest_of(l->rgb[c], cells));
	for (int c = 0; c < 3; c++) {
		struct colour_fit fit;
		size_t n = 0;
		for (size_t i = 0; i < cells; i++)
			if (l->valid[i]) {
				x[n] = (double)(float)((l->rgb[0][i] + l->rgb[1][i] + l->rgb[2][i]) / unit) * unit;
				y[n++] = l->rgb[c][i];
			}
		const double most_y = largest_of(y, n);
		if (n < 3 || is_constant(x, n) || most_y > 1e140 || most_y < 1e-140 || robust_fit(x, y, n, &fit, NULL) != BP_OK)
			continue; /* GSL fails silently: on a constant x, and on squares beyond the range of double */
		const struct oracle slow = slow_fit(x, y, n), gsl = gsl_fit(x, y, n);
		if (!slow.status && isfinite(slow.slope)) {
			const double deviation = oracle_deviation(fit.diffuse, fit.specular, &slow, x, n);
			note(trial, REGRESSION, deviation_counted(trial, deviation, 1, fit.iterations == slow.iterations, &slow, x, y, n));
		}
		/* Where the remaining weights leave a constant x, no line is determined, and the slow reference gives NaN. */
		if (gsl.status == GSL_SUCCESS && isfinite(gsl.slope) && isfinite(slow.slope)) {
			const double deviation = oracle_deviation(fit.diffuse, fit.specular, &gsl, x, n);
			/* GSL adds plainly: a sum of n terms errs by up to n half units. */
			note(trial, GSL, deviation_counted(trial, deviation, (double)n, gsl.iterations == slow.iterations, &slow, x, y, n));
		}
	}
	free(x);
	free(y);
}

void checks_run(const struct trial *trial, const struct packed_table *packed)
{
	note(trial, WRONG, (double)packed_bad_values(packed));
	check_recorded(trial, packed);
	check_scale(trial, packed);
	check_permutation(trial, packed, (const size_t[3]){1, 2, 0});
	check_permutation(trial, packed, (const size_t[3]){1, 0, 2});
	check_mirror(trial, packed);
	check_generations(trial, packed, DECODED_FILE, FILES_ONE);
	check_generations(trial, packed, DECODED_PLAIN, PLAIN_ONE);
	check_generations(trial, packed, DECODED_WHOLE, WHOLE_ONE);
	const double marginals = reference_marginals(trial->lattice);
	note(trial, MARGINALS, marginals < 0 ? INFINITY : marginals);
	/* It knows nothing of budgets, and is slow; large samples may go their own way where they creep (robust.h). */
	if (trial->options.budget_bytes == trial->subject->budgets[0] && lattice_cells(trial->lattice->dims) < 32768)
		check_regression(trial);
}
