/* Subset, merge and reuse copy records as they are, in name order, all or nothing. */
#include "archive_fixture.h"

#include "archive/merge.h"
#include "name.h"
#include "codec/profile_codec.h"

static bp_archive *opened(const char *name)
{
	bp_archive *archive = NULL;
	bp_error error;
	if (bp_archive_open(fixture_path(name), &archive, &error))
		fail_msg("%s: %s", name, error.message);
	return archive;
}

/* The whole record of a material, and its length. */
static uint8_t *record_of(const bp_archive *archive, const char *name, struct record_head *head)
{
	struct index_page leaf;
	struct index_entry entry;
	uint8_t *record = NULL;
	uint64_t index;
	leaf.count = 0;
	assert_int_equal(bp_archive_find(archive, name, &index, NULL), BP_OK);
	assert_int_equal(archive_entry(archive, index, &leaf, &entry, NULL), BP_OK);
	assert_int_equal(archive_entry_record(archive, &entry, head, &record, NULL), BP_OK);
	return record;
}

static void same_record(const bp_archive *from, const bp_archive *to, const char *name)
{
	struct record_head want, got;
	uint8_t *a = record_of(from, name, &want), *b = record_of(to, name, &got);
	assert_int_equal(want.record_bytes, got.record_bytes);
	assert_memory_equal(a, b, want.record_bytes);
	free(a);
	free(b);
}

static int archives_make(void **state)
{
	const char *const a[] = {"alum", "chrome", "delrin", "nickel"}, *const b[] = {"brass", "zinc"},
					  *const c[] = {"chrome", "tin"};
	if (fixture_folder_make(state))
		return -1;
	fixture_archive(fixture_path("a.bpk"), a, 4, 1000);
	fixture_archive(fixture_path("b.bpk"), b, 2, 500);
	fixture_archive(fixture_path("c.bpk"), c, 2, 100);
	return 0;
}

static void a_subset_has_the_chosen_records_byte_for_byte(void **state)
{
	(void)state;
	bp_archive *from = opened("a.bpk"), *to;
	const uint64_t index[] = {1, 3};
	struct copy_options options = {.output = fixture_path("subset.bpk")};
	struct copy_totals totals;
	char name[BP_NAME_BYTES_MAX + 1];
	assert_int_equal(archive_subset(from, index, 2, &options, &totals, NULL), BP_OK);
	assert_true(totals.copied == 2 && totals.trimmed == 0 && totals.bytes_from == totals.bytes_to);
	to = opened("subset.bpk");
	assert_int_equal(bp_archive_count(to), 2);
	assert_int_equal(bp_archive_name(to, 0, name, NULL), BP_OK);
	assert_string_equal(name, "chrome");
	for (int n = 0; n < 2; n++)
		same_record(from, to, n ? "nickel" : "chrome");
	assert_int_equal(bp_archive_verify(to, 0, NULL, NULL, NULL), BP_OK);
	bp_archive_close(to);
	bp_archive_close(from);
}

static void a_largest_error_drops_the_layers_it_does_not_need(void **state)
{
	(void)state;
	/* the fixture's layers have log RMSE 0.375 and 0.1875 of what can be seen */
	const double errors[] = {0, 1, 0.5, 0.375, 0.25, 0.01}; /* as much as the first has is enough */
	const uint32_t layers[] = {2, 1, 1, 1, 2, 2};
	bp_archive *from = opened("a.bpk");
	for (int n = 0; n < 6; n++) {
		struct copy_options options = {.output = fixture_path("trimmed.bpk"), .max_log_rmse = errors[n]};
		struct copy_totals totals;
		struct record_head whole, head;
		assert_int_equal(archive_subset(from, NULL, 4, &options, &totals, NULL), BP_OK);
		assert_true(totals.copied == 4 && totals.trimmed == (layers[n] == 1 ? 4u : 0u));
		bp_archive *to = opened("trimmed.bpk");
		uint8_t *a = record_of(from, "delrin", &whole), *b = record_of(to, "delrin", &head);
		assert_int_equal(head.layer_count, layers[n]);
		assert_int_equal(head.section_count, 2 * layers[n]);
		for (uint32_t s = 0; s < head.section_count; s++)
			assert_memory_equal(a + whole.sections[s].offset, b + head.sections[s].offset, head.sections[s].bytes);
		assert_true(layers[n] == 1 ? totals.bytes_to < totals.bytes_from : totals.bytes_to == totals.bytes_from);
		assert_int_equal(bp_archive_verify(to, 0, NULL, NULL, NULL), BP_OK);
		free(a);
		free(b);
		bp_archive_close(to);
	}
	bp_archive_close(from);
}

static void a_merge_has_all_records_in_name_order_whatever_the_inputs_order(void **state)
{
	(void)state;
	const char *const names[] = {"alum", "brass", "chrome", "delrin", "nickel", "zinc"};
	bp_archive *a = opened("a.bpk"), *b = opened("b.bpk");
	size_t bytes[2], failed;
	uint8_t *file[2];
	for (int swap = 0; swap < 2; swap++) {
		const struct bp_archive *const inputs[] = {swap ? b : a, swap ? a : b};
		struct copy_options options = {.output = fixture_path("merged.bpk")};
		struct copy_totals totals;
		assert_int_equal(archive_merge(inputs, 2, &options, &totals, &failed, NULL), BP_OK);
		assert_true(totals.copied == 6 && totals.replaced == 0);
		file[swap] = fixture_file_read(fixture_path("merged.bpk"), &bytes[swap]);
	}
	assert_int_equal(bytes[0], bytes[1]);
	assert_memory_equal(file[0], file[1], bytes[0]);
	free(file[0]);
	free(file[1]);
	bp_archive *merged = opened("merged.bpk");
	for (uint64_t n = 0; n < 6; n++) {
		char name[BP_NAME_BYTES_MAX + 1];
		assert_int_equal(bp_archive_name(merged, n, name, NULL), BP_OK);
		assert_string_equal(name, names[n]);
		same_record(n == 1 || n == 5 ? b : a, merged, name);
	}
	bp_archive_close(merged);
	bp_archive_close(a);
	bp_archive_close(b);
}

/* An archive of one record whose head says something else: `what` 0 nothing, 1.. one of what shards have in common. */
static void other_archive_make(const char *path, const char *name, int what)
{
	struct archive_writer *writer = NULL;
	struct byte_buffer head_bytes = {0};
	struct record_head head;
	size_t bytes;
	uint8_t *record = fixture_record(name, 2, 100, &bytes);
	assert_int_equal(record_head_read(record, bytes, &head, NULL), BP_OK);
	head.profile = what == 1 ? PROFILE_SPECTRAL : head.profile;
	head.codec_version += what == 2;
	head.options.budget_bytes += what == 3;
	head.options.max_error = what == 4 ? 0.01 : head.options.max_error;
	head.options.effort += what == 5;
	head.options.zeros = what == 6 ? ZEROS_MEASURED : head.options.zeros;
	record_head_write(&head, &head_bytes);
	assert_int_equal(head_bytes.count, head.head_bytes);
	memcpy(record, head_bytes.bytes, head_bytes.count);
	assert_int_equal(archive_writer_open(path, &writer, NULL), BP_OK);
	assert_int_equal(archive_writer_add(writer, record, bytes, NULL), BP_OK);
	assert_int_equal(archive_writer_commit(writer, NULL), BP_OK);
	byte_buffer_free(&head_bytes);
	free(record);
}

static void shards_of_one_build_are_alike_in_all_that_was_asked_for(void **state)
{
	static const char *const WORDS[] = {NULL,     "profile",       "codec version", "budget", "bound of the error",
	                                    "effort", "rule for zeros"};
	(void)state;
	/* names of two different shards of two */
	const char *const first = name_shard("alum", 2) != name_shard("tin", 2) ? "alum" : "brass";
	assert_int_not_equal(name_shard(first, 2), name_shard("tin", 2));
	other_archive_make(fixture_path("e.bpk"), first, 0);
	for (int what = 0; what < 7; what++) {
		other_archive_make(fixture_path("d.bpk"), "tin", what);
		bp_archive *a = opened("e.bpk"), *d = opened("d.bpk");
		const struct bp_archive *const inputs[] = {a, d};
		struct copy_options options = {.output = fixture_path("alike.bpk"), .shards = 2};
		struct copy_totals totals;
		bp_error error;
		size_t failed;
		assert_int_equal(archive_merge(inputs, 2, &options, &totals, &failed, &error), what ? BP_ERROR_BAD_INPUT : BP_OK);
		assert_true(!what || (failed == 1 && strstr(error.message, WORDS[what]) && strstr(error.message, first)));
		options.shards = 0;
		assert_int_equal(archive_merge(inputs, 2, &options, &totals, &failed, &error), BP_OK);
		bp_archive_close(a);
		bp_archive_close(d);
	}
}

static void a_double_name_is_refused_or_replaced_by_the_last(void **state)
{
	(void)state;
	bp_archive *a = opened("a.bpk"), *c = opened("c.bpk");
	const struct bp_archive *const inputs[] = {a, c};
	struct copy_options options = {.output = fixture_path("double.bpk")};
	struct copy_totals totals;
	bp_error error;
	size_t failed;
	assert_int_equal(archive_merge(inputs, 2, &options, &totals, &failed, &error), BP_ERROR_BAD_INPUT);
	assert_int_equal(failed, 1);
	assert_non_null(strstr(error.message, "a.bpk"));
	assert_int_equal(access(fixture_path("double.bpk"), F_OK), -1);
	options.replace = true;
	assert_int_equal(archive_merge(inputs, 2, &options, &totals, &failed, &error), BP_OK);
	assert_true(totals.copied == 5 && totals.replaced == 1);
	bp_archive *merged = opened("double.bpk");
	same_record(c, merged, "chrome");
	bp_archive_close(merged);
	bp_archive_close(a);
	bp_archive_close(c);
}

static void an_output_may_be_one_of_the_inputs(void **state)
{
	(void)state;
	const char *const names[] = {"iron"};
	fixture_archive(fixture_path("grow.bpk"), names, 1, 10);
	bp_archive *grow = opened("grow.bpk"), *b = opened("b.bpk");
	const struct bp_archive *const inputs[] = {grow, b};
	struct copy_options options = {.output = fixture_path("grow.bpk")};
	struct copy_totals totals;
	size_t failed;
	assert_int_equal(archive_merge(inputs, 2, &options, &totals, &failed, NULL), BP_OK);
	bp_archive_close(grow);
	bp_archive_close(b);
	grow = opened("grow.bpk");
	assert_int_equal(bp_archive_count(grow), 3);
	bp_archive_close(grow);
}

static bool stop_at_once(void) { return true; }

static void stopping_and_damage_leave_nothing_behind(void **state)
{
	(void)state;
	size_t count;
	uint8_t *bytes = fixture_file_read(fixture_path("a.bpk"), &count);
	bp_archive *from = opened("a.bpk");
	struct copy_options options = {.output = fixture_path("none.bpk"), .stop = stop_at_once};
	struct copy_totals totals;
	bp_material_info info = {.struct_bytes = sizeof info};
	bp_error error;
	assert_int_equal(archive_subset(from, NULL, 4, &options, &totals, &error), BP_OK);
	assert_true(totals.stopped);
	assert_int_equal(access(fixture_path("none.bpk"), F_OK), -1);
	assert_int_equal(archive_subset(from, NULL, 0, &options, &totals, &error), BP_ERROR_ARGUMENT);

	assert_int_equal(bp_archive_info(from, 2, &info, NULL), BP_OK);
	bp_archive_close(from);
	bytes[info.record_offset + info.record_bytes - 5] ^= 4;
	fixture_file_write(fixture_path("bad.bpk"), bytes, count);
	from = opened("bad.bpk");
	options.stop = NULL;
	assert_int_equal(archive_subset(from, NULL, 4, &options, &totals, &error), BP_ERROR_CHECKSUM);
	assert_true(error.offset >= info.record_offset && error.offset < info.record_offset + info.record_bytes);
	assert_int_equal(access(fixture_path("none.bpk"), F_OK), -1);
	bp_archive_close(from);
	free(bytes);
}

/* An archive of one record as today's encoder of the paper's profile heads it. */
static void current_archive(const char *name, const char *path)
{
	enum { AT_HEAD_BYTES = 8, AT_CODEC_VERSION = 20 };
	struct archive_writer *writer = NULL;
	size_t bytes;
	uint8_t *record = fixture_record(name, 2, 200, &bytes);
	const uint32_t head_bytes = load_u32(record + AT_HEAD_BYTES);
	store_u32(record + AT_CODEC_VERSION, profile_codec_find(PROFILE_PAPER)->version);
	store_u32(record + head_bytes - 4, bytes_crc32(record, head_bytes - 4));
	assert_int_equal(archive_writer_open(path, &writer, NULL), BP_OK);
	assert_int_equal(archive_writer_add(writer, record, bytes, NULL), BP_OK);
	assert_int_equal(archive_writer_commit(writer, NULL), BP_OK);
	free(record);
}

static void a_record_is_reused_when_source_options_and_codec_are_the_same(void **state)
{
	(void)state;
	current_archive("delrin", fixture_path("current.bpk"));
	bp_archive *current = opened("current.bpk"), *older = opened("a.bpk");
	struct record_head head, now;
	uint8_t *want = record_of(current, "delrin", &head), *got = NULL;
	size_t bytes = 0;
	assert_int_equal(archive_reuse(current, "delrin", &head.source, &head.options, &got, &bytes, NULL), BP_OK);
	assert_non_null(got);
	assert_int_equal(bytes, head.record_bytes);
	assert_memory_equal(got, want, bytes);
	free(got);
	for (int n = 0; n < 6; n++) {
		now = head;
		if (n == 0)
			now.source.sha256[31] ^= 1;
		if (n == 1)
			now.source.bytes++;
		if (n == 2)
			now.options.budget_bytes++;
		if (n == 3)
			now.options.effort++;
		if (n == 4)
			now.options.max_error = 0.5;
		if (n == 5)
			now.options.profile = PROFILE_SPECTRAL;
		assert_int_equal(archive_reuse(current, "delrin", &now.source, &now.options, &got, &bytes, NULL), BP_OK);
		assert_null(got);
	}
	assert_int_equal(archive_reuse(current, "not-there", &head.source, &head.options, &got, &bytes, NULL), BP_OK);
	assert_null(got);
	assert_int_equal(archive_reuse(older, "delrin", &head.source, &head.options, &got, &bytes, NULL), BP_OK);
	assert_null(got);
	free(want);
	bp_archive_close(older);
	bp_archive_close(current);
}

static void a_record_that_lost_layers_is_not_reused(void **state)
{
	(void)state;
	current_archive("delrin", fixture_path("whole.bpk"));
	bp_archive *whole = opened("whole.bpk");
	struct copy_options options = {.output = fixture_path("lost.bpk"), .max_log_rmse = 0.5};
	struct copy_totals totals;
	struct record_head head;
	uint8_t *record = record_of(whole, "delrin", &head), *got = NULL;
	size_t bytes = 0;
	assert_int_equal(archive_subset(whole, NULL, 1, &options, &totals, NULL), BP_OK);
	assert_true(totals.trimmed == 1);
	bp_archive *lost = opened("lost.bpk");
	assert_int_equal(archive_reuse(lost, "delrin", &head.source, &head.options, &got, &bytes, NULL), BP_OK);
	assert_null(got);
	free(record);
	bp_archive_close(lost);
	bp_archive_close(whole);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_subset_has_the_chosen_records_byte_for_byte),
		cmocka_unit_test(a_largest_error_drops_the_layers_it_does_not_need),
		cmocka_unit_test(a_merge_has_all_records_in_name_order_whatever_the_inputs_order),
		cmocka_unit_test(shards_of_one_build_are_alike_in_all_that_was_asked_for),
		cmocka_unit_test(a_double_name_is_refused_or_replaced_by_the_last),
		cmocka_unit_test(an_output_may_be_one_of_the_inputs),
		cmocka_unit_test(stopping_and_damage_leave_nothing_behind),
		cmocka_unit_test(a_record_is_reused_when_source_options_and_codec_are_the_same),
		cmocka_unit_test(a_record_that_lost_layers_is_not_reused),
	};
	return cmocka_run_group_tests(tests, archives_make, fixture_folder_remove);
}
