#include "archive_fixture.h"

#include <pthread.h>
#include <sys/stat.h>

static const char *const NAMES[] = {"brass", "chrome", "delrin", "nickel"};

static bp_archive *opened(const char *path)
{
	bp_archive *archive = NULL;
	bp_error error = {0};
	if (bp_archive_open(path, &archive, &error) != BP_OK)
		fail_msg("%s", error.message);
	return archive;
}

static void layers_and_sections_are_told(const bp_archive *archive, const bp_material_info *info)
{
	bp_layer layers[2];
	bp_section sections[3] = {{0}, {0}, {.type = 77}};
	uint32_t count = 0;
	assert_int_equal(bp_archive_layers(archive, 2, sizeof *layers, layers, 2, &count, NULL), BP_OK);
	assert_int_equal(count, 2);
	assert_int_equal(layers[1].bytes, info->record_bytes);
	assert_int_equal(layers[0].bytes, info->head_bytes + 10000);
	assert_true(layers[0].log_rmse == 0.5);
	/* fewer than there are: no more are written */
	assert_int_equal(bp_archive_sections(archive, 2, sizeof *sections, sections, 2, &count, NULL), BP_OK);
	assert_int_equal(count, 4);
	assert_true(sections[1].type == SECTION_SLICES && sections[1].bytes == 5000 && sections[1].layer == 0 &&
	            isnan(sections[1].error));
	assert_true(sections[0].flags == SECTION_REQUIRED && sections[0].error == 0.125 && sections[2].type == 77);
	assert_int_equal(bp_archive_sections(archive, 2, sizeof *sections - 4, sections, 2, &count, NULL), BP_ERROR_ARGUMENT);
	assert_int_equal(bp_archive_layers(archive, 2, sizeof *layers, NULL, 2, &count, NULL), BP_ERROR_ARGUMENT);
	assert_int_equal(bp_archive_layers(archive, 2, sizeof *layers, NULL, 0, &count, NULL), BP_OK);
	assert_int_equal(bp_archive_layers(archive, 4, sizeof *layers, layers, 2, &count, NULL), BP_ERROR_NOT_FOUND);
}

static void an_archive_tells_its_materials_without_loading_them(void **state)
{
	bp_material_info info = {.struct_bytes = sizeof info};
	(void)state;
	fixture_archive(fixture_path("a.bpk"), NAMES, 4, 5000);
	bp_archive *archive = opened(fixture_path("a.bpk"));
	assert_int_equal(bp_archive_count(archive), 4);
	uint64_t before = bp_archive_bytes_read(archive);
	assert_int_equal(before, 64 + 4096);
	assert_int_equal(bp_archive_info(archive, 2, &info, NULL), BP_OK);
	assert_int_equal(bp_archive_bytes_read(archive) - before, info.head_bytes);
	assert_string_equal(info.name, "delrin");
	assert_int_equal(info.profile, 1);
	assert_int_equal(info.theta_h, 4);
	assert_int_equal(info.phi_d, 6);
	assert_int_equal(info.layer_count, 2);
	assert_int_equal(info.section_count, 4);
	assert_true(info.channels[2].diffuse == 0.75);
	assert_int_equal(info.source_bytes, 34992012);
	layers_and_sections_are_told(archive, &info);
	info.struct_bytes = 8;
	assert_int_equal(bp_archive_info(archive, 2, &info, NULL), BP_ERROR_ARGUMENT);
	info.struct_bytes = sizeof info;
	assert_int_equal(bp_archive_info(archive, 4, &info, NULL), BP_ERROR_NOT_FOUND);
	bp_archive_close(archive);
	bp_archive_close(NULL);
}

static void a_record_is_read_whole_and_checked(void **state)
{
	struct index_page leaf = {0};
	struct index_entry entry;
	struct record_head head;
	uint8_t *record, *expected;
	size_t expected_bytes;
	(void)state;
	fixture_archive(fixture_path("a.bpk"), NAMES, 4, 50);
	bp_archive *archive = opened(fixture_path("a.bpk"));
	assert_int_equal(archive_entry(archive, 1, &leaf, &entry, NULL), BP_OK);
	assert_int_equal(archive_entry_record(archive, &entry, &head, &record, NULL), BP_OK);
	expected = fixture_record("chrome", 2, 50, &expected_bytes);
	assert_int_equal(head.record_bytes, expected_bytes);
	assert_memory_equal(record, expected, expected_bytes);
	free(record);
	free(expected);
	bp_archive_close(archive);
}

static void what_is_not_an_archive_is_called_so(void **state)
{
	static const uint8_t text_mode[64] = "\x8b"
										 "BPK\n\x1a\n"; /* CR LF became LF on the way */
	static const struct {
		const void *bytes;
		size_t count;
		bp_status expected;
	} cases[] = {
		{"", 0, BP_ERROR_NOT_OURS},
		{"\x8b"
	     "BPK",
	     4, BP_ERROR_NOT_OURS},
		{text_mode, 64, BP_ERROR_NOT_OURS},
		{"\x8b"
	     "BPK\r\n\x1a\n",
	     8, BP_ERROR_CORRUPT},
		{"PK\3\4 and so on", 15, BP_ERROR_NOT_OURS},
	};
	bp_archive *archive = NULL;
	bp_error error;
	(void)state;
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		fixture_file_write(fixture_path("x"), cases[i].bytes, cases[i].count);
		assert_int_equal(bp_archive_open(fixture_path("x"), &archive, &error), cases[i].expected);
		assert_int_equal(error.status, cases[i].expected);
		if (error.status == BP_ERROR_NOT_OURS) /* whole without the status's text */
			assert_string_equal(error.message, "not an archive: it does not begin as one");
	}
	assert_int_equal(bp_archive_open(fixture_path("nothing-here"), &archive, NULL), BP_ERROR_IO);
	assert_int_equal(bp_archive_open(fixture_folder, &archive, NULL), BP_ERROR_NOT_OURS);
	assert_int_equal(mkfifo(fixture_path("fifo"), 0600), 0);
	assert_int_equal(bp_archive_open(fixture_path("fifo"), &archive, NULL), BP_ERROR_NOT_OURS);
	assert_int_equal(bp_archive_open(NULL, &archive, NULL), BP_ERROR_ARGUMENT);
	assert_null(archive);
}

/* Changes `width` bytes at `at` of the header, mends its checksum, and opens. */
static bp_status open_with(size_t at, uint64_t value, unsigned width)
{
	size_t bytes;
	uint8_t *file = fixture_file_read(fixture_path("a.bpk"), &bytes);
	bp_archive *archive = NULL;
	for (unsigned i = 0; i < width; i++)
		file[at + i] = (uint8_t)(value >> 8 * i);
	store_u32(file + 60, bytes_crc32(file, 60));
	fixture_file_write(fixture_path("b.bpk"), file, bytes);
	bp_status status = bp_archive_open(fixture_path("b.bpk"), &archive, NULL);
	bp_archive_close(archive);
	free(file);
	return status;
}

static void newer_versions_and_hostile_headers_are_told_apart(void **state)
{
	(void)state;
	fixture_archive(fixture_path("a.bpk"), NAMES, 4, 5);
	assert_int_equal(open_with(8, 2, 2), BP_ERROR_UNSUPPORTED);
	assert_int_equal(open_with(10, 7, 2), BP_OK); /* a minor version only adds */
	assert_int_equal(open_with(12, 1, 4), BP_ERROR_UNSUPPORTED);
	assert_int_equal(open_with(12, 0x10000, 4), BP_OK);
	assert_int_equal(open_with(16, UINT64_MAX, 8), BP_ERROR_CORRUPT);
	assert_int_equal(open_with(24, 0, 8), BP_ERROR_CORRUPT);
	assert_int_equal(open_with(24, UINT64_MAX, 8), BP_ERROR_CORRUPT);
	assert_int_equal(open_with(32, 0, 8), BP_ERROR_CORRUPT);
	assert_int_equal(open_with(32, UINT64_MAX, 8), BP_ERROR_CORRUPT);
	assert_int_equal(open_with(32, UINT64_MAX - 4095, 8), BP_ERROR_CORRUPT);
	assert_int_equal(open_with(40, 0, 4), BP_ERROR_CORRUPT);
	assert_int_equal(open_with(40, UINT32_MAX, 4), BP_ERROR_CORRUPT);
	assert_int_equal(open_with(44, 2, 4), BP_ERROR_CORRUPT);
	assert_int_equal(open_with(44, UINT32_MAX, 4), BP_ERROR_CORRUPT);
	assert_int_equal(open_with(48, 1, 1), BP_ERROR_CORRUPT);
	assert_int_equal(open_with(48, 0, 1), BP_OK);
}

static void a_file_cut_while_open_gives_an_error(void **state)
{
	bp_material_info info = {.struct_bytes = sizeof info};
	bp_error error;
	(void)state;
	fixture_archive(fixture_path("a.bpk"), NAMES, 4, 5000);
	bp_archive *archive = opened(fixture_path("a.bpk"));
	assert_int_equal(truncate(fixture_path("a.bpk"), 30000), 0);
	assert_int_equal(bp_archive_info(archive, 0, &info, &error), BP_OK);
	assert_int_equal(bp_archive_info(archive, 3, &info, &error), BP_ERROR_CORRUPT);
	assert_int_equal(error.offset, 30000);
	assert_int_equal(bp_archive_verify(archive, 0, NULL, NULL, &error), BP_ERROR_CORRUPT);
	bp_archive_close(archive);
}

static int count_problem(void *user, const bp_problem *problem)
{
	unsigned *counts = user;
	counts[problem->material ? 1 : 0]++;
	return 0;
}

static void verify_names_each_damaged_material(void **state)
{
	size_t bytes;
	bp_material_info info = {.struct_bytes = sizeof info};
	unsigned counts[2] = {0, 0};
	bp_error error;
	(void)state;
	fixture_archive(fixture_path("a.bpk"), NAMES, 4, 500);
	bp_archive *archive = opened(fixture_path("a.bpk"));
	assert_int_equal(bp_archive_verify(archive, 0, count_problem, counts, &error), BP_OK);
	assert_true(bp_archive_bytes_read(archive) >= archive_header(archive)->file_bytes);
	assert_int_equal(counts[0] + counts[1], 0);
	uint8_t *file = fixture_file_read(fixture_path("a.bpk"), &bytes);
	bp_archive_info(archive, 1, &info, NULL);
	file[info.record_offset + info.record_bytes - 1] ^= 1;
	bp_archive_info(archive, 3, &info, NULL);
	file[info.record_offset + 40] ^= 1;
	bp_archive_close(archive);
	fixture_file_write(fixture_path("a.bpk"), file, bytes);
	archive = opened(fixture_path("a.bpk"));
	assert_int_equal(bp_archive_verify(archive, 0, count_problem, counts, &error), BP_ERROR_CHECKSUM);
	assert_int_equal(counts[0], 0);
	assert_int_equal(counts[1], 2);
	bp_archive_close(archive);
	free(file);
}

static void *read_everything(void *user)
{
	bp_archive *archive = user;
	for (int turn = 0; turn < 50; turn++)
		for (uint64_t i = 0; i < 4; i++) {
			bp_material_info info = {.struct_bytes = sizeof info};
			uint64_t found;
			if (bp_archive_find(archive, NAMES[i], &found, NULL) != BP_OK || found != i ||
			    bp_archive_info(archive, i, &info, NULL) != BP_OK || strcmp(info.name, NAMES[i]) != 0)
				return user;
		}
	return bp_archive_verify(archive, 0, NULL, NULL, NULL) == BP_OK ? NULL : user;
}

static void eight_threads_read_through_one_handle(void **state)
{
	pthread_t threads[8];
	uint64_t before, each;
	(void)state;
	fixture_archive(fixture_path("a.bpk"), NAMES, 4, 500);
	bp_archive *archive = opened(fixture_path("a.bpk"));
	before = bp_archive_bytes_read(archive);
	assert_null(read_everything(archive));
	each = bp_archive_bytes_read(archive) - before;
	for (int i = 0; i < 8; i++)
		assert_int_equal(pthread_create(&threads[i], NULL, read_everything, archive), 0);
	for (int i = 0; i < 8; i++) {
		void *failed;
		assert_int_equal(pthread_join(threads[i], &failed), 0);
		assert_null(failed);
	}
	assert_int_equal(bp_archive_bytes_read(archive), before + 9 * each); /* none is lost in counting */
	bp_archive_close(archive);
}

static void a_message_is_one_line_of_whole_characters_whatever_was_asked_for(void **state)
{
	const char *const names[] = {"alum"};
	char name[700] = "two\nlines\t\x1b[1m";
	bp_archive *archive = NULL;
	bp_error error;
	uint64_t index = 7;
	(void)state;
	fixture_archive(fixture_path("asked.bpk"), names, 1, 10);
	assert_int_equal(bp_archive_open(fixture_path("asked.bpk"), &archive, NULL), BP_OK);
	assert_int_equal(bp_archive_find(archive, name, &index, &error), BP_ERROR_NOT_FOUND);
	assert_string_equal(error.message, "there is no material \"two\\x0alines\\x09\\x1b[1m\"");
	for (int shift = 0; shift < 3; shift++) { /* characters of three bytes, cut at each of them */
		memset(name, 'x', 2);
		for (size_t n = (size_t)shift; n < 600; n += 3)
			memcpy(name + n, "\xe2\x82\xac", 4);
		assert_int_equal(bp_archive_find(archive, name, &index, &error), BP_ERROR_NOT_FOUND);
		const size_t bytes = strlen(error.message);
		assert_true(bytes < sizeof error.message && bytes > sizeof error.message - 8);
		assert_memory_equal(error.message + bytes - 3, "\xe2\x82\xac", 4);
	}
	assert_int_equal(index, 7);
	bp_archive_close(archive);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(an_archive_tells_its_materials_without_loading_them),
		cmocka_unit_test(a_record_is_read_whole_and_checked),
		cmocka_unit_test(what_is_not_an_archive_is_called_so),
		cmocka_unit_test(newer_versions_and_hostile_headers_are_told_apart),
		cmocka_unit_test(a_file_cut_while_open_gives_an_error),
		cmocka_unit_test(a_message_is_one_line_of_whole_characters_whatever_was_asked_for),
		cmocka_unit_test(eight_threads_read_through_one_handle),
		cmocka_unit_test(verify_names_each_damaged_material),
	};
	return cmocka_run_group_tests(tests, fixture_folder_make, fixture_folder_remove);
}
