/* The paper's profile: what it keeps, what it leaves out, and what comes out of odd inputs. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "model/fidelity.h"
#include "model/model.h"
#include "model/paper/paper.h"
#include "model/paper/sparse_fit.h"
#define RANDOM_SEED 23
#include "random.h"

static const struct fit_options OPTIONS = {.profile = PROFILE_PAPER, .budget_bytes = 60400, .effort = 5};
static const struct lattice_dims SMALL[] = {{4, 4, 4}, {12, 10, 16}, {5, 7, 9}, {9, 33, 5}};
enum { SMALL_COUNT = sizeof SMALL / sizeof *SMALL };

/* A smooth glossy material: a diffuse part, a lobe along theta_h, a Fresnel rise along theta_d, a touch of phi_d. */
static double glossy(struct lattice_dims d, uint32_t i, uint32_t j, uint32_t k, int c)
{
	double h = pow((double)i / d.theta_h, 2) * 1.5707963, t = (double)j / d.theta_d * 1.5707963,
		   p = (double)k / d.phi_d * 3.14159265;
	double lobe = 4 * exp(-20 * h * h) * (1 + 3 * pow(1 - cos(t), 3)) * (1 + 0.2 * cos(2 * p) * sin(t) * sin(h));
	return (c == 0 ? 0.3 : c == 1 ? 0.2 : 0.1) * cos(t) + (c == 2 ? 0.9 : 1) * lobe;
}

static void lattice_make(struct lattice *l, struct lattice_dims d, double share_invalid)
{
	assert_int_equal(lattice_alloc(d, l, NULL), BP_OK);
	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++)
			for (uint32_t k = 0; k < d.phi_d; k++) {
				bool gone = uniform() < share_invalid;
				for (int c = 0; c < 3; c++)
					l->rgb[c][lattice_index(d, i, j, k)] = gone ? -1 : glossy(d, i, j, k, c);
			}
	lattice_validate(l);
}

static void assert_expands_finite(const struct model *model, uint32_t layers, struct expansion *table)
{
	assert_int_equal(model_expand(model, layers, table, NULL), BP_OK);
	assert_true(isfinite(table->unit) && table->unit > 0);
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < lattice_cells(table->dims); i++) {
			float v = table->rgb[c][i];
			if (!(v >= 0 && v <= FLT_MAX) || !isfinite(table->unit * (double)v))
				fail_msg("channel %d, cell %zu: %g * %g", c, i, (double)v, table->unit);
		}
}

/* Fits, expands every prefix, and returns the fidelity of the whole. */
static struct fidelity fit_and_measure(const struct lattice *l, struct model **model, struct expansion *table)
{
	struct fidelity f;
	assert_int_equal(model_fit(l, &OPTIONS, model, NULL), BP_OK);
	assert_int_equal(expansion_alloc(l->dims, table, NULL), BP_OK);
	for (uint32_t layers = 1; layers <= (*model)->layer_count; layers++)
		assert_expands_finite(*model, layers, table);
	assert_int_equal(fidelity_measure(l, table, 1, &f, NULL), BP_OK);
	return f;
}

/* The same of a lattice that is done with then. */
static void fit_and_free(struct lattice *l)
{
	struct model *model;
	struct expansion table;
	lattice_validate(l);
	fit_and_measure(l, &model, &table);
	expansion_free(&table);
	model_free(model);
	lattice_free(l);
}

static void assert_field(const struct sparse_field *field, struct lattice_dims d, enum paper_field kind)
{
	for (uint32_t i = 0; i < field->count; i++) {
		assert_true(field->index[i] < paper_plane_cells(d, kind));
		assert_true(i == 0 || field->index[i] > field->index[i - 1]);
		assert_true(field->level[i] != 0 && abs(field->level[i]) <= PAPER_LEVEL_MAX);
	}
	assert_true(field->count == 0 || (field->step >= PAPER_STEP_LEAST && field->step <= PAPER_STEP_MOST));
}

static uint32_t slice_coefficients(const struct paper_channel *channel)
{
	uint32_t count = 0;
	for (uint32_t i = 0; i < channel->slice_count; i++)
		count += channel->slice[i].count;
	return count;
}

/* A sixteenth of the cells of each pair, a sixty-fourth of all slices together, with the last slice for all from 40 degrees on. */
static void the_fractions_of_the_paper_are_kept(void **user)
{
	(void)user;
	assert_int_equal(paper_keep(LATTICE_MERL, PAPER_HD), 506);
	assert_int_equal(paper_keep(LATTICE_MERL, PAPER_HPHI), 1012);
	assert_int_equal(paper_keep(LATTICE_MERL, PAPER_SLICE), 61 * 253);
	assert_int_equal(paper_keep(SMALL[0], PAPER_SLICE), 4); /* at least one to a slice */
	for (int q = 0; q < SMALL_COUNT; q++) {
		const struct lattice_dims d = SMALL[q];
		struct lattice l;
		struct model *model;
		struct expansion table;
		lattice_make(&l, d, 0.2);
		fit_and_measure(&l, &model, &table);
		assert_int_equal(model->layer_count, PAPER_LAYERS);
		for (int c = 0; c < 3; c++) {
			const struct paper_channel *channel = &model->paper->channel[c];
			assert_int_equal(channel->slice_count, paper_shared_from(d.theta_h) + 1);
			assert_field(&channel->hd, d, PAPER_HD);
			assert_field(&channel->hphi, d, PAPER_HPHI);
			for (uint32_t i = 0; i < channel->slice_count; i++)
				assert_field(&channel->slice[i], d, PAPER_SLICE);
			assert_true(channel->hd.count <= paper_keep(d, PAPER_HD) && channel->hphi.count <= paper_keep(d, PAPER_HPHI));
			assert_true(slice_coefficients(channel) <= paper_keep(d, PAPER_SLICE) + channel->slice_count);
			const uint32_t extents[3] = {d.theta_h, d.theta_d, d.phi_d};
			for (int a = 0; a < 3; a++) {
				double sum = 0;
				for (uint32_t i = 0; i < extents[a]; i++) {
					assert_true(channel->marginal[a][i] >= 0);
					assert_true(channel->marginal[a][i] == paper_coded(paper_code(channel->marginal[a][i])));
					sum += (double)channel->marginal[a][i];
				}
				assert_true(fabs(sum / extents[a] - 1) < 4e-4);
			}
		}
		expansion_free(&table);
		model_free(model);
		lattice_free(&l);
	}
}

static void slices_are_shared_from_forty_degrees_on(void **user)
{
	(void)user;
	assert_int_equal(paper_shared_from(90), 60);
	assert_int_equal(paper_shared_from(4), 3);
	assert_int_equal(paper_shared_from(12), 8);
	for (uint32_t n = 4; n <= 1024; n++) {
		double at = 90 * pow((double)paper_shared_from(n) / n, 2), before = 90 * pow((paper_shared_from(n) - 1.0) / n, 2);
		assert_true(at >= 40 - 1e-9 && before < 40);
	}
}

static void a_merl_size_material_is_fitted_well(void **user)
{
	(void)user;
	struct lattice l;
	struct model *model;
	struct expansion table;
	lattice_make(&l, LATTICE_MERL, 0.01);
	struct fidelity f = fit_and_measure(&l, &model, &table), first;
	assert_int_equal(model_expand(model, 1, &table, NULL), BP_OK);
	assert_int_equal(fidelity_measure(&l, &table, 1, &first, NULL), BP_OK);
	assert_true(f.log_rmse < 0.05);
	assert_true(f.log_rmse < first.log_rmse / 2);
	for (int c = 0; c < 3; c++) {
		const struct paper_channel *channel = &model->paper->channel[c];
		assert_true(channel->hd.count > 480 && channel->hd.count <= 506);
		assert_true(channel->hphi.count > 900 && channel->hphi.count <= 1012);
		assert_int_equal(channel->slice_count, 61);
		assert_true(slice_coefficients(channel) > 14500 && slice_coefficients(channel) <= 15433);
		assert_true(fabs(model->colour[c].specular - 1) < 0.02 && model->colour[c].converged && model->colour[c].rejected < 0.5);
	}
	expansion_free(&table);
	model_free(model);
	lattice_free(&l);
}

/* Pairs that are independent are left out, the table comes back all the same. */
static void independent_pairs_are_left_out(void **user)
{
	(void)user;
	const struct lattice_dims d = {12, 10, 16};
	struct lattice l;
	struct model *model;
	struct expansion table;
	assert_int_equal(lattice_alloc(d, &l, NULL), BP_OK);
	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++)
			for (uint32_t k = 0; k < d.phi_d; k++)
				for (int c = 0; c < 3; c++)
					l.rgb[c][lattice_index(d, i, j, k)] = exp(-0.3 * i) * (1 + j) * (2 + cos(0.4 * k)) * (c + 1);
	lattice_validate(&l);
	struct fidelity f = fit_and_measure(&l, &model, &table);
	for (int c = 0; c < 3; c++) {
		const struct paper_channel *channel = &model->paper->channel[c];
		assert_true(channel->hd.count == 0 && channel->hphi.count == 0);
		for (uint32_t i = 0; i < channel->slice_count; i++)
			assert_int_equal(channel->slice[i].count, 0);
		assert_true(fabs(model->colour[c].specular - 1) < 1e-3);
	}
	assert_true(f.log_rmse < 5e-4 && f.largest_relative < 2e-3); /* marginals have steps of 0.0007 */
	expansion_free(&table);
	model_free(model);
	lattice_free(&l);
}

static void a_constant_and_a_black_material_come_back(void **user)
{
	(void)user;
	static const double sizes[] = {0, 1, 1e-300, 1e300, 1e-4, 1e8};
	for (int q = 0; q < SMALL_COUNT; q++)
		for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
			struct lattice l;
			struct model *model;
			struct expansion table;
			assert_int_equal(lattice_alloc(SMALL[q], &l, NULL), BP_OK);
			for (int c = 0; c < 3; c++)
				for (size_t i = 0; i < lattice_cells(SMALL[q]); i++)
					l.rgb[c][i] = sizes[s] * (1 + 0.25 * c);
			lattice_validate(&l);
			fit_and_measure(&l, &model, &table);
			for (int c = 0; c < 3; c++)
				for (size_t i = 0; i < lattice_cells(SMALL[q]); i++)
					assert_true(fabs(table.unit * (double)table.rgb[c][i] - l.rgb[c][i]) <= 1e-6 * l.rgb[c][i]);
			expansion_free(&table);
			model_free(model);
			lattice_free(&l);
		}
}

static void a_single_bright_cell_stays_where_it_is(void **user)
{
	(void)user;
	static const double sizes[] = {1, 1e12, 1e-300, 1e300};
	for (int q = 0; q < SMALL_COUNT; q++)
		for (int s = 0; s < 4; s++) {
			struct lattice l;
			size_t bright = lattice_cells(SMALL[q]) / 3;
			assert_int_equal(lattice_alloc(SMALL[q], &l, NULL), BP_OK);
			for (int c = 0; c < 3; c++)
				l.rgb[c][bright] = sizes[s];
			fit_and_free(&l);
		}
}

/* Cells, rows, slices that were not measured, and nearly everything missing. */
static void lattices_with_little_valid_are_fitted(void **user)
{
	(void)user;
	static const double shares[] = {0.5, 0.9, 0.99};
	for (int q = 0; q < SMALL_COUNT; q++)
		for (int s = 0; s < 5; s++) {
			const struct lattice_dims d = SMALL[q];
			struct lattice l;
			lattice_make(&l, d, s < 3 ? shares[s] : 0);
			for (size_t i = 0; i < lattice_cells(d); i++) {
				size_t slice = i / (d.theta_d * d.phi_d), row = i / d.phi_d % d.theta_d, column = i % d.phi_d;
				bool gone = s == 3 ? i != 5 : s == 4 ? slice == 1 || row == 2 || column == 3 : false;
				for (int c = 0; c < 3; c++)
					l.rgb[c][i] = gone ? -1 : i == 5 ? 1 : l.rgb[c][i];
			}
			fit_and_free(&l);
		}
}

/* What is measured below the clamp and across eighteen orders of magnitude stays finite. */
static void extremes_side_by_side_stay_finite(void **user)
{
	(void)user;
	for (int q = 0; q < SMALL_COUNT; q++)
		for (int s = 0; s < 3; s++) {
			struct lattice l;
			struct model *model;
			struct expansion table;
			assert_int_equal(lattice_alloc(SMALL[q], &l, NULL), BP_OK);
			for (int c = 0; c < 3; c++)
				for (size_t i = 0; i < lattice_cells(SMALL[q]); i++)
					l.rgb[c][i] = s == 0 ? (i % 2 ? 1e12 : 1e-6) : s == 1 ? exp(80 * uniform() - 40) : i % 3 ? DBL_MAX : 4.9e-324;
			lattice_validate(&l);
			assert_int_equal(model_fit(&l, &OPTIONS, &model, NULL), BP_OK);
			assert_int_equal(expansion_alloc(l.dims, &table, NULL), BP_OK);
			assert_int_equal(model_expand(model, 0, &table, NULL), BP_OK);
			for (int c = 0; c < 3; c++)
				for (size_t i = 0; i < lattice_cells(SMALL[q]); i++)
					assert_true(isfinite(table.rgb[c][i]) && table.rgb[c][i] >= 0);
			expansion_free(&table);
			model_free(model);
			lattice_free(&l);
		}
}

/* The scale of the material changes the scale of the model and nothing else. */
static void the_unit_of_the_input_does_not_matter(void **user)
{
	(void)user;
	const struct lattice_dims d = {12, 10, 16};
	struct lattice l;
	struct model *one, *other;
	struct expansion a, b;
	state = 77;
	lattice_make(&l, d, 0.2);
	fit_and_measure(&l, &one, &a);
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < lattice_cells(d); i++)
			l.rgb[c][i] *= 0x1p40;
	fit_and_measure(&l, &other, &b);
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < lattice_cells(d); i++)
			assert_true(fabs(b.unit * (double)b.rgb[c][i] / 0x1p40 - a.unit * (double)a.rgb[c][i]) <=
			            1e-6 * a.unit * (double)a.rgb[c][i] + 1e-30);
	expansion_free(&a);
	expansion_free(&b);
	model_free(one);
	model_free(other);
	lattice_free(&l);
}

/*
 * A sixth of the cells, and so some whole rows of slices, are so dark that a scaled table says 0 there. Which it is, and how
 * dark, must not matter: ratios of such rows to their means were as large as any.
 */
static void how_dark_the_dark_is_does_not_matter(void **user)
{
	(void)user;
	static const double darkness[] = {0, DBL_TRUE_MIN, 17 * DBL_TRUE_MIN, 1e-200, 1e-60};
	const struct lattice_dims d = {8, 8, 8};
	struct expansion first = {0};
	for (size_t n = 0; n < sizeof darkness / sizeof *darkness; n++) {
		struct lattice l;
		struct model *model;
		struct expansion table;
		state = 77;
		lattice_make(&l, d, 0);
		for (size_t i = 0; i < lattice_cells(d); i++) {
			const bool dark = i / 8 % 3 == 0 || uniform() < 0.2;
			for (int c = 0; c < 3; c++)
				l.rgb[c][i] = dark ? darkness[n] : l.rgb[c][i];
		}
		lattice_validate(&l);
		fit_and_measure(&l, &model, &table);
		if (n == 0)
			first = table;
		for (int c = 0; n && c < 3; c++)
			assert_memory_equal(first.rgb[c], table.rgb[c], lattice_cells(d) * sizeof *table.rgb[c]);
		if (n)
			expansion_free(&table);
		model_free(model);
		lattice_free(&l);
	}
	expansion_free(&first);
}

static void a_field_of_zeros_is_not_a_field_of_ones(void **user)
{
	(void)user;
	const struct lattice_dims d = {4, 5, 4};
	const struct wavelet_plane plane = paper_plane(d, PAPER_SLICE);
	struct sparse_fit fit;
	struct field_codec *codec;
	struct sparse_field field;
	float wanted[20] = {0}, weight[20], energy[64], x[64] = {0}, back[20];
	struct sparse_target target = {wanted, weight, energy, 0};
	for (int i = 0; i < 20; i++)
		weight[i] = 1;
	assert_true(wavelet_cells(&plane) <= 64);
	assert_int_equal(sparse_fit_create(&plane, &fit, NULL), BP_OK);
	sparse_fit_energies(&fit, &target);
	assert_int_equal(sparse_fit_quantise(&fit, &target, 1, x, &field, NULL), BP_OK);
	assert_int_equal(field.count, 1);
	assert_int_equal(field_codec_create(d, PAPER_SLICE, &codec, NULL), BP_OK);
	field_expand(codec, &field, back);
	for (int i = 0; i < 20; i++)
		assert_true(back[i] < 1e-20f);
	/* An index that no plane has, as a damaged record might, is ignored. */
	field.index[0] = UINT32_MAX;
	field_expand(codec, &field, back);
	sparse_field_free(&field);
	for (int i = 0; i < 20; i++)
		wanted[i] = 1;
	assert_int_equal(sparse_fit_quantise(&fit, &target, 1, x, &field, NULL), BP_OK);
	assert_int_equal(field.count, 0);
	free(codec);
	sparse_fit_free(&fit);
}

/* With as many coefficients as a plane has, the fit is exact wherever there is a weight. */
static void enough_coefficients_say_everything(void **user)
{
	(void)user;
	const struct wavelet_plane plane = wavelet_plane_for(WAVELET_DAUBECHIES, 6, 9, true);
	const size_t n = wavelet_field_cells(&plane), m = wavelet_cells(&plane);
	struct sparse_fit fit;
	float *wanted = malloc(n * sizeof *wanted), *weight = malloc(n * sizeof *weight), *energy = malloc(m * sizeof *energy);
	float *x = calloc(m, sizeof *x), *back = malloc(n * sizeof *back);
	uint8_t *kept = malloc(m);
	struct sparse_target target = {wanted, weight, energy, 0};
	for (size_t i = 0; i < n; i++) {
		wanted[i] = (float)(1 + uniform());
		weight[i] = i % 5 ? (float)(0.1 + uniform()) : 0;
	}
	assert_int_equal(sparse_fit_create(&plane, &fit, NULL), BP_OK);
	sparse_fit_energies(&fit, &target);
	sparse_fit_rounds(&fit, &target, m, 2, 100, kept, x);
	wavelet_inverse(&plane, x, back, fit.scratch);
	for (size_t i = 0; i < n; i++)
		assert_true(weight[i] == 0 || fabsf(back[i] - wanted[i]) < 2e-3f);
	sparse_fit_free(&fit);
	free(wanted);
	free(weight);
	free(energy);
	free(x);
	free(back);
	free(kept);
}

/* Exactly as many gains are kept as are asked for, the largest to within a bin; of equal ones the first. */
static void the_largest_gains_are_kept(void **user)
{
	(void)user;
	enum { N = 1000 };
	float gain[N];
	uint8_t kept[N];
	for (int i = 0; i < N; i++)
		gain[i] = i % 10 ? (float)pow(10, 20 * uniform() - 10) : i % 20 ? 1 : 0;
	for (size_t keep = 0; keep <= N; keep += 50) {
		const float edge = gains_keep(gain, N, keep, kept);
		size_t count = 0;
		for (int i = 0; i < N; i++) {
			count += kept[i];
			assert_true(!kept[i] || gain[i] >= edge);
			assert_true(kept[i] || gain[i] <= edge * (1 + 1.0f / 32) || gain[i] == 0);
		}
		assert_int_equal(count, keep < N - 50 ? keep : N - 50);
	}
}

static void unknown_profiles_and_wrong_tables_are_refused(void **user)
{
	(void)user;
	struct lattice l;
	struct model *model;
	struct expansion table;
	struct fit_options odd = OPTIONS;
	odd.profile = (enum profile)99;
	lattice_make(&l, SMALL[0], 0);
	assert_int_equal(model_fit(&l, &odd, &model, NULL), BP_ERROR_UNSUPPORTED);
	assert_int_equal(model_fit(&l, &OPTIONS, &model, NULL), BP_OK);
	assert_int_equal(expansion_alloc(SMALL[1], &table, NULL), BP_OK);
	assert_int_equal(model_expand(model, 0, &table, NULL), BP_ERROR_ARGUMENT);
	expansion_free(&table);
	model_free(model);
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < 64; i++)
			l.rgb[c][i] = NAN;
	lattice_validate(&l);
	assert_int_equal(model_fit(&l, &OPTIONS, &model, NULL), BP_ERROR_BAD_INPUT);
	lattice_free(&l);
	model_free(NULL);
}

/* For tests/paper_oracle.py: a small lattice, and what it decodes to. */
static void table_write(void)
{
	const struct lattice_dims d = {12, 10, 16};
	struct lattice l;
	struct model *model;
	struct expansion table;
	state = 5;
	lattice_make(&l, d, 0.1);
	fit_and_measure(&l, &model, &table);
	printf("{\"dims\": [%u, %u, %u],\n", d.theta_h, d.theta_d, d.phi_d);
	for (int part = 0; part < 2; part++) {
		printf("\"%s\": [", part ? "decoded" : "measured");
		for (int c = 0; c < 3; c++)
			for (size_t i = 0; i < lattice_cells(d); i++) {
				const double v = part ? table.unit * (double)table.rgb[c][i] : l.valid[i] ? l.rgb[c][i] : -1;
				printf("%s%.17g%s", i ? ", " : "[", v, i + 1 < lattice_cells(d) ? "" : c < 2 ? "],\n" : "]");
			}
		printf("]%s\n", part ? "}" : ",");
	}
	expansion_free(&table);
	model_free(model);
	lattice_free(&l);
}

int main(int argc, char **argv)
{
	if (argc == 2 && !strcmp(argv[1], "--table")) {
		table_write();
		return 0;
	}
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_fractions_of_the_paper_are_kept),
		cmocka_unit_test(slices_are_shared_from_forty_degrees_on),
		cmocka_unit_test(a_merl_size_material_is_fitted_well),
		cmocka_unit_test(independent_pairs_are_left_out),
		cmocka_unit_test(a_constant_and_a_black_material_come_back),
		cmocka_unit_test(a_single_bright_cell_stays_where_it_is),
		cmocka_unit_test(lattices_with_little_valid_are_fitted),
		cmocka_unit_test(extremes_side_by_side_stay_finite),
		cmocka_unit_test(the_unit_of_the_input_does_not_matter),
		cmocka_unit_test(how_dark_the_dark_is_does_not_matter),
		cmocka_unit_test(a_field_of_zeros_is_not_a_field_of_ones),
		cmocka_unit_test(enough_coefficients_say_everything),
		cmocka_unit_test(the_largest_gains_are_kept),
		cmocka_unit_test(unknown_profiles_and_wrong_tables_are_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
