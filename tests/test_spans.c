/* spans.h and spectrum_rows.h: rows cut at the horizon, against sums written out, for any extents. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "model/spectral/spans.h"
#include "model/spectral/spectral_kernels.h"
#include "model/spectral/spectrum_rows.h"
#include "random_tables.h"

static uint16_t *spans_of(struct lattice_dims d)
{
	uint16_t *span = malloc((size_t)d.theta_h * d.theta_d * sizeof *span);
	spans_find(d, SPAN_MARGIN, span);
	return span;
}

/* Cell by cell, by the formula of FORMAT.md. */
static void a_span_counts_the_cells_that_can_be_seen(void **unused)
{
	static const struct lattice_dims BOTH[] = {{90, 90, 180}, {17, 15, 7}};
	(void)unused;
	for (int n = 0; n < 2; n++) {
		const struct lattice_dims d = BOTH[n];
		uint16_t *span = spans_of(d);
		uint8_t *seen = malloc(lattice_cells(d));
		lattice_seen(d, seen);
		for (uint32_t r = 0; r < d.theta_h * d.theta_d; r++) {
			const double i = r / d.theta_d, j = r % d.theta_d;
			const double h = i / d.theta_h * (i / d.theta_h) * M_PI_2, t = j / d.theta_d * M_PI_2;
			uint32_t count = 0;
			for (uint32_t k = 0; k < d.phi_d; k++) {
				const double from = M_PI * k / d.phi_d, to = M_PI * (k + 1) / d.phi_d;
				const double least = from <= M_PI_2 + 1e-9 && to >= M_PI_2 - 1e-9 ? 0 : fmin(fabs(cos(from)), fabs(cos(to)));
				const bool here = cos(h) * cos(t) - sin(h) * sin(t) * least > (double)SPAN_MARGIN;
				const uint32_t first = (d.phi_d - span[r]) / 2;
				count += here;
				/* what can be seen lies in the middle, and is what lattice.h means by it, but for cells that touch the horizon */
				assert_true(!here || (k >= first && k < first + span[r]));
				assert_true(!here || seen[r * d.phi_d + k]);
			}
			assert_int_equal(span[r], count ? count : 2 - d.phi_d % 2);
		}
		free(seen);
		free(span);
	}
}

/* What an instrument sees up to 85 degrees: no measured cell is left out, and no cell beyond the first row of cells that are not. */
static void a_limit_leaves_what_was_measured(void **unused)
{
	const struct lattice_dims d = {90, 90, 180};
	struct lattice lattice;
	size_t left = 0, beyond = 0;
	(void)unused;
	assert_int_equal(lattice_alloc(d, &lattice, NULL), BP_OK);
	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++)
			for (uint32_t k = 0; k < d.phi_d; k++) {
				const double h = (i + 0.5) / 90 * ((i + 0.5) / 90) * M_PI_2, t = (j + 0.5) / 90 * M_PI_2;
				lattice.valid[lattice_index(d, i, j, k)] =
					cos(h) * cos(t) - sin(h) * sin(t) * fabs(cos(M_PI * (k + 0.5) / 180)) > cos(85 / 180.0 * M_PI);
			}
	const float limit = spans_limit(&lattice);
	uint16_t *span = malloc(90 * 90 * sizeof *span), *higher = malloc(90 * 90 * sizeof *higher);
	assert_true(limit > 0.09f && limit < 0.1f);
	spans_find(d, limit, span);
	spans_find(d, limit * (1 + 0x1p-12f), higher);
	for (size_t n = 0; n < lattice_cells(d); n++) {
		const uint32_t k = (uint32_t)(n % d.phi_d), first = (d.phi_d - span[n / d.phi_d]) / 2,
					   first_higher = (d.phi_d - higher[n / d.phi_d]) / 2;
		const bool in = k >= first && k < d.phi_d - first;
		assert_true(in || !lattice.valid[n]);
		beyond += in && !lattice.valid[n];
		left += lattice.valid[n] && (k < first_higher || k >= d.phi_d - first_higher);
	}
	assert_true(left > 0); /* it is the highest */
	assert_true(beyond < lattice_cells(d) / 100);
	memset(lattice.valid, 1, lattice_cells(d));
	assert_true(spans_limit(&lattice) == SPAN_MARGIN);
	free(span);
	free(higher);
	lattice_free(&lattice);
}

static void span_forward_is_the_sum_written_out(void **unused)
{
	(void)unused;
	for (int n = 0; n < DIMS_COUNT; n++) {
		const struct lattice_dims d = DIMS[n];
		const uint32_t p = d.phi_d;
		uint16_t *span = spans_of(d);
		struct span_cosines *cosines = NULL;
		assert_int_equal(span_cosines_create(d.phi_d, span, (size_t)d.theta_h * d.theta_d, d.phi_d, false, &cosines, NULL),
		                 BP_OK);
		for (uint32_t r = 0; r < d.theta_h * d.theta_d; r++) {
			float row[1024], cells[1024];
			const uint32_t s = span[r], first = (p - s) / 2;
			for (uint32_t k = 0; k < p; k++)
				cells[k] = row[k] = (float)(uniform() - 0.5);
			span_forward(cosines, s, 0.25f, row);
			for (uint32_t m = 0; m < p; m++) {
				double sum = 0;
				for (uint32_t k = 0; k < s && m < s; k++)
					sum += ((double)cells[first + k] - 0.25) * cos(M_PI * m * (k + 0.5) / s);
				sum *= sqrt((m ? 2.0 : 1.0) / s) * sqrt((double)p / s);
				assert_true(fabs((double)row[spectrum_lane(p, m)] - sum) < 1e-5);
			}
		}
		span_cosines_free(cosines);
		free(span);
	}
}

static void what_can_be_seen_comes_back_and_what_lies_beyond_is_the_value_beside_it(void **unused)
{
	(void)unused;
	for (int n = 0; n < DIMS_COUNT; n++) {
		const struct lattice_dims d = DIMS[n];
		const size_t cells = lattice_cells(d);
		float *table = malloc(cells * sizeof *table), *spectrum = malloc(cells * sizeof *spectrum);
		struct spectrum *forward = NULL;
		for (size_t i = 0; i < cells; i++)
			spectrum[i] = table[i] = (float)(uniform() - 0.5);
		assert_int_equal(spectrum_create(d, SPAN_MARGIN, &forward, NULL), BP_OK);
		const uint16_t *span = spectrum_spans(forward);
		spectrum_forward(forward, spectrum, 0);
		float *back = table_of(d, SPAN_MARGIN, spectrum, false);
		for (size_t i = 0; i < cells; i++) {
			const uint32_t s = span[i / d.phi_d], first = (d.phi_d - s) / 2, last = first + s - 1, k = (uint32_t)(i % d.phi_d);
			const size_t source = i - k + (k < first ? first : k > last ? last : k);
			assert_true(fabsf(back[i] - table[source]) < 6e-6f);
		}
		spectrum_free(forward);
		free(back);
		free(table);
		free(spectrum);
	}
}

static void half_a_table_is_every_second_cell_of_the_whole(void **unused)
{
	(void)unused;
	for (int n = 0; n < DIMS_COUNT; n++) {
		const struct lattice_dims d = DIMS[n], h = {d.theta_h / 2, d.theta_d / 2, d.phi_d / 2};
		if (d.theta_h % 2 || d.theta_d % 2 || d.phi_d % 2)
			continue;
		float *spectrum = malloc(lattice_cells(d) * sizeof *spectrum);
		for (size_t i = 0; i < lattice_cells(d); i++)
			spectrum[i] = uniform() > 0.2 ? 0 : (float)(uniform() - 0.5);
		float *whole = table_of(d, SPAN_MARGIN, spectrum, false), *half = table_of(d, SPAN_MARGIN, spectrum, true);
		for (uint32_t i = 0; i < h.theta_h; i++)
			for (uint32_t j = 0; j < h.theta_d; j++)
				for (uint32_t k = 0; k < h.phi_d; k++)
					assert_true(fabsf(half[lattice_index(h, i, j, k)] - whole[lattice_index(d, 2 * i, 2 * j, 2 * k)]) < 1e-6f);
		free(spectrum);
		free(whole);
		free(half);
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_span_counts_the_cells_that_can_be_seen),
		cmocka_unit_test(a_limit_leaves_what_was_measured),
		cmocka_unit_test(span_forward_is_the_sum_written_out),
		cmocka_unit_test(what_can_be_seen_comes_back_and_what_lies_beyond_is_the_value_beside_it),
		cmocka_unit_test(half_a_table_is_every_second_cell_of_the_whole),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
