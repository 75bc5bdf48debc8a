/*
 * The container of tensor files: what is read from it, and what is refused, with the field's name.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#include "tensor_maker.h"
#include "words.h"

static void refused(const struct byte_buffer *file, const char *words)
{
	struct tensor_table table;
	bp_error error;
	assert_int_equal(tensor_table_parse(file->bytes, file->count, file->count, &table, &error), BP_ERROR_BAD_INPUT);
	expect_words(error.message, words);
}

/* Where the type of field n stands. */
static size_t type_at(const struct made_file *file, uint32_t n)
{
	size_t at = TENSOR_HEAD_BYTES;
	for (uint32_t k = 0; k < n; k++)
		at += 2 + strlen(file->field[k].name) + 11 + 8 * file->field[k].rank;
	return at + 2 + strlen(file->field[n].name) + 2;
}

static void store_u64(uint8_t *at, uint64_t value)
{
	store_u32(at, (uint32_t)value);
	store_u32(at + 4, (uint32_t)(value >> 32));
}

static void fields_come_back_with_their_values(void **state)
{
	(void)state;
	static const enum tensor_type types[] = {TENSOR_F16, TENSOR_F32, TENSOR_F64};
	const uint64_t shape[2] = {2, 3};
	struct made_file file = {0};
	struct byte_buffer bytes = {0};
	struct tensor_table table;
	for (int n = 0; n < 3; n++) {
		static const char *const names[] = {"half", "single", "double"};
		struct made_field *field = made_set(&file, names[n], types[n], 2, shape, 0);
		for (int k = 0; k < 6; k++)
			field->values[k] = (k - 2) * 0.375;
	}
	made_set(&file, "scalar", TENSOR_U8, 0, shape, 7);
	made_write(&file, &bytes);
	assert_int_equal(tensor_table_parse(bytes.bytes, bytes.count, bytes.count, &table, NULL), BP_OK);
	assert_int_equal(table.count, 4);
	for (uint32_t n = 0; n < 3; n++) {
		double values[4];
		assert_true(tensor_field_has_shape(&table.field[n], 2, shape));
		assert_true(tensor_floats(bytes.bytes, &table.field[n], 2, 4, values));
		for (int k = 0; k < 4; k++)
			assert_true(values[k] == k * 0.375);
		assert_false(tensor_floats(bytes.bytes, &table.field[n], 3, 4, values));
	}
	const struct tensor_field *scalar = tensor_field_find(&table, "scalar");
	double none;
	assert_int_equal(scalar->count, 1);
	assert_int_equal(bytes.bytes[scalar->offset], 7);
	assert_false(tensor_floats(bytes.bytes, scalar, 0, 1, &none));
	assert_null(tensor_field_find(&table, "other"));
	byte_buffer_free(&bytes);
	made_free(&file);
}

static void a_half_has_its_whole_range(void **state)
{
	(void)state;
	static const struct {
		uint16_t bits;
		double value;
	} cases[] = {{0x0001, 0x1p-24}, {0x03ff, 1023 * 0x1p-24}, {0x0400, 0x1p-14}, {0x7bff, 65504},
	             {0xbc00, -1},      {0x7c00, HUGE_VAL}};
	const struct tensor_field field = {.type = TENSOR_F16, .count = 1};
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		const uint8_t bytes[2] = {(uint8_t)cases[n].bits, (uint8_t)(cases[n].bits >> 8)};
		double value;
		assert_true(tensor_floats(bytes, &field, 0, 1, &value));
		assert_true(value == cases[n].value);
	}
}

static void every_beginning_is_refused(void **state)
{
	(void)state;
	struct made_file file = {0};
	struct byte_buffer bytes = {0};
	struct tensor_table table;
	bp_error error;
	made_material(&file);
	made_write(&file, &bytes);
	for (size_t count = 0; count < bytes.count; count++) {
		assert_int_equal(tensor_table_parse(bytes.bytes, count, count, &table, &error), BP_ERROR_BAD_INPUT);
		if (count >= TENSOR_MAGIC_BYTES && !strstr(error.message, "truncated"))
			expect_words(error.message, "beyond the file's end");
	}
	byte_buffer_free(&bytes);
	made_free(&file);
}

static void what_cannot_be_is_named(void **state)
{
	(void)state;
	struct made_file file = {0};
	struct byte_buffer good = {0}, bytes = {0};
	made_material(&file);
	made_write(&file, &good);
	const size_t type = type_at(&file, 4); /* vndf: rank before, offset and shape behind */
	static const struct {
		const char *words;
		int at; /* from the type */
		uint64_t value;
	} cases[] = {
		{"field vndf: type 12 is not known", 0, 12},
		{"field vndf: type 0 is not known", 0, 0},
		{"field vndf: rank 9", -2, 9},
		{"field vndf: 192 bytes at offset 4294967295 go beyond the file's end", 1, UINT32_MAX},
		{"field vndf: its shape overflows (dimension 0", 9, UINT64_MAX},
		{"field vndf: its shape overflows (dimension 1", 17, UINT64_MAX / 8},
		{"field vndf: dimension 2 of its shape is 0", 25, 0},
		{"field vndf:", 33, 1000},
	};
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		bytes.count = 0;
		write_bytes(&bytes, good.bytes, good.count);
		uint8_t *at = bytes.bytes + (ptrdiff_t)type + cases[n].at;
		if (cases[n].at > 0)
			store_u64(at, cases[n].value);
		else
			*at = (uint8_t)cases[n].value;
		refused(&bytes, cases[n].words);
	}
	bytes.count = 0;
	write_bytes(&bytes, good.bytes, good.count);
	bytes.bytes[12] = 2;
	refused(&bytes, "version 2.0; version 1 is read");
	bytes.bytes[12] = 1;
	store_u32(bytes.bytes + 14, 1000);
	refused(&bytes, "1000 fields; at most 64");
	store_u32(bytes.bytes + 14, file.count);
	bytes.bytes[18] = 200;
	refused(&bytes, "field 0: a name of 200 bytes");
	bytes.bytes[18] = 5;
	bytes.bytes[20] = '\n';
	refused(&bytes, "field 0: its name is no plain text");
	bytes.bytes[20] = 'p';
	byte_buffer_free(&bytes);
	byte_buffer_free(&good);
	made_free(&file);
}

static void two_fields_of_one_name_and_overlapping_arrays_are_refused(void **state)
{
	(void)state;
	const uint64_t shape[1] = {100};
	struct made_file file = {0};
	struct byte_buffer bytes = {0};
	made_set(&file, "a", TENSOR_F64, 1, shape, 1);
	made_set(&file, "b", TENSOR_F64, 1, shape, 1);
	made_write(&file, &bytes);
	const size_t first = type_at(&file, 0), second = type_at(&file, 1);
	bytes.count -= 800;
	store_u64(bytes.bytes + second + 1, load_u64(bytes.bytes + first + 1));
	refused(&bytes, "they overlap");
	bytes.count += 800;
	bytes.bytes[second - 3] = 'a';
	refused(&bytes, "two fields named a");
	byte_buffer_free(&bytes);
	made_free(&file);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(fields_come_back_with_their_values),
		cmocka_unit_test(a_half_has_its_whole_range),
		cmocka_unit_test(every_beginning_is_refused),
		cmocka_unit_test(what_cannot_be_is_named),
		cmocka_unit_test(two_fields_of_one_name_and_overlapping_arrays_are_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
