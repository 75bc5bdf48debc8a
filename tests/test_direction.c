/* A pair of directions falls where Rusinkiewicz's definition says, in long double with rotations and arccosines. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "model/table/direction.h"
#include "trilinear.h"
#define RANDOM_SEED 7
#include "random.h"

static const struct lattice_dims DIMS = {90, 90, 180};
#define PI 3.14159265358979323846264338327950288L

static void direction(double theta, double phi, float out[3])
{
	out[0] = (float)(sin(theta) * cos(phi));
	out[1] = (float)(sin(theta) * sin(phi));
	out[2] = (float)cos(theta);
}

/* theta_h, theta_d, phi_d in [0, pi), of the very floats, normalised in long double. */
static void oracle(const float fi[3], const float fo[3], long double angles[3])
{
	long double i[3], o[3], h[3], ni = 0, no = 0, nh = 0;
	for (int c = 0; c < 3; c++) {
		ni += (long double)fi[c] * (long double)fi[c];
		no += (long double)fo[c] * (long double)fo[c];
	}
	for (int c = 0; c < 3; c++) {
		i[c] = (long double)fi[c] / sqrtl(ni);
		o[c] = (long double)fo[c] / sqrtl(no);
		h[c] = i[c] + o[c];
		nh += h[c] * h[c];
	}
	for (int c = 0; c < 3; c++)
		h[c] /= sqrtl(nh);
	angles[0] = acosl(fminl(1, h[2]));
	if (h[2] > 0.9L)
		angles[0] = asinl(hypotl(h[0], h[1]));
	long double phi_h = atan2l(h[1], h[0]);
	long double x = cosl(phi_h) * i[0] + sinl(phi_h) * i[1], y = -sinl(phi_h) * i[0] + cosl(phi_h) * i[1];
	long double dx = cosl(angles[0]) * x - sinl(angles[0]) * i[2], dz = sinl(angles[0]) * x + cosl(angles[0]) * i[2];
	angles[1] = atan2l(hypotl(dx, y), dz);
	angles[2] = atan2l(y, dx);
	if (angles[2] < 0)
		angles[2] += PI;
}

/*
 * Distances in radians; the one of phi_d as a length on the sphere around h, where a rounding of the input counts alike everywhere.
 * Lengths differ from 1 by roundings, and wi + wo is as short as cos theta_d: near grazing the roundings count as much more.
 */
static void check(const float wi[3], const float wo[3], long double tolerance)
{
	struct lattice_point at;
	long double want[3];
	oracle(wi, wo, want);
	assert_true(direction_to_lattice(DIMS, wi, wo, &at));
	assert_true(at.h >= 0 && at.h <= 90 && at.d >= 0 && at.d <= 90 && at.p >= 0 && at.p <= 180);
	tolerance /= cosl(want[1]);
	long double theta_h = (long double)at.h * (long double)at.h / 8100 * (PI / 2), theta_d = (long double)at.d / 90 * (PI / 2);
	long double turn = fabsl((long double)at.p / 180 * PI - want[2]);
	if (turn > PI / 2)
		turn = PI - turn;
	assert_true(fabsl(theta_h - want[0]) < tolerance);
	assert_true(fabsl(theta_d - want[1]) < tolerance);
	assert_true(turn * sinl(want[0]) * sinl(want[1]) < 2 * tolerance);
}

static void random_directions_agree_with_the_definition(void **user)
{
	(void)user;
	for (int n = 0; n < 100000; n++) {
		float wi[3], wo[3];
		direction(acos(1 - uniform()), 2 * M_PI * uniform(), wi);
		direction(acos(1 - uniform()), 2 * M_PI * uniform(), wo);
		check(wi, wo, 1e-6L);
	}
}

static void directions_near_the_mirror_and_near_grazing_agree_with_the_definition(void **user)
{
	(void)user;
	for (int n = 0; n < 100000; n++) {
		float wi[3], wo[3];
		double theta = n % 2 ? M_PI_2 * uniform() : M_PI_2 - pow(10, -1 - 4 * uniform()), phi = 2 * M_PI * uniform();
		direction(theta, phi, wi);
		direction(theta + 1e-3 * (uniform() - 0.5), phi + M_PI + 1e-3 * (uniform() - 0.5), wo);
		if (wo[2] > 0)
			check(wi, wo, 1e-6L);
	}
}

static void lengths_do_not_matter(void **user)
{
	(void)user;
	for (int n = 0; n < 10000; n++) {
		float wi[3], wo[3], si[3], so[3];
		direction(acos(1 - uniform()), 2 * M_PI * uniform(), wi);
		direction(acos(1 - uniform()), 2 * M_PI * uniform(), wo);
		float a = (float)pow(10, 30 * uniform() - 15), b = (float)pow(10, 30 * uniform() - 15);
		for (int c = 0; c < 3; c++) {
			si[c] = a * wi[c];
			so[c] = b * wo[c];
		}
		check(si, so, 1e-6L);
	}
}

static void exchanging_the_directions_gives_the_same_point(void **user)
{
	(void)user;
	for (int n = 0; n < 10000; n++) {
		float wi[3], wo[3];
		struct lattice_point a, b;
		direction(acos(1 - uniform()), 2 * M_PI * uniform(), wi);
		direction(acos(1 - uniform()), 2 * M_PI * uniform(), wo);
		assert_true(direction_to_lattice(DIMS, wi, wo, &a));
		assert_true(direction_to_lattice(DIMS, wo, wi, &b));
		assert_true(a.h == b.h && a.d == b.d && a.p == b.p);
	}
}

static void where_phi_is_undefined_the_documented_values_come_out(void **user)
{
	(void)user;
	struct lattice_point at;
	const float up[3] = {0, 0, 1}, a[3] = {0.6f, 0, 0.8f}, b[3] = {-0.6f, 0, 0.8f}, c[3] = {0, 0.6f, 0.8f},
				d[3] = {0, -0.6f, 0.8f};
	assert_true(direction_to_lattice(DIMS, up, up, &at));
	assert_true(at.h == 0 && at.d == 0 && fmodf(at.p, 180) == 0);
	assert_true(direction_to_lattice(DIMS, a, a, &at)); /* wi = wo */
	assert_true(at.d == 0 && fmodf(at.p, 180) == 0);
	assert_true(direction_to_lattice(DIMS, a, b, &at)); /* the mirror: phi_h is taken as 0, so phi_d = atan2(dy, dx) */
	assert_true(at.h == 0 && fmodf(at.p, 180) == 0);
	assert_true(direction_to_lattice(DIMS, c, d, &at));
	assert_true(at.h == 0 && fabsf(at.p - 90) < 1e-4f);
}

static void unusable_directions_are_refused(void **user)
{
	(void)user;
	struct lattice_point at;
	const float good[3] = {0.6f, 0, 0.8f};
	const float bad[][3] = {{0, 0, 0},        {0.6f, 0, -0.8f},  {1, 0, 0},           {1, 0, -0.0f},
	                        {NAN, 0, 1},      {0, NAN, 1},       {0, 0, NAN},         {INFINITY, 0, 1},
	                        {0, 0, INFINITY}, {0, -INFINITY, 1}, {1e-30f, 0, 1e-30f}, {1e30f, 0, 1e30f}};
	for (size_t n = 0; n < sizeof bad / sizeof *bad; n++) {
		assert_false(direction_to_lattice(DIMS, bad[n], good, &at));
		assert_false(direction_to_lattice(DIMS, good, bad[n], &at));
	}
	assert_true(direction_to_lattice(DIMS, good, good, &at));
}

static void four_arctangents_at_once_are_the_same_to_the_bit(void **user)
{
	(void)user;
	for (int n = 0; n < 10000; n++) {
		f32x4 y, x;
		for (int lane = 0; lane < 4; lane++) {
			y[lane] = (float)(uniform() * pow(10, 20 * uniform() - 15));
			x[lane] = n % 7 ? (float)uniform() : 0;
		}
		f32x4 turns = quarter_turns_of_squares_x4(y * y, x * x, (f32x4){90, 1, 90, 8100});
		for (int lane = 0; lane < 4; lane++) {
			const float scale = lane == 1 ? 1 : lane == 3 ? 8100 : 90;
			assert_true(turns[lane] == quarter_turns_of_squares(y[lane] * y[lane], x[lane] * x[lane], scale));
			double want = atan2((double)y[lane], (double)x[lane]) / M_PI_2;
			assert_true(fabs((double)turns[lane] - want * (double)scale) <= 5e-7 * want * (double)scale);
		}
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(random_directions_agree_with_the_definition),
		cmocka_unit_test(directions_near_the_mirror_and_near_grazing_agree_with_the_definition),
		cmocka_unit_test(lengths_do_not_matter),
		cmocka_unit_test(exchanging_the_directions_gives_the_same_point),
		cmocka_unit_test(where_phi_is_undefined_the_documented_values_come_out),
		cmocka_unit_test(unusable_directions_are_refused),
		cmocka_unit_test(four_arctangents_at_once_are_the_same_to_the_bit),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
