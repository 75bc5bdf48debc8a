#include <string.h>

#include "error.h"
#include "index.h"

void index_add(struct index_builder *builder, const char *name, uint64_t offset, uint32_t record_bytes, uint32_t head_bytes)
{
	size_t name_bytes = strlen(name);
	write_u64(&builder->entries, offset);
	write_u32(&builder->entries, record_bytes);
	write_u32(&builder->entries, head_bytes);
	write_u8(&builder->entries, (uint8_t)name_bytes);
	write_bytes(&builder->entries, name, name_bytes);
	builder->count++;
}

/*
 * Packs the entries of one level into pages, each as full as it gets, and notes in *above the inner
 * entry that leads to each page.
 */
static bp_status level_write(const struct byte_buffer *entries, uint32_t level, index_page_fn *write, void *user,
                             uint32_t *page_number, struct byte_buffer *above, bp_error *error)
{
	size_t fixed = index_fixed_bytes(level), at = 0;
	uint64_t ordinal = 0;
	while (at < entries->count) {
		uint8_t page[PAGE_BYTES] = {0};
		struct byte_buffer out = {.bytes = page, .capacity = PAGE_BYTES};
		size_t end = at, count = 0;
		uint64_t first = level ? load_u64(entries->bytes + at + 4) : ordinal;
		const uint8_t *name = entries->bytes + at + fixed;
		while (end < entries->count && count < PAGE_ENTRIES_MAX) {
			size_t bytes = fixed + entries->bytes[end + fixed - 1];
			if (PAGE_HEAD_BYTES + (end - at) + bytes > PAGE_BYTES - 4)
				break;
			end += bytes;
			count++;
		}
		write_bytes(&out, PAGE_MAGIC, 4);
		write_u16(&out, (uint16_t)level);
		write_u16(&out, (uint16_t)count);
		write_u64(&out, first);
		write_bytes(&out, entries->bytes + at, end - at);
		store_u32(page + PAGE_BYTES - 4, bytes_crc32(page, PAGE_BYTES - 4));
		bp_status status = write(user, page, error);
		if (status)
			return status;
		write_u32(above, *page_number);
		write_u64(above, first);
		write_bytes(above, name - 1, 1u + name[-1]);
		ordinal += count;
		at = end;
		++*page_number;
	}
	return above->failed ? error_memory(error, above->count) : BP_OK;
}

bp_status index_write(const struct index_builder *builder, index_page_fn *write, void *user, uint32_t *page_count,
                      uint32_t *depth, bp_error *error)
{
	const struct byte_buffer *entries = &builder->entries;
	struct byte_buffer held = {0};
	uint32_t level = 0, number = 0;
	bp_status status = BP_OK;

	*page_count = *depth = 0;
	if (entries->failed)
		return error_memory(error, entries->count);
	if (builder->count > ARCHIVE_COUNT_MAX)
		return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "%llu materials; an archive holds at most %llu",
		                 (unsigned long long)builder->count, (unsigned long long)ARCHIVE_COUNT_MAX);
	while (builder->count) {
		struct byte_buffer above = {0};
		const uint32_t first = number;
		status = level_write(entries, level, write, user, &number, &above, error);
		byte_buffer_free(&held);
		held = above;
		entries = &held;
		level++;
		if (status || number == first + 1)
			break;
	}
	byte_buffer_free(&held);
	if (!status) {
		*page_count = number;
		*depth = level;
	}
	return status;
}
