/*
 * vectors_damaged.h: the bad and the unsupported archives of format-spec/vectors: good ones, changed.
 */
#ifndef TESTS_VECTORS_DAMAGED_H
#define TESTS_VECTORS_DAMAGED_H

#include "vectors.h"

/* ---- the file as bytes, and mending its checksums ---- */

struct bytes {
	uint8_t *at;
	size_t count;
};

FIXTURE struct bytes three_bytes(const char *path)
{
	struct bytes file;
	vector_three(path);
	file.at = fixture_file_read(path, &file.count);
	return file;
}

FIXTURE void bytes_keep(const char *path, struct bytes file)
{
	fixture_file_write(path, file.at, file.count);
	free(file.at);
}

FIXTURE void put(uint8_t *at, uint64_t value, unsigned width)
{
	for (unsigned i = 0; i < width; i++)
		at[i] = (uint8_t)(value >> 8 * i);
}

FIXTURE void mend(uint8_t *from, size_t count) /* the checksum behind `count` bytes */
{
	store_u32(from + count, bytes_crc32(from, count));
}

/* Changes the header of three materials and mends its checksum. */
FIXTURE void header_with(const char *path, size_t at, uint64_t value, unsigned width)
{
	struct bytes file = three_bytes(path);
	put(file.at + at, value, width);
	mend(file.at, 60);
	bytes_keep(path, file);
}

FIXTURE void flipped(const char *path, size_t from_start, size_t from_end)
{
	struct bytes file = three_bytes(path);
	file.at[from_end ? file.count - from_end : from_start] ^= 4;
	bytes_keep(path, file);
}

FIXTURE void make_minor(const char *path)
{
	struct bytes file = three_bytes(path);
	put(file.at + 10, 1, 2);
	put(file.at + 12, 0xABCD0000, 4);
	put(file.at + 48, 0x1122334455667788, 8);
	mend(file.at, 60);
	bytes_keep(path, file);
}

FIXTURE void make_major(const char *path) { header_with(path, 8, 2, 2); }
FIXTURE void make_flags(const char *path) { header_with(path, 12, 1, 4); }
FIXTURE void make_count(const char *path) { header_with(path, 24, 4, 8); }
FIXTURE void make_count_pages(const char *path) { header_with(path, 24, 100000000, 8); }
FIXTURE void make_depth(const char *path) { header_with(path, 44, 2, 4); }
FIXTURE void make_index_offset(const char *path) { header_with(path, 32, UINT64_MAX - 4095, 8); }
FIXTURE void make_header_checksum(const char *path) { flipped(path, 20, 0); }
FIXTURE void make_page_checksum(const char *path) { flipped(path, 0, 4090); }
FIXTURE void make_head_checksum(const char *path) { flipped(path, 64 + 40, 0); }

FIXTURE void make_section_checksum(const char *path)
{
	struct bytes file = three_bytes(path);
	file.at[64 + load_u32(file.at + 64 + 8) + 3] ^= 4;
	bytes_keep(path, file);
}

FIXTURE void make_empty_file(const char *path) { fixture_file_write(path, "", 0); }

FIXTURE void make_text_mode(const char *path)
{
	struct bytes file = three_bytes(path);
	size_t kept = 0;
	for (size_t i = 0; i < file.count; i++)
		if (!(file.at[i] == '\r' && i + 1 < file.count && file.at[i + 1] == '\n'))
			file.at[kept++] = file.at[i];
	file.count = kept;
	bytes_keep(path, file);
}

FIXTURE void cut(const char *path, size_t count, int more)
{
	struct bytes file = three_bytes(path);
	file.count = count ? count : file.count + (size_t)more;
	if (more > 0)
		file.at[file.count - 1] = 0;
	bytes_keep(path, file);
}

FIXTURE void make_short_header(const char *path) { cut(path, 30, 0); }
FIXTURE void make_truncated(const char *path) { cut(path, 0, -1); }
FIXTURE void make_trailing(const char *path) { cut(path, 0, 1); }

/* ---- index pages ---- */

/* Changes the only page of three materials (its entries: 21, 22 and 20 bytes from 16 on) and mends its checksum. */
FIXTURE void page_change(const char *path, void change(uint8_t *page))
{
	struct bytes file = three_bytes(path);
	uint8_t *page = file.at + file.count - PAGE_BYTES;
	change(page);
	mend(page, PAGE_BYTES - 4);
	bytes_keep(path, file);
}

FIXTURE void change_padding(uint8_t *page) { page[3000] = 1; }
FIXTURE void change_order(uint8_t *page) { memcpy(page + 16 + 17, "grey", 4); }
FIXTURE void change_offset(uint8_t *page) { put(page + 16, UINT64_MAX - 300, 8); }
FIXTURE void change_swap(uint8_t *page)
{
	uint8_t first[16];
	memcpy(first, page + 16, 16);
	memcpy(page + 16, page + 16 + 21, 16);
	memcpy(page + 16 + 21, first, 16);
}

FIXTURE void make_page_padding(const char *path) { page_change(path, change_padding); }
FIXTURE void make_page_order(const char *path) { page_change(path, change_order); }
FIXTURE void make_record_offset(const char *path) { page_change(path, change_offset); }
FIXTURE void make_record_swapped(const char *path) { page_change(path, change_swap); }

/* Writes an archive by hand, so that what archive_writer refuses can be made. gap: a byte before the last record. */
FIXTURE void raw_archive(const char *path, uint8_t *const *records, const size_t *bytes, const char *const *names, size_t count,
                         bool gap)
{
	struct byte_buffer file = {0};
	uint8_t page[PAGE_BYTES] = {0};
	struct byte_buffer entries = {.bytes = page, .capacity = PAGE_BYTES};
	struct archive_header header = {.count = count, .page_count = 1, .depth = 1};
	write_zeros(&file, ARCHIVE_HEADER_BYTES);
	write_bytes(&entries, PAGE_MAGIC, 4);
	write_u16(&entries, 0);
	write_u16(&entries, (uint16_t)count);
	write_u64(&entries, 0);
	for (size_t i = 0; i < count; i++) {
		if (gap && i + 1 == count)
			write_u8(&file, 0);
		write_u64(&entries, file.count);
		write_u32(&entries, (uint32_t)bytes[i]);
		write_u32(&entries, load_u32(records[i] + 8) < 4096 ? load_u32(records[i] + 8) : 300);
		write_u8(&entries, (uint8_t)strlen(names[i]));
		write_bytes(&entries, names[i], strlen(names[i]));
		write_bytes(&file, records[i], bytes[i]);
	}
	mend(page, PAGE_BYTES - 4);
	header.index_offset = file.count;
	write_bytes(&file, page, PAGE_BYTES);
	header.file_bytes = file.count;
	archive_header_write(&header, file.bytes);
	fixture_file_write(path, file.bytes, file.count);
	byte_buffer_free(&file);
}

FIXTURE void make_duplicate(const char *path)
{
	static const char *const names[] = {"blue", "blue"};
	uint8_t *records[2];
	size_t bytes[2];
	for (int i = 0; i < 2; i++)
		records[i] = vector_record("blue", SHAPE_MARGINALS, &bytes[i]);
	raw_archive(path, records, bytes, names, 2, false);
	free(records[0]);
	free(records[1]);
}

FIXTURE void make_gap(const char *path)
{
	static const char *const names[] = {"blue", "red"};
	uint8_t *records[2];
	size_t bytes[2];
	for (int i = 0; i < 2; i++)
		records[i] = vector_record(names[i], SHAPE_MARGINALS, &bytes[i]);
	raw_archive(path, records, bytes, names, 2, true);
	free(records[0]);
	free(records[1]);
}

/* The root of two leaves, changed. Its entries: page, ordinal, name of 255 bytes, 268 bytes each. */
FIXTURE void root_change(const char *path, bool cycle)
{
	struct bytes file;
	vector_two_levels(path);
	file.at = fixture_file_read(path, &file.count);
	uint8_t *root = file.at + file.count - PAGE_BYTES;
	put(root + (cycle ? 16 : 16 + 268), cycle ? 2 : 0, 4);
	mend(root, PAGE_BYTES - 4);
	bytes_keep(path, file);
}

FIXTURE void make_cycle(const char *path) { root_change(path, true); }
FIXTURE void make_leaf_twice(const char *path) { root_change(path, false); }

/* ---- records ---- */

/* One material whose head is changed at `at`, its checksum mended. */
FIXTURE void head_with(const char *path, size_t at, uint64_t value, unsigned width, const char *name)
{
	size_t bytes;
	uint8_t *record = vector_record("material", SHAPE_FULL, &bytes);
	uint32_t head_bytes = load_u32(record + 8);
	put(record + at, value, width);
	mend(record, head_bytes - 4);
	raw_archive(path, &record, &bytes, &name, 1, false);
	free(record);
}

FIXTURE void make_record_version(const char *path) { head_with(path, 16, 1, 2, "material"); }
FIXTURE void make_profile(const char *path) { head_with(path, 18, 77, 2, "material"); }
FIXTURE void make_head_bytes(const char *path) { head_with(path, 8, UINT32_MAX, 4, "material"); }
FIXTURE void make_extents(const char *path) { head_with(path, 24, 0x040004000400, 6, "material"); }
FIXTURE void make_too_many_holes(const char *path) { head_with(path, 52, 6 * 5 * 8 + 1, 4, "material"); }
FIXTURE void make_zeros_rule(const char *path) { head_with(path, 52, 0x30000000, 4, "material"); }
FIXTURE void make_codec(const char *path) { head_with(path, 208 + 96 + 32 + 2, 9, 2, "material"); }
FIXTURE void make_section_order(const char *path) { head_with(path, 208 + 96 + 6, 2, 2, "material"); }
FIXTURE void make_section_bytes(const char *path) { head_with(path, 208 + 96 + 16, UINT32_MAX, 4, "material"); }
FIXTURE void make_name(const char *path) { head_with(path, 208 + 96 + 12 * 32 + 3, '/', 1, "mat/rial"); }

/* One material whose sections are changed before the record is written. */
FIXTURE void sections_change(const char *path, void change(struct record_head *head, struct section_list *sections))
{
	struct record_head head;
	struct section_list sections;
	uint8_t *record;
	size_t bytes;
	vector_encode("material", SHAPE_FULL, &head, &sections);
	change(&head, &sections);
	assert_int_equal(sections_join(&head, &sections, &record, &bytes, NULL), BP_OK);
	section_list_free(&sections);
	vector_archive(path, &record, &bytes, 1);
}

FIXTURE void change_nan(struct record_head *head, struct section_list *sections)
{
	(void)head;
	put(sections->bytes[0].bytes, UINT64_C(0x7FF8000000000000), 8);
}

FIXTURE void change_marginal_bytes(struct record_head *head, struct section_list *sections)
{
	(void)head;
	write_u8(&sections->bytes[0], 0);
}

FIXTURE void change_coefficients(struct record_head *head, struct section_list *sections)
{
	(void)head;
	put(sections->bytes[3].bytes + 2, UINT32_MAX, 4); /* a number of 24 bits */
	sections->bytes[3].count = 2 + 4;
}

FIXTURE void change_stream_short(struct record_head *head, struct section_list *sections)
{
	(void)head;
	sections->bytes[6].count--;
}

FIXTURE void change_stream_long(struct record_head *head, struct section_list *sections)
{
	(void)head;
	write_u8(&sections->bytes[6], 0);
}

FIXTURE void change_step(struct record_head *head, struct section_list *sections)
{
	(void)head;
	put(sections->bytes[9].bytes, PAPER_STEP_MOST + 1, 2);
}

FIXTURE void change_section_missing(struct record_head *head, struct section_list *sections)
{
	(void)head;
	sections->entry[0].type = 900;
	sections->entry[0].flags = 0;
}

FIXTURE void change_section_twice(struct record_head *head, struct section_list *sections)
{
	struct byte_buffer *again = section_add(sections, SECTION_MARGINALS, 0, 2, 2, SECTION_REQUIRED, NAN);
	(void)head;
	write_bytes(again, sections->bytes[0].bytes, sections->bytes[0].count);
}

/* specular x scale beyond the range of a double */
FIXTURE void change_overflow(struct record_head *head, struct section_list *sections)
{
	head->colour[0].specular = 1e200;
	put(sections->bytes[0].bytes, UINT64_C(0x6974E718D7D7625A), 8); /* 1e200 */
}

/* Everything as large as it may be: values meet their limit, or are 0. */
FIXTURE void change_limits(struct record_head *head, struct section_list *sections)
{
	head->colour[0] = (struct colour_fit){1e308, 0, 1, 1, 0};
	head->colour[1] = (struct colour_fit){-1e308, 1e154, 1, 1, 0};
	head->colour[2] = (struct colour_fit){0, 1e150, 1, 1, 0};
	for (int c = 0; c < 3; c++) {
		uint8_t *marginals = sections->bytes[c].bytes;
		put(marginals, UINT64_C(0x5FE3E9F5B0F5A5A5), 8); /* about 4.8e153 */
		for (int i = 0; i < 6 + 5 + 8; i++)
			put(marginals + 8 + 2 * i, i % 3 ? 0xFFFF : 0, 2); /* the largest, and 0 */
		put(sections->bytes[3 + c].bytes, PAPER_STEP_MOST, 2); /* the step of c_hd */
	}
}

/* As codec versions up to 3 wrote: one density for all channels. */
FIXTURE void change_retired(struct record_head *head, struct section_list *sections)
{
	head->codec_version = 3;
	sections->entry[0].version = 1;
}

/* All that is there in one layer. */
FIXTURE void change_one_layer(struct record_head *head, struct section_list *sections)
{
	head->layer_count = 1;
	for (uint32_t i = 0; i < sections->count; i++)
		sections->entry[i].layer = 0;
}

FIXTURE void make_retired(const char *path) { sections_change(path, change_retired); }
FIXTURE void make_one_layer(const char *path) { sections_change(path, change_one_layer); }
FIXTURE void make_nan(const char *path) { sections_change(path, change_nan); }
FIXTURE void make_overflow(const char *path) { sections_change(path, change_overflow); }
FIXTURE void make_limits(const char *path) { sections_change(path, change_limits); }
FIXTURE void make_marginal_bytes(const char *path) { sections_change(path, change_marginal_bytes); }
FIXTURE void make_coefficients(const char *path) { sections_change(path, change_coefficients); }
FIXTURE void make_stream_short(const char *path) { sections_change(path, change_stream_short); }
FIXTURE void make_stream_long(const char *path) { sections_change(path, change_stream_long); }
FIXTURE void make_step(const char *path) { sections_change(path, change_step); }
FIXTURE void make_section_missing(const char *path) { sections_change(path, change_section_missing); }
FIXTURE void make_section_twice(const char *path) { sections_change(path, change_section_twice); }

#endif
