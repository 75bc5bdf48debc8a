/* The half that writes: packing from memory, the writer, reading what is in memory or comes through callbacks. */
#include "archive_fixture.h"

#include <float.h>
#include <pthread.h>

#include "held_archive.h"
#include "merl/merl_file.h"
#include "packed_fixture.h"

static const struct lattice_dims DIMS = {12, 10, 24};
enum { CELLS = 12 * 10 * 24 };

/* The same values in both numbers and layouts. */
struct tables {
	double planes[3 * CELLS], interleaved[3 * CELLS];
	float planes_f[3 * CELLS], interleaved_f[3 * CELLS];
};

static struct tables *tables_make(void)
{
	struct tables *t = malloc(sizeof *t);
	struct lattice lattice;
	glossy_lattice_make(DIMS, 1, &lattice);
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < CELLS; n++) {
			const float value = n % 7 == 3 ? -1 : (float)lattice.rgb[c][n];
			t->planes[n + (size_t)c * CELLS] = t->interleaved[3 * n + (size_t)c] = (double)value;
			t->planes_f[n + (size_t)c * CELLS] = t->interleaved_f[3 * n + (size_t)c] = value;
		}
	lattice_free(&lattice);
	return t;
}

static bp_measured measured_of(const void *values, bp_number number, bp_layout layout)
{
	return (bp_measured){.struct_bytes = sizeof(bp_measured),
	                     .theta_h = 12,
	                     .theta_d = 10,
	                     .phi_d = 24,
	                     .number = number,
	                     .layout = layout,
	                     .values = values};
}

struct packed {
	uint8_t *bytes;
	size_t count;
};

static struct packed pack(const bp_measured *measured, const char *name, const bp_pack_options *options)
{
	struct packed packed = {0};
	bp_error error;
	if (bp_pack(measured, name, options, &packed.bytes, &packed.count, &error))
		fail_msg("%s", error.message);
	return packed;
}

static void assert_same(struct packed a, struct packed b)
{
	assert_int_equal(a.count, b.count);
	assert_memory_equal(a.bytes, b.bytes, a.count);
}

static void all_layouts_and_numbers_give_the_record_of_the_lattice(void **state)
{
	struct tables *t = tables_make();
	const bp_measured ways[] = {measured_of(t->planes, BP_NUMBER_DOUBLE, BP_LAYOUT_PLANES),
	                            measured_of(t->interleaved, BP_NUMBER_DOUBLE, BP_LAYOUT_INTERLEAVED),
	                            measured_of(t->planes_f, BP_NUMBER_FLOAT, BP_LAYOUT_PLANES),
	                            measured_of(t->interleaved_f, BP_NUMBER_FLOAT, BP_LAYOUT_INTERLEAVED)};
	const struct fit_options options = {.profile = PROFILE_SPECTRAL, .budget_bytes = 60400, .effort = 5};
	const struct record_source source = {0};
	struct lattice lattice;
	struct packed expected = {0};
	(void)state;
	assert_int_equal(lattice_alloc(DIMS, &lattice, NULL), BP_OK);
	memcpy(lattice.rgb[0], t->planes, CELLS * sizeof(double));
	memcpy(lattice.rgb[1], t->planes + CELLS, CELLS * sizeof(double));
	memcpy(lattice.rgb[2], t->planes + 2 * CELLS, CELLS * sizeof(double));
	lattice_validate(&lattice);
	assert_int_equal(record_encode(&lattice, "a", &source, &options, &expected.bytes, &expected.count, NULL, NULL), BP_OK);
	for (int n = 0; n < 4; n++) {
		struct packed got = pack(&ways[n], "a", NULL);
		assert_same(got, expected);
		bp_free(got.bytes);
	}
	lattice_free(&lattice);
	free(expected.bytes);
	free(t);
}

static void a_mask_says_what_negative_values_say(void **state)
{
	struct tables *t = tables_make();
	uint8_t mask[CELLS];
	(void)state;
	struct packed expected = pack(
		&(bp_measured){.struct_bytes = sizeof(bp_measured), .theta_h = 12, .theta_d = 10, .phi_d = 24, .values = t->planes_f},
		"a", NULL);
	for (size_t n = 0; n < CELLS; n++) {
		mask[n] = n % 7 == 3 ? 0 : 9;
		for (size_t c = 0; c < 3 && !mask[n]; c++)
			t->planes_f[n + c * CELLS] = c == 1 ? NAN : 1e9f; /* what is masked is not looked at */
	}
	bp_measured masked = measured_of(t->planes_f, BP_NUMBER_FLOAT, BP_LAYOUT_PLANES);
	masked.mask = mask;
	struct packed got = pack(&masked, "a", NULL);
	assert_same(got, expected);
	bp_free(got.bytes);
	bp_free(expected.bytes);
	free(t);
}

/* 0 below the horizon in place of marks: the record is that of the mask, but for the word that says so and the head's checksum. */
static void zeros_below_the_horizon_are_holes(void **state)
{
	static const struct {
		uint32_t zeros;
		bool masked, same;
	} ways[] = {{BP_ZEROS_AUTO, true, true},
	            {BP_ZEROS_AUTO, false, true},
	            {BP_ZEROS_HOLES, false, true},
	            {BP_ZEROS_MEASURED, false, false}};
	struct tables *t = tables_make();
	uint8_t mask[CELLS];
	struct packed expected = {0};
	(void)state;
	lattice_below_horizon(DIMS, -0.01, mask);
	uint32_t holes = 0;
	for (size_t n = 0; n < CELLS; n++) {
		mask[n] = !mask[n];
		holes += !mask[n];
		for (size_t c = 0; c < 3; c++)
			t->planes[n + c * CELLS] = mask[n] ? fabs(t->planes[n + c * CELLS]) : 0;
	}
	assert_true(holes > 0);
	for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
		const bp_pack_options options = {.struct_bytes = sizeof options, .zeros = ways[w].zeros};
		bp_measured measured = measured_of(t->planes, BP_NUMBER_DOUBLE, BP_LAYOUT_PLANES);
		struct record_head head;
		measured.mask = ways[w].masked ? mask : NULL;
		struct packed got = pack(&measured, "a", &options);
		assert_int_equal(record_head_read(got.bytes, got.count, &head, NULL), BP_OK);
		assert_int_equal(head.source.hole_count, ways[w].same && !ways[w].masked ? holes : 0);
		assert_int_equal(head.options.zeros, ways[w].zeros);
		memset(got.bytes + 52, 0, 4);
		memset(got.bytes + head.head_bytes - 4, 0, 4);
		if (!w)
			expected = got;
		else if (ways[w].same)
			assert_same(got, expected);
		else
			assert_true(got.count != expected.count || memcmp(got.bytes, expected.bytes, got.count) != 0);
		if (w)
			bp_free(got.bytes);
	}
	bp_free(expected.bytes);
	free(t);
}

static void scale_and_source_are_those_of_a_measured_file(void **state)
{
	struct tables *t = tables_make();
	struct record_head head;
	(void)state;
	bp_measured measured = measured_of(t->planes, BP_NUMBER_DOUBLE, BP_LAYOUT_PLANES);
	struct packed plain = pack(&measured, "a", NULL);
	for (int c = 0; c < 3; c++) {
		measured.scale[c] = 0x1p-8;
		for (size_t n = 0; n < CELLS; n++)
			t->planes[n + (size_t)c * CELLS] *= 256;
	}
	struct packed scaled = pack(&measured, "a", NULL);
	assert_same(scaled, plain);
	measured.source_bytes = 34992012;
	measured.source_sha256[31] = 7;
	struct packed told = pack(&measured, "a", NULL);
	assert_int_equal(record_head_read(told.bytes, told.count, &head, NULL), BP_OK);
	assert_true(head.source.bytes == 34992012 && head.source.sha256[31] == 7 && head.source.nonfinite_count == 0);
	bp_free(plain.bytes);
	bp_free(scaled.bytes);
	bp_free(told.bytes);
	free(t);
}

/* A table that carries its record keeps it, name and all that `build` asks of it considered; changed, masked or as floats it does not. */
static void an_extracted_table_keeps_its_record(void **state)
{
	struct tables *t = tables_make();
	uint8_t mask[CELLS], below[CELLS];
	(void)state;
	lattice_below_horizon(DIMS, LATTICE_MERL_HORIZON, below);
	for (size_t n = 0; n < 3 * CELLS; n++)
		t->planes[n] = below[n % CELLS] ? -1 : fabs(t->planes[n]) + 0.1 * sin((double)n);
	bp_measured measured = measured_of(t->planes, BP_NUMBER_DOUBLE, BP_LAYOUT_PLANES);
	const bp_pack_options small = {.struct_bytes = sizeof small, .budget_bytes = 1500};
	struct packed first = pack(&measured, "a", &small), all = pack(&measured, "a", NULL);
	assert_true(all.count > first.count);
	/* what extract would write */
	struct record_head head;
	struct model *model;
	struct expansion table = {0};
	assert_int_equal(record_head_read(first.bytes, first.count, &head, NULL), BP_OK);
	assert_int_equal(record_decode_whole(&head, 0, first.bytes, &model, NULL), BP_OK);
	assert_int_equal(expansion_alloc(DIMS, &table, NULL), BP_OK);
	assert_int_equal(model_expand(model, 0, &table, NULL), BP_OK);
	lattice_below_horizon(DIMS, head.horizon_limit, below);
	assert_int_equal(lattice_write_path(fixture_path("a.binary"), OUTPUT_REPLACE, &table, below, first.bytes, first.count, NULL),
	                 BP_OK);
	size_t file_bytes;
	uint8_t *file = fixture_file_read(fixture_path("a.binary"), &file_bytes);
	assert_int_equal(file_bytes, 12 + sizeof t->planes);
	memcpy(t->planes, file + 12, sizeof t->planes);
	for (int c = 0; c < 3; c++)
		measured.scale[c] = MERL_SCALE[c];
	struct packed kept = pack(&measured, "a", NULL), renamed = pack(&measured, "other", NULL);
	assert_same(kept, first);
	assert_int_equal(renamed.count, first.count + 4);

	memset(mask, 1, sizeof mask);
	measured.mask = mask;
	struct packed masked = pack(&measured, "a", NULL);
	assert_true(masked.count != first.count);
	measured.mask = NULL;
	for (size_t n = 0; n < CELLS; n++)
		if (!below[n]) {
			t->planes[n] *= 1.0000001;
			break;
		}
	struct packed changed = pack(&measured, "a", NULL);
	assert_true(changed.count != first.count);
	struct packed *const all_of_them[] = {&first, &all, &kept, &renamed, &masked, &changed};
	for (size_t n = 0; n < sizeof all_of_them / sizeof *all_of_them; n++)
		bp_free(all_of_them[n]->bytes);
	model_free(model);
	expansion_free(&table);
	free(file);
	free(t);
}

static void options_are_those_of_build(void **state)
{
	struct tables *t = tables_make();
	struct record_head head;
	bp_error error;
	const bp_measured measured = measured_of(t->planes, BP_NUMBER_DOUBLE, BP_LAYOUT_PLANES);
	bp_pack_options options = {.struct_bytes = sizeof options, .profile = 1, .budget_bytes = 2000, .effort = 7};
	(void)state;
	struct packed got = pack(&measured, "a", &options);
	assert_int_equal(record_head_read(got.bytes, got.count, &head, NULL), BP_OK);
	assert_true(head.profile == PROFILE_PAPER && head.options.budget_bytes == 2000 && head.options.effort == 7 &&
	            got.count <= 2000);
	bp_free(got.bytes);
	options = (bp_pack_options){.struct_bytes = sizeof options, .max_error = 0.01};
	got = pack(&measured, "a", &options);
	assert_int_equal(record_head_read(got.bytes, got.count, &head, NULL), BP_OK);
	assert_true(head.options.max_error == 0.01 && head.layers[head.layer_count - 1].fidelity.log_rmse <= 0.01);
	bp_free(got.bytes);

	const bp_pack_options bad[] = {{.struct_bytes = 8},
	                               {.struct_bytes = sizeof options, .profile = 3},
	                               {.struct_bytes = sizeof options, .budget_bytes = 999},
	                               {.struct_bytes = sizeof options, .budget_bytes = 4000001},
	                               {.struct_bytes = sizeof options, .max_error = NAN},
	                               {.struct_bytes = sizeof options, .max_error = -1},
	                               {.struct_bytes = sizeof options, .max_error = 11},
	                               {.struct_bytes = sizeof options, .max_error = 0.1, .budget_bytes = 5000},
	                               {.struct_bytes = sizeof options, .zeros = 3},
	                               {.struct_bytes = sizeof options, .effort = 10}};
	for (size_t n = 0; n < sizeof bad / sizeof *bad; n++) {
		got = (struct packed){.count = 5};
		assert_int_equal(bp_pack(&measured, "a", &bad[n], &got.bytes, &got.count, &error), BP_ERROR_ARGUMENT);
		assert_true(!got.bytes && got.count == 5 && error.message[0]);
	}
	free(t);
}

static void bad_tables_are_refused(void **state)
{
	struct tables *t = tables_make();
	struct packed got = {0};
	uint8_t nothing[CELLS] = {0};
	bp_measured bad;
	(void)state;
	const bp_measured good = measured_of(t->planes, BP_NUMBER_DOUBLE, BP_LAYOUT_PLANES);
#define REFUSED(change, expected) \
	bad = good; \
	change; \
	assert_int_equal(bp_pack(&bad, "a", NULL, &got.bytes, &got.count, NULL), expected)
	REFUSED(bad.struct_bytes--, BP_ERROR_ARGUMENT);
	REFUSED(bad.theta_h = 3, BP_ERROR_LIMIT);
	REFUSED(bad.phi_d = 1025, BP_ERROR_LIMIT);
	REFUSED((bad.theta_h = bad.theta_d = bad.phi_d = 1024), BP_ERROR_LIMIT);
	REFUSED(bad.values = NULL, BP_ERROR_ARGUMENT);
	REFUSED(bad.number = BP_NUMBER_HALF, BP_ERROR_ARGUMENT);
	REFUSED(bad.number = (bp_number)9, BP_ERROR_ARGUMENT);
	REFUSED(bad.layout = (bp_layout)2, BP_ERROR_ARGUMENT);
	REFUSED(bad.scale[1] = -1, BP_ERROR_ARGUMENT);
	REFUSED(bad.scale[1] = NAN, BP_ERROR_ARGUMENT);
	REFUSED(bad.mask = nothing, BP_ERROR_BAD_INPUT);
	assert_int_equal(bp_pack(NULL, "a", NULL, &got.bytes, &got.count, NULL), BP_ERROR_ARGUMENT);
	assert_int_equal(bp_pack(&good, NULL, NULL, &got.bytes, &got.count, NULL), BP_ERROR_ARGUMENT);
	for (int n = 0; n < 4; n++)
		assert_int_equal(bp_pack(&good, (const char *const[]){"", "..", "a/b", "\xff"}[n], NULL, &got.bytes, &got.count, NULL),
		                 BP_ERROR_ARGUMENT);
	for (size_t n = 0; n < 3 * CELLS; n++)
		t->planes[n] = n % 2 ? NAN : INFINITY;
	assert_int_equal(bp_pack(&good, "a", NULL, &got.bytes, &got.count, NULL), BP_ERROR_BAD_INPUT);
	assert_null(got.bytes);
	free(t);
}

struct told {
	int calls, cancel_at;
	double last, most;
};

static int tell(void *user, double share)
{
	struct told *told = user;
	told->last = share;
	told->most = share > told->most ? share : told->most;
	return ++told->calls == told->cancel_at;
}

/* At every call in turn: nothing is left, which the sanitizers see to, and nothing is handed out. */
static void progress_is_told_and_any_call_may_cancel(void **state)
{
	struct tables *t = tables_make();
	const bp_measured measured = measured_of(t->planes, BP_NUMBER_DOUBLE, BP_LAYOUT_PLANES);
	(void)state;
	for (uint32_t profile = 1; profile <= 2; profile++)
		for (int bounded = 0; bounded < 2; bounded++) {
			struct told told = {0};
			bp_pack_options options = {.struct_bytes = sizeof options,
			                           .profile = profile,
			                           .max_error = bounded ? 0.3 : 0,
			                           .progress = tell,
			                           .user = &told};
			struct packed expected = pack(&measured, "a", &options);
			assert_true(told.calls >= 5 && told.most <= 1 && told.most >= 0.8);
			for (int at = 1, calls = told.calls, step = 1 + calls / 40; at <= calls; at += step) {
				struct packed got = {0};
				bp_error error;
				told = (struct told){.cancel_at = at};
				assert_int_equal(bp_pack(&measured, "a", &options, &got.bytes, &got.count, &error), BP_ERROR_CANCELLED);
				assert_true(told.calls == at && !got.bytes && error.status == BP_ERROR_CANCELLED);
			}
			options.progress = NULL;
			struct packed unwatched = pack(&measured, "a", &options);
			assert_same(unwatched, expected);
			bp_free(unwatched.bytes);
			bp_free(expected.bytes);
		}
	free(t);
}

struct packer {
	const bp_measured *measured;
	struct packed expected;
	int failed;
};

static void *packer_run(void *user)
{
	struct packer *packer = user;
	for (int n = 0; n < 3; n++) {
		struct packed got = {0};
		packer->failed |= bp_pack(packer->measured, "a", NULL, &got.bytes, &got.count, NULL) != BP_OK ||
		                  got.count != packer->expected.count || memcmp(got.bytes, packer->expected.bytes, got.count) != 0;
		bp_free(got.bytes);
	}
	return NULL;
}

static void several_threads_pack_at_once(void **state)
{
	struct tables *t = tables_make();
	const bp_measured measured = measured_of(t->planes, BP_NUMBER_DOUBLE, BP_LAYOUT_PLANES);
	struct packer packer[4];
	pthread_t thread[4];
	(void)state;
	struct packed expected = pack(&measured, "a", NULL);
	for (int n = 0; n < 4; n++) {
		packer[n] = (struct packer){&measured, expected, 0};
		assert_int_equal(pthread_create(&thread[n], NULL, packer_run, &packer[n]), 0);
	}
	for (int n = 0; n < 4; n++) {
		pthread_join(thread[n], NULL);
		assert_int_equal(packer[n].failed, 0);
	}
	bp_free(expected.bytes);
	free(t);
}

/* ---- the writer ---- */

static bp_writer *writer_of(const char *const *names, size_t count)
{
	bp_writer *writer = NULL;
	assert_int_equal(bp_writer_create(&writer, NULL), BP_OK);
	for (size_t n = 0; n < count; n++) {
		size_t bytes;
		uint8_t *record = fixture_record(names[n], 2, 300, &bytes);
		assert_int_equal(bp_writer_add(writer, record, bytes, NULL), BP_OK);
		free(record);
	}
	return writer;
}

static void records_in_any_order_make_the_archive_of_sorted_ones(void **state)
{
	static const char *const MIXED[] = {"nickel", "\xc3\xa9mail", "alum", "Zinc", "brass"}, *const SORTED[] = {"Zinc", "alum",
	                                                                                                           "brass", "nickel",
	                                                                                                           "\xc3\xa9mail"};
	size_t count, expected_count;
	uint8_t *bytes = NULL;
	(void)state;
	bp_writer *writer = writer_of(MIXED, 5);
	assert_int_equal(bp_writer_count(writer), 5);
	fixture_archive(fixture_path("sorted.bpk"), SORTED, 5, 300);
	uint8_t *expected = fixture_file_read(fixture_path("sorted.bpk"), &expected_count);
	assert_int_equal(bp_writer_save_memory(writer, &bytes, &count, NULL), BP_OK);
	assert_int_equal(count, expected_count);
	assert_memory_equal(bytes, expected, count);
	bp_free(bytes);
	/* the writer goes on, and what is there is replaced */
	assert_int_equal(bp_writer_save(writer, fixture_path("saved.bpk"), NULL), BP_OK);
	assert_int_equal(bp_writer_save(writer, fixture_path("saved.bpk"), NULL), BP_OK);
	bytes = fixture_file_read(fixture_path("saved.bpk"), &count);
	assert_int_equal(count, expected_count);
	assert_memory_equal(bytes, expected, count);
	free(bytes);
	free(expected);
	bp_writer_free(writer);
}

static void the_writer_refuses_and_stays_as_it_was(void **state)
{
	static const char *const NAMES[] = {"a", "b"};
	size_t bytes, count;
	uint8_t *memory = NULL;
	bp_archive *archive = NULL;
	bp_error error;
	(void)state;
	bp_writer *writer = writer_of(NAMES, 2);
	uint8_t *again = fixture_record("b", 2, 300, &bytes);
	assert_int_equal(bp_writer_add(writer, again, bytes, &error), BP_ERROR_ARGUMENT);
	assert_string_equal(error.message, "there is a material \"b\" already");
	assert_int_equal(bp_writer_add(writer, again, bytes - 1, NULL), BP_ERROR_CORRUPT);
	again[bytes - 1] ^= 1;
	assert_int_equal(bp_writer_add(writer, again, bytes, NULL), BP_ERROR_CHECKSUM);
	assert_int_equal(bp_writer_add(writer, NULL, 5, NULL), BP_ERROR_ARGUMENT);
	free(again);
	assert_int_equal(bp_writer_save(writer, fixture_path("no/such/folder.bpk"), &error), BP_ERROR_IO);
	assert_int_equal(bp_writer_save(writer, NULL, NULL), BP_ERROR_ARGUMENT);
	assert_int_equal(bp_writer_count(writer), 2);
	assert_int_equal(bp_writer_save_memory(writer, &memory, &count, NULL), BP_OK);
	assert_int_equal(bp_archive_open_memory(memory, count, &archive, NULL), BP_OK);
	assert_int_equal(bp_archive_verify(archive, 0, NULL, NULL, NULL), BP_OK);
	bp_archive_close(archive);
	bp_free(memory);
	bp_writer_free(writer);
	bp_writer_free(NULL);
	/* none at all is an archive too */
	assert_int_equal(bp_writer_create(&writer, NULL), BP_OK);
	assert_int_equal(bp_writer_save_memory(writer, &memory, &count, NULL), BP_OK);
	assert_int_equal(count, 64);
	bp_free(memory);
	bp_writer_free(writer);
}

/* ---- reading from elsewhere ---- */

struct served {
	const uint8_t *bytes;
	size_t count, reads;
	uint64_t fails_from;
	int closed;
};

static int served_read(void *user, uint64_t offset, void *bytes, size_t count)
{
	struct served *served = user;
	served->reads++;
	assert_true(count && offset <= served->count && count <= served->count - offset);
	if (offset + count > served->fails_from)
		return -5;
	memcpy(bytes, served->bytes + offset, count);
	return 0;
}

static void served_close(void *user) { ((struct served *)user)->closed++; }

static void memory_and_callbacks_give_what_the_file_gives(void **state)
{
	static const char *const NAMES[] = {"a", "b", "c"};
	uint64_t index;
	size_t count, record_bytes;
	uint8_t *record = NULL;
	bp_archive *archive[3] = {0};
	bp_error error;
	(void)state;
	fixture_archive(fixture_path("f.bpk"), NAMES, 3, 300);
	uint8_t *bytes = fixture_file_read(fixture_path("f.bpk"), &count);
	struct served served = {.bytes = bytes, .count = count, .fails_from = UINT64_MAX};
	bp_source source = {
		.struct_bytes = sizeof source, .read = served_read, .close = served_close, .user = &served, .bytes = count};
	assert_int_equal(bp_archive_open(fixture_path("f.bpk"), &archive[0], NULL), BP_OK);
	assert_int_equal(bp_archive_open_memory(bytes, count, &archive[1], NULL), BP_OK);
	assert_int_equal(bp_archive_open_source(&source, &archive[2], NULL), BP_OK);
	for (int n = 0; n < 3; n++) {
		size_t expected_bytes;
		uint8_t *expected = fixture_record("b", 2, 300, &expected_bytes);
		assert_int_equal(bp_archive_count(archive[n]), 3);
		assert_int_equal(bp_archive_find(archive[n], "b", &index, NULL), BP_OK);
		assert_int_equal(bp_archive_record(archive[n], index, &record, &record_bytes, NULL), BP_OK);
		assert_int_equal(record_bytes, expected_bytes);
		assert_memory_equal(record, expected, record_bytes);
		bp_free(record);
		free(expected);
		assert_int_equal(bp_archive_verify(archive[n], 0, NULL, NULL, NULL), BP_OK);
		assert_int_equal(bp_archive_bytes_read(archive[n]), bp_archive_bytes_read(archive[0]));
		assert_int_equal(bp_archive_record(archive[n], 3, &record, &record_bytes, NULL), BP_ERROR_NOT_FOUND);
	}
	served.fails_from = 100;
	assert_int_equal(bp_archive_record(archive[2], 1, &record, &record_bytes, &error), BP_ERROR_IO);
	for (int n = 0; n < 3; n++)
		bp_archive_close(archive[n]);
	assert_int_equal(served.closed, 1);

	/* where opening fails, what the caller has stays the caller's */
	bp_archive *none = NULL;
	served.fails_from = 10;
	assert_int_equal(bp_archive_open_source(&source, &none, &error), BP_ERROR_IO);
	served.fails_from = UINT64_MAX;
	source.bytes = 63;
	assert_true(bp_archive_open_source(&source, &none, NULL) != BP_OK);
	source.struct_bytes = 1;
	assert_int_equal(bp_archive_open_source(&source, &none, NULL), BP_ERROR_ARGUMENT);
	source = (bp_source){.struct_bytes = sizeof source, .bytes = count};
	assert_int_equal(bp_archive_open_source(&source, &none, NULL), BP_ERROR_ARGUMENT);
	assert_int_equal(bp_archive_open_memory(NULL, 5, &none, NULL), BP_ERROR_ARGUMENT);
	assert_true(served.closed == 1 && !none);
	/* cut at every byte */
	for (size_t cut = 0; cut < count; cut++)
		assert_true(bp_archive_open_memory(bytes, cut, &none, NULL) != BP_OK);
	free(bytes);
}

static void a_record_takes_another_name(void **state)
{
	size_t bytes, renamed_bytes, expected_bytes;
	uint8_t *record = fixture_record("a", 2, 300, &bytes), *renamed = NULL;
	struct record_head head;
	(void)state;
	assert_int_equal(bp_record_rename(record, bytes, "another", &renamed, &renamed_bytes, NULL), BP_OK);
	assert_int_equal(record_head_read(renamed, renamed_bytes, &head, NULL), BP_OK);
	assert_string_equal(head.name, "another");
	bp_free(renamed);
	expected_bytes = renamed_bytes;
	assert_int_equal(bp_record_rename(record, bytes, "a/b", &renamed, &renamed_bytes, NULL), BP_ERROR_ARGUMENT);
	record[bytes - 1] ^= 1;
	assert_int_equal(bp_record_rename(record, bytes, "b", &renamed, &renamed_bytes, NULL), BP_ERROR_CHECKSUM);
	assert_int_equal(renamed_bytes, expected_bytes);
	free(record);
}

static void version_and_numbers_agree(void **state)
{
	(void)state;
	assert_int_equal(bp_version(), BP_VERSION_NUMBER);
	assert_string_equal(bp_version_text(), BP_VERSION);
	assert_string_equal(bp_status_text(BP_ERROR_CANCELLED), "cancelled");
}

/* Beyond what a MERL file can say values are cut, so that their sums and ratios are numbers; what comes back is finite. */
static void values_at_the_end_of_the_range_are_cut(void **state)
{
	struct tables *t = tables_make();
	double *values = malloc(3 * CELLS * sizeof *values);
	(void)state;
	for (size_t n = 0; n < 3 * CELLS; n++)
		t->planes[n] = n % 5 ? DBL_MAX : 0x1p1014;
	for (uint32_t profile = PROFILE_PAPER; profile <= PROFILE_SPECTRAL; profile++) {
		const bp_measured measured = measured_of(t->planes, BP_NUMBER_DOUBLE, BP_LAYOUT_PLANES);
		const bp_pack_options options = {.struct_bytes = sizeof options, .profile = profile};
		const bp_table_options doubles = {.struct_bytes = sizeof doubles, .number = BP_NUMBER_DOUBLE, .continued = 1};
		struct packed packed = pack(&measured, "a", &options);
		struct held held = held_of(packed.bytes, packed.count);
		assert_int_equal(bp_archive_table(held.archive, 0, &doubles, values, 3 * CELLS * sizeof *values, NULL), BP_OK);
		for (size_t n = 0; n < 3 * CELLS; n++)
			assert_true(values[n] >= 0 && values[n] <= DBL_MAX);
		for (size_t n = 0; profile == PROFILE_SPECTRAL && n < 3 * CELLS; n++)
			assert_true(values[n] > 0x1p1009); /* more than about 2^1010 is not decoded */
		held_free(&held);
		bp_free(packed.bytes);
	}
	free(values);
	free(t);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(all_layouts_and_numbers_give_the_record_of_the_lattice),
		cmocka_unit_test(a_mask_says_what_negative_values_say),
		cmocka_unit_test(zeros_below_the_horizon_are_holes),
		cmocka_unit_test(scale_and_source_are_those_of_a_measured_file),
		cmocka_unit_test(an_extracted_table_keeps_its_record),
		cmocka_unit_test(options_are_those_of_build),
		cmocka_unit_test(bad_tables_are_refused),
		cmocka_unit_test(progress_is_told_and_any_call_may_cancel),
		cmocka_unit_test(several_threads_pack_at_once),
		cmocka_unit_test(records_in_any_order_make_the_archive_of_sorted_ones),
		cmocka_unit_test(the_writer_refuses_and_stays_as_it_was),
		cmocka_unit_test(memory_and_callbacks_give_what_the_file_gives),
		cmocka_unit_test(a_record_takes_another_name),
		cmocka_unit_test(values_at_the_end_of_the_range_are_cut),
		cmocka_unit_test(version_and_numbers_agree),
	};
	return cmocka_run_group_tests(tests, fixture_folder_make, fixture_folder_remove);
}
