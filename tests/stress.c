/*
 * stress.c: adversarial materials through every profile, and the properties that must survive.
 *
 *     stress [-s SEEDS] [-g GENERATIONS] [-k KIND]... [-m] [-q] [-v] [-d DUMP] [-c DUMP]
 *
 * Prints one table (TSV): a row per profile, budget and kind of material, with the worst figure of every property. The exit
 * code is 1 when a figure exceeds its profile's limit. -k: only these kinds. -m: also on MERL's lattice. -q: one variant of each kind on the larger
 * lattices. -v: every case over the limit on standard error. -d writes all decoded values to a file; -c compares them
 * with such a file of another build instead.
 */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/robust.h"
#include "robust_oracle.h"
#include "stress_cases.h"
#include "stress_reference.h"
#include "stress_subject.h"

/*
 * The columns. All are "at most". Decibels are 20 log10 of log RMSE against the first original over the first
 * record's, where either counts as at least 1e-3.
 */
enum property {
	WRONG,       /* outcomes: packed although nothing is valid, refused although something is, values not finite or negative */
	ASYMMETRIC,  /* evaluations that change when the directions change places */
	RECORDED,    /* recorded figures of every layer against the slow reference, relative; figures below 1e-6 absolute */
	FIGURES,     /* the same, relative, beyond what the rounding of the terms explains; see figure_deviation */
	SCALE,       /* pack(s B) against s pack(B), relative to the value; see value_deviation */
	PERMUTE,     /* channels exchanged, all three or two of them, in the same way */
	MIRROR,      /* log RMS between pack(mirror B) and mirror(pack(B)), over the larger of their recorded errors */
	FILES_ONE,   /* dB lost by packing an extracted file, where it carries its record */
	FILES_TEN,   /* dB lost by doing so `generations` times */
	PLAIN_ONE,   /* the same without the record: values alone, nothing of what lies below the horizon */
	PLAIN_TEN,
	WHOLE_ONE,   /* the same for the whole decoded table, which no file holds */
	WHOLE_TEN,
	MARGINALS,   /* means and scale against exact sums, relative */
	REGRESSION,  /* robust_fit against the same steps in long double, where these converge: relative; see deviation_counted */
	GSL,         /* robust_fit against GSL, where that converges, likewise */
	PROPERTY_COUNT
};
static const char *const PROPERTY_NAMES[PROPERTY_COUNT] = {
	"wrong", "asymmetric", "recorded", "figures", "scale", "permute", "mirror",
	"file_1_dB", "file_n_dB", "plain_1_dB", "plain_n_dB", "whole_1_dB", "whole_n_dB", "marginals", "regression", "gsl",
};

/*
 * format-spec/STRESS.md says why limits are no lower than they are; where a kind of material alone needs another one, it
 * stands in EXCEPTIONS.
 */
struct subject {
	const char *name;
	enum profile profile;
	uint32_t budgets[3]; /* 0: none */
	double limit[PROPERTY_COUNT];
	double binding[4]; /* limits of the columns of generations without the record at the smaller budgets, which bind */
};
static const struct subject SUBJECTS[] = {
	{"paper", PROFILE_PAPER, {60400, 1000, 0}, {0, 0, 1e-9, 1e-12, 1e-6, 1e-6, 2, 0.1, 1, 70, 80, 70, 80, 1e-12, 1e-12, 1e-12}, {70, 80, 70, 80}},
	{"default", PROFILE_DEFAULT, {60400, 1000, 0}, {0, 0, 1e-9, 1e-12, 1e-6, 0, 2, 0.1, 1, 20, 30, 0.1, 1, 1e-12, 1e-12, 1e-12}, {120, 120, 120, 120}},
};
static const struct {
	enum profile profile;
	const char *kind;
	enum property property;
	double limit;
} EXCEPTIONS[] = {
	/* Ranges beyond single precision: the coefficients' rounding errors are what is lost. */
	{PROFILE_DEFAULT, "bright-cell", WHOLE_ONE, 10},
	{PROFILE_DEFAULT, "bright-cell", WHOLE_TEN, 30},
	{PROFILE_DEFAULT, "checkerboard", WHOLE_ONE, 10},
	{PROFILE_DEFAULT, "checkerboard", WHOLE_TEN, 10},
	{PROFILE_DEFAULT, "odd-channel", WHOLE_ONE, 10},
	{PROFILE_DEFAULT, "odd-channel", WHOLE_TEN, 30},
	{PROFILE_DEFAULT, "random-validity", WHOLE_ONE, 2}, /* a hundredth of the cells: not always recognised */
	{PROFILE_DEFAULT, "random-validity", WHOLE_TEN, 2},
};

static double limit_of(const struct subject *subject, uint32_t budget, const char *kind, enum property property)
{
	if (budget != subject->budgets[0] && property >= PLAIN_ONE && property <= WHOLE_TEN)
		return subject->binding[property - PLAIN_ONE];
	for (size_t i = 0; i < sizeof EXCEPTIONS / sizeof *EXCEPTIONS; i++)
		if (EXCEPTIONS[i].profile == subject->profile && EXCEPTIONS[i].property == property && !strcmp(EXCEPTIONS[i].kind, kind))
			return EXCEPTIONS[i].limit;
	return subject->limit[property];
}

static const struct lattice_dims SMALL[] = {{4, 4, 4}, {8, 8, 8}, {7, 10, 12}, {24, 20, 36}};
static const double SCALES[] = {1e-12, 3.3e-7, 1e-3, 0.7, 1024, 7.7e8, 1e12};
static unsigned generations = 10;
static bool verbose;
static FILE *dump, *compared;
static double compared_worst;
static size_t compared_values, compared_differ;

struct figures {
	double worst[PROPERTY_COUNT];
	unsigned cases, packed, refused, carried; /* carried: of the packed ones, records with room in their extracted file */
};

/* One case at work. */
struct trial {
	const struct subject *subject;
	struct fit_options options;
	const struct lattice *lattice;
	const char *kind, *name;
	struct figures *figures;
};

static void note(const struct trial *trial, enum property property, double figure)
{
	double *worst = &trial->figures->worst[property];
	if (verbose && !(figure <= limit_of(trial->subject, trial->options.budget_bytes, trial->kind, property)))
		fprintf(stderr, "%s %u %s: %s %g\n", trial->subject->name, trial->options.budget_bytes, trial->name, PROPERTY_NAMES[property],
		        figure);
	if (!(figure <= *worst))
		*worst = figure;
}

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
	if (base->head.profile == PROFILE_DEFAULT)
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
			packed_make(&scaled, trial->name, &trial->options, &packed);
			if (packed.status)
				note(trial, WRONG, 1);
			for (size_t c = 0; !packed.status && c < 3; c++)
				note(trial, SCALE, value_deviation(base->value + c * cells, packed.value + c * cells, SCALES[s], cells, value_floor(base, c)));
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
	packed_make(&permuted, trial->name, &trial->options, &packed);
	if (packed.status)
		note(trial, WRONG, 1);
	for (size_t c = 0; !packed.status && c < 3; c++)
		note(trial, PERMUTE, value_deviation(base->value + c * cells, packed.value + place[c] * cells, 1, cells, value_floor(base, c)));
	packed_free(&packed);
	lattice_free(&permuted);
}

static double last_error(const struct packed_table *packed)
{
	return packed->head.layers[packed->head.layer_count - 1].fidelity.log_rmse;
}

/* phi_d -> pi - phi_d: corner k goes to P - k, corner 0 stays. */
static size_t mirrored(struct lattice_dims d, size_t n)
{
	const size_t k = n % d.phi_d;
	return n - k + (d.phi_d - k) % d.phi_d;
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
	packed_make(&mirror, trial->name, &trial->options, &packed);
	if (packed.status) {
		note(trial, WRONG, 1);
	} else {
		for (size_t c = 0; c < 3; c++)
			for (size_t n = 0; n < cells; n++) {
				const double a = base->value[c * cells + n], b = packed.value[c * cells + mirrored(d, n)];
				const double l = trial->lattice->valid[n] ? log10((a + 1e-3) / (b + 1e-3)) : 0;
				squares += l * l;
			}
		note(trial, MIRROR, sqrt(squares / (3.0 * (double)mirror.valid_count)) / fmax(1e-6, fmax(last_error(base), last_error(&packed))));
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
static void check_generations(const struct trial *trial, const struct packed_table *base, enum decoded_form form, enum property once)
{
	struct lattice next = {0};
	packed_to_lattice(base, form, &next);
	struct lattice original = above_horizon(trial, &next);
	struct packed_table packed = {.status = BP_OK};
	struct fidelity figures;
	double first = 0;

	lattice_free(&next);
	for (unsigned g = 0; g <= generations && original.valid_count; g++) {
		packed_make(g ? &next : &original, trial->name, &trial->options, &packed);
		lattice_free(&next);
		if (packed.status) {
			note(trial, WRONG, 1);
			break;
		}
		reference_fidelity(&original, &packed.table, &figures);
		if (g == 0)
			first = fmax(1e-3, figures.log_rmse);
		else
			note(trial, g == 1 ? once : (enum property)(once + 1), 20 * log10(fmax(1e-3, figures.log_rmse) / first));
		packed_to_lattice(&packed, form, &next);
		packed_free(&packed);
		if (g == 0 && form == DECODED_FILE) {
			if (!next.carried)
				break;
			trial->figures->carried++;
		}
	}
	lattice_free(&next);
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
		if (record_decode_whole(head, layers, base->record, &model, NULL) != BP_OK || model_expand(model, 0, &table, NULL) != BP_OK)
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
 * then moves is tried in long double; four times the most of four trials may be, since rounding errors need not be as random.
 * And where the two stopped at different steps, the one may be off by what is left to go: four times the reference's last step.
 */
static double deviation_counted(double deviation, double units, bool same_stop, const struct oracle *slow, const double *x, const double *y,
                                size_t n)
{
	uint64_t random = 1;
	double moved = 0;
	if (!(deviation > 1e-12))
		return deviation;
	for (int trial = 0; trial < 4; trial++) {
		const struct oracle shaken = slow_fit_shaken(x, y, n, (long double)units * 0x1p-53L, &random);
		if (isfinite(shaken.slope))
			moved = fmax(moved, oracle_deviation(shaken.intercept, shaken.slope, slow, x, n));
	}
	if (!same_stop)
		moved += oracle_deviation(slow->intercept - slow->step[0], slow->slope - slow->step[1], slow, x, n);
	if (verbose)
		fprintf(stderr, "a regression deviates by %.3g where %.3g may be\n", deviation, 4 * moved);
	return deviation * fmin(1, 1e-12 / (4 * moved));
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
		struct robust_fit fit;
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
			const double deviation = oracle_deviation(fit.intercept, fit.slope, &slow, x, n);
			note(trial, REGRESSION, deviation_counted(deviation, 1, fit.iterations == slow.iterations, &slow, x, y, n));
		}
		/* Where the remaining weights leave a constant x, no line is determined, and the slow reference gives NaN. */
		if (gsl.status == GSL_SUCCESS && isfinite(gsl.slope) && isfinite(slow.slope)) {
			const double deviation = oracle_deviation(fit.intercept, fit.slope, &gsl, x, n);
			/* GSL adds plainly: a sum of n terms errs by up to n half units. */
			note(trial, GSL, deviation_counted(deviation, (double)n, gsl.iterations == slow.iterations, &slow, x, y, n));
		}
	}
	free(x);
	free(y);
}

/* Writes the decoded values, or compares them with those of another build. */
static void values_out(const struct packed_table *packed)
{
	const size_t n = 3 * lattice_cells(packed->head.dims);
	const double floor = 1e-6 * largest_of(packed->value, n);
	if (dump && fwrite(packed->value, sizeof(double), n, dump) != n)
		exit(1);
	for (size_t i = 0; compared && i < n; i++) {
		double other;
		if (fread(&other, sizeof other, 1, compared) != 1) {
			fprintf(stderr, "stress: the values to compare with end early\n");
			exit(1);
		}
		compared_values++;
		compared_differ += other != packed->value[i];
		compared_worst = fmax(compared_worst, relative_deviation(packed->value[i], other, floor));
	}
}

static void case_run(struct trial *trial, bool values_only, struct packed_table *packed)
{
	trial->figures->cases++;
	packed_make(trial->lattice, trial->name, &trial->options, packed);
	if (packed->status) {
		trial->figures->refused++;
		/* Nothing to pack, or a budget that the message says is too small; anything else is a fault. */
		if (packed->status != (trial->lattice->valid_count ? BP_ERROR_LIMIT : BP_ERROR_BAD_INPUT) || trial->options.budget_bytes > 60000)
			note(trial, WRONG, trial->lattice->valid_count != 0);
		return;
	}
	trial->figures->packed++;
	values_out(packed);
	if (values_only)
		return;
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

struct plan {
	const struct subject *subject;
	uint32_t budget;
	unsigned seeds;
	bool merl, quick, values_only;
	uint32_t kinds; /* a bit for every kind wanted; 0: all */
};

/* All cases of one kind: every variant, lattice and seed. */
static void kind_run(const struct plan *plan, const struct stress_kind *kind, struct figures *figures)
{
	const size_t lattices = sizeof SMALL / sizeof *SMALL + (plan->merl ? 1 : 0);
	struct packed_table *packed = calloc(kind->variant_count * lattices * plan->seeds, sizeof *packed);
	struct archive_outcome outcome;
	struct trial last = {0};
	size_t count = 0;

	for (unsigned v = 0; v < kind->variant_count; v++)
		for (size_t d = 0; d < lattices; d++)
			for (unsigned seed = 1; seed <= plan->seeds; seed++) {
				const struct lattice_dims dims = d < sizeof SMALL / sizeof *SMALL ? SMALL[d] : LATTICE_MERL;
				struct lattice lattice;
				char name[128];
				if (dims.phi_d == LATTICE_MERL.phi_d && (v || seed > 1))
					continue; /* one of each kind is enough at this size */
				if (plan->quick && lattice_cells(dims) > 1000 && v)
					continue;
				snprintf(name, sizeof name, "%04zu-%s-%u-%ux%ux%u-seed-%u", count, kind->name, v, dims.theta_h, dims.theta_d, dims.phi_d, seed);
				if (stress_case_make(kind, v, seed, dims, &lattice, NULL) != BP_OK)
					exit(1);
				struct trial trial = {plan->subject, {plan->subject->profile, plan->budget, 0, 5}, &lattice, kind->name, name, figures};
				case_run(&trial, plan->values_only, &packed[count++]);
				last = trial;
				lattice_free(&lattice);
			}
	if (!plan->values_only) {
		last.name = kind->name;
		archive_exercise(packed, count, 64, &outcome);
		note(&last, WRONG, (double)(outcome.bad + outcome.refused));
		note(&last, ASYMMETRIC, (double)outcome.asymmetric);
	}
	for (size_t i = 0; i < count; i++)
		packed_free(&packed[i]);
	free(packed);
}

/* A bit for the kind of that name; ends the program where there is none. */
static uint32_t kind_bit(const char *name)
{
	for (unsigned k = 0; k < STRESS_KIND_COUNT; k++)
		if (!strcmp(STRESS_KINDS[k].name, name))
			return 1u << k;
	fprintf(stderr, "stress: there is no kind '%s'\n", name);
	exit(2);
}

/* Prints a row; whether all is within the limits. */
static bool row_print(const struct plan *plan, const char *kind, const struct figures *figures)
{
	bool within = true;
	printf("%s\t%u\t%s\t%u\t%u\t%u\t%u", plan->subject->name, plan->budget, kind, figures->cases, figures->packed, figures->refused, figures->carried);
	for (int p = 0; p < PROPERTY_COUNT; p++) {
		const bool over = !(figures->worst[p] <= limit_of(plan->subject, plan->budget, kind, (enum property)p));
		printf("\t%.3g%s", figures->worst[p], over ? "!" : "");
		within = within && !over;
	}
	putchar('\n');
	fflush(stdout);
	return within;
}

static bool subject_run(struct plan plan)
{
	bool within = true;
	for (int b = 0; plan.subject->budgets[b]; b++) {
		plan.budget = plan.subject->budgets[b];
		for (unsigned k = 0; k < STRESS_KIND_COUNT; k++) {
			struct figures figures = {{0}, 0, 0, 0, 0};
			if (plan.kinds && !(plan.kinds >> k & 1))
				continue;
			kind_run(&plan, &STRESS_KINDS[k], &figures);
			if (!plan.values_only)
				within = row_print(&plan, STRESS_KINDS[k].name, &figures) && within;
		}
	}
	return within;
}

int main(int argc, char **argv)
{
	struct plan plan = {.seeds = 1};
	bool within = true;
	int option;

	while ((option = getopt(argc, argv, "s:g:k:mqvd:c:")) != -1)
		switch (option) {
		case 's': plan.seeds = (unsigned)atoi(optarg); break;
		case 'g': generations = (unsigned)atoi(optarg); break;
		case 'k': plan.kinds |= kind_bit(optarg); break;
		case 'm': plan.merl = true; break;
		case 'q': plan.quick = true; break;
		case 'v': verbose = true; break;
		case 'd': dump = fopen(optarg, "wb"); plan.values_only = true; break;
		case 'c': compared = fopen(optarg, "rb"); plan.values_only = true; break;
		default: return 2;
		}
	if (plan.values_only && !dump && !compared) {
		perror("stress");
		return 1;
	}
	if (!plan.values_only) {
		printf("profile\tbudget\tkind\tcases\tpacked\trefused\tcarried");
		for (int p = 0; p < PROPERTY_COUNT; p++)
			printf("\t%s", PROPERTY_NAMES[p]);
		putchar('\n');
	}
	for (size_t s = 0; s < sizeof SUBJECTS / sizeof *SUBJECTS; s++) {
		plan.subject = &SUBJECTS[s];
		within = subject_run(plan) && within;
	}
	if (compared) {
		within = compared_worst <= 1e-5 && fgetc(compared) == EOF;
		printf("%zu of %zu values differ, by at most %.3g of themselves\n", compared_differ, compared_values, compared_worst);
	}
	if (dump && fclose(dump) != 0)
		return 1;
	return within ? 0 : 1;
}
