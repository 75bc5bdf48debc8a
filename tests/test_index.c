#include "archive_fixture.h"

/* A record of the least size, patched for each name: a million of them take seconds only. */
static void archive_of_many(const char *path, uint32_t count, void name_of(uint32_t i, char *name))
{
	struct archive_writer *writer = NULL;
	assert_int_equal(archive_writer_open(path, &writer, NULL), BP_OK);
	for (uint32_t i = 0; i < count; i++) {
		struct section_list sections = {0};
		struct record_head head;
		uint8_t *record;
		size_t bytes;
		char name[256];
		name_of(i, name);
		fixture_head(&head, name);
		head.layer_count = 1;
		assert_int_equal(sections_join(&head, &sections, &record, &bytes, NULL), BP_OK);
		assert_int_equal(archive_writer_add(writer, record, bytes, NULL), BP_OK);
		free(record);
	}
	assert_int_equal(archive_writer_commit(writer, NULL), BP_OK);
}

static void short_name(uint32_t i, char *name) { sprintf(name, "m%07u", i); }

/* 255 bytes, different at the end only: the fewest entries per page. */
static void long_name(uint32_t i, char *name)
{
	memset(name, 'x', 255);
	sprintf(name + 247, "%08u", i);
}

static void a_million_materials_cost_at_most_64_KiB_to_open_and_find(void **state)
{
	const char *path = fixture_path("million.bpk");
	const uint32_t count = 1000000;
	(void)state;
	archive_of_many(path, count, short_name);
	for (uint32_t probe = 0; probe < count; probe = probe * 3 + 1) {
		bp_archive *archive = NULL;
		char name[256], found_name[256];
		uint64_t found;
		short_name(probe, name);
		assert_int_equal(bp_archive_open(path, &archive, NULL), BP_OK);
		assert_int_equal(bp_archive_count(archive), count);
		assert_int_equal(bp_archive_find(archive, name, &found, NULL), BP_OK);
		assert_int_equal(found, probe);
		assert_true(bp_archive_bytes_read(archive) <= 3 * 4096 + 64);
		assert_int_equal(bp_archive_name(archive, probe, found_name, NULL), BP_OK);
		assert_string_equal(found_name, name);
		assert_int_equal(bp_archive_find(archive, strcat(name, "0"), &found, NULL), BP_ERROR_NOT_FOUND);
		bp_archive_close(archive);
	}
	unlink(path);
}

static void the_longest_names_stay_below_64_KiB(void **state)
{
	const char *path = fixture_path("long.bpk");
	const uint32_t count = 60000;
	bp_archive *archive = NULL;
	char name[256];
	uint64_t found;
	(void)state;
	archive_of_many(path, count, long_name);
	assert_int_equal(bp_archive_open(path, &archive, NULL), BP_OK);
	assert_int_equal(archive_header(archive)->depth,
	                 5); /* 15 entries a page: 15^4 < 60000 <= 15^5, and 15^5 < 1,000,000 <= 15^6 */
	for (uint32_t i = 0; i < count; i += 997) {
		uint64_t before = bp_archive_bytes_read(archive);
		name[255] = 0;
		long_name(i, name);
		assert_int_equal(bp_archive_find(archive, name, &found, NULL), BP_OK);
		assert_int_equal(found, i);
		assert_int_equal(bp_archive_bytes_read(archive) - before, 4 * 4096);
	}
	bp_archive_close(archive);
	unlink(path);
}

static void a_walk_over_all_materials_reads_every_page_about_once(void **state)
{
	const char *path = fixture_path("walk.bpk");
	const uint32_t count = 20000;
	bp_archive *archive = NULL;
	struct index_page leaf = {0};
	(void)state;
	archive_of_many(path, count, short_name);
	assert_int_equal(bp_archive_open(path, &archive, NULL), BP_OK);
	for (uint32_t i = 0; i < count; i++) {
		struct index_entry entry;
		char name[256];
		short_name(i, name);
		assert_int_equal(archive_entry(archive, i, &leaf, &entry, NULL), BP_OK);
		assert_string_equal(entry.name, name);
		assert_int_equal(entry.ordinal, i);
	}
	assert_true(bp_archive_bytes_read(archive) <= 64 + 4096 * (uint64_t)archive_header(archive)->page_count);
	bp_archive_close(archive);
	unlink(path);
}

static void names_before_between_and_behind_all_are_not_found(void **state)
{
	static const char *const names[] = {"b", "d", "f"};
	static const char *const missing[] = {"a", "bb", "c", "e", "g", "", "B", "\xFF"};
	bp_archive *archive = NULL;
	uint64_t found = 77;
	char name[256];
	(void)state;
	fixture_archive(fixture_path("three.bpk"), names, 3, 4);
	assert_int_equal(bp_archive_open(fixture_path("three.bpk"), &archive, NULL), BP_OK);
	for (size_t i = 0; i < sizeof missing / sizeof *missing; i++)
		assert_int_equal(bp_archive_find(archive, missing[i], &found, NULL), BP_ERROR_NOT_FOUND);
	assert_int_equal(found, 77);
	for (uint64_t i = 0; i < 3; i++) {
		assert_int_equal(bp_archive_find(archive, names[i], &found, NULL), BP_OK);
		assert_int_equal(found, i);
	}
	assert_int_equal(bp_archive_name(archive, 3, name, NULL), BP_ERROR_NOT_FOUND);
	assert_int_equal(bp_archive_name(archive, UINT64_MAX, name, NULL), BP_ERROR_NOT_FOUND);
	bp_archive_close(archive);
}

static void an_empty_archive_is_legal_and_holds_nothing(void **state)
{
	bp_archive *archive = NULL;
	uint64_t found;
	char name[256];
	(void)state;
	fixture_archive(fixture_path("empty.bpk"), NULL, 0, 0);
	assert_int_equal(bp_archive_open(fixture_path("empty.bpk"), &archive, NULL), BP_OK);
	assert_int_equal(bp_archive_count(archive), 0);
	assert_int_equal(bp_archive_find(archive, "a", &found, NULL), BP_ERROR_NOT_FOUND);
	assert_int_equal(bp_archive_name(archive, 0, name, NULL), BP_ERROR_NOT_FOUND);
	bp_archive_close(archive);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_million_materials_cost_at_most_64_KiB_to_open_and_find),
		cmocka_unit_test(the_longest_names_stay_below_64_KiB),
		cmocka_unit_test(a_walk_over_all_materials_reads_every_page_about_once),
		cmocka_unit_test(names_before_between_and_behind_all_are_not_found),
		cmocka_unit_test(an_empty_archive_is_legal_and_holds_nothing),
	};
	return cmocka_run_group_tests(tests, fixture_folder_make, fixture_folder_remove);
}
