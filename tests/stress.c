/*
 * stress.c: adversarial materials through every profile, and the properties that must survive.
 *
 *     stress [-s SEEDS] [-g GENERATIONS] [-k KIND]... [-m] [-q] [-v] [-d DUMP] [-c DUMP]
 *
 * Prints one table (TSV): a row per profile, budget and kind of material, with the worst figure of every property. The exit
 * code is 1 when a figure exceeds its profile's limit. -k: only these kinds. -m: also on MERL's lattice. -q: one variant of
 * each kind on the larger lattices. -v: every case over the limit on standard error. -d writes all decoded values to a file;
 * -c compares them with such a file of another build instead.
 */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stress_cases.h"
#include "stress_checks.h"
#include "stress_reference.h"

static const struct lattice_dims SMALL[] = {{4, 4, 4}, {8, 8, 8}, {7, 10, 12}, {24, 20, 36}};
static FILE *dump, *compared;
static double compared_worst;
static size_t compared_values, compared_differ;

/* Writes the decoded values, or compares them with those of another build. */
static void values_out(const struct packed_table *packed)
{
	const size_t n = 3 * lattice_cells(packed->head.dims);
	double floor = 0;
	for (size_t i = 0; i < n; i++)
		floor = fmax(floor, 1e-6 * packed->value[i]);
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
	packed_make(trial->lattice, NULL, trial->name, &trial->options, packed);
	if (packed->status) {
		trial->figures->refused++;
		/* Nothing to pack, or a budget that the message says is too small; anything else is a fault. */
		if (packed->status != (trial->lattice->valid_count ? BP_ERROR_LIMIT : BP_ERROR_BAD_INPUT) ||
		    trial->options.budget_bytes > 60000)
			note(trial, WRONG, trial->lattice->valid_count != 0);
		return;
	}
	trial->figures->packed++;
	values_out(packed);
	if (values_only)
		return;
	checks_run(trial, packed);
}

struct plan {
	const struct subject *subject;
	uint32_t budget;
	unsigned seeds;
	unsigned generations;
	bool merl, quick, values_only, verbose;
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
				snprintf(name, sizeof name, "%04zu-%s-%u-%ux%ux%u-seed-%u", count, kind->name, v, dims.theta_h, dims.theta_d,
				         dims.phi_d, seed);
				if (stress_case_make(kind, v, seed, dims, &lattice, NULL) != BP_OK)
					exit(1);
				struct trial trial = {
					.subject = plan->subject,
					.options = {plan->subject->profile, plan->budget, 0, 5},
					.lattice = &lattice,
					.kind = kind->name,
					.name = name,
					.figures = figures,
					.generations = plan->generations,
					.verbose = plan->verbose,
				};
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
	printf("%s\t%u\t%s\t%u\t%u\t%u\t%u", plan->subject->name, plan->budget, kind, figures->cases, figures->packed,
	       figures->refused, figures->carried);
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
	struct plan plan = {.seeds = 1, .generations = 10};
	bool within = true;
	int option;

	while ((option = getopt(argc, argv, "s:g:k:mqvd:c:")) != -1)
		switch (option) {
		case 's': plan.seeds = (unsigned)atoi(optarg); break;
		case 'g': plan.generations = (unsigned)atoi(optarg); break;
		case 'k': plan.kinds |= kind_bit(optarg); break;
		case 'm': plan.merl = true; break;
		case 'q': plan.quick = true; break;
		case 'v': plan.verbose = true; break;
		case 'd':
			dump = fopen(optarg, "wb");
			plan.values_only = true;
			break;
		case 'c':
			compared = fopen(optarg, "rb");
			plan.values_only = true;
			break;
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
	for (size_t s = 0; s < SUBJECT_COUNT; s++) {
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
