#include "archive_fixture.h"

static void a_head_comes_back_as_written(void **state)
{
	size_t bytes;
	uint8_t *record = fixture_record("alum-bronze", 3, 10, &bytes);
	struct record_head head, expected;
	(void)state;
	store_u32(record + 52, 17 | ZEROS_HOLES << 28);
	store_u32(record + load_u32(record + 8) - 4, bytes_crc32(record, load_u32(record + 8) - 4));
	fixture_head(&expected, "alum-bronze");
	assert_int_equal(record_head_read(record, bytes, &head, NULL), BP_OK);
	assert_string_equal(head.name, "alum-bronze");
	assert_int_equal(head.profile, PROFILE_PAPER);
	assert_int_equal(head.head_bytes, record_head_size(11, 3, 6));
	assert_int_equal(head.record_bytes, bytes);
	assert_int_equal(head.record_bytes, head.head_bytes + 60);
	assert_memory_equal(&head.dims, &expected.dims, sizeof head.dims);
	assert_true(head.horizon_limit == expected.horizon_limit);
	for (int c = 0; c < 3; c++) {
		assert_true(head.colour[c].diffuse == expected.colour[c].diffuse);
		assert_true(head.colour[c].specular == expected.colour[c].specular);
		assert_true(head.colour[c].rejected == expected.colour[c].rejected);
		assert_int_equal(head.colour[c].iterations, expected.colour[c].iterations);
		assert_int_equal(head.colour[c].converged, 1);
	}
	assert_int_equal(head.options.budget_bytes, 60400);
	assert_int_equal(head.options.effort, 5);
	assert_int_equal(head.source.bytes, expected.source.bytes);
	assert_memory_equal(head.source.sha256, expected.source.sha256, SHA256_BYTES);
	assert_int_equal(head.source.nonfinite_count, 3);
	assert_int_equal(head.source.hole_count, 17);
	assert_int_equal(head.options.zeros, ZEROS_HOLES);
	assert_int_equal(head.left_out, 2);
	assert_int_equal(head.layer_count, 3);
	assert_int_equal(head.layers[0].bytes, head.head_bytes + 20);
	assert_int_equal(head.layers[2].bytes, bytes);
	assert_true(head.layers[1].fidelity.log_rmse == 0.25);
	assert_int_equal(head.section_count, 6);
	assert_int_equal(head.sections[5].offset, bytes - 10);
	assert_true(head.sections[0].error == 0.125);
	assert_true(isnan(head.sections[1].error));
	free(record);
}

static void every_flipped_bit_of_a_head_is_noticed(void **state)
{
	size_t bytes;
	uint8_t *record = fixture_record("m", 2, 4, &bytes);
	struct record_head head;
	(void)state;
	assert_int_equal(record_head_read(record, bytes, &head, NULL), BP_OK);
	for (size_t bit = 0; bit < 8 * (size_t)head.head_bytes; bit++) {
		struct record_head ignored;
		record[bit / 8] ^= (uint8_t)(1 << bit % 8);
		assert_int_not_equal(record_head_read(record, bytes, &ignored, NULL), BP_OK);
		record[bit / 8] ^= (uint8_t)(1 << bit % 8);
	}
	free(record);
}

static void every_short_head_is_noticed(void **state)
{
	size_t bytes;
	uint8_t *record = fixture_record("m", 2, 4, &bytes);
	struct record_head head, ignored;
	(void)state;
	assert_int_equal(record_head_read(record, bytes, &head, NULL), BP_OK);
	for (size_t count = 0; count < head.head_bytes; count++) {
		uint8_t *copy = malloc(count ? count : 1); /* so that a sanitizer sees a read past the end */
		memcpy(copy, record, count);
		assert_int_equal(record_head_read(copy, count, &ignored, NULL), BP_ERROR_CORRUPT);
		free(copy);
	}
	free(record);
}

/* Writes `value` of `width` bytes at `at` of the head, with a checksum that holds, and parses. */
static bp_status parse_with(size_t at, uint64_t value, unsigned width)
{
	size_t bytes;
	uint8_t *record = fixture_record("m", 2, 4, &bytes);
	uint32_t head_bytes = load_u32(record + 8);
	struct record_head head;
	for (unsigned i = 0; i < width; i++)
		record[at + i] = (uint8_t)(value >> 8 * i);
	store_u32(record + head_bytes - 4, bytes_crc32(record, head_bytes - 4));
	bp_status status = record_head_read(record, bytes, &head, NULL);
	free(record);
	return status;
}

static void hostile_values_under_a_right_checksum_are_refused(void **state)
{
	static const uint64_t infinity = UINT64_C(0x7FF0000000000000), nan_bits = UINT64_C(0x7FF8000000000000);
	static const uint64_t minus_one = UINT64_C(0xBFF0000000000000), two = UINT64_C(0x4000000000000000);
	static const struct {
		size_t at;
		uint64_t value;
		unsigned width;
		bp_status expected;
	} cases[] = {
		{8, 0, 4, BP_ERROR_CORRUPT},
		{8, UINT32_MAX, 4, BP_ERROR_CORRUPT}, /* head bytes */
		{12, 0, 4, BP_ERROR_CORRUPT},
		{12, UINT32_MAX, 4, BP_ERROR_CORRUPT}, /* record bytes */
		{16, 1, 2, BP_ERROR_UNSUPPORTED},      /* record version */
		{24, 3, 2, BP_ERROR_CORRUPT},
		{26, 1025, 2, BP_ERROR_CORRUPT},
		{28, 0, 2, BP_ERROR_CORRUPT}, /* extents */
		{30, 0, 1, BP_ERROR_CORRUPT},
		{30, 255, 1, BP_ERROR_CORRUPT}, /* name bytes */
		{31, 0, 1, BP_ERROR_CORRUPT},
		{31, 17, 1, BP_ERROR_CORRUPT}, /* layers */
		{32, 65, 2, BP_ERROR_CORRUPT},
		{32, 65535, 2, BP_ERROR_CORRUPT}, /* sections */
		{40, nan_bits, 8, BP_ERROR_CORRUPT},
		{40, minus_one, 8, BP_ERROR_CORRUPT}, /* max error */
		{48, 10, 4, BP_ERROR_CORRUPT},
		{52, UINT64_C(0x00000079), 4, BP_ERROR_CORRUPT}, /* effort; more holes than 4 x 5 x 6 cells, */
		{52, UINT64_C(0x20000001), 4, BP_ERROR_CORRUPT}, /* holes by the rule that there are none, */
		{52, UINT64_C(0x30000000), 4, BP_ERROR_CORRUPT}, /* rule 3 */
		{52, UINT64_C(0x10000078), 4, BP_OK},
		{52, UINT64_C(0x20000000), 4, BP_OK},
		{56, nan_bits, 8, BP_ERROR_CORRUPT},
		{56, two, 8, BP_ERROR_CORRUPT},
		{56, UINT64_C(0xBFF0000000000001), 8, BP_ERROR_CORRUPT},
		{56, UINT64_C(0xBFF0000000000000), 8, BP_OK}, /* horizon: -1 to 0 */
		{112, nan_bits, 8, BP_ERROR_CORRUPT},
		{120, infinity, 8, BP_ERROR_CORRUPT},
		{128, two, 8, BP_ERROR_CORRUPT},
		{140, 2, 4, BP_ERROR_CORRUPT}, /* converged */
		{208, 0, 4, BP_ERROR_CORRUPT},
		{212, 0xBF800000, 4, BP_ERROR_CORRUPT},
		{216, nan_bits, 8, BP_ERROR_CORRUPT}, /* layer 0 */
		{272 + 6, 2, 2, BP_ERROR_CORRUPT},
		{272 + 10, 1, 2, BP_ERROR_CORRUPT}, /* section 0: layer, reserved */
		{272 + 12, 0, 4, BP_ERROR_CORRUPT},
		{272 + 12, UINT32_MAX, 4, BP_ERROR_CORRUPT}, /* offset */
		{272 + 16, 0, 4, BP_ERROR_CORRUPT},
		{272 + 16, UINT32_MAX, 4, BP_ERROR_CORRUPT}, /* bytes */
		{272 + 128, '/', 1, BP_ERROR_CORRUPT},
		{272 + 128, 0xFF, 1, BP_ERROR_CORRUPT}, /* the name */
		{272, 999, 2, BP_OK},
		{18, 999, 2, BP_OK}, /* unknown section type and profile: for the decoder to judge */
	};
	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
		assert_int_equal(parse_with(cases[i].at, cases[i].value, cases[i].width), cases[i].expected);
}

static void dropping_layers_keeps_the_other_sections_byte_for_byte(void **state)
{
	size_t bytes, kept_bytes, same_bytes;
	uint8_t *record = fixture_record("m", 3, 10, &bytes), *kept, *same;
	struct record_head full, head;
	(void)state;
	assert_int_equal(record_keep_layers(record, bytes, 2, &kept, &kept_bytes, NULL), BP_OK);
	assert_int_equal(record_head_read(record, bytes, &full, NULL), BP_OK);
	assert_int_equal(record_head_read(kept, kept_bytes, &head, NULL), BP_OK);
	assert_int_equal(head.layer_count, 2);
	assert_int_equal(head.section_count, 4);
	for (int i = 0; i < 4; i++)
		assert_memory_equal(kept + head.sections[i].offset, record + full.sections[i].offset, 10);
	assert_true(head.layers[1].fidelity.log_rmse == full.layers[1].fidelity.log_rmse);
	assert_memory_equal(head.source.sha256, full.source.sha256, SHA256_BYTES);
	assert_true(full.codec_version != RECORD_LAYERS_DROPPED && head.codec_version == RECORD_LAYERS_DROPPED);
	assert_int_equal(record_keep_layers(record, bytes, 0, &same, &same_bytes, NULL), BP_OK);
	assert_int_equal(same_bytes, bytes);
	assert_memory_equal(same, record, bytes);
	record[bytes - 1] ^= 1;
	free(kept);
	assert_int_equal(record_keep_layers(record, bytes, 0, &kept, &kept_bytes, NULL), BP_ERROR_CHECKSUM);
	free(same);
	free(record);
}

static void sections_out_of_order_are_not_written(void **state)
{
	struct section_list sections = {0};
	struct record_head head;
	uint8_t *record;
	size_t bytes;
	(void)state;
	fixture_head(&head, "m");
	head.layer_count = 2;
	write_u8(section_add(&sections, SECTION_PAIR_HD, 1, 1, 1, 0, NAN), 1);
	write_u8(section_add(&sections, SECTION_PAIR_HD, 1, 1, 0, 0, NAN), 1);
	assert_int_equal(sections_join(&head, &sections, &record, &bytes, NULL), BP_ERROR_ARGUMENT);
	strcpy(head.name, "a/b");
	assert_int_equal(sections_join(&head, &sections, &record, &bytes, NULL), BP_ERROR_ARGUMENT);
	section_list_free(&sections);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_head_comes_back_as_written),
		cmocka_unit_test(every_flipped_bit_of_a_head_is_noticed),
		cmocka_unit_test(every_short_head_is_noticed),
		cmocka_unit_test(hostile_values_under_a_right_checksum_are_refused),
		cmocka_unit_test(dropping_layers_keeps_the_other_sections_byte_for_byte),
		cmocka_unit_test(sections_out_of_order_are_not_written),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
