/* Damaged and hostile archives: every byte and every bit of a small one. */
#include "archive_fixture.h"

static const char *const NAMES[] = {"brass", "chrome", "delrin"};

/* Everything a reader does with an archive but decoding; the first error, or BP_OK. */
static bp_status read_all(const char *path, bp_error *error)
{
	bp_archive *archive = NULL;
	bp_status status = bp_archive_open(path, &archive, error);
	if (!status)
		status = bp_archive_verify(archive, 0, NULL, NULL, error);
	bp_archive_close(archive);
	return status;
}

/* Loads what it can of each material, by name: whatever comes without an error must be what was stored. */
static void nothing_false_is_told(const char *path)
{
	bp_archive *archive = NULL;
	if (bp_archive_open(path, &archive, NULL) != BP_OK)
		return;
	for (int i = 0; i < 3; i++) {
		struct index_page leaf = {0};
		struct index_entry entry;
		struct record_head head;
		uint8_t *record = NULL, *expected;
		size_t expected_bytes;
		uint64_t index;
		if (bp_archive_find(archive, NAMES[i], &index, NULL) != BP_OK ||
		    archive_entry(archive, index, &leaf, &entry, NULL) != BP_OK ||
		    archive_entry_record(archive, &entry, &head, &record, NULL) != BP_OK)
			continue;
		expected = fixture_record(NAMES[i], 2, 9, &expected_bytes);
		assert_int_equal(index, i);
		assert_int_equal(head.record_bytes, expected_bytes);
		assert_memory_equal(record, expected, expected_bytes);
		free(expected);
		free(record);
	}
	bp_archive_close(archive);
}

static void every_truncation_is_noticed(void **state)
{
	size_t bytes;
	(void)state;
	fixture_archive(fixture_path("a.bpk"), NAMES, 3, 9);
	uint8_t *file = fixture_file_read(fixture_path("a.bpk"), &bytes);
	for (size_t count = 0; count < bytes; count++) {
		bp_error error = {0};
		fixture_file_write(fixture_path("t.bpk"), file, count);
		bp_status status = read_all(fixture_path("t.bpk"), &error);
		assert_int_equal(status, count < 8 ? BP_ERROR_NOT_OURS : BP_ERROR_CORRUPT);
		assert_int_equal(error.offset, count < 8 ? 0 : count);
	}
	file[bytes] = 0;
	fixture_file_write(fixture_path("t.bpk"), file, bytes + 1);
	assert_int_equal(read_all(fixture_path("t.bpk"), NULL), BP_ERROR_CORRUPT);
	free(file);
}

static void every_flipped_bit_is_noticed_and_nothing_false_is_told(void **state)
{
	size_t bytes;
	(void)state;
	fixture_archive(fixture_path("a.bpk"), NAMES, 3, 9);
	uint8_t *file = fixture_file_read(fixture_path("a.bpk"), &bytes);
	fixture_file_write(fixture_path("f.bpk"), file, bytes);
	FILE *damaged = fopen(fixture_path("f.bpk"), "r+b");
	assert_non_null(damaged);
	setbuf(damaged, NULL);
	for (size_t bit = 0; bit < 8 * bytes; bit++) {
		bp_error error = {0};
		fseek(damaged, (long)(bit / 8), SEEK_SET);
		fputc(file[bit / 8] ^ 1 << bit % 8, damaged);
		if (read_all(fixture_path("f.bpk"), &error) == BP_OK)
			fail_msg("bit %zu of byte %zu", bit % 8, bit / 8);
		assert_true(error.offset == BP_NO_OFFSET || error.offset < bytes);
		nothing_false_is_told(fixture_path("f.bpk"));
		fseek(damaged, (long)(bit / 8), SEEK_SET);
		fputc(file[bit / 8], damaged);
	}
	fclose(damaged);
	assert_int_equal(read_all(fixture_path("f.bpk"), NULL), BP_OK);
	free(file);
}

/* The index page of a small archive, with a value changed and its checksum mended. */
static bp_status verify_with_page(size_t at, uint64_t value, unsigned width)
{
	size_t bytes;
	uint8_t *file = fixture_file_read(fixture_path("a.bpk"), &bytes), *page = file + bytes - PAGE_BYTES;
	bp_error error = {0};
	for (unsigned i = 0; i < width; i++)
		page[at + i] = (uint8_t)(value >> 8 * i);
	store_u32(page + PAGE_BYTES - 4, bytes_crc32(page, PAGE_BYTES - 4));
	fixture_file_write(fixture_path("p.bpk"), file, bytes);
	bp_status status = read_all(fixture_path("p.bpk"), &error);
	nothing_false_is_told(fixture_path("p.bpk"));
	free(file);
	return status;
}

static void hostile_index_pages_are_refused(void **state)
{
	static const struct {
		size_t at;
		uint64_t value;
		unsigned width;
	} cases[] = {
		{4, 1, 2},     {4, 65535, 2}, /* level */
		{6, 0, 2},     {6, 2, 2},           {6, 4, 2},           {6, 255, 2},
		{6, 65535, 2},                                                                      /* entries */
		{8, 1, 8},     {8, UINT64_MAX, 8},                                                  /* first ordinal */
		{16, 0, 8},    {16, 65, 8},         {16, UINT64_MAX, 8}, {16, UINT64_MAX - 100, 8}, /* record offset */
		{24, 0, 4},    {24, UINT32_MAX, 4}, {24, 1 << 24, 4},                               /* record bytes */
		{28, 0, 4},    {28, UINT32_MAX, 4}, {28, 300, 4},                                   /* head bytes */
		{32, 0, 1},    {32, 4, 1},          {32, 255, 1},                                   /* name bytes */
		{33, 'z', 1},  {33, '/', 1},        {33, 'a', 1}, /* the name: out of order, illegal, not the record's */
		{2000, 1, 1},                                     /* padding */
	};
	(void)state;
	fixture_archive(fixture_path("a.bpk"), NAMES, 3, 9);
	assert_int_equal(verify_with_page(6, 3, 2), BP_OK);
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
		assert_int_equal(verify_with_page(cases[i].at, cases[i].value, cases[i].width), BP_ERROR_CORRUPT);
}

enum {
	LONG_NAMES = 20,
	ROOT_KEY = PAGE_HEAD_BYTES + 4 + 8 + 1 + 255 + 4
}; /* where the root says with what its second leaf begins */

/* An archive whose names are so long that its index has two leaves and a root, the last pages of the file; names: 255 letters each. */
static uint8_t *two_leaves(const char *names[LONG_NAMES], size_t *bytes)
{
	static char name[LONG_NAMES][256];
	for (size_t n = 0; n < LONG_NAMES; n++) {
		memset(name[n], 'a' + (int)n, 255);
		names[n] = name[n];
	}
	fixture_archive(fixture_path("o.bpk"), names, LONG_NAMES, 9);
	return fixture_file_read(fixture_path("o.bpk"), bytes);
}

static void page_seal(uint8_t *page) { store_u32(page + PAGE_BYTES - 4, bytes_crc32(page, PAGE_BYTES - 4)); }

/* `more` bytes of zeros or of what stands there already, put in at `at`, and a header that knows of them and of so many pages more. */
static bp_status verify_with_more(const uint8_t *file, size_t bytes, size_t at, size_t more, uint32_t pages, bp_error *error)
{
	uint8_t *longer = calloc(1, bytes + more);
	struct archive_header header;
	assert_int_equal(archive_header_read(file, ARCHIVE_HEADER_BYTES, bytes, &header, NULL), BP_OK);
	memcpy(longer, file, at);
	if (pages)
		memcpy(longer + at, file + at, more);
	memcpy(longer + at + more, file + at, bytes - at);
	header.file_bytes += more;
	header.page_count += pages;
	header.index_offset += pages ? 0 : more;
	archive_header_write(&header, longer);
	fixture_file_write(fixture_path("p.bpk"), longer, bytes + more);
	free(longer);
	return read_all(fixture_path("p.bpk"), error);
}

static void what_belongs_to_nothing_is_found(void **state)
{
	const char *names[LONG_NAMES];
	size_t bytes;
	bp_error error;
	(void)state;
	uint8_t *file = two_leaves(names, &bytes);
	const size_t index = bytes - 3 * PAGE_BYTES;
	assert_int_equal(verify_with_more(file, bytes, index, 0, 0, &error), BP_OK);
	assert_int_equal(verify_with_more(file, bytes, index, 100, 0, &error), BP_ERROR_CORRUPT); /* between records and index */
	assert_int_equal(error.offset, index);
	/* a page that no other leads to: the second leaf once more */
	assert_int_equal(verify_with_more(file, bytes, index + PAGE_BYTES, PAGE_BYTES, 1, &error), BP_ERROR_CORRUPT);
	assert_int_equal(error.offset, index);
	free(file);
}

static void an_index_that_contradicts_itself_is_refused(void **state)
{
	const char *names[LONG_NAMES];
	size_t bytes;
	bp_archive *archive = NULL;
	struct index_page leaf = {0};
	struct index_entry entry;
	(void)state;
	uint8_t *file = two_leaves(names, &bytes), *root = file + bytes - PAGE_BYTES, *second = root - PAGE_BYTES;

	/* the root says another first name of the second leaf, still between those of the leaves */
	uint8_t *key = root + ROOT_KEY + 8 + 1;
	assert_memory_equal(key, second + PAGE_HEAD_BYTES + 17, 255);
	key[254]--;
	page_seal(root);
	fixture_file_write(fixture_path("p.bpk"), file, bytes);
	assert_int_equal(read_all(fixture_path("p.bpk"), NULL), BP_ERROR_CORRUPT);
	key[254]++;

	/* the root is its own child: told for what it is, before it is read again */
	const uint32_t first = load_u32(root + PAGE_HEAD_BYTES);
	bp_error error;
	store_u32(root + PAGE_HEAD_BYTES, first + 2);
	page_seal(root);
	fixture_file_write(fixture_path("p.bpk"), file, bytes);
	assert_int_equal(read_all(fixture_path("p.bpk"), &error), BP_ERROR_CORRUPT);
	assert_non_null(strstr(error.message, "a child page follows its parent"));
	store_u32(root + PAGE_HEAD_BYTES, first);
	page_seal(root);

	/* the second leaf ends before the last material */
	const size_t last = PAGE_HEAD_BYTES + (size_t)(load_u16(second + 6) - 1) * (17 + 255);
	second[6]--;
	memset(second + last, 0, 17 + 255);
	page_seal(second);
	fixture_file_write(fixture_path("p.bpk"), file, bytes);
	assert_int_equal(bp_archive_open(fixture_path("p.bpk"), &archive, NULL), BP_OK);
	assert_int_equal(archive_entry(archive, LONG_NAMES - 2, &leaf, &entry, NULL), BP_OK);
	assert_string_equal(entry.name, names[LONG_NAMES - 2]);
	assert_int_equal(archive_entry(archive, LONG_NAMES - 1, &leaf, &entry, NULL), BP_ERROR_CORRUPT);
	bp_archive_close(archive);
	free(file);
}

/* Numbers at the end of their range: a sum with them must not come round to the front. */
static void ordinals_beyond_all_numbers_are_no_materials(void **state)
{
	static const uint64_t ORDINALS[] = {UINT64_MAX, UINT64_MAX - 1, 20, UINT64_C(1) << 32};
	const char *names[LONG_NAMES];
	size_t bytes;
	uint64_t index = 77;
	(void)state;
	uint8_t *file = two_leaves(names, &bytes), *root = file + bytes - PAGE_BYTES, *leaf = root - PAGE_BYTES,
			*at = root + ROOT_KEY;
	assert_memory_equal(at, leaf + 8, 8); /* the first number of the second leaf */
	for (size_t n = 0; n < sizeof ORDINALS / sizeof *ORDINALS; n++) {
		bp_archive *archive = NULL;
		store_u32(at, (uint32_t)ORDINALS[n]);
		store_u32(at + 4, (uint32_t)(ORDINALS[n] >> 32));
		memcpy(leaf + 8, at, 8);
		page_seal(leaf);
		page_seal(root);
		fixture_file_write(fixture_path("p.bpk"), file, bytes);
		assert_int_equal(bp_archive_open(fixture_path("p.bpk"), &archive, NULL), BP_OK);
		for (size_t k = 17; k < LONG_NAMES; k++)
			assert_int_equal(bp_archive_find(archive, names[k], &index, NULL), BP_ERROR_CORRUPT);
		assert_int_equal(bp_archive_verify(archive, 0, NULL, NULL, NULL), BP_ERROR_CORRUPT);
		bp_archive_close(archive);
	}
	assert_int_equal(index, 77);
	free(file);
}

static void two_entries_may_not_share_a_record(void **state)
{
	size_t bytes;
	uint8_t *file, *page;
	bp_archive *archive = NULL;
	struct index_entry entry;
	struct record_head head;
	(void)state;
	fixture_archive(fixture_path("a.bpk"), NAMES, 3, 9);
	file = fixture_file_read(fixture_path("a.bpk"), &bytes);
	page = file + bytes - PAGE_BYTES;
	memcpy(page + 16 + 17 + 5, page + 16, 16); /* chrome's place becomes brass's */
	store_u32(page + PAGE_BYTES - 4, bytes_crc32(page, PAGE_BYTES - 4));
	fixture_file_write(fixture_path("s.bpk"), file, bytes);
	assert_int_equal(read_all(fixture_path("s.bpk"), NULL), BP_ERROR_CORRUPT);
	assert_int_equal(bp_archive_open(fixture_path("s.bpk"), &archive, NULL), BP_OK);
	assert_int_equal(archive_record_head(archive, 0, &entry, &head, NULL), BP_OK);
	assert_int_equal(archive_record_head(archive, 1, &entry, &head, NULL), BP_ERROR_CORRUPT);
	bp_archive_close(archive);
	free(file);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_truncation_is_noticed),
		cmocka_unit_test(every_flipped_bit_is_noticed_and_nothing_false_is_told),
		cmocka_unit_test(hostile_index_pages_are_refused),
		cmocka_unit_test(what_belongs_to_nothing_is_found),
		cmocka_unit_test(an_index_that_contradicts_itself_is_refused),
		cmocka_unit_test(ordinals_beyond_all_numbers_are_no_materials),
		cmocka_unit_test(two_entries_may_not_share_a_record),
	};
	return cmocka_run_group_tests(tests, fixture_folder_make, fixture_folder_remove);
}
