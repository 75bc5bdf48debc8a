#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <math.h>

#include <cmocka.h>

#include "tool/export/normals.h"
#include "tool/export/visible.h"
#include "words.h"

enum { NODES = 181 };

/* GGX (Walter and others 2007; Smith's masking): D, and sigma = cos (1 + Lambda), both known in closed form. */
static double ggx_density(double alpha, double theta)
{
	const double c = cos(theta), d = c * c * (alpha * alpha - 1) + 1;
	return alpha * alpha / (M_PI * d * d);
}

static double ggx_area(double alpha, double theta)
{
	const double c = cos(theta), s = sin(theta);
	return (c + sqrt(c * c + alpha * alpha * s * s)) / 2;
}

/* f(w, w) of a conductor of these normals, but for a constant. */
static void ggx_profile(double alpha, double *profile)
{
	for (int n = 0; n < NODES; n++) {
		const double theta = normals_theta(n / (NODES - 1.0));
		profile[n] = 17 * ggx_density(alpha, theta) / (ggx_area(alpha, theta) * fmax(cos(theta), 0.01));
	}
}

static void normals_of_a_known_material_come_back(void **state)
{
	(void)state;
	const double alphas[] = {0.02, 0.1, 0.35, 0.8};
	for (size_t a = 0; a < sizeof alphas / sizeof *alphas; a++) {
		double profile[NODES];
		struct normals normals;
		ggx_profile(alphas[a], profile);
		assert_int_equal(normals_make(NODES, profile, &normals, NULL), BP_OK);
		for (int n = 0; n < NODES - 3; n++) {
			const double theta = normals_theta(n / (NODES - 1.0)), density = ggx_density(alphas[a], theta);
			assert_true(fabs(normals.area[n] - ggx_area(alphas[a], theta)) < 0.005);
			if (density > 1e-3)
				assert_true(fabs(normals.density[n] / density - 1) < 0.02);
		}
		normals_free(&normals);
	}
}

/* sigma against a sum over the sphere that knows nothing of nodes in u. */
static double area_by_quadrature(const struct normals *normals, const double *density, double theta_w)
{
	enum { STEPS = 2000, TURNS = 360 };
	double sum = 0;
	for (int i = 0; i < STEPS; i++)
		for (int k = 0; k < TURNS; k++) {
			const double theta = (i + 0.5) / STEPS * M_PI_2, phi = (k + 0.5) / TURNS * 2 * M_PI;
			const double facing = sin(theta_w) * sin(theta) * cos(phi) + cos(theta_w) * cos(theta);
			sum += fmax(facing, 0) * normals_at(normals, density, normals_u(theta)) * sin(theta);
		}
	return sum * M_PI_2 / STEPS * 2 * M_PI / TURNS;
}

static void areas_are_those_of_the_densities(void **state)
{
	(void)state;
	double profile[NODES];
	struct normals normals;
	ggx_profile(0.15, profile);
	assert_int_equal(normals_make(NODES, profile, &normals, NULL), BP_OK);
	for (int n = 0; n < NODES; n += 30) {
		const double theta = normals_theta(n / (NODES - 1.0));
		assert_true(fabs(area_by_quadrature(&normals, normals.density, theta) - normals.area[n]) < 2e-3);
		assert_true(fabs(area_by_quadrature(&normals, normals.soft, theta) - normals.soft_area[n]) < 2e-3);
	}
	assert_true(fabs(normals.area[0] - 1) < 1e-12 && fabs(normals.soft_area[0] - 1) < 1e-12);
	normals_free(&normals);
}

static void a_material_without_light_has_uniform_normals(void **state)
{
	(void)state;
	const double profile[NODES] = {0};
	struct normals normals;
	assert_int_equal(normals_make(NODES, profile, &normals, NULL), BP_OK);
	for (int n = 0; n < NODES; n++) {
		assert_true(fabs(normals.density[n] - 1 / M_PI) < 1e-4);
		assert_true(fabs(normals.area[n] - (1 + cos(normals_theta(n / (NODES - 1.0)))) / 2) < 1e-3);
	}
	normals_free(&normals);
}

static void visible_of(double alpha, uint32_t angles, const float *theta_i, uint32_t width, uint32_t height, struct warp *out)
{
	double profile[NODES];
	struct normals normals;
	ggx_profile(alpha, profile);
	assert_int_equal(normals_make(NODES, profile, &normals, NULL), BP_OK);
	assert_int_equal(visible_make(&normals, (struct visible_mix){0.5, 0.2}, angles, theta_i, width, height, out, NULL), BP_OK);
	normals_free(&normals);
}

static const float ANGLES[] = {0, 0.5f, 1.1f, 1.5707963f};

static void every_angle_has_the_mass_one(void **state)
{
	(void)state;
	enum { WIDTH = 23, HEIGHT = 17 };
	struct warp visible;
	visible_of(0.2, 4, ANGLES, WIDTH, HEIGHT, &visible);
	for (size_t angle = 0; angle < 4; angle++) {
		double mass = 0;
		for (size_t y = 0; y + 1 < HEIGHT; y++)
			for (size_t x = 0; x + 1 < WIDTH; x++) {
				const float *corner = visible.density + (angle * HEIGHT + y) * WIDTH + x;
				mass += ((double)corner[0] + corner[1] + corner[WIDTH] + corner[WIDTH + 1]) / 4 / ((WIDTH - 1) * (HEIGHT - 1));
			}
		assert_true(fabs(mass - 1) < 1e-6);
		assert_true(fabs(visible.along_column[angle * HEIGHT + HEIGHT - 1] - 1) < 1e-12);
	}
	warp_free(&visible);
}

static void warping_back_leads_home(void **state)
{
	(void)state;
	struct warp visible;
	visible_of(0.05, 4, ANGLES, 40, 31, &visible);
	for (uint32_t angle = 0; angle < 4; angle++)
		for (int n = 0; n < 400; n++) {
			const double at[2] = {(n % 20 + 0.5) / 20, (n / 20 + 0.5) / 20};
			double u[2], back[2];
			warp_forward(&visible, angle, at, u);
			warp_inverse(&visible, (struct warp_place){angle, 0}, u, back);
			assert_true(fabs(back[0] - at[0]) < 1e-6 && fabs(back[1] - at[1]) < 1e-6);
		}
	warp_free(&visible);
}

static void an_angle_without_a_density_is_refused(void **state)
{
	(void)state;
	const double profile[NODES] = {0};
	const float angles[] = {0, NAN};
	struct normals normals;
	struct warp visible;
	bp_error error;
	assert_int_equal(normals_make(NODES, profile, &normals, NULL), BP_OK);
	assert_int_equal(visible_make(&normals, (struct visible_mix){0.5, 0.2}, 2, angles, 8, 8, &visible, &error),
	                 BP_ERROR_BAD_INPUT);
	expect_words(error.message, "theta_i = nan");
	warp_free(&visible);
	normals_free(&normals);
}

/* Between two angles: t is the mass of the mixed density below v, by brute force. */
static void a_mixture_warps_by_its_own_mass(void **state)
{
	(void)state;
	enum { WIDTH = 12, HEIGHT = 9, FINE = 400 };
	struct warp visible;
	visible_of(0.4, 4, ANGLES, WIDTH, HEIGHT, &visible);
	const double weight = 0.3, at[2] = {0.47, 0.62};
	double below = 0, left = 0, line = 0;
	for (int b = 0; b < FINE; b++)
		for (int a = 0; a < FINE; a++) {
			const double u = (a + 0.5) / FINE, v = at[1] * (b + 0.5) / FINE;
			const double px = u * (WIDTH - 1), py = v * (HEIGHT - 1), top = at[1] * (HEIGHT - 1);
			const size_t x = (size_t)px, y = (size_t)py, row = (size_t)top;
			double value[2];
			for (int line_of = 0; line_of < 2; line_of++) {
				const size_t from = line_of ? row : y;
				const double fy = (line_of ? top : py) - (double)from, fx = px - (double)x;
				value[line_of] = 0;
				for (size_t k = 0; k < 2; k++) {
					const float *c = visible.density + ((1 + k) * HEIGHT + from) * WIDTH + x;
					value[line_of] += (k ? weight : 1 - weight) *
					                  ((1 - fy) * ((1 - fx) * c[0] + fx * c[1]) + fy * ((1 - fx) * c[WIDTH] + fx * c[WIDTH + 1]));
				}
			}
			below += value[0] * at[1] / (FINE * FINE);
			line += b == 0 ? value[1] : 0;
			left += b == 0 && u < at[0] ? value[1] : 0;
		}
	double got[2];
	warp_inverse(&visible, (struct warp_place){1, weight}, at, got);
	assert_true(fabs(got[1] - below) < 1e-3);
	assert_true(fabs(got[0] - left / line) < 5e-3);
	warp_free(&visible);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(normals_of_a_known_material_come_back),
		cmocka_unit_test(areas_are_those_of_the_densities),
		cmocka_unit_test(a_material_without_light_has_uniform_normals),
		cmocka_unit_test(every_angle_has_the_mass_one),
		cmocka_unit_test(warping_back_leads_home),
		cmocka_unit_test(an_angle_without_a_density_is_refused),
		cmocka_unit_test(a_mixture_warps_by_its_own_mass),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
