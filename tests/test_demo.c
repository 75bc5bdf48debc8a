/*
 * The demo materials: kinds, horizon, reciprocity, energy, faults, and that the table is what it says.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "merl/demo.h"
#include "merl/merl_file.h"
#include "scratch.h"

static const struct lattice_dims SMALL = {24, 20, 36};

static size_t demo_find(const char *name)
{
	for (size_t n = 0; n < demo_count(); n++)
		if (!strcmp(demo_name(n), name))
			return n;
	fail_msg("no demo material %s", name);
	return 0;
}

static void every_kind_of_material_is_there_under_names_that_differ(void **state)
{
	(void)state;
	static const char *const kinds[] = {"matte",      "satin",          "plastic", "rough-metal",    "polished-metal",
	                                    "mirror",     "metallic-paint", "cloth",   "retroreflector", "clear-coat",
	                                    "iridescent", "near-black",     "white",   "speckled-mirror"};
	assert_true(demo_count() >= 14);
	FILE *table = fopen("manifests/demo.tsv", "r");
	size_t found[sizeof kinds / sizeof *kinds] = {0};
	char line[1024], kind[64];
	assert_non_null(table);
	while (fgets(line, sizeof line, table))
		for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
			found[k] += sscanf(line, "%*[^\t]\t%63[^\t]", kind) == 1 && !strcmp(kind, kinds[k]);
	fclose(table);
	for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
		assert_true(found[k] >= 1);
	for (size_t n = 0; n < demo_count(); n++)
		for (size_t m = 0; m < n; m++)
			assert_string_not_equal(demo_name(n), demo_name(m));
}

static void invalid_cells_of_a_clean_table_are_those_below_the_horizon(void **state)
{
	(void)state;
	struct lattice lattice;
	assert_int_equal(demo_generate(0, SMALL, true, &lattice, NULL), BP_OK);
	const size_t cells = lattice_cells(SMALL);
	uint8_t *below = malloc(cells);
	lattice_below_horizon(SMALL, LATTICE_MERL_HORIZON, below);
	for (size_t n = 0; n < cells; n++)
		assert_int_equal(lattice.valid[n], !below[n]);
	assert_true(lattice.valid_count < cells);
	lattice_free(&lattice);
	free(below);
}

static void clean_tables_are_positive_finite_and_reciprocal(void **state)
{
	(void)state;
	for (size_t m = 0; m < demo_count(); m++) {
		struct lattice lattice;
		assert_int_equal(demo_generate(m, SMALL, true, &lattice, NULL), BP_OK);
		for (uint32_t i = 0; i < SMALL.theta_h; i++)
			for (uint32_t j = 0; j < SMALL.theta_d; j++)
				for (uint32_t k = 0; k < SMALL.phi_d; k++) {
					/* isotropy mirrors phi_d -> -phi_d, and reciprocity adds pi: together pi - phi_d */
					const size_t n = lattice_index(SMALL, i, j, k), mirror = lattice_index(SMALL, i, j, SMALL.phi_d - 1 - k);
					if (!lattice.valid[n] || !lattice.valid[mirror])
						continue;
					for (int c = 0; c < 3; c++) {
						assert_true(isfinite(lattice.rgb[c][n]) && lattice.rgb[c][n] >= 0);
						assert_true(fabs(lattice.rgb[c][n] - lattice.rgb[c][mirror]) <= 1e-12 * lattice.rgb[c][n]);
					}
				}
		lattice_free(&lattice);
	}
}

/* Light that leaves in all directions for light from theta_o: h and d from vectors by libm, the table read in the cell. */
static double albedo(const struct lattice *lattice, int channel, double theta_o)
{
	const struct lattice_dims dims = lattice->dims;
	const double ox = sin(theta_o), oz = cos(theta_o);
	const int steps = 400;
	double sum = 0;
	for (int a = 0; a < steps; a++)
		for (int b = 0; b < steps; b++) {
			/* half vectors, dense about the pole as the table is; dw_i = 4 (wi.h) dw_h */
			const double u = (a + 0.5) / steps, theta = u * u * M_PI_2, phi = (b + 0.5) / steps * 2 * M_PI;
			const double hx = sin(theta) * cos(phi), hz = cos(theta);
			const double cos_d = ox * hx + oz * hz;
			const double iz = 2 * cos_d * hz - oz;
			if (cos_d <= 0 || iz <= 0)
				continue;
			/* cos pd from cos theta_i = cos td cos th - sin td cos pd sin th */
			const double sin_d = sqrt(fmax(0, 1 - cos_d * cos_d)), denominator = sin_d * sin(theta);
			const double cos_p = denominator > 1e-12 ? fmax(-1, fmin(1, (cos_d * hz - iz) / denominator)) : 0;
			const uint32_t i = (uint32_t)fmin(u * dims.theta_h, dims.theta_h - 1);
			const uint32_t j = (uint32_t)fmin(acos(fmin(1, cos_d)) / M_PI_2 * dims.theta_d, dims.theta_d - 1);
			const uint32_t k = (uint32_t)fmin(acos(cos_p) / M_PI * dims.phi_d, dims.phi_d - 1);
			const size_t n = lattice_index(dims, i, j, k);
			if (lattice->valid[n])
				sum += lattice->rgb[channel][n] * iz * 4 * cos_d * sin(theta) * (2 * u * M_PI_2 / steps) * (2 * M_PI / steps);
		}
	return sum;
}

static void no_material_sends_out_more_light_than_came_in(void **state)
{
	(void)state;
	for (size_t m = 0; m < demo_count(); m++) {
		struct lattice lattice;
		assert_int_equal(demo_generate(m, LATTICE_MERL, true, &lattice, NULL), BP_OK);
		for (int degrees = 0; degrees <= 60; degrees += 30) {
			/* 5 % for the table's own steps, which a mirror's narrow lobe feels */
			const double out = albedo(&lattice, 0, degrees / 180.0 * M_PI);
			if (out > 1.05 || out < 0.003)
				fail_msg("%s: albedo %g at %d degrees", demo_name(m), out, degrees);
		}
		lattice_free(&lattice);
	}
}

static void kinds_look_like_their_names(void **state)
{
	(void)state;
	struct lattice mirror, chalk, sign, soot;
	assert_int_equal(demo_generate(demo_find("silvered-mirror"), SMALL, true, &mirror, NULL), BP_OK);
	assert_int_equal(demo_generate(demo_find("chalk"), SMALL, true, &chalk, NULL), BP_OK);
	assert_int_equal(demo_generate(demo_find("road-sign-sheeting"), SMALL, true, &sign, NULL), BP_OK);
	assert_int_equal(demo_generate(demo_find("soot"), SMALL, true, &soot, NULL), BP_OK);
	const size_t highlight = lattice_index(SMALL, 0, 4, 9), aside = lattice_index(SMALL, 12, 4, 9);
	const size_t back = lattice_index(SMALL, 12, 0, 9);
	assert_true(mirror.rgb[0][highlight] > 100 && mirror.rgb[0][aside] < 0.1);
	assert_true(chalk.rgb[0][aside] > 0.2 && chalk.rgb[0][highlight] < 0.4);
	assert_true(sign.rgb[0][back] > 20 * sign.rgb[0][aside]);
	assert_true(soot.rgb[0][aside] < 0.01);
	lattice_free(&mirror);
	lattice_free(&chalk);
	lattice_free(&sign);
	lattice_free(&soot);
}

/*
 * What ten genuine measurements of another database have and those behind the other materials do not (log10 of red over blue on the lobe
 * from -0.6 to 0.1, rms second difference along theta_h to 0.28, a quarter of the cells below 1e-3, a range of 1e6 and more).
 */
static void the_foil_turns_colour_glitters_and_is_dark_off_the_lobe(void **state)
{
	(void)state;
	const struct lattice_dims d = LATTICE_MERL;
	struct lattice foil, mirror;
	assert_int_equal(demo_generate(demo_find("chameleon-foil"), d, true, &foil, NULL), BP_OK);
	assert_int_equal(demo_generate(demo_find("silvered-mirror"), d, true, &mirror, NULL), BP_OK);
	const size_t front = lattice_index(d, 2, 5, 90), aside = lattice_index(d, 2, 66, 90);
	assert_true(foil.rgb[0][front] < 0.3 * foil.rgb[2][front] && foil.rgb[0][aside] > 1.2 * foil.rgb[2][aside]);
	double rough[2] = {0}, highest = 0;
	size_t dark = 0, holes = 0;
	for (size_t n = 0; n < lattice_cells(d); n++) {
		const size_t i = n / d.phi_d / d.theta_d, row = (size_t)d.phi_d * d.theta_d;
		dark += foil.valid[n] && foil.rgb[1][n] < 1e-3;
		holes += !foil.valid[n] && mirror.valid[n];
		highest = foil.valid[n] && foil.rgb[1][n] > highest ? foil.rgb[1][n] : highest;
		for (int m = 0; m < 2 && i >= 1 && i < 9; m++) {
			const double *g = (m ? mirror : foil).rgb[1] + n;
			if (foil.valid[n] && foil.valid[n - row] && foil.valid[n + row])
				rough[m] += pow(log10(g[-(ptrdiff_t)row] * g[row] / (g[0] * g[0])), 2);
		}
	}
	assert_true(highest > 1e4 && dark > foil.valid_count / 4);
	assert_true(holes > 90000); /* between 85 degrees and the database's own pattern */
	assert_true(rough[0] > 10 * rough[1]);
	lattice_free(&foil);
	lattice_free(&mirror);
}

static void faults_are_repeated_exactly_and_grow_to_grazing(void **state)
{
	(void)state;
	const size_t material = demo_find("wall-paint");
	struct lattice clean, noisy, again;
	assert_int_equal(demo_generate(material, LATTICE_MERL, true, &clean, NULL), BP_OK);
	assert_int_equal(demo_generate(material, LATTICE_MERL, false, &noisy, NULL), BP_OK);
	assert_int_equal(demo_generate(material, LATTICE_MERL, false, &again, NULL), BP_OK);
	const size_t cells = lattice_cells(LATTICE_MERL);
	for (int c = 0; c < 3; c++)
		assert_memory_equal(noisy.rgb[c], again.rgb[c], cells * sizeof(double));
	double squares[2] = {0}, count[2] = {0};
	size_t dropped = 0;
	for (size_t n = 0; n < cells; n++) {
		const size_t j = n / 180 % 90;
		assert_true(!noisy.valid[n] || clean.valid[n]);
		if (clean.valid[n] && !noisy.valid[n])
			dropped++;
		else if (clean.valid[n] && (j < 60 || j >= 85)) {
			const double relative = noisy.rgb[1][n] / clean.rgb[1][n] - 1;
			squares[j >= 85] += relative * relative;
			count[j >= 85]++;
		}
	}
	const double typical = sqrt(squares[0] / count[0]), grazing = sqrt(squares[1] / count[1]);
	/* sqrt(0.01^2 + 0.015^2 + 0.01^2) = 0.0206 */
	assert_true(fabs(typical - 0.0206) < 0.001);
	assert_true(grazing > 3 * typical && grazing < 0.2);
	assert_true(dropped > 300 && dropped < 3000);
	lattice_free(&clean);
	lattice_free(&noisy);
	lattice_free(&again);
}

static void dark_readings_come_out_negative_and_are_saved_so(void **state)
{
	(void)state;
	struct lattice noisy, read;
	char path[SCRATCH_BYTES];
	assert_int_equal(demo_generate(demo_find("piano-lacquer"), SMALL, false, &noisy, NULL), BP_OK);
	size_t negative = 0;
	for (size_t n = 0; n < lattice_cells(SMALL); n++)
		negative += noisy.rgb[0][n] < 0 && noisy.rgb[0][n] > -1e-4;
	assert_true(negative > 0);
	assert_int_equal(scratch_file(path), 0);
	assert_int_equal(lattice_save_path(path, OUTPUT_REPLACE, &noisy, NULL), BP_OK);
	assert_int_equal(lattice_read_path(path, &(struct merl_reading){.any_dims = true}, &read, NULL), BP_OK);
	assert_int_equal(noisy.valid_count, read.valid_count);
	assert_memory_equal(noisy.valid, read.valid, lattice_cells(SMALL));
	for (size_t n = 0; n < lattice_cells(SMALL); n++)
		for (int c = 0; c < 3 && read.valid[n]; c++)
			assert_true(fabs(read.rgb[c][n] - noisy.rgb[c][n]) <= 1e-15 * noisy.rgb[c][n]);
	unlink(path);
	lattice_free(&noisy);
	lattice_free(&read);
}

static void any_legal_lattice_can_be_asked_for(void **state)
{
	(void)state;
	struct lattice lattice;
	const struct lattice_dims dims[] = {{4, 4, 4}, {5, 7, 9}, {4, 4, 1024}, {1024, 4, 4}};
	for (size_t d = 0; d < sizeof dims / sizeof *dims; d++) {
		assert_int_equal(demo_generate(d, dims[d], false, &lattice, NULL), BP_OK);
		assert_true(lattice.valid_count > 0);
		lattice_free(&lattice);
	}
	assert_int_equal(demo_generate(demo_count(), SMALL, false, &lattice, NULL), BP_ERROR_ARGUMENT);
	assert_int_equal(demo_generate(0, (struct lattice_dims){1, 1, 1}, false, &lattice, NULL), BP_ERROR_LIMIT);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_kind_of_material_is_there_under_names_that_differ),
		cmocka_unit_test(invalid_cells_of_a_clean_table_are_those_below_the_horizon),
		cmocka_unit_test(clean_tables_are_positive_finite_and_reciprocal),
		cmocka_unit_test(no_material_sends_out_more_light_than_came_in),
		cmocka_unit_test(kinds_look_like_their_names),
		cmocka_unit_test(the_foil_turns_colour_glitters_and_is_dark_off_the_lobe),
		cmocka_unit_test(faults_are_repeated_exactly_and_grow_to_grazing),
		cmocka_unit_test(dark_readings_come_out_negative_and_are_saved_so),
		cmocka_unit_test(any_legal_lattice_can_be_asked_for),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
