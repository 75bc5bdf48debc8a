#include "archive_fixture.h"

#include "name.h"

static void values_come_back_as_written(void **state)
{
	struct byte_buffer out = {0};
	struct byte_reader in;
	(void)state;
	write_u8(&out, 0xA5);
	write_u16(&out, 0xBEEF);
	write_u32(&out, 0xDEADBEEF);
	write_u64(&out, UINT64_C(0x0123456789ABCDEF));
	write_f32(&out, -1.5f);
	write_f64(&out, 0.1);
	write_f64(&out, NAN);
	write_bytes(&out, "abc", 3);
	write_zeros(&out, 2);
	in = byte_reader_over(out.bytes, out.count);
	assert_int_equal(read_u8(&in), 0xA5);
	assert_int_equal(read_u16(&in), 0xBEEF);
	assert_int_equal(read_u32(&in), 0xDEADBEEF);
	assert_true(read_u64(&in) == UINT64_C(0x0123456789ABCDEF));
	assert_true(read_f32(&in) == -1.5f);
	assert_true(read_f64(&in) == 0.1);
	double nan_kept = read_f64(&in);
	assert_true(isnan(nan_kept));
	assert_memory_equal(read_span(&in, 3), "abc", 3);
	assert_int_equal(read_u16(&in), 0);
	assert_int_equal(byte_reader_left(&in), 0);
	assert_false(in.failed);
	byte_buffer_free(&out);
}

static void bytes_are_little_endian(void **state)
{
	static const uint8_t expected[] = {0x04, 0x03, 0x02, 0x01, 0x00, 0x00, 0x80, 0x3F};
	struct byte_buffer out = {0};
	(void)state;
	write_u32(&out, 0x01020304);
	write_f32(&out, 1.0f);
	assert_memory_equal(out.bytes, expected, sizeof expected);
	assert_int_equal(load_u32(out.bytes), 0x01020304);
	assert_int_equal(load_u16(out.bytes), 0x0304);
	byte_buffer_free(&out);
}

static void reading_past_the_end_fails_for_good(void **state)
{
	static const uint8_t three[3] = {1, 2, 3};
	struct byte_reader in = byte_reader_over(three, 3);
	uint8_t copy[4] = {9, 9, 9, 9};
	(void)state;
	assert_int_equal(read_u32(&in), 0);
	assert_true(in.failed);
	assert_int_equal(read_u8(&in), 0); /* sticky, although a byte is there */
	read_bytes(&in, copy, 4);
	assert_int_equal(copy[0] | copy[3], 0);
	in = byte_reader_over(three, 3);
	assert_null(read_span(&in, SIZE_MAX));
	assert_true(in.failed);
}

static void a_buffer_grows_past_its_first_size(void **state)
{
	struct byte_buffer out = {0};
	(void)state;
	for (uint32_t i = 0; i < 10000; i++)
		write_u32(&out, i);
	assert_int_equal(out.count, 40000);
	for (uint32_t i = 0; i < 10000; i++)
		assert_int_equal(load_u32(out.bytes + 4 * i), i);
	byte_buffer_free(&out);
}

static void the_checksum_is_the_usual_crc32(void **state)
{
	(void)state;
	assert_int_equal(bytes_crc32("123456789", 9), 0xCBF43926); /* the check value of CRC-32/ISO-HDLC */
	assert_int_equal(bytes_crc32(NULL, 0), 0);
	assert_int_equal(bytes_crc32_more(bytes_crc32("1234", 4), "56789", 5), 0xCBF43926);
}

static void names_are_utf8_without_controls_and_slashes(void **state)
{
	static const char *const good[] = {"a", "alum-bronze", "...", ".a", "caf\xC3\xA9", "\xF0\x9F\x8E\xA8", "\xED\x9F\xBF", "a b"};
	static const struct {
		const char *name;
		size_t count;
	} bad[] = {
		{"", 0},
		{".", 1},
		{"..", 2},
		{"a/b", 3},
		{"a\nb", 3},
		{"a\0b", 3},
		{"\x7F", 1},
		{"\xC2\x85", 2},         /* a C1 control */
		{"\xC0\x80", 2},         /* overlong */
		{"\xE0\x80\xAF", 3},     /* overlong '/' */
		{"\xED\xA0\x80", 3},     /* surrogate */
		{"\xF4\x90\x80\x80", 4}, /* above U+10FFFF */
		{"\xC3", 1},
		{"\x80", 1},
		{"\xFF", 1},
	};
	char long_name[256];
	(void)state;
	for (size_t i = 0; i < sizeof good / sizeof *good; i++)
		assert_null(name_fault(good[i], strlen(good[i])));
	for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
		assert_non_null(name_fault(bad[i].name, bad[i].count));
	memset(long_name, 'x', sizeof long_name);
	assert_null(name_fault(long_name, 255));
	assert_non_null(name_fault(long_name, 256));
}

static void names_are_ordered_by_bytes_the_shorter_first(void **state)
{
	(void)state;
	assert_int_equal(name_compare("a", 1, "b", 1), -1);
	assert_int_equal(name_compare("a", 1, "a", 1), 0);
	assert_int_equal(name_compare("ab", 2, "a", 1), 1);
	assert_int_equal(name_compare("\xC3\xA9", 2, "z", 1), 1);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(values_come_back_as_written),
		cmocka_unit_test(bytes_are_little_endian),
		cmocka_unit_test(reading_past_the_end_fails_for_good),
		cmocka_unit_test(a_buffer_grows_past_its_first_size),
		cmocka_unit_test(the_checksum_is_the_usual_crc32),
		cmocka_unit_test(names_are_utf8_without_controls_and_slashes),
		cmocka_unit_test(names_are_ordered_by_bytes_the_shorter_first),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
