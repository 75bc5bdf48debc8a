/* test_default_grid.c: axes, step, centres and the end of the lowest plane come back from coefficients that lie on a grid. */
#include "archive_fixture.h"

#include <math.h>

#include "model/default_grid.h"

static const struct lattice_dims DIMS = {40, 36, 50};

static uint32_t state;
static double draw(void)
{
	state = state * 1664525 + 1013904223;
	return (state >> 8) * 0x1p-24;
}

struct fixture {
	float *x[3];
	uint8_t *exact;
	struct default_grid truth;
	struct grid_evidence evidence;
};

/* Most levels are 0, many 1, few large; half as many in each next field. Those of units from `end` on have lost their lowest plane. */
static double level_draw(uint32_t field, bool low)
{
	const double level = draw() < 0.06 / (1 << field) ? floor(0.8 / (draw() + 0.0005) + 0.3) : 0;
	return low ? 2 * floor(level / 2) : level;
}

/* turned: axes 1 and 2 about axis 0, in radians. */
static void fixture_make(uint32_t seed, double turned, uint32_t end, struct fixture *out)
{
	const double a[3] = {0.6, 0.64, 0.48}, u[3] = {0.8, -0.48, -0.36}, v[3] = {0, 0.6, -0.8};
	const size_t cells = lattice_cells(DIMS), rows = (size_t)DIMS.theta_h * DIMS.theta_d;
	const uint32_t p = DIMS.phi_d;

	state = seed;
	out->truth = (struct default_grid){.step = 0.0123f, .centre = {0.031f, 0.056f, DEFAULT_CENTRE_BELOW}, .end = end, .offset = {0.004f, -0.003f, 0.002f}};
	for (int c = 0; c < 3; c++) {
		out->truth.axis[0][c] = (float)a[c];
		out->truth.axis[1][c] = (float)(cos(turned) * u[c] + sin(turned) * v[c]);
		out->truth.axis[2][c] = (float)(cos(turned) * v[c] - sin(turned) * u[c]);
		out->x[c] = calloc(cells, sizeof(float));
	}
	out->exact = malloc(rows);
	for (size_t at = 0; at < cells; at++) {
		const size_t r = at / p;
		const uint32_t m = spectrum_harmonic(p, (uint32_t)(at % p));
		const bool coarsest = m == 0 && r / DIMS.theta_d < 10 && r % DIMS.theta_d < 9;
		out->exact[r] = r % 5 != 1;
		for (uint32_t f = 0; f < 3; f++) {
			const bool low = f * p + m >= end;
			const double level = level_draw(f, low) + (coarsest ? 40 + 2 * floor(50 * draw()) : 0);
			float place;
			default_grid_level(&out->truth, low ? (float)(level + 0.8) * (level > 0) : (float)level * 1.04f, low, &place);
			const double value = (double)(place * out->truth.step) * (draw() < 0.5 && !coarsest ? -1 : 1) + (coarsest ? (double)out->truth.offset[f] : 0);
			for (int c = 0; c < 3; c++)
				out->x[c][at] += (float)((double)out->truth.axis[f][c] * value + 2e-7 * (draw() - 0.5));
		}
		/* What does not count may be anything. */
		for (int c = 0; c < 3 && !out->exact[r]; c++)
			out->x[c][at] = (float)(0.1 * (draw() - 0.5));
	}
	out->evidence = (struct grid_evidence){DIMS, out->x, out->exact};
}

static void fixture_free(struct fixture *f)
{
	free(f->exact);
	for (int c = 0; c < 3; c++)
		free(f->x[c]);
}

/* The same axis, whichever way it points. */
static double axis_difference(const float a[3], const float b[3])
{
	double same = 0, other = 0;
	for (int c = 0; c < 3; c++) {
		same = fmax(same, fabs((double)(a[c] - b[c])));
		other = fmax(other, fabs((double)(a[c] + b[c])));
	}
	return fmin(same, other);
}

static void the_grid_comes_back(void **unused)
{
	static const uint32_t ends[] = {150, 130, 112, 99, 77, 58};
	(void)unused;
	for (size_t n = 0; n < sizeof ends / sizeof *ends; n++) {
		struct fixture f;
		struct default_grid found;
		bool is = false;
		fixture_make(3 + (uint32_t)n, 0.3 * (double)n, ends[n], &f);
		/* A guess that is off by some degrees, axes 1 and 2 by any angle and in any order. */
		const float guess[3][3] = {{0.62f, 0.61f, 0.5f}, {0.1f, 0.7f, -0.7f}, {0.7f, -0.5f, -0.4f}};
		assert_int_equal(default_grid_find(&f.evidence, 0.0127f, guess, &found, &is, NULL), BP_OK);
		assert_true(is);
		assert_true(fabs((double)(found.step / f.truth.step) - 1) < 1e-6);
		for (int i = 0; i < 2; i++)
			assert_true(fabs((double)(found.centre[i] - f.truth.centre[i])) < 1e-3);
		assert_int_equal(found.end, ends[n]);
		const bool swapped = axis_difference(found.axis[1], f.truth.axis[1]) > 0.5;
		/* Which of the two was the first shows only where one of them has lost units. */
		assert_true(!swapped || ends[n] == 150);
		for (int i = 0; i < 3; i++)
			assert_true(axis_difference(found.axis[i], f.truth.axis[swapped && i ? 3 - i : i]) < 1e-5);
		assert_true(default_grid_missed(&f.evidence, &found) < 1e-4);
		fixture_free(&f);
	}
}

static void another_grid_is_missed(void **unused)
{
	struct fixture f;
	struct default_grid other;
	(void)unused;
	fixture_make(11, 0.4, 112, &f);
	assert_true(default_grid_missed(&f.evidence, &f.truth) < 1e-4);
	other = f.truth;
	other.step *= 1.01f;
	assert_true(default_grid_missed(&f.evidence, &other) > 0.02);
	other = f.truth;
	other.end = 150;
	assert_true(default_grid_missed(&f.evidence, &other) > 0.02);
	fixture_free(&f);
}

static void an_error_of_the_unit_shows_in_what_it_does(void **unused)
{
	struct fixture f;
	float *slope[3];
	const size_t cells = lattice_cells(DIMS);
	const double wrong = 0.0007;
	(void)unused;
	fixture_make(12, 0.1, 150, &f);
	for (int c = 0; c < 3; c++) {
		slope[c] = malloc(cells * sizeof(float));
		for (size_t i = 0; i < cells; i++) {
			slope[c][i] = (float)(2 * (draw() - 0.5));
			f.x[c][i] += (float)wrong * slope[c][i];
		}
	}
	assert_true(fabs(default_grid_unit_error(&f.evidence, &f.truth, slope, 0.001) - wrong) < 1e-6);
	for (int c = 0; c < 3; c++)
		free(slope[c]);
	fixture_free(&f);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_grid_comes_back),
		cmocka_unit_test(another_grid_is_missed),
		cmocka_unit_test(an_error_of_the_unit_shows_in_what_it_does),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
