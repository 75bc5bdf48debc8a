/* Evaluation against a slow reference: trilinear between cell centres, in double, from the expansion itself. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "model/table/compact.h"
#include "model/table/direction.h"
#include "model/table/table.h"
#include "model/math/kernels.h"
#include "model/table/table_parts.h"
#include "trilinear.h"
#define RANDOM_SEED 11
#include "random.h"

enum { COUNT = 200 };

static void hemisphere(float out[3])
{
	double z = 1 - uniform(), phi = 2 * M_PI * uniform(), r = sqrt(1 - z * z);
	out[0] = (float)(r * cos(phi));
	out[1] = (float)(r * sin(phi));
	out[2] = (float)z;
}

/* A smooth coloured material with a highlight, periodic in phi_d. */
static struct expansion smooth_material(struct lattice_dims dims, double unit)
{
	struct expansion e;
	assert_int_equal(expansion_alloc(dims, &e, NULL), BP_OK);
	e.unit = unit;
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++)
			for (uint32_t k = 0; k < dims.phi_d; k++) {
				double h = (double)i / dims.theta_h, d = (double)j / dims.theta_d, p = 2 * M_PI * k / dims.phi_d;
				double gloss = 80 * exp(-30 * h * h) * (1 + 3 * pow(d, 5)), body = 0.2 * (1 - 0.3 * d * h * cos(p));
				size_t n = lattice_index(dims, i, j, k);
				e.rgb[0][n] = (float)(gloss + body * (1 + 0.1 * sin(p) * h * d));
				e.rgb[1][n] = (float)(gloss + 0.4 * body);
				e.rgb[2][n] = (float)(0.9 * gloss + 0.05 * body * (1 + 0.2 * cos(p) * h));
			}
	return e;
}

static void compare(const struct expansion *e, const struct table *table, int channels, int count, double relative, int edges)
{
	for (int n = 0; n < count; n++) {
		float wi[3], wo[3], rgb[3], near[3];
		struct lattice_point at;
		hemisphere(wi);
		hemisphere(wo);
		if (edges && n % 3 == 0) { /* mirror directions: theta_h about 0 */
			wo[0] = -wi[0] + 1e-4f * (float)(n % 5);
			wo[1] = -wi[1];
			wo[2] = wi[2];
		}
		if (edges && n % 3 == 1) /* grazing: theta_d to 90 degrees */
			wi[2] *= 1e-4f, wo[2] *= 1e-4f;
		assert_true(direction_to_lattice(e->dims, wi, wo, &at));
		table_evaluate(table, wi, wo, rgb);
		table_nearest(table, wi, wo, near);
		for (int c = 0; c < 3; c++) {
			double want = trilinear(e, c, at, 0.5), cell = cell_value(e, c, (int)at.h, (int)at.d, (int)at.p);
			if (channels == 1) {
				want = (trilinear(e, 0, at, 0.5) + trilinear(e, 1, at, 0.5) + trilinear(e, 2, at, 0.5)) / 3;
				cell = 0;
				for (int other = 0; other < 3; other++)
					cell += cell_value(e, other, (int)at.h, (int)at.d, (int)at.p) / 3;
			}
			assert_true(fabs((double)rgb[c] - want) <= relative * want);
			assert_true(fabs((double)near[c] - cell) <= relative * cell);
		}
	}
}

static struct table *build(const struct expansion *e, enum table_form form, int channels)
{
	struct table *table = NULL;
	bp_error error;
	assert_int_equal(table_build(e, form, channels, &table, &error), BP_OK);
	return table;
}

static void the_expanded_form_keeps_every_value_to_2_to_the_minus_11(void **user)
{
	(void)user;
	const struct lattice_dims dims[] = {{90, 90, 180}, {4, 4, 4}, {5, 7, 37}, {16, 4, 19}};
	for (size_t n = 0; n < sizeof dims / sizeof *dims; n++) {
		struct expansion e = smooth_material(dims[n], 1);
		for (int channels = 1; channels <= 3; channels += 2) {
			struct table *table = build(&e, TABLE_EXPANDED, channels);
			compare(&e, table, channels, 5000, 0x1p-11 + 1e-5, 1);
			table_free(table);
		}
		expansion_free(&e);
	}
}

static void the_compact_form_keeps_a_smooth_material_to_half_a_percent(void **user)
{
	(void)user;
	const struct lattice_dims dims[] = {{90, 90, 180}, {30, 30, 395}, {30, 31, 127}};
	for (size_t n = 0; n < sizeof dims / sizeof *dims; n++) {
		struct expansion e = smooth_material(dims[n], 1);
		for (int channels = 1; channels <= 3; channels += 2) {
			struct table *table = build(&e, TABLE_COMPACT, channels);
			compare(&e, table, channels, 5000, 5e-3, 1);
			table_free(table);
		}
		expansion_free(&e);
	}
}

static bool values_at(const struct table *table, struct lattice_dims dims, double h, double d, double p, float rgb[3])
{
	float wi[3], wo[3];
	bool above = directions_at(dims, h, d, p, wi, wo);
	table_evaluate(table, wi, wo, rgb);
	return above;
}

/* Values differ from cell to cell. */
static void the_centre_of_a_cell_has_its_value_and_before_the_first_and_beyond_the_last_it_stays(void **user)
{
	(void)user;
	const struct lattice_dims dims = {10, 9, 16};
	struct expansion e;
	assert_int_equal(expansion_alloc(dims, &e, NULL), BP_OK);
	e.unit = 1;
	for (size_t n = 0; n < lattice_cells(dims); n++)
		e.rgb[0][n] = e.rgb[1][n] = e.rgb[2][n] = (float)(1 + uniform());
	for (int form = 0; form < 2; form++) {
		struct table *table = build(&e, (enum table_form)form, 3);
		const double within = form ? 0.01 : 0x1p-10 + 1e-4;
		int seen = 0;
		for (uint32_t i = 0; i < dims.theta_h; i++)
			for (uint32_t j = 0; j < dims.theta_d; j++)
				for (uint32_t k = 0; k < dims.phi_d; k++) {
					float rgb[3];
					const double want = (double)e.rgb[1][lattice_index(dims, i, j, k)];
					if (!values_at(table, dims, i + 0.5, j + 0.5, k + 0.5, rgb))
						continue;
					seen++;
					assert_true(fabs((double)rgb[1] - want) < within);
					if (i == 0 && values_at(table, dims, 0.3, j + 0.5, k + 0.5, rgb))
						assert_true(fabs((double)rgb[1] - want) < within);
					if (i + 1 == dims.theta_h && values_at(table, dims, i + 0.9, j + 0.5, k + 0.5, rgb))
						assert_true(fabs((double)rgb[1] - want) < within);
					if (j == 0 && values_at(table, dims, i + 0.5, 0.1, k + 0.5, rgb))
						assert_true(fabs((double)rgb[1] - want) < within);
					/* half-way between the last and the first phi_d, from either side */
					const double first = (double)e.rgb[1][lattice_index(dims, i, j, 0)];
					for (int side = 0; side < 2 && k + 1 == dims.phi_d; side++)
						if (values_at(table, dims, i + 0.5, j + 0.5, side ? 1e-4 : k + 1 - 1e-4, rgb))
							assert_true(fabs((double)rgb[1] - (want + first) / 2) < within);
				}
		assert_true(seen > 800);
		table_free(table);
	}
	expansion_free(&e);
}

/* The least and the largest code of the shares of R (0) or B (2) that a compact table of 30 x 30 x 30 cells has. */
static void codes_range(const struct table *table, int channel, uint32_t *least, uint32_t *most)
{
	struct table_layout layout;
	assert_true(table_layout(table, &layout));
	*least = 4095;
	*most = 0;
	for (size_t block = 0; block < 30 * 30 * 2; block++)
		for (int n = 0; n < 3; n++) {
			const uint8_t *at = layout.blocks + 32 * block + 23 + 3 * n;
			const uint32_t code = channel ? (uint32_t)(at[1] >> 4 | at[2] << 4) : (uint32_t)(at[0] | at[1] << 8) & 4095;
			*least = code < *least ? code : *least;
			*most = code > *most ? code : *most;
		}
}

/* A hostile record's, found by fuzzing: the range of a channel's shares had no finite reciprocal. */
static void a_channel_that_is_next_to_nothing_leaves_the_others_alone(void **user)
{
	(void)user;
	struct expansion e = smooth_material((struct lattice_dims){30, 30, 30}, 1);
	for (int c = 0; c < 3; c += 2) {
		for (size_t i = 0; i < lattice_cells(e.dims); i++)
			e.rgb[c][i] = 1e-37f * (float)(1 + i % 3);
		struct table *table = build(&e, TABLE_COMPACT, 3);
		for (int n = 0; n < COUNT; n++) {
			float wi[3], wo[3], rgb[3];
			hemisphere(wi);
			hemisphere(wo);
			table_evaluate(table, wi, wo, rgb);
			assert_true(rgb[c] >= 0 && rgb[c] < 1e-3f && rgb[1] > 0 && isfinite(rgb[1]));
		}
		for (int channel = 0; channel < 3; channel += 2) {
			uint32_t least, most;
			codes_range(table, channel, &least, &most);
			assert_true(least == 0 && most == 4095);
		}
		table_free(table);
	}
	expansion_free(&e);
}

static void tables_stay_within_their_memory(void **user)
{
	(void)user;
	struct expansion e = smooth_material((struct lattice_dims){90, 90, 180}, 1);
	struct table *expanded = build(&e, TABLE_EXPANDED, 3), *compact = build(&e, TABLE_COMPACT, 3);
	assert_true((double)table_bytes(expanded) < 8.8e6);
	assert_true((double)table_bytes(compact) < 2.6e6);
	table_free(expanded);
	table_free(compact);
	expansion_free(&e);
}

/* Directions of several lengths; where `some` unusable, some pairs have one below the horizon, NaN or infinite. */
static void many_directions(bool unit, bool some_unusable, float in[6][COUNT])
{
	for (int n = 0; n < COUNT; n++) {
		float wi[3], wo[3];
		hemisphere(wi);
		hemisphere(wo);
		for (int c = 0; c < 3; c++) {
			in[c][n] = wi[c] * (unit || n % 4 ? 1 : 3);
			in[3 + c][n] = wo[c];
		}
		if (n % 10 == 0 && some_unusable)
			in[2][n] = -in[2][n];
		if (n % 10 == 1 && some_unusable)
			in[5][n] = n % 20 == 1 ? NAN : 0;
		if (n % 10 == 2 && some_unusable)
			in[3][n] = n % 20 == 2 ? INFINITY : NAN;
	}
}

static const struct table_kernels *kernels_of(enum table_form form, int channels, int avx2)
{
	if (avx2)
		return &(form ? table_compact_avx2 : table_expanded_avx2)[channels == 3];
	return &(form ? table_compact_plain : table_expanded_plain)[channels == 3];
}

static void a_batch_gives_the_same_bits_as_single_calls_at_any_count(void **user)
{
	(void)user;
	struct expansion e = smooth_material((struct lattice_dims){20, 21, 40}, 0.5);
	float in[6][COUNT], out[3][COUNT];
	for (int kind = 0; kind < 16; kind++) {
		const enum table_form form = (enum table_form)(kind & 1);
		const int channels = kind & 2 ? 3 : 1;
		struct table *table = build(&e, form, channels);
		many_directions(kind & 4, kind & 8, in);
		for (int avx2 = 0; avx2 <= (kernels_avx2_usable() ? 1 : 0); avx2++)
			for (size_t count = 0; count <= COUNT; count += count < 70 ? 1 : 13) {
				for (size_t m = 0; m < 3 * COUNT; m++)
					out[m / COUNT][m % COUNT] = -1;
				kernels_of(form, channels, avx2)
					->batch(table, count, (const float *const[]){in[0], in[1], in[2]},
				            (const float *const[]){in[3], in[4], in[5]}, (float *const[]){out[0], out[1], out[2]});
				for (size_t m = 0; m < COUNT; m++) {
					float want[3];
					const float wi[3] = {in[0][m], in[1][m], in[2][m]}, wo[3] = {in[3][m], in[4][m], in[5][m]};
					table_evaluate(table, wi, wo, want);
					for (int c = 0; c < 3; c++)
						assert_true(out[c][m] == (m < count ? want[c] : -1));
				}
			}
		table_free(table);
	}
	expansion_free(&e);
}

static void plain_and_avx2_kernels_give_the_same_bits(void **user)
{
	(void)user;
	if (!kernels_avx2_usable())
		skip();
	struct expansion e = smooth_material((struct lattice_dims){20, 21, 40}, 1);
	for (int form = 0; form < 2; form++)
		for (int channels = 1; channels <= 3; channels += 2) {
			struct table *table = build(&e, (enum table_form)form, channels);
			const struct table_kernels *plain = kernels_of((enum table_form)form, channels, 0);
			const struct table_kernels *avx2 = kernels_of((enum table_form)form, channels, 1);
			for (int n = 0; n < 20000; n++) {
				float wi[3], wo[3], a[3], b[3];
				hemisphere(wi);
				hemisphere(wo);
				plain->evaluate(table, wi, wo, a);
				avx2->evaluate(table, wi, wo, b);
				assert_memory_equal(a, b, sizeof a);
				plain->nearest(table, wi, wo, a);
				avx2->nearest(table, wi, wo, b);
				assert_memory_equal(a, b, sizeof a);
			}
			table_free(table);
		}
	expansion_free(&e);
}

static void unusable_directions_give_0(void **user)
{
	(void)user;
	const float good[3] = {0.6f, 0, 0.8f};
	const float bad[][3] = {{0, 0, 0},   {0.6f, 0, -0.8f}, {1, 0, 0},        {NAN, 0, 1},
	                        {0, 0, NAN}, {INFINITY, 0, 1}, {0, 0, INFINITY}, {1e30f, 0, 1e30f}};
	struct expansion e = smooth_material((struct lattice_dims){8, 8, 8}, 1);
	for (int form = 0; form < 2; form++) {
		struct table *table = build(&e, (enum table_form)form, 3);
		for (size_t n = 0; n < sizeof bad / sizeof *bad; n++)
			for (int swap = 0; swap < 2; swap++) {
				float rgb[3] = {7, 7, 7};
				table_evaluate(table, swap ? good : bad[n], swap ? bad[n] : good, rgb);
				assert_true(rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0);
				table_nearest(table, swap ? good : bad[n], swap ? bad[n] : good, rgb);
				assert_true(rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0);
			}
		table_free(table);
	}
	expansion_free(&e);
}

/* All zero, one bright cell, a channel of zeros, steps over many orders: finite, never negative, and zeros stay 0. */
static void extreme_tables_stay_finite_and_zeros_stay_0(void **user)
{
	(void)user;
	const double units[] = {1, 1e300, 1e-300, 1e-40, 1e38};
	for (int kind = 0; kind < 4; kind++)
		for (size_t u = 0; u < sizeof units / sizeof *units; u++)
			for (int form = 0; form < 2; form++)
				for (int channels = 1; channels <= 3; channels += 2) {
					struct expansion e;
					assert_int_equal(expansion_alloc((struct lattice_dims){6, 6, 24}, &e, NULL), BP_OK);
					size_t cells = lattice_cells(e.dims);
					e.unit = units[u];
					for (size_t n = 0; n < cells; n++)
						for (int c = 0; c < 3; c++)
							e.rgb[c][n] = kind == 0   ? 0
							              : kind == 1 ? (n == 100 ? 1e30f : 0)
							              : kind == 2 ? (c == 1 ? 0 : 1)
							                          : (float)pow(10, 70 * uniform() - 35);
					struct table *table = build(&e, (enum table_form)form, channels);
					for (int n = 0; n < 2000; n++) {
						float wi[3], wo[3], rgb[3];
						hemisphere(wi);
						hemisphere(wo);
						table_evaluate(table, wi, wo, rgb);
						for (int c = 0; c < 3; c++) {
							assert_true(rgb[c] >= 0 && rgb[c] <= FLT_MAX);
							if (kind == 0)
								assert_true(rgb[c] == 0);
						}
						if (kind == 2 && u == 0 && channels == 3) {
							assert_true(fabsf(rgb[0] - 1) < 5e-3f && fabsf(rgb[2] - 1) < 5e-3f);
							assert_true(rgb[1] <= 0x1p-11f);
						}
					}
					table_free(table);
					expansion_free(&e);
				}
}

static void forms_and_channels_that_do_not_exist_are_refused(void **user)
{
	(void)user;
	struct expansion e = smooth_material((struct lattice_dims){4, 4, 4}, 1);
	struct table *table = NULL;
	bp_error error;
	assert_int_equal(table_build(&e, TABLE_EXPANDED, 2, &table, &error), BP_ERROR_ARGUMENT);
	assert_int_equal(table_build(&e, (enum table_form)2, 3, &table, &error), BP_ERROR_ARGUMENT);
	assert_null(table);
	table_free(NULL);
	expansion_free(&e);
}

/* The layout is enough to look a value up by hand, as a shader does: at a centre, where interpolation takes one cell alone. */
static void the_layout_of_a_compact_table_is_enough_to_look_a_value_up(void **user)
{
	(void)user;
	const struct lattice_dims dims = {10, 7, 40};
	struct expansion e = smooth_material(dims, 1);
	struct table *table, *expanded;
	struct table_layout layout;
	assert_int_equal(table_build(&e, TABLE_COMPACT, 3, &table, NULL), BP_OK);
	assert_int_equal(table_build(&e, TABLE_EXPANDED, 3, &expanded, NULL), BP_OK);
	assert_false(table_layout(expanded, &layout));
	assert_true(table_layout(table, &layout));
	assert_memory_equal(&layout.dims, &dims, sizeof dims);
	assert_true(layout.first == 0.5f);
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++)
			for (uint32_t k = 0; k < dims.phi_d; k++) {
				const uint32_t number = k / layout.width, in = k % layout.width, later = in >= layout.half;
				const size_t offset = (size_t)i * layout.slice + (size_t)(j / 2) * layout.row + 32 * (2 * number + j % 2);
				assert_true(offset + 32 <= layout.bytes);
				const uint8_t *block = layout.blocks + offset, *share = block + 23 + 3 * later;
				uint32_t head, code[2];
				memcpy(&head, block, 4);
				for (int n = 0; n < 2; n++)
					code[n] = share[3 * n] | (uint32_t)share[3 * n + 1] << 8 | (uint32_t)share[3 * n + 2] << 16;
				union {
					uint32_t bits;
					float value;
				} base = {(head & 0xffff) << 14}, step = {head >> 16 << 14};
				const double root = (double)base.value + (double)step.value * block[4 + in], mean = root * root * root * root;
				const double to = (double)(in - later * layout.half) / layout.half;
				const double red = mean * ((1 - to) * (code[0] & 4095) + to * (code[1] & 4095)),
							 blue = mean * ((1 - to) * (code[0] >> 12) + to * (code[1] >> 12));
				for (int c = 0; c < 3; c++) {
					const double found =
						red * (double)layout.mix[0][c] + blue * (double)layout.mix[1][c] + mean * (double)layout.mix[2][c];
					const double expected = (double)e.rgb[c][lattice_index(dims, i, j, k)];
					assert_true(fabs(found - expected) < 0.03 * expected + 1e-4);
				}
			}
	table_free(table);
	table_free(expanded);
	expansion_free(&e);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_expanded_form_keeps_every_value_to_2_to_the_minus_11),
		cmocka_unit_test(the_compact_form_keeps_a_smooth_material_to_half_a_percent),
		cmocka_unit_test(the_layout_of_a_compact_table_is_enough_to_look_a_value_up),
		cmocka_unit_test(the_centre_of_a_cell_has_its_value_and_before_the_first_and_beyond_the_last_it_stays),
		cmocka_unit_test(a_channel_that_is_next_to_nothing_leaves_the_others_alone),
		cmocka_unit_test(tables_stay_within_their_memory),
		cmocka_unit_test(a_batch_gives_the_same_bits_as_single_calls_at_any_count),
		cmocka_unit_test(plain_and_avx2_kernels_give_the_same_bits),
		cmocka_unit_test(unusable_directions_give_0),
		cmocka_unit_test(extreme_tables_stay_finite_and_zeros_stay_0),
		cmocka_unit_test(forms_and_channels_that_do_not_exist_are_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
