/* Sampling: the density integrates to 1, the samples follow it (chi-square), and their mean weight is the albedo. */
#include "sampling.h"

#include <pthread.h>

enum kind { MATTE, SATIN, GLOSSY, MIRROR, RETRO, SHEEN, ASYMMETRIC, KINDS };

/* f at the centre of a cell; the asymmetric one is not mirror-symmetric about the plane of wo. */
static double kind_value(enum kind kind, double theta_h, double theta_d, double phi_d, int c)
{
	double fresnel = pow(1 - cos(theta_d), 5);
	switch (kind) {
	case MATTE: return 0.2 + 0.1 * c;
	case SATIN: return 0.1 + (0.5 + 2 * fresnel) * exp(-20 * theta_h * theta_h);
	case GLOSSY: return 0.05 * (c + 1) + (10 + 60 * fresnel) * exp(-900 * theta_h * theta_h);
	case MIRROR: return 1e-4 + 2e4 * exp(-2e4 * theta_h * theta_h) + 2 / (1 + 1e5 * theta_h * theta_h);
	case RETRO: return 0.05 + 40 * exp(-60 * theta_d * theta_d);
	case SHEEN: return 0.02 + 0.5 * pow(sin(theta_h), 4) + 0.1 * fresnel;
	default: return 0.1 + exp(-10 * theta_h * theta_h) * (1.5 + 1.4 * sin(2 * phi_d)) * (1 + c);
	}
}

static struct material make(enum kind kind, struct lattice_dims dims)
{
	struct expansion e;
	struct material m;
	assert_int_equal(expansion_alloc(dims, &e, NULL), BP_OK);
	e.unit = 1;
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++)
			for (uint32_t k = 0; k < dims.phi_d; k++)
				for (int c = 0; c < 3; c++) {
					double h = (i + 0.5) / dims.theta_h, d = (j + 0.5) / dims.theta_d, p = (k + 0.5) / dims.phi_d;
					e.rgb[c][lattice_index(dims, i, j, k)] = (float)kind_value(kind, h * h * M_PI_2, d * M_PI_2, p * M_PI, c);
				}
	assert_int_equal(table_build(&e, TABLE_EXPANDED, 3, &m.table, NULL), BP_OK);
	assert_int_equal(sampler_build(m.table, &m.sampler, NULL), BP_OK);
	expansion_free(&e);
	return m;
}

static void the_density_integrates_to_1_down_to_grazing(void **user)
{
	(void)user;
	for (int kind = 0; kind < KINDS; kind++) {
		struct material m = make((enum kind)kind, SMALL);
		for (int n = 0; n < ANGLES; n++) {
			double total = integrate_all(m.sampler, DEGREES[n]);
			if (fabs(total - 1) >= 1e-3)
				fail_msg("kind %d at %g degrees: %.6f", kind, DEGREES[n], total);
		}
		release(&m);
	}
}

/* The integral over wi itself, in steps that crowd at the horizon opposite wo: of the half-angle nothing is assumed. */
static double integrate_directly(const struct sampler *s, const float wo[3])
{
	enum { STEPS = 700 };
	const double opposite = atan2((double)wo[1], (double)wo[0]) + M_PI;
	double sum = 0;
	for (int a = 0; a < STEPS; a++)
		for (int b = 0; b < STEPS; b++) {
			const double v = (a + 0.5) / STEPS, w = 2 * (b + 0.5) / STEPS - 1, z = v * v * v, phi = opposite + M_PI * w * w * w,
						 r = sqrt(1 - z * z);
			const float wi[3] = {(float)(r * cos(phi)), (float)(r * sin(phi)), (float)z};
			sum += (double)sampler_pdf(s, wi, wo) * 3 * v * v / STEPS * 3 * w * w * M_PI * 2 / STEPS;
		}
	return sum;
}

/* Closer to the horizon than the rounding of wi and wo lets half-angles be told apart. */
static void at_the_horizon_the_density_still_integrates_to_1_and_samples_follow_it(void **user)
{
	(void)user;
	const enum kind kinds[] = {SATIN, GLOSSY, MIRROR};
	const double degrees[] = {89.97, 89.99, 89.999, 89.99999};
	for (int kind = 0; kind < 3; kind++) {
		struct material m = make(kinds[kind], SMALL);
		for (int n = 0; n < 4; n++) {
			double p = chi_square_probability(m.sampler, m.sampler, degrees[n]);
			if (p < 0.01 / 12) /* 1 %, Bonferroni */
				fail_msg("kind %d at %g degrees: p = %g", (int)kinds[kind], degrees[n], p);
			for (int turn = 0; turn < 4 && kinds[kind] != MIRROR; turn++) { /* whose highlight is narrower than the steps */
				const double theta = degrees[n] * M_PI / 180, phi = 0.9 * turn + 0.2;
				const float wo[3] = {(float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta)};
				double total = integrate_directly(m.sampler, wo);
				if (fabs(total - 1) >= 1e-3)
					fail_msg("kind %d at %g degrees: %.6f", (int)kinds[kind], degrees[n], total);
			}
		}
		release(&m);
	}
}

static void samples_follow_the_density_by_chi_square(void **user)
{
	(void)user;
	for (int kind = 0; kind < KINDS; kind++) {
		struct material m = make((enum kind)kind, SMALL);
		for (int n = 0; n < ANGLES; n++) {
			double p = chi_square_probability(m.sampler, m.sampler, DEGREES[n]);
			if (p < 0.01 / (KINDS * ANGLES)) /* 1 %, Bonferroni */
				fail_msg("kind %d at %g degrees: p = %g", kind, DEGREES[n], p);
		}
		release(&m);
	}
}

static void a_wrong_density_fails_the_chi_square_test(void **user)
{
	(void)user;
	struct material a = make(SATIN, SMALL), b = make(GLOSSY, SMALL);
	assert_true(chi_square_probability(a.sampler, a.sampler, 45) > 1e-4);
	assert_true(chi_square_probability(a.sampler, b.sampler, 45) < 1e-6);
	assert_true(chi_square_probability(b.sampler, a.sampler, 45) < 1e-6);
	release(&a);
	release(&b);
}

static void the_mean_weight_is_the_albedo_and_its_spread_is_small(void **user)
{
	(void)user;
	double spread = 0, spread_cosine = 0;
	for (int kind = 0; kind < KINDS; kind++) {
		struct material m = make((enum kind)kind, SMALL);
		for (int n = 0; n < ANGLES; n++) {
			float wo[3], rgb[3];
			double mean, deviation, unused, cosine;
			outgoing(DEGREES[n], wo);
			weights(&m, wo, 20000, 0, &mean, &deviation);
			weights(&m, wo, 4000, 1, &unused, &cosine);
			albedo_integrate(m.table, (float)(DEGREES[n] * M_PI / 180), rgb);
			double albedo = quadrature(&m, DEGREES[n]), given = ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3;
			if (fabs(given - albedo) > 0.005 * albedo)
				fail_msg("kind %d at %g degrees: albedo %g by quadrature, %g given", kind, DEGREES[n], albedo, given);
			/* half a percent, and three standard errors of the sampling itself */
			if (fabs(mean - albedo) > (0.005 + 3 * deviation / sqrt(20000)) * albedo)
				fail_msg("kind %d at %g degrees: albedo %g by quadrature, %g by sampling (spread %g)", kind, DEGREES[n], albedo,
				         mean, deviation);
			/* near grazing cosine samples miss the highlight, and with it its spread */
			if ((kind == GLOSSY || kind == MIRROR) && DEGREES[n] <= 70 && !(deviation < cosine))
				fail_msg("kind %d at %g degrees: spread %g, of cosine sampling %g", kind, DEGREES[n], deviation, cosine);
			spread += deviation;
			spread_cosine += cosine;
		}
		release(&m);
	}
	assert_true(spread < 0.5 * spread_cosine);
}

/* Angles between the kept ones, in an order of no meaning; the value does not depend on what was asked before. */
static void the_kept_albedo_is_the_integrated_one(void **user)
{
	(void)user;
	for (int kind = 0; kind < KINDS; kind++) {
		struct material m = make((enum kind)kind, SMALL);
		struct albedo_cache *cache = NULL, *other = NULL;
		assert_int_equal(albedo_cache_make(&cache, NULL), BP_OK);
		assert_int_equal(albedo_cache_make(&other, NULL), BP_OK);
		for (int n = 0; n < 30; n++) {
			float theta = (float)(M_PI_2 * (n % 2 ? fmod(n * 0.381966, 1) : 1 - pow(10, -4 * fmod(n * 0.381966, 1)))), want[3],
				  got[3], again[3];
			theta = theta < 1.5707f ? theta : 1.5707f;
			albedo_integrate(m.table, theta, want);
			albedo_cached(cache, m.table, theta, got);
			for (int c = 0; c < 3; c++)
				if (fabsf(got[c] - want[c]) > 1e-3f * want[c])
					fail_msg("kind %d at %g radians: albedo %g integrated, %g kept", kind, (double)theta, (double)want[c],
					         (double)got[c]);
			albedo_cached(cache, m.table, theta, again);
			assert_memory_equal(got, again, sizeof got);
			if (kind != GLOSSY)
				continue;
			albedo_cached(other, m.table, theta + 0.1f, again);
			albedo_cached(other, m.table, theta, again);
			assert_memory_equal(got, again, sizeof got);
		}
		const float bad[] = {-0.1f, 1.6f, NAN, INFINITY};
		for (int n = 0; n < 4; n++) {
			float rgb[3] = {7, 7, 7};
			albedo_cached(cache, m.table, bad[n], rgb);
			assert_true(rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0);
		}
		albedo_cache_free(cache);
		albedo_cache_free(other);
		release(&m);
	}
}

/* The albedo about wo itself: wi at the angle alpha from it, dense at 0. */
static double albedo_about(const struct table *table, double degrees)
{
	enum { STEPS = 600, TURNS = 180 };
	double theta = degrees * M_PI / 180, sum = 0;
	const float wo[3] = {(float)sin(theta), 0, (float)cos(theta)};
	for (int n = 0; n < STEPS; n++)
		for (int turn = 0; turn < TURNS; turn++) {
			const double v = (n + 0.5) / STEPS, alpha = M_PI * v * v, beta = 2 * M_PI * (turn + 0.5) / TURNS,
						 x = sin(alpha) * cos(beta);
			const float wi[3] = {(float)(cos(alpha) * sin(theta) + x * cos(theta)), (float)(sin(alpha) * sin(beta)),
			                     (float)(cos(alpha) * cos(theta) - x * sin(theta))};
			float rgb[3];
			table_evaluate(table, wi, wo, rgb);
			if (wi[2] > 0)
				sum += (double)rgb[1] * (double)wi[2] * sin(alpha) * 2 * M_PI * v / STEPS * 2 * M_PI / TURNS;
		}
	return sum;
}

static void a_narrow_retroreflectors_albedo_misses_nothing_of_its_peak(void **user)
{
	const struct lattice_dims dims = {30, 60, 36};
	struct table *table;
	struct expansion e;
	(void)user;
	assert_int_equal(expansion_alloc(dims, &e, NULL), BP_OK);
	e.unit = 1;
	for (uint32_t j = 0; j < dims.theta_d; j++)
		for (uint32_t n = 0; n < dims.theta_h * dims.phi_d; n++)
			for (int c = 0; c < 3; c++)
				e.rgb[c][lattice_index(dims, n / dims.phi_d, j, n % dims.phi_d)] = j == 0 ? 50 : 0.02f;
	assert_int_equal(table_build(&e, TABLE_EXPANDED, 3, &table, NULL), BP_OK);
	for (int degrees = 5; degrees < 85; degrees += 5) {
		float rgb[3];
		double want = albedo_about(table, degrees);
		albedo_integrate(table, (float)(degrees * M_PI / 180), rgb);
		if (fabs((double)rgb[1] - want) > 0.005 * want)
			fail_msg("at %d degrees: albedo %g about wo, %g given", degrees, want, (double)rgb[1]);
	}
	table_free(table);
	expansion_free(&e);
}

static void numbers_at_the_ends_and_beyond_give_usable_samples(void **user)
{
	(void)user;
	const float numbers[] = {0, 1e-30f, 0.06f, 0.5f, 0x1.fffffep-1f, 1, 2, -1, NAN, INFINITY};
	enum { COUNT = sizeof numbers / sizeof *numbers };
	for (int kind = 0; kind < KINDS; kind++) {
		struct material m = make((enum kind)kind, SMALL);
		for (int n = 0; n < COUNT * COUNT * COUNT; n++)
			for (int a = 0; a < ANGLES + 3; a++) {
				const float extra[3][3] = {{1, 0, 1e-7f}, {1, 0, 1e-20f}, {0.3f, 0.3f, 1e-30f}};
				float wo[3], wi[3];
				const float u[3] = {numbers[n % COUNT], numbers[n / COUNT % COUNT], numbers[n / COUNT / COUNT]};
				if (a < ANGLES)
					outgoing(DEGREES[a], wo);
				else
					memcpy(wo, extra[a - ANGLES], sizeof wo);
				float p = sampler_draw(m.sampler, wo, u, wi);
				assert_true(p > 0 && p < INFINITY);
				assert_true(wi[2] > 0 && wi[2] <= 1.000001f && fabsf(wi[0]) < 1.000001f && fabsf(wi[1]) < 1.000001f);
			}
		release(&m);
	}
}

static void unusable_directions_give_no_sample_and_no_density(void **user)
{
	(void)user;
	const float good[3] = {0.6f, 0, 0.8f}, u[3] = {0.5f, 0.5f, 0.5f};
	const float bad[][3] = {{0, 0, 0},   {0.6f, 0, -0.8f}, {1, 0, 0},        {NAN, 0, 1},
	                        {0, 0, NAN}, {INFINITY, 0, 1}, {0, 0, INFINITY}, {1e30f, 0, 1e30f}};
	struct material m = make(SATIN, SMALL);
	for (size_t n = 0; n < sizeof bad / sizeof *bad; n++) {
		float wi[3] = {7, 7, 7};
		assert_true(sampler_draw(m.sampler, bad[n], u, wi) == 0);
		assert_true(wi[0] == 0 && wi[1] == 0 && wi[2] == 0);
		assert_true(sampler_pdf(m.sampler, bad[n], good) == 0);
		assert_true(sampler_pdf(m.sampler, good, bad[n]) == 0);
	}
	const float angles[] = {-0.1f, 1.6f, NAN, INFINITY};
	for (int n = 0; n < 4; n++) {
		float rgb[3] = {7, 7, 7};
		albedo_integrate(m.table, angles[n], rgb);
		assert_true(rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0);
	}
	/* other lengths count as normalised */
	const float longer[3] = {3, 0, 4};
	assert_true(fabsf(sampler_pdf(m.sampler, longer, good) / sampler_pdf(m.sampler, good, good) - 1) < 1e-3f);
	release(&m);
}

static void a_black_material_still_gives_samples(void **user)
{
	(void)user;
	struct expansion e;
	struct material m;
	assert_int_equal(expansion_alloc((struct lattice_dims){4, 4, 4}, &e, NULL), BP_OK);
	e.unit = 1;
	assert_int_equal(table_build(&e, TABLE_COMPACT, 3, &m.table, NULL), BP_OK);
	assert_int_equal(sampler_build(m.table, &m.sampler, NULL), BP_OK);
	for (int n = 0; n < ANGLES; n++) {
		double total = integrate_all(m.sampler, DEGREES[n]);
		if (fabs(total - 1) >= 1e-3)
			fail_msg("black at %g degrees: %.6f", DEGREES[n], total);
	}
	expansion_free(&e);
	release(&m);
}

struct job {
	const struct material *material;
	struct albedo_cache *cache;
	double sum;
};

static void *work(void *user)
{
	struct job *job = user;
	uint64_t x = 5;
	for (int n = 0; n < 20000; n++) {
		float u[3], wo[3], wi[3], rgb[3];
		for (int c = 0; c < 3; c++) {
			x = x * 6364136223846793005u + 1442695040888963407u;
			u[c] = (float)(x >> 40) * 0x1p-24f;
		}
		outgoing(89.0 * n / 20000, wo);
		job->sum += (double)sampler_draw(job->material->sampler, wo, u, wi);
		table_evaluate(job->material->table, wi, wo, rgb);
		job->sum += (double)rgb[1];
	}
	for (int n = 0; n < 10; n++) { /* all ask for the same angles first */
		float rgb[3];
		albedo_cached(job->cache, job->material->table, 0.15f * (float)n, rgb);
		job->sum += (double)rgb[1];
	}
	return NULL;
}

static void many_threads_use_one_material_and_get_the_same(void **user)
{
	(void)user;
	enum { THREADS = 6 };
	struct material m = make(GLOSSY, SMALL);
	struct albedo_cache *cache = NULL;
	struct job jobs[THREADS];
	assert_int_equal(albedo_cache_make(&cache, NULL), BP_OK);
	pthread_t threads[THREADS];
	for (int n = 0; n < THREADS; n++) {
		jobs[n] = (struct job){&m, cache, 0};
		assert_int_equal(pthread_create(&threads[n], NULL, work, &jobs[n]), 0);
	}
	for (int n = 0; n < THREADS; n++)
		pthread_join(threads[n], NULL);
	for (int n = 1; n < THREADS; n++)
		assert_true(jobs[n].sum == jobs[0].sum);
	albedo_cache_free(cache);
	release(&m);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_density_integrates_to_1_down_to_grazing),
		cmocka_unit_test(at_the_horizon_the_density_still_integrates_to_1_and_samples_follow_it),
		cmocka_unit_test(samples_follow_the_density_by_chi_square),
		cmocka_unit_test(a_wrong_density_fails_the_chi_square_test),
		cmocka_unit_test(the_mean_weight_is_the_albedo_and_its_spread_is_small),
		cmocka_unit_test(the_kept_albedo_is_the_integrated_one),
		cmocka_unit_test(a_narrow_retroreflectors_albedo_misses_nothing_of_its_peak),
		cmocka_unit_test(numbers_at_the_ends_and_beyond_give_usable_samples),
		cmocka_unit_test(unusable_directions_give_no_sample_and_no_density),
		cmocka_unit_test(a_black_material_still_gives_samples),
		cmocka_unit_test(many_threads_use_one_material_and_get_the_same),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
