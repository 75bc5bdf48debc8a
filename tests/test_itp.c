/* test_itp.c: dE ITP against what was worked out by hand, and against others' figures. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "render/itp.h"

static double of_colours(const double a[3], const double b[3])
{
	double x[3], y[3];
	itp_of(a, x);
	itp_of(b, y);
	return itp_difference(x, y);
}

/* itp.h has the first of them worked out. */
static void greys_differ_in_intensity_alone_as_worked_out_by_hand(void **state)
{
	(void)state;
	const double white[3] = {1, 1, 1}, half[3] = {0.5, 0.5, 0.5};
	double itp[3];
	assert_true(fabs(of_colours(white, half) - 48.81) < 0.005);
	itp_of(half, itp);
	assert_true(fabs(itp[0] - 0.44028) < 5e-6 && fabs(itp[1]) < 1e-15 && fabs(itp[2]) < 1e-15);
	assert_true(of_colours(half, half) == 0);
}

/*
 * The example of the Python package colour-science's documentation: R, G, B of BT.2020 at 0.45620519, 0.03081071,
 * 0.04091952 cd/m^2 have I, C_T, C_P = 0.07351364, 0.00475253, 0.09351596; here by way of BT.709, out of its gamut.
 */
static void a_colour_has_the_coordinates_that_others_find(void **state)
{
	(void)state;
	const double rgb[3] = {0.00736447084187585, -0.000222619295287055, 0.000343912880949639};
	double itp[3];
	itp_of(rgb, itp);
	assert_true(fabs(itp[0] - 0.07351364) < 1e-8);
	assert_true(fabs(itp[1] - 0.00475253 / 2) < 1e-8);
	assert_true(fabs(itp[2] - 0.09351596) < 1e-8);
}

/* That documentation's example of dE ITP: T is half of C_T. */
static void a_difference_is_what_others_find(void **state)
{
	(void)state;
	const double a[3] = {0.4885468072, -0.04739350675 / 2, 0.07475401302},
				 b[3] = {0.4899203231, -0.04567508203 / 2, 0.07361341775};
	assert_true(fabs(itp_difference(a, b) - 1.42657228) < 1e-8);
}

static struct sphere_image image_of(uint32_t size, float value)
{
	struct sphere_image image;
	assert_int_equal(sphere_image_alloc(size, &image, NULL), BP_OK);
	for (size_t n = 0; n < 3 * (size_t)size * size; n++)
		image.rgb[n] = value;
	return image;
}

/* The reference is exposed to 0.9, the estimate of a third of it to 0.3; one pixel is not finite. */
static void the_mean_of_an_image_is_that_of_its_covered_pixels(void **state)
{
	(void)state;
	struct sphere_image reference = image_of(8, 30), estimate = image_of(8, 10);
	const double a[3] = {0.9, 0.9, 0.9}, b[3] = {0.3, 0.3, 0.3}, odd[3] = {0.1, 0.3, 0.3};
	const double pixels = (double)reference.covered_count;
	double mean;
	assert_false(reference.covered[0]);
	reference.rgb[0] = 1e9f; /* not covered */
	assert_int_equal(itp_mean(&reference, &estimate, &mean, NULL), BP_OK);
	assert_true(fabs(mean - of_colours(a, b)) < 1e-5);
	estimate.rgb[3 * (8 * 4 + 4)] = NAN;
	assert_int_equal(itp_mean(&reference, &estimate, &mean, NULL), BP_OK);
	assert_true(fabs(mean - ((pixels - 1) * of_colours(a, b) + of_colours(a, odd)) / pixels) < 1e-5);
	assert_int_equal(itp_mean(&reference, &reference, &mean, NULL), BP_OK);
	assert_true(mean == 0);
	sphere_image_free(&reference);
	sphere_image_free(&estimate);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(greys_differ_in_intensity_alone_as_worked_out_by_hand),
		cmocka_unit_test(a_colour_has_the_coordinates_that_others_find),
		cmocka_unit_test(a_difference_is_what_others_find),
		cmocka_unit_test(the_mean_of_an_image_is_that_of_its_covered_pixels),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
