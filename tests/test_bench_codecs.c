/*
 * The general codecs: lossless ones give the table back, zfp's size and error move the right way.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "bench/baseline.h"
#include "merl/merl_file.h"

static const struct lattice_dims SMALL = {16, 12, 20};

static struct lattice make_table(void)
{
	struct lattice lattice;

	assert_int_equal(lattice_alloc(SMALL, &lattice, NULL), BP_OK);
	for (size_t cell = 0; cell < lattice_cells(SMALL); cell++) {
		lattice.valid[cell] = cell % 7 != 0;
		for (int c = 0; c < 3; c++)
			lattice.rgb[c][cell] = lattice.valid[cell] ? 0.1 * (c + 1) + 20 * exp(-1e-3 * (double)cell) : 0;
	}
	return lattice;
}

static void lossless_codecs_read_a_files_bytes_with_its_scale(void **unused)
{
	const size_t cells = lattice_cells(SMALL), bytes = 12 + 24 * cells;
	struct lattice lattice = make_table();
	uint8_t *raw = calloc(1, bytes);
	const struct bench_material material = {.name = "file", .lattice = &lattice, .raw = raw, .raw_bytes = bytes};
	const struct baseline *const codecs[] = {&BASELINE_ZLIB, &BASELINE_ZSTD, &BASELINE_XZ};
	struct expansion table;
	(void)unused;

	assert_non_null(raw);
	for (size_t n = 0; n < 3 * cells; n++) {
		double stored = n % 5 ? 1500.0 * (double)(n + 1) : -1;
		memcpy(raw + 12 + 8 * n, &stored, sizeof stored);
	}
	assert_int_equal(expansion_alloc(SMALL, &table, NULL), BP_OK);
	for (int n = 0; n < 3; n++) {
		struct fitted fitted;
		assert_int_equal(codecs[n]->fit(codecs[n], &material, &fitted, NULL), BP_OK);
		assert_in_range(fitted.bytes, 1, bytes + 100);
		assert_int_equal(codecs[n]->expand(fitted.state, &table, NULL), BP_OK);
		for (size_t c = 0; c < 3; c++)
			for (size_t cell = 0; cell < cells; cell++) {
				double stored;
				memcpy(&stored, raw + 12 + 8 * (c * cells + cell), sizeof stored);
				assert_true(table.rgb[c][cell] == (stored > 0 ? (float)(stored * MERL_SCALE[c]) : 0)); /* -1: not measured */
			}
		assert_true(table.rgb[0][1] == 2);
		codecs[n]->free_state(fitted.state);
	}
	expansion_free(&table);
	free(raw);
	lattice_free(&lattice);
}

static double largest_error(const struct lattice *lattice, const struct expansion *table)
{
	double most = 0;

	for (int c = 0; c < 3; c++)
		for (size_t cell = 0; cell < lattice_cells(SMALL); cell++)
			if (lattice->valid[cell])
				most = fmax(most, fabs(log((double)table->rgb[c][cell] + 1e-3) - log(lattice->rgb[c][cell] + 1e-3)));
	return most;
}

static void more_bytes_bring_zfp_closer(void **unused)
{
	struct lattice lattice = make_table();
	struct bench_material material = {.name = "zfp", .lattice = &lattice};
	struct expansion table;
	double error = HUGE_VAL;
	size_t bytes = 0;
	(void)unused;

	assert_int_equal(expansion_alloc(SMALL, &table, NULL), BP_OK);
	for (size_t budget = 1500; budget < 24000; budget *= 4) {
		struct fitted fitted;
		material.budget_bytes = budget;
		assert_int_equal(BASELINE_ZFP.fit(&BASELINE_ZFP, &material, &fitted, NULL), BP_OK);
		assert_int_equal(BASELINE_ZFP.expand(fitted.state, &table, NULL), BP_OK);
		double now = largest_error(&lattice, &table);
		assert_true(now < error);
		assert_true(fitted.bytes > bytes);
		assert_in_range(fitted.bytes, budget / 2, budget * 2);
		error = now;
		bytes = fitted.bytes;
		BASELINE_ZFP.free_state(fitted.state);
	}
	assert_true(error < 0.1);
	expansion_free(&table);
	lattice_free(&lattice);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(lossless_codecs_read_a_files_bytes_with_its_scale),
		cmocka_unit_test(more_bytes_bring_zfp_closer),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
