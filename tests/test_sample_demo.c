/* Sampling of every demo material: from normal incidence to grazing, against the oracles of sampling.h. */
#include "sampling.h"

#include "merl/demo.h"

static const double TESTED[] = {0, 60, 89};
enum { TESTED_COUNT = sizeof TESTED / sizeof *TESTED, DRAWN = 20000 };

/* A demo material as a table; cells that nothing was measured in are 0, which sampling has to bear. */
static struct material make_demo(size_t index)
{
	struct lattice lattice;
	struct expansion e;
	struct material m;
	assert_int_equal(demo_generate(index, SMALL, true, &lattice, NULL), BP_OK);
	assert_int_equal(expansion_alloc(SMALL, &e, NULL), BP_OK);
	e.unit = 1;
	for (size_t n = 0; n < lattice_cells(SMALL); n++)
		for (int c = 0; c < 3; c++)
			e.rgb[c][n] = lattice.valid[n] ? (float)lattice.rgb[c][n] : 0;
	assert_int_equal(table_build(&e, TABLE_COMPACT, 3, &m.table, NULL), BP_OK);
	assert_int_equal(sampler_build(m.table, &m.sampler, NULL), BP_OK);
	expansion_free(&e);
	lattice_free(&lattice);
	return m;
}

static void every_demo_material_is_drawn_as_its_density_says(void **user)
{
	(void)user;
	double spread = 0, spread_cosine = 0;
	for (size_t index = 0; index < demo_count(); index++) {
		struct material m = make_demo(index);
		for (int n = 0; n < TESTED_COUNT; n++) {
			float wo[3];
			double mean, deviation, unused, cosine, total = integrate_all(m.sampler, TESTED[n]),
													albedo = quadrature(&m, TESTED[n]);
			if (fabs(total - 1) >= 1e-3)
				fail_msg("%s at %g degrees: the density integrates to %.6f", demo_name(index), TESTED[n], total);
			double p = chi_square_probability(m.sampler, m.sampler, TESTED[n]);
			if (p < 0.01 / (double)(demo_count() * TESTED_COUNT)) /* 1 %, Bonferroni */
				fail_msg("%s at %g degrees: p = %g", demo_name(index), TESTED[n], p);
			outgoing(TESTED[n], wo);
			weights(&m, wo, DRAWN, 0, &mean, &deviation);
			weights(&m, wo, DRAWN / 8, 1, &unused, &cosine);
			/* half a percent, and four standard errors of the sampling itself; what sends back a millionth is black */
			if (fabs(mean - albedo) > (0.005 + 4 * deviation / sqrt(DRAWN)) * albedo + 1e-6)
				fail_msg("%s at %g degrees: albedo %g by quadrature, %g by sampling", demo_name(index), TESTED[n], albedo, mean);
			spread += deviation;
			spread_cosine += cosine;
		}
		release(&m);
	}
	assert_true(spread < 0.5 * spread_cosine);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_demo_material_is_drawn_as_its_density_says),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
