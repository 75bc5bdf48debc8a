/* test_metrics.c: error figures against values worked out by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "render/energy.h"
#include "render/metrics.h"

static const struct lattice_dims SMALL = {4, 4, 4};

static bool near(double a, double b, double tolerance) { return fabs(a - b) <= tolerance; }

/* Every pixel of a size x size image covered and equal to (value, value, value). */
static void image_make(uint32_t size, float value, struct sphere_image *image)
{
	bp_error error;
	assert_int_equal(sphere_image_alloc(size, image, &error), BP_OK);
	memset(image->covered, 1, size * size);
	image->covered_count = size * size;
	for (uint32_t n = 0; n < 3 * size * size; n++)
		image->rgb[n] = value;
}

/*
 * Reference 0.2 everywhere: exposure 4.5 makes it 0.9, sRGB 0.954687 (243 of 255). Estimate 0.1: 0.45, 0.701411 (179).
 * Float: -20 log10(0.253276) = 11.9281 dB; 8-bit: 20 log10(255/64) = 12.0072 dB.
 */
static void psnr_of_a_constant_image_is_as_worked_out_by_hand(void **state)
{
	(void)state;
	bp_error error;
	struct sphere_image reference, estimate;
	struct psnr psnr;
	image_make(4, 0.2f, &reference);
	image_make(4, 0.1f, &estimate);
	assert_int_equal(metrics_psnr(&reference, &estimate, &psnr, &error), BP_OK);
	assert_true(near(psnr.real, 11.9281, 1e-4) && near(psnr.eight_bit, 12.0072, 1e-4));

	/* half of the pixels right: the mean square halves, 3.0103 dB more */
	for (int n = 0; n < 24; n++)
		estimate.rgb[n] = 0.2f;
	assert_int_equal(metrics_psnr(&reference, &estimate, &psnr, &error), BP_OK);
	assert_true(near(psnr.real, 11.9281 + 3.0103, 1e-4) && near(psnr.eight_bit, 12.0072 + 3.0103, 1e-4));

	/* a quarter of the pixels not covered, two of them right: 6 of 12 still wrong, but uncovered ones never count */
	for (int n = 0; n < 4; n++)
		reference.covered[n] = 0;
	reference.covered_count = 12;
	assert_int_equal(metrics_psnr(&reference, &estimate, &psnr, &error), BP_OK);
	assert_true(near(psnr.real, 11.9281 + 10 * log10(12.0 / 8), 1e-4));
	sphere_image_free(&reference);
	sphere_image_free(&estimate);
}

static void psnr_of_equal_images_is_the_cap(void **state)
{
	(void)state;
	bp_error error;
	struct sphere_image image;
	struct psnr psnr;
	image_make(3, 0.7f, &image);
	assert_int_equal(metrics_psnr(&image, &image, &psnr, &error), BP_OK);
	assert_true(near(psnr.real, 120, 1e-9) && near(psnr.eight_bit, 108.1308, 1e-4));
	sphere_image_free(&image);
}

/* |a - b| with b = 1 - a: 2 * 0.954687 - 1 = 0.909374, 0.825 dB. */
static void a_pixel_that_is_not_finite_counts_as_far_off(void **state)
{
	(void)state;
	bp_error error;
	struct sphere_image reference, estimate;
	struct psnr psnr;
	image_make(2, 0.2f, &reference);
	image_make(2, NAN, &estimate);
	assert_int_equal(metrics_psnr(&reference, &estimate, &psnr, &error), BP_OK);
	assert_true(near(psnr.real, -20 * log10(0.909374), 1e-4));
	sphere_image_free(&reference);
	sphere_image_free(&estimate);
}

static void the_worst_cell_is_found_and_invalid_ones_are_passed_over(void **state)
{
	(void)state;
	bp_error error;
	struct lattice lattice;
	struct expansion expansion;
	struct worst_cell worst;
	assert_int_equal(lattice_alloc(SMALL, &lattice, &error), BP_OK);
	assert_int_equal(expansion_alloc(SMALL, &expansion, &error), BP_OK);
	expansion.unit = 2;
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < lattice_cells(SMALL); n++) {
			lattice.rgb[c][n] = 1;
			expansion.rgb[c][n] = 0.5f;
		}
	lattice.rgb[0][5] = -1;
	lattice_validate(&lattice);
	metrics_worst_cell(&lattice, &expansion, &worst);
	assert_true(worst.value == 0);
	expansion.rgb[0][5] = 1e6f;                          /* where nothing was measured */
	expansion.rgb[2][lattice_index(SMALL, 2, 1, 3)] = 2; /* 4 instead of 1: 3/1.01 */
	expansion.rgb[1][lattice_index(SMALL, 3, 3, 0)] = 1;
	metrics_worst_cell(&lattice, &expansion, &worst);
	assert_true(near(worst.value, 3 / 1.01, 1e-6) && worst.channel == 2);
	assert_int_equal(worst.i * 100 + worst.j * 10 + worst.k, 213);
	/* (2.5/4)^2 90, 1.5/4 90, 3.5/4 180 degrees */
	assert_true(worst.theta_h == 35.15625 && worst.theta_d == 33.75 && worst.phi_d == 157.5);
	expansion_free(&expansion);
	lattice_free(&lattice);
}

/* Fills a lattice with f(theta_h, theta_d, phi_d) at the centres, G half and B a quarter of R, and measures it. */
static void energy_of(struct lattice_dims dims, double (*f)(double, double, double), bool some_invalid, struct energy *energy)
{
	bp_error error;
	struct lattice lattice;
	struct lookup_table table;
	struct energy_plan *plan;
	assert_int_equal(lattice_alloc(dims, &lattice, &error), BP_OK);
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++)
			for (uint32_t k = 0; k < dims.phi_d; k++) {
				size_t n = lattice_index(dims, i, j, k);
				double root = (i + 0.5) / dims.theta_h;
				double value = f(root * root * M_PI_2, (j + 0.5) * M_PI_2 / dims.theta_d, (k + 0.5) * M_PI / dims.phi_d);
				for (int c = 0; c < 3; c++)
					lattice.rgb[c][n] = value / (1 << c);
				if (some_invalid && j % 2)
					lattice.rgb[0][n] = -1;
			}
	lattice_validate(&lattice);
	assert_int_equal(lookup_table_measured(&lattice, &table, &error), BP_OK);
	assert_int_equal(energy_plan_make(dims, &plan, &error), BP_OK);
	energy_measure(plan, &table, energy);
	free(plan);
	lookup_table_free(&table);
	lattice_free(&lattice);
}

static double white(double theta_h, double theta_d, double phi_d)
{
	(void)theta_h, (void)theta_d, (void)phi_d;
	return 1 / M_PI;
}

static void a_white_matte_surface_returns_all_light_in_every_direction(void **state)
{
	(void)state;
	struct energy energy;
	energy_of(SMALL, white, false, &energy);
	for (int n = 0; n < ENERGY_DIRECTIONS; n++)
		for (int c = 0; c < 3; c++)
			assert_true(near(energy.albedo[n][c], 1.0 / (1 << c), 5e-4));
	assert_int_equal(energy.channel, 0);
}

static double half_cosine_squared(double theta_h, double theta_d, double phi_d)
{
	(void)theta_d, (void)phi_d;
	return cos(theta_h) * cos(theta_h);
}

/*
 * At normal incidence theta_h = theta_i/2, cos^2 theta_h = (1 + mu)/2 with mu = cos theta_i:
 * 2 pi integral of (1 + mu)/2 mu over 0..1 = 2 pi (1/4 + 1/6) = 5 pi/6.
 */
static void energy_of_a_half_angle_lobe_is_as_worked_out_by_hand(void **state)
{
	(void)state;
	struct energy energy;
	energy_of((struct lattice_dims){90, 16, 8}, half_cosine_squared, false, &energy);
	assert_true(near(energy.albedo[0][0], 5 * M_PI / 6, 2e-3));
}

static double difference_cosine(double theta_h, double theta_d, double phi_d)
{
	(void)theta_h, (void)phi_d;
	return cos(theta_d);
}

/* At normal incidence theta_d = theta_i/2: 2 pi integral of sqrt((1 + mu)/2) mu = 2 pi (4/15)(1 + 1/sqrt 2)... by parts. */
static void energy_looks_up_the_difference_angle(void **state)
{
	(void)state;
	struct energy energy;
	energy_of((struct lattice_dims){16, 90, 8}, difference_cosine, false, &energy);
	/* s = sqrt((1 + mu)/2), mu = 2 s^2 - 1, d mu = 4 s ds: integral of (2 s^2 - 1) 4 s^2 ds over sqrt(1/2)..1 */
	double a = sqrt(0.5), integral = 8.0 / 5 * (1 - pow(a, 5)) - 4.0 / 3 * (1 - pow(a, 3));
	assert_true(near(energy.albedo[0][0], 2 * M_PI * integral, 2e-3));
}

/* Every second cell along theta_d black: trilinear look-up halves a constant table. */
static void invalid_cells_add_no_energy(void **state)
{
	(void)state;
	struct energy energy;
	energy_of((struct lattice_dims){4, 90, 4}, white, true, &energy);
	assert_true(energy.albedo[0][0] > 0.45 && energy.albedo[0][0] < 0.55);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(psnr_of_a_constant_image_is_as_worked_out_by_hand),
		cmocka_unit_test(psnr_of_equal_images_is_the_cap),
		cmocka_unit_test(a_pixel_that_is_not_finite_counts_as_far_off),
		cmocka_unit_test(the_worst_cell_is_found_and_invalid_ones_are_passed_over),
		cmocka_unit_test(a_white_matte_surface_returns_all_light_in_every_direction),
		cmocka_unit_test(energy_of_a_half_angle_lobe_is_as_worked_out_by_hand),
		cmocka_unit_test(energy_looks_up_the_difference_angle),
		cmocka_unit_test(invalid_cells_add_no_energy),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
