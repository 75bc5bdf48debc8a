/*
 * What build is given -> materials. Every case is a folder with files made here, containers by libarchive.
 */
#include <archive.h>
#include <archive_entry.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "merl/container_fault.h"
#include "merl/source.h"
#include "merl/source_kind.h"
#include "scratch.h"
#include "words.h"

static char folder[SCRATCH_BYTES];

/* A path in the test's folder; the last eight stay valid. */
static const char *in(const char *name) { return scratch_in(folder, name); }

static void put(const char *name, const void *bytes, size_t count)
{
	FILE *file = fopen(in(name), "wb");
	assert_non_null(file);
	assert_int_equal(fwrite(bytes, 1, count, file), count);
	fclose(file);
}

static void put_text(const char *name, const char *text) { put(name, text, strlen(text)); }

/* Everything that was noticed, one line each: kind, path below the folder, reason. */
static char noticed[4096];

static void take_note(void *user, enum source_notice kind, const char *path, const char *reason)
{
	(void)user;
	const size_t used = strlen(noticed), root = strlen(folder) + 1;
	snprintf(noticed + used, sizeof noticed - used, "%s %s: %s\n", kind == SOURCE_SKIPPED ? "skipped" : "damaged",
	         strlen(path) > root && !strncmp(path, folder, root - 1) ? path + root : path, reason);
}

static const struct source_options watched = {.notice = take_note};

/* The names of all items, each followed by a blank. */
static const char *names_of(const struct source_list *list)
{
	static char names[1024];
	names[0] = '\0';
	for (size_t n = 0; n < list->item_count; n++) {
		strcat(names, list->items[n].name);
		strcat(names, " ");
	}
	return names;
}

static struct source_list scan(const char *name)
{
	struct source_list list;
	bp_error error;
	const char *inputs[] = {in(name)};
	noticed[0] = '\0';
	if (source_scan(inputs, 1, &watched, &list, &error) != BP_OK)
		fail_msg("%s", error.message);
	return list;
}

static bp_error scan_fails(const char *name, bp_status expected)
{
	struct source_list list;
	bp_error error = {0};
	const char *inputs[] = {in(name)};
	noticed[0] = '\0';
	assert_int_equal(source_scan(inputs, 1, &watched, &list, &error), expected);
	return error;
}

/* --- containers --- */

struct pack {
	struct archive *archive;
};

static struct pack pack_open(const char *name, int format, int filter, const char *options)
{
	struct pack pack = {archive_write_new()};
	assert_int_equal(archive_write_set_format(pack.archive, format), ARCHIVE_OK);
	assert_true(filter == ARCHIVE_FILTER_NONE || archive_write_add_filter(pack.archive, filter) == ARCHIVE_OK);
	if (options)
		assert_int_equal(archive_write_set_options(pack.archive, options), ARCHIVE_OK);
	assert_int_equal(archive_write_open_filename(pack.archive, in(name)), ARCHIVE_OK);
	return pack;
}

static void pack_add(struct pack *pack, const char *path, const void *bytes, size_t count)
{
	struct archive_entry *entry = archive_entry_new();
	archive_entry_set_pathname(entry, path);
	archive_entry_set_filetype(entry, path[strlen(path) - 1] == '/' ? AE_IFDIR : AE_IFREG);
	archive_entry_set_perm(entry, 0644);
	archive_entry_set_size(entry, (la_int64_t)count);
	assert_in_range(archive_write_header(pack->archive, entry) + 100, ARCHIVE_WARN + 100, 100);
	assert_int_equal(archive_write_data(pack->archive, bytes, count), count);
	archive_entry_free(entry);
}

static void pack_text(struct pack *pack, const char *path, const char *text) { pack_add(pack, path, text, strlen(text)); }

static void pack_close(struct pack *pack)
{
	assert_int_equal(archive_write_close(pack->archive), ARCHIVE_OK);
	archive_write_free(pack->archive);
}

static void pack_usual(const char *name, int format, int filter)
{
	struct pack pack = pack_open(name, format, filter, NULL);
	pack_text(&pack, "brdfs/", "");
	pack_text(&pack, "brdfs/nickel.binary", "table of nickel");
	pack_text(&pack, "brdfs/README.txt", "not a table");
	pack_text(&pack, "brdfs/._nickel.binary", "what a Mac adds");
	pack_text(&pack, "../../alum-bronze.binary", "table of bronze");
	pack_text(&pack, "/etc/delrin.BINARY", "table of delrin");
	pack_close(&pack);
}

static const char *content_of(struct container *container)
{
	static char text[64];
	size_t count = 0, once;
	do {
		assert_int_equal(container_read(container, text + count, 3, &once, NULL), BP_OK);
		count += once;
	} while (once);
	text[count] = '\0';
	return text;
}

/* --- tests --- */

static void the_stem_is_the_name(void **state)
{
	(void)state;
	static const char *const cases[][2] = {
		{"a/b/nickel.binary", "nickel"},
		{"nickel", "nickel"},
		{"a.b/nickel", "nickel"},
		{"nickel.v2.binary", "nickel.v2"},
		{"nickel.binary.gz", "nickel"},
		{"../../etc/passwd", "passwd"},
		{"x.dat", "x"},
		{".binary", ".binary"},
	};
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		char stem[SOURCE_STEM_BYTES];
		source_stem(cases[n][0], stem);
		assert_string_equal(stem, cases[n][1]);
	}
}

static void a_folder_is_searched_to_the_bottom_in_name_order(void **state)
{
	(void)state;
	mkdir(in("a"), 0700);
	mkdir(in("a/deep"), 0700);
	mkdir(in("a/deep/deeper"), 0700);
	put_text("a/zinc.binary", "12345");
	put_text("a/deep/deeper/brass.BINARY", "");
	put_text("a/deep/nickel.binary", "");
	put_text("a/notes.txt", "");
	put_text("a/.hidden.binary", "");
	struct source_list list = scan("a");
	assert_string_equal(names_of(&list), "brass nickel zinc ");
	assert_string_equal(list.items[2].path, in("a/zinc.binary"));
	assert_int_equal(list.items[2].bytes, 5);
	assert_null(list.items[2].member);
	assert_int_equal(list.ignored_count, 2);
	assert_string_equal(noticed, "");
	source_list_free(&list);
}

static void things_that_are_no_files_are_refused_and_never_waited_for(void **state)
{
	(void)state;
	mkdir(in("b"), 0700);
	put_text("b/nickel.binary", "");
	assert_int_equal(mkfifo(in("b/fifo.binary"), 0600), 0);
	assert_int_equal(symlink("nowhere", in("b/dangling.binary")), 0);
	mkdir(in("b/inner"), 0700);
	assert_int_equal(symlink("..", in("b/inner/up")), 0);
	assert_int_equal(symlink(".", in("b/self")), 0);
	assert_int_equal(symlink("loop", in("b/loop")), 0);
	assert_int_equal(symlink("/dev/zero", in("b/zero.binary")), 0);
	struct source_list list = scan("b");
	assert_string_equal(names_of(&list), "nickel ");
	expect_words(noticed, "damaged b/fifo.binary: a FIFO");
	expect_words(noticed, "damaged b/dangling.binary: dangling link");
	expect_words(noticed, "skipped b/inner/up: a link to a folder");
	expect_words(noticed, "skipped b/self: a link to a folder");
	assert_null(strstr(noticed, "b/loop:")); /* neither a table nor a container by its name */
	expect_words(noticed, "damaged b/zero.binary: a device");
	assert_int_equal(list.damaged_count, 0);
	assert_int_equal(list.refused_count, 3);
	source_list_free(&list);
	list = scan("b/fifo.binary");
	assert_int_equal(list.item_count, 0);
	assert_int_equal(list.refused_count, 1);
	source_list_free(&list);
}

static void an_input_that_is_not_there_is_refused(void **state)
{
	(void)state;
	bp_error error = scan_fails("missing.binary", BP_ERROR_IO);
	expect_words(error.message, "missing.binary: cannot open: No such file");
}

static void a_file_given_by_name_is_taken_whatever_its_suffix(void **state)
{
	(void)state;
	put_text("table.dat", "any bytes");
	struct source_list list = scan("table.dat");
	assert_string_equal(names_of(&list), "table ");
	source_list_free(&list);
	pack_usual("database", ARCHIVE_FORMAT_ZIP, ARCHIVE_FILTER_NONE);
	list = scan("database");
	assert_string_equal(names_of(&list), "alum-bronze delrin nickel ");
	source_list_free(&list);
}

static void of_two_materials_of_one_name_the_first_path_s_is_taken_and_both_are_named(void **state)
{
	(void)state;
	mkdir(in("c"), 0700);
	mkdir(in("c/one"), 0700);
	mkdir(in("c/two"), 0700);
	put_text("c/one/nickel.binary", "");
	put_text("c/two/nickel.binary", "");
	put_text("c/two/zinc.binary", "");
	const char *const turns[2][3] = {{in("c/one"), in("c/two"), in("c/one/nickel.binary")},
	                                 {in("c/two"), in("c/two"), in("c/one")}};
	for (int turn = 0; turn < 2; turn++) {
		struct source_list list;
		noticed[0] = '\0';
		assert_int_equal(source_scan(turns[turn], 3, &watched, &list, NULL), BP_OK);
		assert_string_equal(names_of(&list), "nickel zinc ");
		assert_string_equal(list.items[0].path, in("c/one/nickel.binary"));
		assert_int_equal(list.refused_count, 1);
		expect_words(noticed, "damaged c/two/nickel.binary: two materials named nickel: ");
		expect_words(noticed, "c/one/nickel.binary has the name; rename or leave out one");
		source_list_free(&list);
	}
	unlink(in("c/two/nickel.binary"));
	pack_usual("c/two/all.zip", ARCHIVE_FORMAT_ZIP, ARCHIVE_FILTER_NONE);
	struct source_list list = scan("c");
	expect_words(noticed, "c/two/all.zip: brdfs/nickel.binary: two materials named nickel");
	source_list_free(&list);
}

static void illegal_names_are_refused_and_shown_escaped_and_the_others_are_taken(void **state)
{
	(void)state;
	mkdir(in("d"), 0700);
	put_text("d/nic\nkel.binary", "");
	put_text("d/nic\xff.binary", "");
	put_text("d/zinc.binary", "");
	struct source_list list = scan("d");
	assert_string_equal(names_of(&list), "zinc ");
	assert_int_equal(list.refused_count, 2);
	expect_words(noticed, "cannot name a material: it holds a control character; rename the file");
	expect_words(noticed, "cannot name a material: it is not UTF-8; rename the file");
	source_list_free(&list);
	struct pack pack = pack_open("d/a.tar", ARCHIVE_FORMAT_TAR_USTAR, ARCHIVE_FILTER_NONE, NULL);
	pack_text(&pack, "gr\xfcn.binary", "");
	pack_text(&pack, "delrin.binary", "");
	pack_close(&pack);
	list = scan("d/a.tar");
	assert_string_equal(names_of(&list), "delrin ");
	expect_words(noticed, "damaged d/a.tar: gr\\xfcn.binary: its stem cannot name a material: it is not UTF-8; tell the names' "
	                      "character set with --charset");
	source_list_free(&list);
	const struct source_options latin = {.charset = "ISO-8859-1"};
	const char *inputs[] = {in("d/a.tar")};
	assert_int_equal(source_scan(inputs, 1, &latin, &list, NULL), BP_OK);
	assert_string_equal(names_of(&list), "delrin gr\xC3\xBCn ");
	source_list_free(&list);
}

static bool only_nickel(void *user, const char *name)
{
	(void)user;
	return strcmp(name, "nickel") == 0;
}

static void what_is_not_wanted_is_counted_and_may_have_any_name(void **state)
{
	(void)state;
	mkdir(in("e"), 0700);
	mkdir(in("e/f"), 0700);
	put_text("e/zinc.binary", "");
	put_text("e/f/zinc.binary", "");
	put_text("e/bad\n.binary", "");
	put_text("e/nickel.binary", "");
	const struct source_options options = {.wanted = only_nickel};
	const char *inputs[] = {in("e")};
	struct source_list list;
	assert_int_equal(source_scan(inputs, 1, &options, &list, NULL), BP_OK);
	assert_string_equal(names_of(&list), "nickel ");
	assert_int_equal(list.unwanted_count, 3);
	source_list_free(&list);
}

static void members_of_zip_and_plain_tar_are_items_that_can_be_read_in_any_order(void **state)
{
	(void)state;
	const int formats[] = {ARCHIVE_FORMAT_ZIP, ARCHIVE_FORMAT_TAR_USTAR, ARCHIVE_FORMAT_TAR_PAX_INTERCHANGE,
	                       ARCHIVE_FORMAT_TAR_GNUTAR};
	mkdir(in("g"), 0700);
	for (size_t f = 0; f < sizeof formats / sizeof *formats; f++) {
		const char *name = formats[f] == ARCHIVE_FORMAT_ZIP ? "g/a.zip" : "g/a.tar";
		pack_usual(name, formats[f], ARCHIVE_FILTER_NONE);
		struct source_list list = scan("g");
		assert_string_equal(names_of(&list), "alum-bronze delrin nickel ");
		assert_int_equal(list.stream_count, 0);
		assert_int_equal(list.ignored_count, 2);
		assert_string_equal(list.items[0].member, "../../alum-bronze.binary");
		assert_int_equal(list.items[0].bytes, 15);
		static const char *const contents[] = {"table of bronze", "table of delrin", "table of nickel"};
		for (int n = 2; n >= 0; n--) {
			struct container *container;
			assert_int_equal(container_open(list.items[n].path, CONTAINER_INDEXED, NULL, &container, NULL), BP_OK);
			assert_int_equal(container_seek(container, list.items[n].ordinal, NULL), BP_OK);
			assert_string_equal(content_of(container), contents[n]);
			assert_false(container_ahead(container, list.items[n].ordinal));
			container_close(container);
		}
		struct source_cursor cursor = {0};
		struct lattice lattice;
		bp_error error;
		for (int n = 0; n < 3; n++) {
			assert_int_equal(source_item_read(&list.items[n], &cursor, NULL, &lattice, &error), BP_ERROR_BAD_INPUT);
			expect_words(error.message, "neither a MERL file nor one of the RGL database: text");
		}
		source_cursor_close(&cursor);
		source_list_free(&list);
		unlink(in(name));
	}
}

static void a_compressed_tar_is_a_stream_of_the_same_materials(void **state)
{
	(void)state;
	static const struct {
		const char *name;
		int filter;
	} cases[] = {
		{"h/a.tar.gz", ARCHIVE_FILTER_GZIP}, {"h/a.tgz", ARCHIVE_FILTER_GZIP},     {"h/a.tar.bz2", ARCHIVE_FILTER_BZIP2},
		{"h/a.tar.xz", ARCHIVE_FILTER_XZ},   {"h/a.tar.zst", ARCHIVE_FILTER_ZSTD},
	};
	mkdir(in("h"), 0700);
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		pack_usual(cases[n].name, ARCHIVE_FORMAT_TAR_USTAR, cases[n].filter);
		struct source_list list = scan("h");
		assert_int_equal(list.item_count, 0);
		assert_int_equal(list.stream_count, 1);
		struct container *stream;
		assert_int_equal(container_open(list.streams[0].path, CONTAINER_SEQUENTIAL, NULL, &stream, NULL), BP_OK);
		static const char *const expected[][2] = {
			{"nickel", "table of nickel"}, {"alum-bronze", "table of bronze"}, {"delrin", "table of delrin"}};
		struct source_item item;
		bool more;
		for (int m = 0; m < 3; m++) {
			assert_int_equal(source_stream_next(&list, 0, stream, &item, &more, NULL), BP_OK);
			assert_true(more);
			assert_string_equal(item.name, expected[m][0]);
			if (m != 1) /* a member may be left unread */
				assert_string_equal(content_of(stream), expected[m][1]);
			source_item_clear(&item);
		}
		assert_int_equal(source_stream_next(&list, 0, stream, &item, &more, NULL), BP_OK);
		assert_false(more);
		assert_int_equal(list.ignored_count, 2);
		container_close(stream);
		source_list_free(&list);
		unlink(in(cases[n].name));
	}
}

static void a_second_name_in_a_stream_is_refused_as_soon_as_it_is_seen(void **state)
{
	(void)state;
	mkdir(in("i"), 0700);
	put_text("i/delrin.binary", "");
	pack_usual("i/a.tgz", ARCHIVE_FORMAT_TAR_USTAR, ARCHIVE_FILTER_GZIP);
	struct source_list list = scan("i");
	struct container *stream;
	struct source_item item;
	bp_error error;
	bool more;
	assert_int_equal(container_open(list.streams[0].path, CONTAINER_SEQUENTIAL, NULL, &stream, NULL), BP_OK);
	for (int m = 0; m < 2; m++) {
		assert_int_equal(source_stream_next(&list, 0, stream, &item, &more, NULL), BP_OK);
		source_item_clear(&item);
	}
	assert_int_equal(source_stream_next(&list, 0, stream, &item, &more, &error), BP_ERROR_ARGUMENT);
	expect_words(error.message, "two materials named delrin");
	assert_string_equal(item.path, in("i/a.tgz"));
	assert_string_equal(item.member, "/etc/delrin.BINARY");
	assert_true(more);
	source_item_clear(&item);
	assert_int_equal(source_stream_next(&list, 0, stream, &item, &more, &error), BP_OK);
	assert_false(more);
	container_close(stream);
	source_list_free(&list);
}

static void a_single_compressed_table_is_a_stream_of_one(void **state)
{
	(void)state;
	mkdir(in("j"), 0700);
	struct pack pack = pack_open("j/nickel.binary.xz", ARCHIVE_FORMAT_RAW, ARCHIVE_FILTER_XZ, NULL);
	pack_text(&pack, "data", "table of nickel");
	pack_close(&pack);
	struct source_list list = scan("j");
	struct container *stream;
	struct source_item item;
	bool more;
	assert_int_equal(list.stream_count, 1);
	assert_int_equal(container_open(list.streams[0].path, CONTAINER_SEQUENTIAL, NULL, &stream, NULL), BP_OK);
	assert_int_equal(source_stream_next(&list, 0, stream, &item, &more, NULL), BP_OK);
	assert_string_equal(item.name, "nickel");
	assert_string_equal(content_of(stream), "table of nickel");
	source_item_clear(&item);
	container_close(stream);
	source_list_free(&list);
}

static void a_whole_table_comes_out_of_a_zip(void **state)
{
	(void)state;
	const size_t count = 34992012;
	unsigned char *bytes = calloc(count, 1);
	memcpy(bytes, "\132\0\0\0\132\0\0\0\264\0\0\0", 12);
	struct pack pack = pack_open("whole.zip", ARCHIVE_FORMAT_ZIP, ARCHIVE_FILTER_NONE, "compression-level=1");
	pack_add(&pack, "black.binary", bytes, count);
	pack_add(&pack, "short.binary", bytes, count - 1);
	pack_add(&pack, "long.binary", bytes, count);
	pack_close(&pack);
	free(bytes);
	struct source_list list = scan("whole.zip");
	struct source_cursor cursor = {0};
	struct lattice lattice;
	bp_error error;
	assert_string_equal(names_of(&list), "black long short ");
	for (int n = 0; n < 2; n++) {
		assert_int_equal(source_item_read(&list.items[n], &cursor, NULL, &lattice, NULL), BP_OK);
		assert_int_equal(lattice.valid_count, 1458000);
		lattice_free(&lattice);
	}
	assert_int_equal(source_item_read(&list.items[2], &cursor, NULL, &lattice, &error), BP_ERROR_BAD_INPUT);
	assert_string_equal(error.message, "truncated: expected 34992012 bytes, found 34992011");
	source_cursor_close(&cursor);
	source_list_free(&list);
	unlink(in("whole.zip"));
}

static void names_in_utf8_survive_in_the_c_locale(void **state)
{
	(void)state;
	mkdir(in("k"), 0700);
	const struct {
		const char *name;
		int format;
		const char *options;
	} cases[] = {
		{"k/a.zip", ARCHIVE_FORMAT_ZIP, NULL},
		{"k/a.tar", ARCHIVE_FORMAT_TAR_USTAR, NULL},
		{"k/a.tar", ARCHIVE_FORMAT_TAR_PAX_INTERCHANGE, "hdrcharset=BINARY"},
	};
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		struct pack pack = pack_open(cases[n].name, cases[n].format, ARCHIVE_FILTER_NONE, cases[n].options);
		pack_text(&pack, "gr\xC3\xBCn.binary", "table");
		pack_close(&pack);
		struct source_list list = scan("k");
		assert_string_equal(names_of(&list), "gr\xC3\xBCn ");
		source_list_free(&list);
		unlink(in(cases[n].name));
	}
}

/* Reads whatever a container gives; counts members read without an error. */
static int read_all(const char *name, char *message, size_t capacity)
{
	struct container *container;
	struct container_member member;
	bp_error error = {0};
	bool more = true;
	int good = 0;
	message[0] = '\0';
	if (container_open(in(name), CONTAINER_SEQUENTIAL, NULL, &container, &error) != BP_OK) {
		snprintf(message, capacity, "%s", error.message);
		return 0;
	}
	while (more) {
		char bytes[64];
		size_t once = 0;
		bp_status status = container_next(container, &member, &more, &error);
		while (status == BP_OK && more) {
			status = container_read(container, bytes, sizeof bytes, &once, &error);
			if (status != BP_OK || !once)
				break;
		}
		good += status == BP_OK && more;
		if (status != BP_OK) {
			snprintf(message, capacity, "%s", error.message);
			more = true;
		}
	}
	container_close(container);
	return good;
}

static void a_damaged_container_is_told_with_its_member_and_the_others_are_read(void **state)
{
	(void)state;
	char *bytes = malloc(1 << 16), message[512];
	mkdir(in("l"), 0700);
	struct pack pack = pack_open("l/a.zip", ARCHIVE_FORMAT_ZIP, ARCHIVE_FILTER_NONE, "zip:compression=store");
	pack_text(&pack, "alum-bronze.binary", "table of bronze");
	pack_text(&pack, "brdfs/nickel.binary", "table of nickel");
	pack_text(&pack, "zinc.binary", "table of zinc");
	pack_close(&pack);
	FILE *file = fopen(in("l/a.zip"), "rb");
	const size_t count = fread(bytes, 1, 1 << 16, file);
	fclose(file);
	assert_int_equal(read_all("l/a.zip", message, sizeof message), 3);
	/* One byte of nickel's data is damaged: its CRC32 tells, and the others are read. */
	char *data = memmem(bytes, count, "table of nickel", 15);
	assert_non_null(data);
	data[3] ^= 0x10;
	put("l/a.zip", bytes, count);
	assert_int_equal(read_all("l/a.zip", message, sizeof message), 2);
	expect_words(message, "member brdfs/nickel.binary: damaged");
	free(bytes);
}

static void a_container_cut_off_anywhere_ends_with_an_error_or_fewer_members(void **state)
{
	(void)state;
	static const struct {
		const char *name;
		int format, filter;
	} cases[] = {
		{"m/a.zip", ARCHIVE_FORMAT_ZIP, ARCHIVE_FILTER_NONE},
		{"m/a.tar", ARCHIVE_FORMAT_TAR_USTAR, ARCHIVE_FILTER_NONE},
		{"m/a.tgz", ARCHIVE_FORMAT_TAR_USTAR, ARCHIVE_FILTER_GZIP},
		{"m/a.txz", ARCHIVE_FORMAT_TAR_USTAR, ARCHIVE_FILTER_XZ},
	};
	char *bytes = malloc(1 << 16), message[512];
	mkdir(in("m"), 0700);
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		pack_usual(cases[n].name, cases[n].format, cases[n].filter);
		FILE *file = fopen(in(cases[n].name), "rb");
		const size_t count = fread(bytes, 1, 1 << 16, file);
		fclose(file);
		for (size_t cut = 0; cut<count; cut += count> 2000 ? 97 : 13) {
			put(cases[n].name, bytes, cut);
			struct source_list list = scan("m");
			assert_true(list.item_count <= 3);
			source_list_free(&list);
			assert_in_range(read_all(cases[n].name, message, sizeof message), 0, 3);
		}
		unlink(in(cases[n].name));
	}
	free(bytes);
}

/* Links of a compression that nobody knows: each is an error of its own, which must not go on for ever. */
static void after_a_thousand_members_that_cannot_be_read_the_rest_is_not_tried(void **state)
{
	(void)state;
	enum { LINKS = 1100, ROOM = 1 << 18 };
	uint8_t *bytes = malloc(ROOM);
	struct container *container;
	struct container_member member;
	bool more;
	int failures = 0;
	struct pack pack = pack_open("links.zip", ARCHIVE_FORMAT_ZIP, ARCHIVE_FILTER_NONE, NULL);
	pack_text(&pack, "nickel.binary", "table of nickel");
	for (int n = 0; n < LINKS; n++) {
		struct archive_entry *entry = archive_entry_new();
		archive_entry_set_pathname(entry, "link.binary");
		archive_entry_set_mode(entry, AE_IFLNK | 0644);
		archive_entry_set_symlink(entry, "x");
		assert_int_equal(archive_write_header(pack.archive, entry), ARCHIVE_OK);
		archive_entry_free(entry);
	}
	pack_close(&pack);
	FILE *file = fopen(in("links.zip"), "rb");
	const size_t count = fread(bytes, 1, ROOM, file);
	fclose(file);
	for (size_t at = 100; at + 12 < count; at++) /* behind nickel's head */
		if (!memcmp(bytes + at, "PK\3\4", 4) || !memcmp(bytes + at, "PK\1\2", 4))
			bytes[at + (bytes[at + 2] == 3 ? 8 : 10)] = 99;
	put("links.zip", bytes, count);
	assert_int_equal(container_open(in("links.zip"), CONTAINER_INDEXED, NULL, &container, NULL), BP_OK);
	for (more = true;;) {
		const bp_status status = container_next(container, &member, &more, NULL);
		if (status == BP_OK && !more)
			break;
		failures += status != BP_OK;
	}
	assert_int_equal(failures, 1001);
	container_close(container);
	free(bytes);
}

/* Where a zip's numbers are too large for its last record, that one has 0xFFFF, and another record before it the number. */
static void a_zip_of_large_numbers_is_no_split_one(void **state)
{
	(void)state;
	uint8_t end[22] = "PK\5\6";
	for (uint8_t disk = 0; disk <= 1; disk++) {
		end[4] = end[5] = disk ? 1 : 0xFF;
		put("end.zip", end, sizeof end);
		const int fd = open(in("end.zip"), O_RDONLY);
		const char *fault = container_fault(fd);
		close(fd);
		if (disk)
			expect_words(fault, "the last part of a split zip");
		else
			assert_null(fault);
	}
}

static void an_encrypted_member_is_refused_with_a_remedy(void **state)
{
	(void)state;
	struct archive *archive = archive_write_new();
	assert_int_equal(archive_write_set_format_zip(archive), ARCHIVE_OK);
	const int can = archive_write_set_options(archive, "zip:encryption=zipcrypt");
	if (can != ARCHIVE_OK) { /* this libarchive was built without it */
		archive_write_free(archive);
		skip();
	}
	archive_write_set_passphrase(archive, "secret");
	assert_int_equal(archive_write_open_filename(archive, in("locked.zip")), ARCHIVE_OK);
	struct pack pack = {archive};
	pack_text(&pack, "nickel.binary", "table of nickel");
	pack_close(&pack);
	struct source_list list = scan("locked.zip");
	assert_int_equal(list.item_count, 0);
	assert_int_equal(list.refused_count, 1);
	expect_words(noticed, "damaged locked.zip: nickel.binary: encrypted");
	source_list_free(&list);
}

static int make_folder(void **state)
{
	(void)state;
	return scratch_folder(folder);
}

static int remove_folder(void **state)
{
	(void)state;
	return scratch_remove(folder);
}

/* A container without any material is told where it was named, be it that the folder around it was named as well. */
static void a_stream_is_named_whichever_way_it_was_met_first(void **state)
{
	(void)state;
	mkdir(in("n"), 0700);
	struct pack pack = pack_open("n/a.tgz", ARCHIVE_FORMAT_TAR_USTAR, ARCHIVE_FILTER_GZIP, NULL);
	pack_text(&pack, "readme.txt", "no table");
	pack_close(&pack);
	for (int order = 0; order < 2; order++)
		for (size_t count = 1; count <= 2; count++) {
			const char *inputs[] = {in(order ? "n/a.tgz" : "n"), in(order ? "n" : "n/a.tgz")};
			struct source_list list;
			struct container *stream;
			struct source_item item;
			bp_error error;
			bool more;
			noticed[0] = '\0';
			assert_int_equal(source_scan(inputs, count, &watched, &list, NULL), BP_OK);
			assert_int_equal(list.stream_count, 1);
			const bool named = count == 2 || order;
			assert_int_equal(list.streams[0].named, named);
			assert_int_equal(container_open(list.streams[0].path, CONTAINER_SEQUENTIAL, NULL, &stream, NULL), BP_OK);
			assert_int_equal(source_stream_next(&list, 0, stream, &item, &more, &error), named ? BP_ERROR_BAD_INPUT : BP_OK);
			assert_false(more);
			if (named)
				expect_words(error.message, "no material in it; other files passed over: 1 ");
			container_close(stream);
			source_list_free(&list);
		}
}

static void folders_end_a_thousand_deep(void **state)
{
	(void)state;
	char path[3000] = "o", *end = path + 1;
	mkdir(in(path), 0700);
	const int back = open(".", O_RDONLY | O_DIRECTORY);
	assert_true(back >= 0);
	assert_int_equal(chdir(in(path)), 0);
	for (int depth = 1; depth <= 1001; depth++) {
		assert_int_equal(mkdir("d", 0700), 0);
		assert_int_equal(chdir("d"), 0);
		if (depth == 1000)
			assert_int_equal(close(open("last.binary", O_CREAT | O_WRONLY, 0600)), 0);
		memcpy(end, "/d", 3);
		end += 2;
	}
	assert_int_equal(close(open("lost.binary", O_CREAT | O_WRONLY, 0600)), 0);
	assert_int_equal(fchdir(back), 0);
	close(back);
	struct source_list list = scan("o");
	assert_string_equal(names_of(&list), "last ");
	expect_words(noticed, "more than 1000 folders deep: what is below is not searched");
	assert_int_equal(list.damaged_count, 1);
	source_list_free(&list);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_stem_is_the_name),
		cmocka_unit_test(a_folder_is_searched_to_the_bottom_in_name_order),
		cmocka_unit_test(things_that_are_no_files_are_refused_and_never_waited_for),
		cmocka_unit_test(an_input_that_is_not_there_is_refused),
		cmocka_unit_test(a_file_given_by_name_is_taken_whatever_its_suffix),
		cmocka_unit_test(of_two_materials_of_one_name_the_first_path_s_is_taken_and_both_are_named),
		cmocka_unit_test(illegal_names_are_refused_and_shown_escaped_and_the_others_are_taken),
		cmocka_unit_test(what_is_not_wanted_is_counted_and_may_have_any_name),
		cmocka_unit_test(members_of_zip_and_plain_tar_are_items_that_can_be_read_in_any_order),
		cmocka_unit_test(a_compressed_tar_is_a_stream_of_the_same_materials),
		cmocka_unit_test(a_second_name_in_a_stream_is_refused_as_soon_as_it_is_seen),
		cmocka_unit_test(a_single_compressed_table_is_a_stream_of_one),
		cmocka_unit_test(a_whole_table_comes_out_of_a_zip),
		cmocka_unit_test(names_in_utf8_survive_in_the_c_locale),
		cmocka_unit_test(a_damaged_container_is_told_with_its_member_and_the_others_are_read),
		cmocka_unit_test(a_container_cut_off_anywhere_ends_with_an_error_or_fewer_members),
		cmocka_unit_test(after_a_thousand_members_that_cannot_be_read_the_rest_is_not_tried),
		cmocka_unit_test(a_zip_of_large_numbers_is_no_split_one),
		cmocka_unit_test(a_stream_is_named_whichever_way_it_was_met_first),
		cmocka_unit_test(folders_end_a_thousand_deep),
		cmocka_unit_test(an_encrypted_member_is_refused_with_a_remedy),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
