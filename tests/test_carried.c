/*
 * Bytes in the cells below the horizon: every value is one that readers take for "not measured", and what was written is found.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "merl/carried.h"

enum { VALUES = 100 };

/* `count` bytes in the first values, and -1 in the rest. */
static void values_make(const uint8_t *bytes, size_t count, double values[VALUES])
{
	struct carried_writer writer = {.bytes = bytes, .count = count};
	for (size_t n = 0; n < VALUES; n++)
		values[n] = carried_write(&writer);
}

static void bytes_make(uint8_t *bytes, size_t count)
{
	for (size_t n = 0; n < count; n++)
		bytes[n] = (uint8_t)(7 * n + 0xF0);
}

static void what_was_written_is_found_among_measured_values(void **state)
{
	(void)state;
	static const size_t counts[] = {1, 5, 6, 7, 300, 588};
	for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
		struct carried_reader reader = {.values = 3 * VALUES};
		uint8_t bytes[588];
		double values[VALUES], file[3 * VALUES];
		bytes_make(bytes, counts[k]);
		assert_true(carried_fits(counts[k], VALUES));
		values_make(bytes, counts[k], values);
		for (size_t n = 0; n < VALUES; n++) { /* two measured ones after each */
			assert_true(values[n] <= -1 && values[n] > -1.0625);
			file[3 * n] = values[n];
			file[3 * n + 1] = (double)n;
			file[3 * n + 2] = 1.0;
		}
		for (size_t at = 0; at < 3 * VALUES; at += 25) /* in portions, as files are read */
			assert_true(carried_read(&reader, file + at, 25));
		assert_true(reader.whole);
		assert_int_equal(reader.count, counts[k]);
		assert_memory_equal(reader.bytes, bytes, counts[k]);
		free(reader.bytes);
	}
}

static void the_rest_is_exactly_minus_one(void **state)
{
	(void)state;
	double values[VALUES];
	const uint8_t bytes[7] = {1, 2, 3, 4, 5, 6, 7};
	values_make(bytes, 7, values);
	for (size_t n = 4; n < VALUES; n++) /* 12 of the head and 7 bytes are in four values */
		assert_true(values[n] == -1);
	assert_false(values[3] == -1);
	values_make(NULL, 0, values);
	for (size_t n = 0; n < VALUES; n++)
		assert_true(values[n] == -1);
}

static void room_is_six_bytes_to_a_value_less_twelve(void **state)
{
	(void)state;
	assert_true(carried_fits(588, 100));
	assert_false(carried_fits(589, 100));
	assert_false(carried_fits(1, 2));
	assert_true(carried_fits(CARRIED_BYTES_MAX, CARRIED_BYTES_MAX));
	assert_false(carried_fits((size_t)CARRIED_BYTES_MAX + 1, CARRIED_BYTES_MAX));
	assert_false(carried_fits(SIZE_MAX, 1000));
}

/* The values of a file as they are, with nothing found in it. */
static void nothing_found(const double *values, size_t count)
{
	struct carried_reader reader = {.values = count};
	assert_true(carried_read(&reader, values, count));
	assert_false(reader.whole);
	free(reader.bytes);
}

static void other_files_carry_nothing(void **state)
{
	(void)state;
	double values[VALUES];
	for (size_t n = 0; n < VALUES; n++)
		values[n] = -1; /* as most programs write it */
	nothing_found(values, VALUES);
	for (size_t n = 0; n < VALUES; n++)
		values[n] = -1 - (double)n / 2048; /* of the right kind, of no meaning */
	nothing_found(values, VALUES);
	for (size_t n = 0; n < VALUES; n++)
		values[n] = n % 4 == 0 ? NAN : n % 4 == 1 ? -INFINITY : n % 4 == 2 ? -0.0 : -0.5;
	nothing_found(values, VALUES);
}

/* Another number of bytes in the head. */
static void announce(double values[VALUES], uint64_t count)
{
	const uint64_t bits = (uint64_t)0xBFF0 << 48 | count << 16 | '\n' << 8 | 0x1A;
	memcpy(&values[1], &bits, sizeof bits);
}

/* The search ends with the first negative value that carries nothing: no file is read to its end in vain. */
static void it_begins_with_the_first_negative_value(void **state)
{
	(void)state;
	const uint8_t bytes[7] = {1, 2, 3, 4, 5, 6, 7};
	static const double before[] = {0.5, 0.0, -0.5, -1e300, -0.0, -INFINITY};
	for (size_t k = 0; k < sizeof before / sizeof *before; k++) {
		struct carried_reader reader = {.values = VALUES + 1};
		double values[VALUES + 1];
		values[0] = before[k];
		values_make(bytes, 7, values + 1);
		assert_true(carried_read(&reader, values, VALUES + 1));
		assert_int_equal(reader.whole, k < 2);
		free(reader.bytes);
	}
}

/* Another way to say "not measured", once it has begun, is passed over as a measured value is. */
static void other_negative_values_on_the_way_do_not_end_it(void **state)
{
	(void)state;
	struct carried_reader reader = {.values = 2 * VALUES};
	uint8_t bytes[100];
	double values[VALUES], file[2 * VALUES];
	bytes_make(bytes, sizeof bytes);
	values_make(bytes, sizeof bytes, values);
	for (size_t n = 0; n < VALUES; n++) {
		file[2 * n] = values[n];
		file[2 * n + 1] = n % 2 ? -5 : -(double)INFINITY;
	}
	assert_true(carried_read(&reader, file, 2 * VALUES));
	assert_true(reader.whole);
	assert_memory_equal(reader.bytes, bytes, sizeof bytes);
	free(reader.bytes);
}

static void a_file_that_lost_some_of_it_carries_nothing(void **state)
{
	(void)state;
	uint8_t bytes[300];
	double values[VALUES];
	bytes_make(bytes, 300);
	values_make(bytes, 300, values);
	nothing_found(values, 51);            /* the last value is missing */
	values[0] = (double)(float)values[0]; /* through single precision */
	nothing_found(values, VALUES);
	values_make(bytes, 300, values);
	announce(values, 0);
	nothing_found(values, VALUES);
	announce(values, 589); /* a byte more than so many values can hold: nothing is allocated for it */
	nothing_found(values, VALUES);
	announce(values, UINT32_MAX);
	nothing_found(values, VALUES);
	announce(values, 588); /* and this the file could hold, but it ends before */
	nothing_found(values, VALUES - 1);
	announce(values, 300);
	struct carried_reader reader = {.values = VALUES};
	assert_true(carried_read(&reader, values, VALUES));
	assert_true(reader.whole);
	free(reader.bytes);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(what_was_written_is_found_among_measured_values),
		cmocka_unit_test(the_rest_is_exactly_minus_one),
		cmocka_unit_test(room_is_six_bytes_to_a_value_less_twelve),
		cmocka_unit_test(other_files_carry_nothing),
		cmocka_unit_test(it_begins_with_the_first_negative_value),
		cmocka_unit_test(other_negative_values_on_the_way_do_not_end_it),
		cmocka_unit_test(a_file_that_lost_some_of_it_carries_nothing),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
