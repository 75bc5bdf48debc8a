#include "archive_fixture.h"

#include "codec/range_coder.h"

/* A small generator of its own: xorshift64. */
static uint64_t random_state = 88172645463325252u;
static uint32_t random_below(uint32_t n)
{
	random_state ^= random_state << 13;
	random_state ^= random_state >> 7;
	random_state ^= random_state << 17;
	return (uint32_t)(random_state >> 32) % n;
}

/* `ones` of 1000 bits are 1. */
static size_t round_trip(uint32_t count, uint32_t ones)
{
	struct byte_buffer out = {0};
	struct range_encoder encoder;
	struct range_decoder decoder;
	struct bit_model model;
	uint8_t *bits = malloc(count + 1);
	size_t bytes;
	bit_models_reset(&model, 1);
	range_encoder_start(&encoder, &out);
	for (uint32_t i = 0; i < count; i++) {
		bits[i] = random_below(1000) < ones;
		range_encode(&encoder, &model, bits[i]);
	}
	range_encoder_end(&encoder);
	bit_models_reset(&model, 1);
	range_decoder_start(&decoder, out.bytes, out.count);
	for (uint32_t i = 0; i < count; i++)
		assert_int_equal(range_decode(&decoder, &model), bits[i]);
	assert_true(range_decoder_ended(&decoder));
	bytes = out.count;
	byte_buffer_free(&out);
	free(bits);
	return bytes;
}

static void bits_come_back_and_exactly_the_bytes_written_are_used(void **state)
{
	(void)state;
	for (uint32_t count = 0; count < 200; count++)
		for (uint32_t ones = 0; ones <= 1000; ones += 100)
			round_trip(count, ones);
}

static void sizes_come_close_to_the_entropy(void **state)
{
	(void)state;
	for (uint32_t ones = 10; ones < 1000; ones += 70) {
		double p = ones / 1000.0, entropy = -(p * log2(p) + (1 - p) * log2(1 - p)) * 100000 / 8;
		assert_true((double)round_trip(100000, ones) < 1.06 * entropy + 20);
	}
}

/* The pattern that makes carries run through many 0xFF bytes. */
static void carries_run_through(void **state)
{
	(void)state;
	for (int turn = 0; turn < 200; turn++) {
		struct byte_buffer out = {0};
		struct range_encoder encoder;
		struct range_decoder decoder;
		struct bit_model models[2];
		bit_models_reset(models, 2);
		range_encoder_start(&encoder, &out);
		for (int i = 0; i < 3000; i++)
			range_encode(&encoder, &models[i & 1], i < 1000 + turn || i % 97 == turn % 97);
		range_encoder_end(&encoder);
		bit_models_reset(models, 2);
		range_decoder_start(&decoder, out.bytes, out.count);
		for (int i = 0; i < 3000; i++)
			assert_int_equal(range_decode(&decoder, &models[i & 1]), i < 1000 + turn || i % 97 == turn % 97);
		byte_buffer_free(&out);
	}
}

static void numbers_come_back_over_the_whole_range(void **state)
{
	struct byte_buffer out = {0};
	struct range_encoder encoder;
	struct range_decoder decoder;
	static struct gamma_model model;
	uint32_t numbers[2000], count = 0;
	(void)state;
	for (uint32_t bit = 0; bit < 24; bit++)
		for (int near = -1; near <= 1; near++) {
			int64_t number = ((int64_t)1 << bit) + near;
			if (number >= 0 && number <= (1 << 24) - 2)
				numbers[count++] = (uint32_t)number;
		}
	while (count < 2000)
		numbers[count++] = random_below(1u << (1 + random_below(23)));
	bit_models_reset((struct bit_model *)&model, sizeof model / sizeof(struct bit_model));
	range_encoder_start(&encoder, &out);
	for (uint32_t i = 0; i < count; i++) {
		gamma_encode(&encoder, &model, numbers[i]);
		range_encode_even(&encoder, numbers[i] & 7, 3);
	}
	range_encoder_end(&encoder);
	bit_models_reset((struct bit_model *)&model, sizeof model / sizeof(struct bit_model));
	range_decoder_start(&decoder, out.bytes, out.count);
	for (uint32_t i = 0; i < count; i++) {
		assert_int_equal(gamma_decode(&decoder, &model), numbers[i]);
		assert_int_equal(range_decode_even(&decoder, 3), numbers[i] & 7);
	}
	assert_true(range_decoder_ended(&decoder));
	byte_buffer_free(&out);
}

static void a_decoder_of_nothing_or_of_rubbish_ends(void **state)
{
	uint8_t rubbish[64];
	static struct gamma_model model;
	struct range_decoder decoder;
	(void)state;
	for (size_t i = 0; i < sizeof rubbish; i++)
		rubbish[i] = (uint8_t)random_below(256);
	for (size_t count = 0; count <= sizeof rubbish; count++) {
		bit_models_reset((struct bit_model *)&model, sizeof model / sizeof(struct bit_model));
		range_decoder_start(&decoder, rubbish, count);
		for (int i = 0; i < 200; i++)
			assert_true(gamma_decode(&decoder, &model) <= (1 << 24) - 2);
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(bits_come_back_and_exactly_the_bytes_written_are_used),
		cmocka_unit_test(sizes_come_close_to_the_entropy),
		cmocka_unit_test(carries_run_through),
		cmocka_unit_test(numbers_come_back_over_the_whole_range),
		cmocka_unit_test(a_decoder_of_nothing_or_of_rubbish_ends),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
