/* spectral_sections.c: what a section of the spectral profile may say, at its limits and just beyond, behind right checksums. */
#include "archive_fixture.h"

#include "model/spectral/spectral.h"
#include "packed_fixture.h"
#include "words.h"

/* A record of two layers or more: the fields' section, and one of planes for each layer. */
static uint8_t *record;
static struct record_head head;

static int record_make(void **state)
{
	const struct fit_options options = {.profile = PROFILE_SPECTRAL, .budget_bytes = 12000, .effort = 1};
	const struct record_source source = {.bytes = 1};
	struct lattice lattice;
	size_t bytes;
	(void)state;
	glossy_lattice_make((struct lattice_dims){24, 20, 48}, 1, &lattice);
	assert_int_equal(record_encode(&lattice, "a", &source, &options, &record, &bytes, &head, NULL), BP_OK);
	assert_true(head.layer_count >= 2 && head.section_count == head.layer_count + 1);
	lattice_free(&lattice);
	return 0;
}

static int record_drop(void **state)
{
	(void)state;
	free(record);
	return 0;
}

/* Decodes it with other bytes in a section; then they are what they were. */
static bp_status decoded_with(uint32_t section, size_t at, const void *bytes, size_t count, bp_error *error)
{
	struct record_section *entry = &head.sections[section];
	uint8_t *place = record + entry->offset + at, before[8];
	const uint32_t crc32 = entry->crc32;
	struct model *model = NULL;
	memcpy(before, place, count);
	memcpy(place, bytes, count);
	entry->crc32 = bytes_crc32(record + entry->offset, entry->bytes);
	const bp_status status = record_decode_whole(&head, 0, record, &model, error);
	if (!status)
		model_free(model);
	memcpy(place, before, count);
	entry->crc32 = crc32;
	return status;
}

static void numbers_of_the_fields_are_refused_beyond_their_limits(void **state)
{
	static const struct {
		size_t at;
		float good, bad;
		const char *words;
	} CASES[] = {
		{8, 64, 64.001f, "a base is"},
		{16, -64, -64.001f, "a base is"},
		{20, 1.001f, 1.0011f, "the rotation"},
		{52, -1, -1.0011f, "the rotation"},
		{56, 0x1p40f, 0x1.000002p40f, "the step"},
		{56, 1e-30f, 0, "the step"},
		{60, 1, 1.000001f, "a centre is"},
		{64, -1, -1.000001f, "a centre is"},
		{68, 1, INFINITY, "a centre is"},
		{72, 0, 1.000001f, "a centre is"},
		{60, 0, NAN, "a centre is"},
		{8, 0, NAN, "a base is"},
		{56, 1, NAN, "the step"},
		{80, 0x1p-30f, 0x1.fffffep-31f, "rows are cut at"},
		{80, 0x1.fffffep-1f, 1, "rows are cut at"},
		{80, 0.5f, NAN, "rows are cut at"},
		{80, 0.5f, -0.5f, "rows are cut at"},
	};
	static const double UNITS[2][2] = {{SPECTRAL_UNIT_LEAST, SPECTRAL_UNIT_LEAST / 2},
	                                   {SPECTRAL_UNIT_MOST, SPECTRAL_UNIT_MOST * 2}};
	bp_error error;
	(void)state;
	for (size_t n = 0; n < sizeof CASES / sizeof *CASES; n++) {
		assert_int_equal(decoded_with(0, CASES[n].at, &CASES[n].good, 4, &error), BP_OK);
		assert_int_equal(decoded_with(0, CASES[n].at, &CASES[n].bad, 4, &error), BP_ERROR_CORRUPT);
		expect_words(error.message, CASES[n].words);
		assert_true(error.offset >= head.sections[0].offset && error.offset < head.sections[1].offset);
	}
	for (int n = 0; n < 2; n++) {
		assert_int_equal(decoded_with(0, 0, &UNITS[n][0], 8, &error), BP_OK);
		assert_int_equal(decoded_with(0, 0, &UNITS[n][1], 8, &error), BP_ERROR_CORRUPT);
		expect_words(error.message, "the unit is");
	}
	const uint32_t planes = SPECTRAL_PLANES_MAX + 1;
	assert_int_equal(decoded_with(0, 76, &planes, 4, &error), BP_ERROR_CORRUPT);
	expect_words(error.message, "25 planes");
}

static void layers_end_in_ascending_order_and_within_the_units_there_are(void **state)
{
	const uint32_t first = load_u32(record + head.sections[1].offset), before = first - 1, beyond = 25 * 3 * 48 + 1;
	bp_error error;
	(void)state;
	assert_true(first > 0);
	assert_int_equal(decoded_with(2, 0, &before, 4, &error), BP_ERROR_CORRUPT);
	expect_words(error.message, "planes end at unit");
	assert_int_equal(error.offset, head.sections[2].offset);
	assert_int_equal(decoded_with(1, 0, &beyond, 4, &error), BP_ERROR_CORRUPT);
	expect_words(error.message, "planes end at unit");
	/* one unit less than was coded leaves bytes that nobody asks for */
	assert_int_equal(decoded_with(1, 0, &before, 4, &error), BP_ERROR_CORRUPT);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(numbers_of_the_fields_are_refused_beyond_their_limits),
		cmocka_unit_test(layers_end_in_ascending_order_and_within_the_units_there_are),
	};
	return cmocka_run_group_tests(tests, record_make, record_drop);
}
