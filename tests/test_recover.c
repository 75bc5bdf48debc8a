#include "archive_fixture.h"

#include "archive/recover.h"

enum { COUNT = 50, SECTION_BYTES = 4000, HOLE = 4096 };

static char names_text[COUNT][16];
static const char *names[COUNT];

static void archive_make(const char *path)
{
	for (int i = 0; i < COUNT; i++) {
		sprintf(names_text[i], "material-%02d", i);
		names[i] = names_text[i];
	}
	fixture_archive(path, names, COUNT, SECTION_BYTES);
}

static uint64_t random_state = 88172645463325252u;
static size_t random_below(size_t n)
{
	random_state ^= random_state << 13;
	random_state ^= random_state >> 7;
	random_state ^= random_state << 17;
	return (size_t)(random_state >> 16) % n;
}

static void count_loss(void *user, const char *material, const bp_error *why)
{
	assert_true(why->status == (material ? BP_ERROR_CORRUPT : BP_ERROR_NOT_FOUND));
	++*(unsigned *)user;
}

/* The materials of `path` are those of names[] that are not damaged, byte for byte. */
static void assert_saved(const char *path, const bool *damaged)
{
	bp_archive *archive = NULL;
	uint64_t at = 0;
	assert_int_equal(bp_archive_open(path, &archive, NULL), BP_OK);
	assert_int_equal(bp_archive_verify(archive, 0, NULL, NULL, NULL), BP_OK);
	for (int i = 0; i < COUNT; i++) {
		struct index_page leaf = {0};
		struct index_entry entry;
		struct record_head head;
		uint8_t *record, *expected;
		size_t bytes;
		if (damaged[i])
			continue;
		assert_int_equal(archive_entry(archive, at, &leaf, &entry, NULL), BP_OK);
		assert_string_equal(entry.name, names[i]);
		assert_int_equal(archive_entry_record(archive, &entry, &head, &record, NULL), BP_OK);
		expected = fixture_record(names[i], 2, SECTION_BYTES, &bytes);
		assert_memory_equal(record, expected, bytes);
		free(expected);
		free(record);
		at++;
	}
	assert_int_equal(bp_archive_count(archive), at);
	bp_archive_close(archive);
}

static void holes_cost_only_the_materials_they_hit(void **state)
{
	static const int holes[] = {0, 1, 10, 100};
	size_t bytes, record_bytes;
	uint8_t *file;
	(void)state;
	archive_make(fixture_path("whole.bpk"));
	free(fixture_record(names[0], 2, SECTION_BYTES, &record_bytes));
	for (size_t turn = 0; turn < 4 * sizeof holes / sizeof *holes; turn++) {
		bool damaged[COUNT] = {false};
		unsigned lost_told = 0, lost = 0;
		struct recovery recovery;
		bp_error error;
		file = fixture_file_read(fixture_path("whole.bpk"), &bytes);
		for (int h = 0; h < holes[turn / 4]; h++) {
			size_t at = random_below(bytes - HOLE);
			for (size_t i = at; i < at + HOLE; i++) {
				file[i] = turn % 2 ? 0 : (uint8_t)random_below(256);
				if (i >= ARCHIVE_HEADER_BYTES && i - ARCHIVE_HEADER_BYTES < COUNT * record_bytes)
					damaged[(i - ARCHIVE_HEADER_BYTES) / record_bytes] = true;
			}
		}
		for (int i = 0; i < COUNT; i++)
			lost += damaged[i];
		fixture_file_write(fixture_path("holes.bpk"), file, bytes);
		free(file);
		bp_status status =
			archive_recover(fixture_path("holes.bpk"), fixture_path("saved.bpk"), count_loss, &lost_told, &recovery, &error);
		if (lost == COUNT) {
			assert_int_equal(status, BP_ERROR_NOT_FOUND);
			continue;
		}
		assert_int_equal(status, BP_OK);
		assert_int_equal(recovery.saved, COUNT - lost);
		assert_true(recovery.lost <= lost);
		assert_true(recovery.lost >= lost_told);
		assert_saved(fixture_path("saved.bpk"), damaged);
	}
}

static void a_lost_header_and_index_do_not_matter(void **state)
{
	const bool damaged[COUNT] = {false};
	struct recovery recovery;
	size_t bytes;
	(void)state;
	archive_make(fixture_path("whole.bpk"));
	uint8_t *file = fixture_file_read(fixture_path("whole.bpk"), &bytes);
	memset(file, 0, ARCHIVE_HEADER_BYTES);
	fixture_file_write(fixture_path("headless.bpk"), file, bytes - PAGE_BYTES + 100);
	free(file);
	assert_int_equal(archive_recover(fixture_path("headless.bpk"), fixture_path("saved.bpk"), NULL, NULL, &recovery, NULL),
	                 BP_OK);
	assert_int_equal(recovery.saved, COUNT);
	assert_int_equal(recovery.lost, 0);
	assert_saved(fixture_path("saved.bpk"), damaged);
}

static void what_a_cut_took_with_its_name_is_counted_by_the_header(void **state)
{
	unsigned told = 0;
	struct recovery recovery;
	size_t bytes, record_bytes;
	uint8_t *file;
	(void)state;
	archive_make(fixture_path("whole.bpk"));
	free(fixture_record(names[0], 2, SECTION_BYTES, &record_bytes));
	file = fixture_file_read(fixture_path("whole.bpk"), &bytes);
	fixture_file_write(fixture_path("cut.bpk"), file, ARCHIVE_HEADER_BYTES + 3 * record_bytes - 1);
	assert_int_equal(archive_recover(fixture_path("cut.bpk"), fixture_path("saved.bpk"), count_loss, &told, &recovery, NULL),
	                 BP_OK);
	assert_int_equal(recovery.saved, 2);
	assert_int_equal(recovery.lost, COUNT - 2);
	assert_int_equal(told, 2);        /* the third by its name, all others at once */
	file[ARCHIVE_AT_FILE_BYTES] ^= 1; /* a header that is damaged tells nothing */
	fixture_file_write(fixture_path("cut.bpk"), file, ARCHIVE_HEADER_BYTES + 3 * record_bytes - 1);
	assert_int_equal(archive_recover(fixture_path("cut.bpk"), fixture_path("saved.bpk"), NULL, NULL, &recovery, NULL), BP_OK);
	assert_int_equal(recovery.lost, 1);
	free(file);
}

static void of_two_archives_in_one_file_each_material_is_saved_once(void **state)
{
	const bool damaged[COUNT] = {false};
	struct recovery recovery;
	size_t bytes;
	uint8_t *file, *twice;
	(void)state;
	archive_make(fixture_path("whole.bpk"));
	file = fixture_file_read(fixture_path("whole.bpk"), &bytes);
	twice = malloc(2 * bytes);
	memcpy(twice, file, bytes);
	memcpy(twice + bytes, file, bytes);
	for (unsigned bad = 0; bad < 2; bad++) { /* in the second turn one of the first archive's is damaged: the other one serves */
		unsigned told = 0;
		twice[ARCHIVE_HEADER_BYTES + bytes / 3] ^= (uint8_t)bad;
		fixture_file_write(fixture_path("twice.bpk"), twice, 2 * bytes);
		assert_int_equal(
			archive_recover(fixture_path("twice.bpk"), fixture_path("saved.bpk"), count_loss, &told, &recovery, NULL), BP_OK);
		assert_int_equal(told, COUNT - bad);
		assert_int_equal(recovery.saved, COUNT);
		assert_int_equal(recovery.lost, 0);
		assert_saved(fixture_path("saved.bpk"), damaged);
	}
	free(file);
	free(twice);
}

static void what_holds_no_record_is_refused_and_the_damaged_one_may_be_replaced(void **state)
{
	struct recovery recovery;
	(void)state;
	fixture_file_write(fixture_path("text"), "not an archive, and long enough to be looked at", 47);
	assert_int_equal(archive_recover(fixture_path("text"), fixture_path("none.bpk"), NULL, NULL, &recovery, NULL),
	                 BP_ERROR_NOT_FOUND);
	assert_int_equal(access(fixture_path("none.bpk"), F_OK), -1);
	fixture_file_write(fixture_path("text"), "", 0);
	assert_int_equal(archive_recover(fixture_path("text"), fixture_path("none.bpk"), NULL, NULL, &recovery, NULL),
	                 BP_ERROR_NOT_FOUND);
	assert_int_equal(archive_recover(fixture_path("missing"), fixture_path("none.bpk"), NULL, NULL, &recovery, NULL),
	                 BP_ERROR_IO);
	archive_make(fixture_path("whole.bpk"));
	assert_int_equal(archive_recover(fixture_path("whole.bpk"), fixture_path("whole.bpk"), NULL, NULL, &recovery, NULL), BP_OK);
	assert_int_equal(recovery.lost, 0);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(holes_cost_only_the_materials_they_hit),
		cmocka_unit_test(a_lost_header_and_index_do_not_matter),
		cmocka_unit_test(what_a_cut_took_with_its_name_is_counted_by_the_header),
		cmocka_unit_test(of_two_archives_in_one_file_each_material_is_saved_once),
		cmocka_unit_test(what_holds_no_record_is_refused_and_the_damaged_one_may_be_replaced),
	};
	return cmocka_run_group_tests(tests, fixture_folder_make, fixture_folder_remove);
}
