/*
 * The analytic baselines: single values against an independent evaluation (explicit vectors; Fresnel from
 * Snell's law and the two polarisations; worked out in Python), and each fitter on a table of its own model.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "bench/lobe.h"
#include "bench/lobe_sample.h"

static const struct lattice_dims SMALL = {30, 20, 20};

static void assert_close(double found, double expected, double relative)
{
	if (!(fabs(found - expected) <= relative * fabs(expected)))
		fail_msg("found %.12g, expected %.12g", found, expected);
}

/* theta_h, theta_d, phi_d = (10, 30, 60), (25, 50, 90), (50, 20, 30) degrees, as directions */
static const double WI[3][3] = {
	{0.39658567143348733, 0.43301270189221924, 0.8094564875357106},
	{0.2716537822741845, 0.766044443118978, 0.5825634160695854},
	{0.9102388001215315, 0.17101007166283433, 0.3771218399180657},
};
static const double WO[3][3] = {
	{-0.09581820507261674, -0.43301270189221924, 0.8962805763691759},
	{0.2716537822741844, -0.766044443118978, 0.5825634160695854},
	{0.529453820664377, -0.17101007166283433, 0.8309237071920418},
};

static void check_values(const struct lobe_model *model, const double shape[3][3], const double expected[3])
{
	for (int n = 0; n < 3; n++) {
		assert_close(model->value(shape[n], cell_angles_of(WI[n], WO[n])), expected[n], 1e-12);
		assert_close(model->value(shape[n], cell_angles_of(WO[n], WI[n])), expected[n], 1e-12);
	}
}

static void ward_gives_the_values_worked_out_by_hand(void **state)
{
	(void)state;
	check_values(&LOBE_WARD, (const double[3][3]){{0.2}, {0.2}, {0.6}},
	             (const double[3]){1.0736010770239963, 0.014877548823174193, 0.0076398010319336076});
}

static void cook_torrance_gives_the_values_worked_out_by_hand(void **state)
{
	(void)state;
	/* the third has G = 0.516: shadowed */
	check_values(&LOBE_COOK_TORRANCE, (const double[3][3]){{0.25, 0.04}, {0.25, 0.04}, {0.7, 0.5}},
	             (const double[3]){0.18843769287766277, 0.03954850864000675, 0.1725414090279678});
}

static void edwards_gives_the_values_worked_out_by_hand(void **state)
{
	(void)state;
	check_values(&LOBE_EDWARDS, (const double[3][3]){{8, 0.7, 0.1}, {8, 0.7, 0.1}, {1.5, 0.9, 0.3}},
	             (const double[3]){0.11161308035849178, 0.00990309196181437, 0.008772657329623495});
	/* beyond the lump's radius there is nothing */
	assert_true(LOBE_EDWARDS.value((const double[]){8, 0.5, 0.1}, cell_angles_of(WI[2], WO[2])) == 0);
}

static void the_cells_angles_agree_with_the_directions(void **state)
{
	const struct lattice_dims dims = {90, 90, 180};
	struct lattice_cosines tables;
	(void)state;

	lattice_centres(dims, &tables);
	for (int n = 0; n < 3; n++) {
		/* 10, 25, 50 degrees lie at 30, 47.43, 67.08 */
		const double at[3][3] = {{30, 30, 60}, {47.43416490252569, 50, 90}, {67.08203932499369, 20, 30}};
		double found[3];
		lattice_coordinates(dims, WI[n], WO[n], found);
		for (int axis = 0; axis < 3; axis++)
			assert_close(found[axis], at[n][axis], 1e-9);
		/* reciprocity */
		lattice_coordinates(dims, WO[n], WI[n], found);
		for (int axis = 0; axis < 3; axis++)
			assert_close(found[axis], at[n][axis], 1e-9);
	}
	/* the centre of cell (30, 40, 60), rotated by hand */
	const double h = 30.5 * 30.5 / 8100 * M_PI_2, d = 40.5 / 90 * M_PI_2, p = 60.5 / 180 * M_PI;
	const double x = sin(d) * cos(p), y = sin(d) * sin(p), z = cos(d);
	const double wi[3] = {cos(h) * x + sin(h) * z, y, cos(h) * z - sin(h) * x};
	const double wo[3] = {-cos(h) * x + sin(h) * z, -y, cos(h) * z + sin(h) * x};
	double found[3], beyond;
	lattice_coordinates(dims, wi, wo, found);
	assert_true(fabs(found[0] - 30.5) < 1e-9 && fabs(found[1] - 40.5) < 1e-9 && fabs(found[2] - 60.5) < 1e-9);
	struct cell_angles a = cell_angles_at(&tables, 30, 40, 60), b = cell_angles_of(wi, wo);
	assert_close(a.cos_i, b.cos_i, 1e-12);
	assert_close(a.cos_o, b.cos_o, 1e-12);
	assert_close(a.cos_h, b.cos_h, 1e-12);
	assert_close(a.cos_d, b.cos_d, 1e-12);
	assert_true(centre_before(0.2, 90, &beyond) == 0 && beyond == 0);
	assert_true(centre_before(3.75, 90, &beyond) == 3 && beyond == 0.25);
	assert_true(centre_before(89.9, 90, &beyond) == 89 && beyond == 0);
}

/* On 4 x 4 x 4 cells; the measures integrated numerically in Python, the cosines from rotated vectors. */
static void cells_weigh_their_measure_times_the_squared_cosine(void **state)
{
	const struct {
		size_t at;
		uint32_t cell;
		double weight;
	} expected[] = {
		{0, 0, 0.00119337105232833}, {5, 5, 0.0020706387732306697}, {20, 22, 0.02930306966053244}, {39, 51, 0.02500056761055221}};
	const struct lattice_dims dims = {4, 4, 4};
	struct lattice lattice;
	struct lobe_sample sample;
	(void)state;

	assert_int_equal(lattice_alloc(dims, &lattice, NULL), BP_OK);
	for (size_t cell = 0; cell < 64; cell++)
		lattice.valid[cell] = 1;
	assert_int_equal(lobe_sample_take(&lattice, 1, 1, &sample, NULL), BP_OK);
	assert_int_equal(sample.count, 40); /* the others lie beyond 80 degrees */
	for (size_t n = 0; n < sizeof expected / sizeof *expected; n++) {
		assert_int_equal(sample.cell[expected[n].at], expected[n].cell);
		assert_close(sample.weight[expected[n].at], expected[n].weight, 1e-7);
	}
	lobe_sample_free(&sample);
	lattice_free(&lattice);
}

static void two_albedos_never_go_negative(void **state)
{
	double a, b;
	(void)state;

	/* y = 2 p + 3 l with p, l at an angle: exact */
	assert_close(nonnegative_pair(1, 0.5, 1, 3.5, 4, &a, &b), 4 + 9 + 6, 1e-12);
	assert_close(a, 2, 1e-12);
	assert_close(b, 3, 1e-12);
	/* y = 2 p - l: the better edge is p alone, a = 1.5, which explains 2.25 */
	assert_close(nonnegative_pair(1, 0.5, 1, 1.5, 0, &a, &b), 2.25, 1e-12);
	assert_true(b == 0);
	assert_close(a, 1.5, 1e-12);
	/* the same function twice */
	assert_close(nonnegative_pair(1, 1, 1, 2, 2, &a, &b), 4, 1e-12);
	assert_close(a + b, 2, 1e-12);
}

static struct lattice make_table(const struct lobe_model *model, const float *shape, const float *diffuse, const float *specular)
{
	struct lobe_state truth = {.model = model};
	struct expansion table;
	struct lattice lattice;

	for (int n = 0; n < 3; n++) {
		truth.shape[n] = shape[n];
		truth.diffuse[n] = diffuse[n];
		truth.specular[n] = specular[n];
	}
	assert_int_equal(expansion_alloc(SMALL, &table, NULL), BP_OK);
	assert_int_equal(lattice_alloc(SMALL, &lattice, NULL), BP_OK);
	assert_int_equal(lobe_expand(&truth, &table, NULL), BP_OK);
	for (size_t cell = 0; cell < lattice_cells(SMALL); cell++) {
		for (int c = 0; c < 3; c++)
			lattice.rgb[c][cell] = table.unit * table.rgb[c][cell];
		lattice.valid[cell] = 1;
	}
	lattice.valid_count = lattice_cells(SMALL);
	expansion_free(&table);
	return lattice;
}

static bp_status fit(const struct lobe_model *model, const struct lattice *lattice, enum lobe_objective objective,
                     struct fitted *out, bp_error *error)
{
	const struct lobe_variant variant = {model, objective};
	return lobe_fit(&(struct baseline){.variant = &variant}, &(struct bench_material){.lattice = lattice}, out, error);
}

static void check_recovery_by(enum lobe_objective objective, const struct lobe_model *model, const float *shape,
                              const float *diffuse, const float *specular)
{
	struct lattice lattice = make_table(model, shape, diffuse, specular);
	struct fitted fitted;

	assert_int_equal(fit(model, &lattice, objective, &fitted, NULL), BP_OK);
	struct lobe_state *found = fitted.state;
	for (int n = 0; n < model->shape_count; n++)
		assert_close(found->shape[n], shape[n], 1e-3);
	for (int c = 0; c < 3; c++) {
		assert_close(found->diffuse[c], diffuse[c], 1e-3);
		assert_close(found->specular[c], specular[c], 1e-3);
	}
	free(found);
	lattice_free(&lattice);
}

static void check_recovery(const struct lobe_model *model, const float *shape, const float *diffuse, const float *specular)
{
	check_recovery_by(LOBE_COSINE, model, shape, diffuse, specular);
	check_recovery_by(LOBE_RELATIVE, model, shape, diffuse, specular);
}

static const float DIFFUSE[3] = {0.3F, 0.12F, 0.04F}, SPECULAR[3] = {0.2F, 0.25F, 0.3F};

static void ward_recovers_its_own_parameters(void **state)
{
	(void)state;
	check_recovery(&LOBE_WARD, (const float[3]){0.35F}, DIFFUSE, SPECULAR);
	check_recovery(&LOBE_WARD, (const float[3]){0.05F}, DIFFUSE, SPECULAR);
}

static void cook_torrance_recovers_its_own_parameters(void **state)
{
	(void)state;
	check_recovery(&LOBE_COOK_TORRANCE, (const float[3]){0.3F, 0.05F}, DIFFUSE, SPECULAR);
	check_recovery(&LOBE_COOK_TORRANCE, (const float[3]){0.08F, 0.4F}, DIFFUSE, SPECULAR);
}

static void edwards_recovers_its_own_parameters(void **state)
{
	(void)state;
	check_recovery(&LOBE_EDWARDS, (const float[3]){6, 0.6F, 0.08F}, DIFFUSE, SPECULAR);
	check_recovery(&LOBE_EDWARDS, (const float[3]){40, 0.8F, 0.3F}, DIFFUSE, SPECULAR);
}

static void invalid_cells_take_no_part_in_a_fit(void **state)
{
	const float shape[3] = {0.35F};
	struct lattice lattice = make_table(&LOBE_WARD, shape, DIFFUSE, SPECULAR);
	struct fitted fitted;
	(void)state;

	for (size_t cell = 0; cell < lattice_cells(SMALL); cell += 3) {
		lattice.valid[cell] = 0;
		lattice.rgb[0][cell] = 1e6;
	}
	assert_int_equal(fit(&LOBE_WARD, &lattice, LOBE_COSINE, &fitted, NULL), BP_OK);
	struct lobe_state *found = fitted.state;
	assert_close(found->shape[0], shape[0], 1e-3);
	assert_close(found->diffuse[0], DIFFUSE[0], 1e-3);
	free(found);
	lattice_free(&lattice);
}

static void a_table_without_a_valid_cell_is_refused(void **state)
{
	struct lattice lattice;
	struct fitted fitted;
	bp_error error;
	(void)state;

	assert_int_equal(lattice_alloc(SMALL, &lattice, NULL), BP_OK);
	assert_int_equal(fit(&LOBE_WARD, &lattice, LOBE_COSINE, &fitted, &error), BP_ERROR_BAD_INPUT);
	lattice_free(&lattice);
}

static void a_black_table_gives_a_black_model(void **state)
{
	struct lattice lattice;
	struct fitted fitted;
	(void)state;

	assert_int_equal(lattice_alloc(SMALL, &lattice, NULL), BP_OK);
	for (size_t cell = 0; cell < lattice_cells(SMALL); cell++) {
		lattice.rgb[0][cell] = lattice.rgb[1][cell] = lattice.rgb[2][cell] = 0;
		lattice.valid[cell] = 1;
	}
	assert_int_equal(fit(&LOBE_COOK_TORRANCE, &lattice, LOBE_COSINE, &fitted, NULL), BP_OK);
	struct lobe_state *found = fitted.state;
	for (int c = 0; c < 3; c++)
		assert_true(found->diffuse[c] == 0 && found->specular[c] == 0);
	free(found);
	lattice_free(&lattice);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(ward_gives_the_values_worked_out_by_hand),
		cmocka_unit_test(cook_torrance_gives_the_values_worked_out_by_hand),
		cmocka_unit_test(edwards_gives_the_values_worked_out_by_hand),
		cmocka_unit_test(the_cells_angles_agree_with_the_directions),
		cmocka_unit_test(cells_weigh_their_measure_times_the_squared_cosine),
		cmocka_unit_test(two_albedos_never_go_negative),
		cmocka_unit_test(ward_recovers_its_own_parameters),
		cmocka_unit_test(cook_torrance_recovers_its_own_parameters),
		cmocka_unit_test(edwards_recovers_its_own_parameters),
		cmocka_unit_test(invalid_cells_take_no_part_in_a_fit),
		cmocka_unit_test(a_table_without_a_valid_cell_is_refused),
		cmocka_unit_test(a_black_table_gives_a_black_model),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
