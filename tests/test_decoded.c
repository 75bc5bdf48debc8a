/* Decoded tables in every layout, batches, the albedo as a table, and the caller's allocator. */
#include "archive_fixture.h"

#include <float.h>

#include "half.h"
#include "held_archive.h"
#include "packed_fixture.h"

static const struct lattice_dims DIMS = {12, 10, 24};
enum { CELLS = 12 * 10 * 24 };

static struct held held_make(double unit)
{
	struct lattice lattice;
	uint8_t *record;
	size_t record_bytes;
	glossy_lattice_make(DIMS, unit, &lattice);
	for (size_t n = 0; n < CELLS; n += 5)
		lattice.valid[n] = 0;
	lattice.valid_count = CELLS - (CELLS + 4) / 5;
	const struct fit_options options = {.profile = PROFILE_SPECTRAL, .budget_bytes = 60400, .effort = 5};
	const struct record_source source = {0};
	assert_int_equal(record_encode(&lattice, "a", &source, &options, &record, &record_bytes, NULL, NULL), BP_OK);
	const struct held held = held_of(record, record_bytes);
	free(record);
	lattice_free(&lattice);
	return held;
}

static double half_value(uint16_t code)
{
	const int exponent = code >> 10 & 31, mantissa = code & 1023;
	const double size = exponent ? ldexp(1 + mantissa / 1024.0, exponent - 15) : ldexp(mantissa, -24);
	return code & 0x8000 ? -size : size;
}

static void halves_are_rounded_to_the_nearest_even(void **state)
{
	(void)state;
	for (uint32_t code = 0; code < 0x7C00; code++) {
		const double here = half_value((uint16_t)code), next = code + 1 < 0x7C00 ? half_value((uint16_t)(code + 1)) : here;
		const double middle = (here + next) / 2;
		assert_int_equal(half_of(here), code);
		if (next == here)
			continue;
		assert_int_equal(half_of(nextafter(middle, here)), code);
		assert_int_equal(half_of(nextafter(middle, next)), code + 1);
		assert_int_equal(half_of(middle), code + (code & 1));
	}
	assert_int_equal(half_of(-1), 0xBC00);
	assert_int_equal(half_of(1e30), 0x7BFF);
	assert_int_equal(half_of(INFINITY), 0x7BFF);
	assert_int_equal(half_of(-INFINITY), 0xFBFF);
	assert_int_equal(half_of(NAN), 0);
	assert_int_equal(half_of(DBL_MIN), 0);
}

static void tables_hold_the_expansion_in_every_layout(void **state)
{
	const double units[] = {1, 1e-3, 1e5, 1e60};
	(void)state;
	for (int u = 0; u < 4; u++) {
		struct held held = held_make(units[u]);
		struct model *model = NULL;
		struct expansion expected;
		uint8_t below[CELLS];
		int marked = 0;
		assert_int_equal(archive_model_load(held.archive, 0, 0, &model, NULL), BP_OK);
		assert_int_equal(expansion_alloc(DIMS, &expected, NULL), BP_OK);
		assert_int_equal(model_expand(model, 0, &expected, NULL), BP_OK);
		lattice_below_horizon(DIMS, model->horizon_limit, below);
		for (int kind = 0; kind < 12; kind++) {
			const bp_table_options options = {.struct_bytes = sizeof options,
			                                  .number = (bp_number)(kind % 3),
			                                  .layout = (bp_layout)(kind / 3 % 2),
			                                  .continued = kind / 6};
			const size_t bytes = bp_table_bytes(12, 10, 24, &options);
			assert_int_equal(bytes, 3 * CELLS * (size_t)(kind % 3 == 0 ? 4 : kind % 3 == 1 ? 8 : 2));
			void *values = malloc(bytes);
			assert_int_equal(bp_archive_table(held.archive, 0, &options, values, bytes, NULL), BP_OK);
			for (size_t n = 0; n < CELLS; n++)
				for (size_t c = 0; c < 3; c++) {
					const size_t at = options.layout == BP_LAYOUT_INTERLEAVED ? 3 * n + c : n + c * CELLS;
					const double exact = below[n] && !options.continued ? -1 : expected.unit * (double)expected.rgb[c][n];
					marked += exact < 0;
					if (options.number == BP_NUMBER_DOUBLE)
						assert_true(((double *)values)[at] == exact);
					else if (options.number == BP_NUMBER_FLOAT)
						assert_true(((float *)values)[at] == (exact > (double)FLT_MAX ? FLT_MAX : (float)exact));
					else
						assert_int_equal(((uint16_t *)values)[at], half_of(exact));
				}
			free(values);
		}
		assert_true(marked > 0);
		expansion_free(&expected);
		model_free(model);
		held_free(&held);
	}
}

static void table_options_are_checked(void **state)
{
	struct held held = held_make(1);
	float values[3 * CELLS];
	bp_error error;
	(void)state;
	const bp_table_options bad[] = {{.struct_bytes = 3},
	                                {.struct_bytes = sizeof *bad, .number = (bp_number)3},
	                                {.struct_bytes = sizeof *bad, .layout = (bp_layout)2},
	                                {.struct_bytes = sizeof *bad, .continued = 2},
	                                {.struct_bytes = sizeof *bad, .max_log_rmse = NAN}};
	for (size_t n = 0; n < sizeof bad / sizeof *bad; n++)
		assert_int_equal(bp_archive_table(held.archive, 0, &bad[n], values, sizeof values, &error), BP_ERROR_ARGUMENT);
	assert_int_equal(bp_archive_table(held.archive, 0, NULL, values, sizeof values - 4, &error), BP_ERROR_ARGUMENT);
	assert_int_equal(bp_archive_table(held.archive, 0, NULL, NULL, sizeof values, &error), BP_ERROR_ARGUMENT);
	assert_int_equal(bp_archive_table(held.archive, 1, NULL, values, sizeof values, &error), BP_ERROR_NOT_FOUND);
	assert_int_equal(bp_archive_table(held.archive, 0, NULL, values, sizeof values, &error), BP_OK);
	assert_int_equal(bp_table_bytes(3, 10, 24, NULL), 0);
	assert_int_equal(bp_table_bytes(12, 10, 24, &bad[1]), 0);
	held_free(&held);
}

enum { PAIRS = 1000 };
struct pairs {
	float wi[3][PAIRS], wo[3][PAIRS], u[3][PAIRS];
};

static struct pairs *pairs_make(void)
{
	struct pairs *p = malloc(sizeof *p);
	for (int n = 0; n < PAIRS; n++) {
		const double a = fmod(n * 0.618, 1.7), b = n * 1.71, c = fmod(n * 0.83, 1.7), d = n * 2.3;
		p->wi[0][n] = (float)(sin(a) * cos(b)), p->wi[1][n] = (float)(sin(a) * sin(b)), p->wi[2][n] = (float)cos(a);
		p->wo[0][n] = (float)(sin(c) * cos(d)), p->wo[1][n] = (float)(sin(c) * sin(d)), p->wo[2][n] = (float)cos(c);
		for (int k = 0; k < 3; k++)
			p->u[k][n] = (float)fmod(n * (0.31 + 0.17 * k), 1);
	}
	p->wo[1][5] = NAN;
	p->wo[2][6] = -1;
	p->wi[0][7] = INFINITY;
	return p;
}

static void batches_give_the_bits_of_single_calls(void **state)
{
	struct held held = held_make(1);
	struct pairs *p = pairs_make();
	bp_material *material = NULL;
	float wi[3][PAIRS], pdf[PAIRS], density[PAIRS];
	(void)state;
	for (int sampling = 0; sampling < 2; sampling++) {
		const bp_load_options options = {.struct_bytes = sizeof options, .sampling = sampling};
		assert_int_equal(bp_material_load(held.archive, 0, &options, &material, NULL), BP_OK);
		bp_material_sample_batch(material, PAIRS, (const float *const[]){p->wo[0], p->wo[1], p->wo[2]},
		                         (const float *const[]){p->u[0], p->u[1], p->u[2]}, (float *const[]){wi[0], wi[1], wi[2]}, pdf);
		bp_material_pdf_batch(material, PAIRS, (const float *const[]){p->wi[0], p->wi[1], p->wi[2]},
		                      (const float *const[]){p->wo[0], p->wo[1], p->wo[2]}, density);
		for (int n = 0; n < PAIRS; n++) {
			const float in[3] = {p->wi[0][n], p->wi[1][n], p->wi[2][n]}, out[3] = {p->wo[0][n], p->wo[1][n], p->wo[2][n]};
			const float u[3] = {p->u[0][n], p->u[1][n], p->u[2][n]};
			float one[3];
			assert_true(pdf[n] == bp_material_sample(material, out, u, one));
			assert_true(one[0] == wi[0][n] && one[1] == wi[1][n] && one[2] == wi[2][n]);
			assert_true(density[n] == bp_material_pdf(material, in, out));
		}
		assert_true(sampling ? pdf[100] > 0 && pdf[5] == 0 && pdf[6] == 0 && density[7] == 0 : pdf[100] == 0);
		bp_material_sample_batch(material, 0, (const float *const[]){NULL, NULL, NULL}, (const float *const[]){NULL, NULL, NULL},
		                         (float *const[]){NULL, NULL, NULL}, NULL);
		bp_material_free(material);
	}
	free(p);
	held_free(&held);
}

static void the_albedo_table_is_over_the_cosine(void **state)
{
	struct held held = held_make(1);
	bp_material *material = NULL;
	float table[256][3], one[3];
	bp_load_options options = {.struct_bytes = sizeof options, .sampling = 1};
	(void)state;
	assert_int_equal(bp_material_load(held.archive, 0, &options, &material, NULL), BP_OK);
	assert_int_equal(bp_material_albedo_table(material, 256, table[0], NULL), BP_OK);
	for (int n = 0; n < 256; n++) {
		bp_material_albedo(material, (float)acos((n + 0.5) / 256), one);
		assert_memory_equal(table[n], one, sizeof one);
		assert_true(one[0] > 0 && one[2] > one[0]);
	}
	assert_int_equal(bp_material_albedo_table(material, 0, table[0], NULL), BP_ERROR_ARGUMENT);
	assert_int_equal(bp_material_albedo_table(material, 65537, table[0], NULL), BP_ERROR_ARGUMENT);
	bp_material_free(material);
	options.sampling = 0;
	assert_int_equal(bp_material_load(held.archive, 0, &options, &material, NULL), BP_OK);
	assert_int_equal(bp_material_albedo_table(material, 256, table[0], NULL), BP_ERROR_ARGUMENT);
	bp_material_free(material);
	held_free(&held);
}

/* ---- the caller's allocator ---- */

struct arena {
	size_t live, peak_bytes;
	int calls, fail_at;
};

static void *arena_alloc(void *user, size_t bytes, size_t alignment)
{
	struct arena *arena = user;
	void *block = NULL;
	if (++arena->calls == arena->fail_at || posix_memalign(&block, alignment, bytes) != 0)
		return NULL;
	arena->live++;
	arena->peak_bytes += bytes;
	return block;
}

static void arena_release(void *user, void *block)
{
	((struct arena *)user)->live--;
	free(block);
}

static void what_a_material_keeps_comes_from_the_callers_allocator(void **state)
{
	struct held held = held_make(1);
	(void)state;
	for (int form = 0; form < 3; form++)
		for (int sampling = 0; sampling < 2; sampling++) {
			struct arena arena = {0};
			bp_allocator allocator = {arena_alloc, arena_release, &arena};
			bp_loaded loaded = {.struct_bytes = sizeof loaded};
			const bp_load_options options = {
				.struct_bytes = sizeof options, .form = (bp_form)form, .sampling = sampling, .allocator = &allocator};
			bp_material *material = NULL, *other = NULL;
			assert_int_equal(bp_material_load(held.archive, 0, &options, &material, NULL), BP_OK);
			assert_int_equal(bp_material_loaded(material, &loaded, NULL), BP_OK);
			assert_true(arena.peak_bytes == loaded.memory_bytes);
			const int calls = arena.calls;
			allocator = (bp_allocator){0}; /* it was copied */
			/* others are not concerned, nor is this one when they are freed */
			assert_int_equal(bp_material_load(held.archive, 0, NULL, &other, NULL), BP_OK);
			bp_material_free(other);
			assert_int_equal(arena.calls, calls);
			bp_material_free(material);
			assert_int_equal(arena.live, 0);
			for (int at = 1; at <= calls; at++) {
				arena = (struct arena){.fail_at = at};
				allocator = (bp_allocator){arena_alloc, arena_release, &arena};
				material = NULL;
				assert_int_equal(bp_material_load(held.archive, 0, &options, &material, NULL), BP_ERROR_MEMORY);
				assert_true(!material && arena.live == 0);
			}
		}
	bp_material *material = NULL;
	const bp_allocator half = {.alloc = arena_alloc};
	const bp_load_options options = {.struct_bytes = sizeof options, .allocator = &half};
	assert_int_equal(bp_material_load(held.archive, 0, &options, &material, NULL), BP_ERROR_ARGUMENT);
	held_free(&held);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(halves_are_rounded_to_the_nearest_even),
		cmocka_unit_test(tables_hold_the_expansion_in_every_layout),
		cmocka_unit_test(table_options_are_checked),
		cmocka_unit_test(batches_give_the_bits_of_single_calls),
		cmocka_unit_test(the_albedo_table_is_over_the_cosine),
		cmocka_unit_test(what_a_material_keeps_comes_from_the_callers_allocator),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
