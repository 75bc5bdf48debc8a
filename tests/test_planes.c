/* planes.h and bit_mixer.h: what goes in comes out, whatever it is, and a damaged stream ends. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "codec/spectral/planes.h"

static uint64_t state = 5;
static uint32_t random_below(uint32_t n)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return (uint32_t)((state >> 32) * n >> 32);
}

static void bands_cover_every_coefficient_once(void **unused)
{
	static const uint32_t sizes[][2] = {{4, 4}, {15, 15}, {16, 31}, {90, 90}, {4, 1024}, {257, 33}};
	(void)unused;
	for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
		const uint32_t h = sizes[s][0], d = sizes[s][1];
		struct bands bands;
		uint8_t *seen = calloc(h, d), *numbers;
		bands_lay_out(h, d, &bands);
		numbers = calloc(bands.blocks, 1);
		for (uint32_t b = 0; b < bands.count; b++) {
			const struct band *band = &bands.band[b];
			assert_true(band->parent < (int32_t)b);
			for (uint32_t y = 0; y < band->rows; y++)
				for (uint32_t x = 0; x < band->columns; x++) {
					assert_int_equal(seen[(band->row + y) * d + band->column + x]++, 0);
					assert_true(y / BLOCK_EDGE < band->block_rows && x / BLOCK_EDGE < band->block_columns);
				}
			for (uint32_t y = 0; y < band->block_rows; y++)
				for (uint32_t x = 0; x < band->block_columns; x++) {
					const uint32_t at = band->block_at + y * band->block_stride + x;
					assert_true(at >= band->block_stride + 1 && at + band->block_stride + 1 < bands.blocks);
					assert_int_equal(numbers[at]++, 0);
				}
		}
		for (uint32_t i = 0; i < h * d; i++)
			assert_int_equal(seen[i], 1);
		free(seen);
		free(numbers);
	}
}

/* The levels that were settled on, in place of the coefficients. */
static void levels_read(const struct planes *p, float *field)
{
	const struct lattice_dims d = p->dims;
	for (uint32_t f = 0; f < 3; f++)
		for (uint32_t m = 0; m < d.phi_d; m++)
			for (uint32_t b = 0; b < p->bands.count; b++)
				for (uint32_t y = 0; y < p->bands.band[b].rows; y++)
					for (uint32_t x = 0; x < p->bands.band[b].columns; x++) {
						const struct band *band = &p->bands.band[b];
						const size_t block = (size_t)(m + 2) * p->bands.blocks + band->block_at +
						                     (size_t)(y / BLOCK_EDGE) * band->block_stride + x / BLOCK_EDGE;
						const uint32_t lane = spectrum_lane(d.phi_d, m);
						float *at =
							field + f * lattice_cells(d) + ((band->row + y) * d.theta_d + band->column + x) * d.phi_d + lane;
						*at = (float)p->levels[p->level_slot[f][block]].level[y % BLOCK_EDGE * BLOCK_EDGE + x % BLOCK_EDGE];
					}
}

/* Coefficients of many sizes, most of them 0. */
static void coefficients_make(struct lattice_dims d, uint32_t one_in, float *const field[3])
{
	for (int f = 0; f < 3; f++)
		for (size_t i = 0; i < lattice_cells(d); i++) {
			const float size =
				(float)(1u << random_below(16)) * (1 + (float)(150 + random_below(850)) / 1000); /* beyond what settling thins */
			field[f][i] = random_below(one_in) ? 0 : random_below(2) ? size : -size;
		}
}

static void levels_come_back_from_any_prefix_of_units(void **unused)
{
	static const struct lattice_dims dims[] = {{4, 4, 4}, {5, 9, 7}, {17, 16, 9}, {33, 30, 12}};
	(void)unused;
	for (size_t n = 0; n < sizeof dims / sizeof *dims; n++)
		for (uint32_t one_in = 2; one_in < 200; one_in *= 8) {
			const struct lattice_dims d = dims[n];
			const size_t cells = lattice_cells(d);
			float *block = malloc(3 * cells * sizeof *block), *const field[3] = {block, block + cells, block + 2 * cells},
				  centre[3];
			struct planes *in = NULL, *out = NULL;
			struct byte_buffer bytes = {0};
			struct range_encoder encoder;
			struct mixed_coder coder = {.encoder = &encoder, .tables = mixer_tables_get()};
			struct spectral_level *levels = NULL;
			uint32_t count = 0, found = 0;

			coefficients_make(d, one_in, field);
			assert_int_equal(planes_create(d, 1, &in, NULL), BP_OK);
			assert_int_equal(planes_create(d, 0, &out, NULL), BP_OK);
			assert_int_equal(planes_quantise(in, field, 1, NULL), BP_OK);
			planes_start(in, planes_settle(in, centre));
			levels_read(in, block);
			const uint32_t units = planes_units(in), end = units - units / 5;
			range_encoder_start(&encoder, &bytes);
			for (uint32_t u = 0; u < end; u++)
				planes_encode_unit(in, &coder, u);
			range_encoder_end(&encoder);
			planes_start(out, in->planes);
			range_decoder_start(&coder.decoder, bytes.bytes, bytes.count);
			for (uint32_t u = 0; u < end; u++)
				assert_int_equal(planes_decode_unit(out, &coder, u, NULL), BP_OK);
			assert_true(range_decoder_ended(&coder.decoder));
			assert_int_equal(planes_collect(out, end, &levels, &count, NULL), BP_OK);
			for (uint32_t i = 0; i < count; i++) {
				const uint32_t f = (uint32_t)(levels[i].at / cells), at = (uint32_t)(levels[i].at % cells), lane = at % d.phi_d;
				const uint32_t even = (d.phi_d + 1) / 2, harmonic = lane < even ? 2 * lane : 2 * (lane - even) + 1;
				const uint32_t lowest = spectral_lowest_plane(in->planes, d.phi_d, end, f, harmonic);
				const int32_t size = (int32_t)((uint32_t)fabsf(field[f][at]) >> lowest << lowest);
				assert_int_equal(levels[i].level, field[f][at] < 0 ? -size : size);
				field[f][at] = 0;
			}
			/* And nothing is missing: what is left is below its plane. */
			for (size_t i = 0; i < 3 * cells; i++) {
				const uint32_t f = (uint32_t)(i / cells), lane = (uint32_t)(i % cells % d.phi_d), even = (d.phi_d + 1) / 2;
				const uint32_t harmonic = lane < even ? 2 * lane : 2 * (lane - even) + 1;
				found += (uint32_t)fabsf(block[i]) >> spectral_lowest_plane(in->planes, d.phi_d, end, f, harmonic) != 0;
			}
			assert_int_equal(found, 0);
			free(levels);
			byte_buffer_free(&bytes);
			planes_free(in);
			planes_free(out);
			free(block);
		}
}

/* One harmonic with a lone level, another with the same in company; sizes of 0.9 steps. */
static void a_level_of_one_that_stands_alone_is_dropped_and_one_in_company_stays(void **unused)
{
	const struct lattice_dims d = {16, 16, 40};
	const size_t cells = lattice_cells(d);
	float *block = calloc(3 * cells, sizeof *block), *const field[3] = {block, block + cells, block + 2 * cells}, centre[3];
	struct planes *planes = NULL;
	(void)unused;

	assert_int_equal(planes_create(d, 1, &planes, NULL), BP_OK);
	field[0][(3 * 16 + 3) * 40 + 2] = 0.9f;
	/* Levels of 2 leave the machine in state 0: even ones go 0, 0. */
	for (int y = 2; y < 5; y++)
		for (int x = 2; x < 5; x++)
			field[0][(y * 16 + x) * 40 + 15] = y == 3 && x == 3 ? -0.9f : 2.1f;
	assert_int_equal(planes_quantise(planes, field, 1, NULL), BP_OK);
	assert_int_equal(planes->levels_count, 3);
	/* The company comes first in the pool. */
	assert_int_equal(planes->levels[1].level[3 * 8 + 3], -1);
	assert_int_equal(planes->levels[2].level[3 * 8 + 3], 1);
	assert_int_equal(planes_settle(planes, centre), 2);
	assert_int_equal(planes->levels[1].level[3 * 8 + 3], -1);
	assert_int_equal(planes->levels[2].level[3 * 8 + 3], 0);
	planes_free(planes);
	/* Alone and nothing else: no plane is left. */
	assert_int_equal(planes_create(d, 1, &planes, NULL), BP_OK);
	memset(block, 0, 3 * cells * sizeof *block);
	field[2][(3 * 16 + 3) * 40 + 2] = 0.9f;
	assert_int_equal(planes_quantise(planes, field, 1, NULL), BP_OK);
	assert_int_equal(planes->levels_count, 2);
	assert_int_equal(planes_settle(planes, centre), 0);
	planes_free(planes);
	free(block);
}

/* In a harmonic's first state a level k is k steps; behind an odd one the second quantiser may follow, whose 4 is 3.5 steps. */
static void centres_are_what_sizes_lie_beyond_what_their_levels_stand_for(void **unused)
{
	const struct lattice_dims d = {16, 16, 40};
	const size_t cells = lattice_cells(d);
	float *block = calloc(3 * cells, sizeof *block), *const field[3] = {block, block + cells, block + 2 * cells}, centre[3];
	struct planes *planes = NULL;
	(void)unused;

	assert_int_equal(planes_create(d, 1, &planes, NULL), BP_OK);
	for (int x = 0; x < 3; x++)
		field[0][(3 * 16 + x) * 40 + 2] = 6.125f; /* 6, 6, 6 in the first quantiser */
	assert_int_equal(planes_quantise(planes, field, 1, NULL), BP_OK);
	assert_int_equal(planes_settle(planes, centre), 3);
	for (int x = 0; x < 3; x++)
		assert_int_equal(planes->levels[1].level[3 * 8 + x], 6);
	assert_true(centre[0] == 0 && centre[1] == 0 && fabsf(centre[2] - 0.125f) < 0.004f);
	planes_free(planes);
	free(block);
}

/* The coefficients that were found for the first step serve steps that are coarser or a little finer; much finer ones look again. */
static void every_step_has_the_levels_that_it_would_have_alone(void **unused)
{
	static const float steps[] = {100, 130, 90, 20, 21, 500, 3};
	const struct lattice_dims d = {24, 20, 37};
	const size_t cells = lattice_cells(d);
	float *block = malloc(3 * cells * sizeof *block), *const field[3] = {block, block + cells, block + 2 * cells};
	struct planes *planes = NULL;
	(void)unused;

	coefficients_make(d, 9, field);
	assert_int_equal(planes_create(d, 1, &planes, NULL), BP_OK);
	for (size_t n = 0; n < sizeof steps / sizeof *steps; n++) {
		struct planes *alone = NULL;
		assert_int_equal(planes_create(d, 1, &alone, NULL), BP_OK);
		assert_int_equal(planes_quantise(planes, field, steps[n], NULL), BP_OK);
		assert_int_equal(planes_quantise(alone, field, steps[n], NULL), BP_OK);
		assert_true(alone->levels_count > 1);
		assert_int_equal(planes->levels_count, alone->levels_count);
		assert_memory_equal(planes->levels, alone->levels, alone->levels_count * sizeof *alone->levels);
		for (int f = 0; f < 3; f++)
			assert_memory_equal(planes->level_slot[f], alone->level_slot[f],
			                    (d.phi_d + 4) * alone->bands.blocks * sizeof *alone->level_slot[f]);
		planes_free(alone);
	}
	planes_free(planes);
	free(block);
}

/* Of what a step makes larger than planes can say. */
static void levels_end_with_the_planes_that_there_may_be(void **unused)
{
	const struct lattice_dims d = {4, 4, 4};
	const int32_t most = (1 << SPECTRAL_PLANES_MAX) - 3; /* settling may add 2 */
	float block[3 * 64] = {[0] = 2.0f * (float)most, [64] = -2.0f * (float)most}, *const field[3] = {block, block + 64,
	                                                                                                 block + 128};
	struct planes *planes = NULL;
	(void)unused;
	assert_int_equal(planes_create(d, 1, &planes, NULL), BP_OK);
	assert_int_equal(planes_quantise(planes, field, 1, NULL), BP_OK);
	assert_int_equal(planes->levels_count, 3);
	assert_int_equal(planes->levels[1].level[0], most);
	assert_int_equal(planes->levels[2].level[0], -most);
	planes_free(planes);
}

static void the_lowest_plane_is_that_of_the_last_unit_coded(void **unused)
{
	const uint32_t planes = 5, harmonics = 7;
	(void)unused;
	for (uint32_t end = 0; end <= 3 * planes * harmonics; end++) {
		uint32_t lowest[3][7];
		for (uint32_t f = 0; f < 3; f++)
			for (uint32_t m = 0; m < harmonics; m++)
				lowest[f][m] = planes;
		for (uint32_t u = 0; u < end; u++)
			lowest[u / harmonics % 3][u % harmonics] = planes - 1 - u / (3 * harmonics);
		for (uint32_t f = 0; f < 3; f++)
			for (uint32_t m = 0; m < harmonics; m++)
				assert_int_equal(spectral_lowest_plane(planes, harmonics, end, f, m), lowest[f][m]);
	}
}

static void arbitrary_bytes_decode_to_something_legal(void **unused)
{
	const struct lattice_dims d = {17, 16, 9};
	(void)unused;
	for (int trial = 0; trial < 20; trial++) {
		struct planes *planes = NULL;
		struct spectral_level *levels = NULL;
		struct mixed_coder coder = {.tables = mixer_tables_get()};
		uint8_t bytes[500];
		uint32_t count;
		for (size_t i = 0; i < sizeof bytes; i++)
			bytes[i] = (uint8_t)(trial == 0 ? 0 : trial == 1 ? 255 : random_below(256));
		assert_int_equal(planes_create(d, 0, &planes, NULL), BP_OK);
		planes_start(planes, SPECTRAL_PLANES_MAX);
		range_decoder_start(&coder.decoder, bytes, sizeof bytes);
		for (uint32_t u = 0; u < planes_units(planes); u++)
			assert_int_equal(planes_decode_unit(planes, &coder, u, NULL), BP_OK);
		assert_int_equal(planes_collect(planes, planes_units(planes), &levels, &count, NULL), BP_OK);
		for (uint32_t i = 0; i < count; i++)
			assert_true(levels[i].level != 0 && abs(levels[i].level) < 1 << SPECTRAL_PLANES_MAX &&
			            levels[i].at < 3 * lattice_cells(d));
		free(levels);
		planes_free(planes);
	}
}

static void the_mixer_learns_what_a_bit_depends_on(void **unused)
{
	struct byte_buffer bytes = {0};
	struct range_encoder encoder;
	struct mixed_coder coder = {.encoder = &encoder, .tables = mixer_tables_get()};
	mixer_context contexts[4][4];
	struct mixer_weights weights = {{MIXER_WEIGHT_START, MIXER_WEIGHT_START, MIXER_WEIGHT_START, MIXER_WEIGHT_START}};
	(void)unused;
	for (int i = 0; i < 16; i++)
		contexts[i / 4][i % 4] = MIXER_CONTEXT_EVEN;
	range_encoder_start(&encoder, &bytes);
	for (int i = 0; i < 20000; i++) {
		/* The bit is what context 2 says, nineteen times of twenty; the others know nothing. */
		const uint32_t truth = random_below(2), bit = random_below(20) ? truth : !truth;
		mixer_context *const context[4] = {&contexts[0][random_below(4)], &contexts[1][random_below(4)], &contexts[2][truth],
		                                   &contexts[3][0]};
		mixed_bit(&coder, 0, context, &weights, bit);
	}
	range_encoder_end(&encoder);
	/* The entropy is 0.286 bits each; contexts of 60 bits' memory and four weights cost a little. */
	assert_true((double)bytes.count * 8 < 20000 * 0.286 * 1.08);
	byte_buffer_free(&bytes);
}

static void a_pair_of_contexts_and_one_alone_come_near_the_entropy(void **unused)
{
	(void)unused;
	for (int pair = 0; pair < 2; pair++) {
		struct byte_buffer bytes = {0};
		struct range_encoder encoder;
		struct mixed_coder coder = {.encoder = &encoder, .tables = mixer_tables_get()};
		mixer_context contexts[2] = {MIXER_CONTEXT_EVEN, MIXER_CONTEXT_EVEN};
		const double bits = 20000;
		double ones = 0;
		range_encoder_start(&encoder, &bytes);
		for (int i = 0; i < bits; i++) {
			const uint32_t bit = !random_below(20);
			ones += bit;
			if (pair)
				mixed_bit_pair(&coder, 0, &contexts[0], &contexts[1], bit);
			else
				mixed_bit_alone(&coder, 0, &contexts[0], bit);
		}
		range_encoder_end(&encoder);
		const double entropy = ones * log2(bits / ones) + (bits - ones) * log2(bits / (bits - ones));
		/* A memory of n bits costs about 1/(4 n ln 2) of a bit each. */
		assert_true((double)bytes.count * 8 < entropy + bits * (pair ? 1.5 / (4 * 40 * 0.69) : 1.5 / (4 * 250 * 0.69)) + 64);
		assert_true((double)bytes.count * 8 > entropy);
		byte_buffer_free(&bytes);
	}
}

static void contexts_stay_probabilities_whatever_they_see(void **unused)
{
	const struct mixer_tables *tables = mixer_tables_get();
	(void)unused;
	for (uint32_t bit = 0; bit < 2; bit++)
		for (uint32_t seen = 0; seen <= MIXER_SEEN_MAX_ALONE; seen++)
			for (uint32_t p = 1; p < 1u << MIXER_PROBABILITY_BITS;
			     p += p < 300 || p > (1u << MIXER_PROBABILITY_BITS) - 300 ? 1 : 4001) {
				const uint32_t rate = tables->rate[seen], other = (1u << MIXER_PROBABILITY_BITS) - p;
				const mixer_context context = mixer_context_learnt(tables, p << 10 | seen, bit, 250);
				assert_int_equal(context >> 10, bit ? p + other / 64 * rate / 1024 : p - p / 64 * rate / 1024);
				assert_true(context >> 10 > 0);
				assert_int_equal(context & 1023, seen < 250 ? seen + 1 : seen);
			}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(bands_cover_every_coefficient_once),
		cmocka_unit_test(levels_come_back_from_any_prefix_of_units),
		cmocka_unit_test(a_level_of_one_that_stands_alone_is_dropped_and_one_in_company_stays),
		cmocka_unit_test(centres_are_what_sizes_lie_beyond_what_their_levels_stand_for),
		cmocka_unit_test(every_step_has_the_levels_that_it_would_have_alone),
		cmocka_unit_test(levels_end_with_the_planes_that_there_may_be),
		cmocka_unit_test(the_lowest_plane_is_that_of_the_last_unit_coded),
		cmocka_unit_test(arbitrary_bytes_decode_to_something_legal),
		cmocka_unit_test(the_mixer_learns_what_a_bit_depends_on),
		cmocka_unit_test(a_pair_of_contexts_and_one_alone_come_near_the_entropy),
		cmocka_unit_test(contexts_stay_probabilities_whatever_they_see),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
