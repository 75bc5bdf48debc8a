#include <string.h>

#include "name.h"
#include "codec/record.h"
#include "error.h"
#include "index.h"

const char *index_entry_name(const struct index_page *page, uint32_t i, uint32_t *name_bytes)
{
	const uint8_t *entry = page->bytes + page->entry_at[i];
	size_t fixed = index_fixed_bytes(page->level);
	*name_bytes = entry[fixed - 1];
	return (const char *)entry + fixed;
}

void index_leaf_entry(const struct index_page *leaf, uint32_t i, struct index_entry *out)
{
	const uint8_t *entry = leaf->bytes + leaf->entry_at[i];
	const char *name = index_entry_name(leaf, i, &out->name_bytes);
	out->offset = load_u64(entry);
	out->record_bytes = load_u32(entry + 8);
	out->head_bytes = load_u32(entry + 12);
	out->ordinal = leaf->first_ordinal + i;
	memcpy(out->name, name, out->name_bytes);
	out->name[out->name_bytes] = 0;
}

struct page_expect index_child(const struct index_page *inner, uint32_t i)
{
	const uint8_t *entry = inner->bytes + inner->entry_at[i];
	struct page_expect child = {.number = load_u32(entry), .level = inner->level - 1, .first_ordinal = load_u64(entry + 4)};
	child.first_name = index_entry_name(inner, i, &child.first_name_bytes);
	return child;
}

uint64_t index_child_end(const struct index_page *inner, uint32_t i, uint64_t own_end)
{
	return i + 1 < inner->count ? index_child(inner, i + 1).first_ordinal : own_end;
}

uint32_t index_search(const struct index_page *page, const char *name, uint64_t ordinal)
{
	const size_t name_bytes = name ? strlen(name) : 0;
	uint32_t low = 0, high = page->count; /* entries below low are not greater, from high on they are */
	while (low < high) {
		uint32_t middle = (low + high) / 2, bytes;
		const char *here = index_entry_name(page, middle, &bytes);
		if (name ? name_compare(here, bytes, name, name_bytes) <= 0 : index_child(page, middle).first_ordinal <= ordinal)
			low = middle + 1;
		else
			high = middle;
	}
	return low ? low - 1 : UINT32_MAX;
}

/* The entry at `at`: fits the page, has a legal name above the one before, and plausible numbers. */
static bp_status entry_check(const struct index_page *page, uint32_t i, size_t at, size_t *next, bp_error *error)
{
	size_t fixed = index_fixed_bytes(page->level), name_bytes;
	if (at + fixed > PAGE_BYTES - 4 || at + fixed + page->bytes[at + fixed - 1] > PAGE_BYTES - 4)
		return error_set(error, BP_ERROR_CORRUPT, at, "index entry %u does not fit its page", i);
	name_bytes = page->bytes[at + fixed - 1];
	const char *fault = name_fault((const char *)page->bytes + at + fixed, name_bytes);
	if (fault)
		return error_set(error, BP_ERROR_CORRUPT, at, "index entry %u has an illegal name: %s", i, fault);
	if (i) {
		uint32_t before_bytes;
		const char *before = index_entry_name(page, i - 1, &before_bytes);
		if (name_compare(before, before_bytes, (const char *)page->bytes + at + fixed, name_bytes) >= 0)
			return error_set(error, BP_ERROR_CORRUPT, at, "index entry %u is not in name order", i);
	}
	if (page->level == 0) {
		uint32_t record = load_u32(page->bytes + at + 8), head = load_u32(page->bytes + at + 12);
		if (head < RECORD_HEAD_BYTES_MIN || head > RECORD_HEAD_BYTES_MAX || record < head || record > RECORD_BYTES_MAX)
			return error_set(error, BP_ERROR_CORRUPT, at + 8, "index entry %u: a record of %u bytes with a head of %u cannot be",
			                 i, record, head);
	} else {
		uint64_t first = load_u64(page->bytes + at + 4);
		if (load_u32(page->bytes + at) >= page->number)
			return error_set(error, BP_ERROR_CORRUPT, at, "index entry %u: a child page follows its parent", i);
		if (i == 0 ? first != page->first_ordinal : first <= load_u64(page->bytes + page->entry_at[i - 1] + 4))
			return error_set(error, BP_ERROR_CORRUPT, at + 4, "index entry %u: ordinals are out of order", i);
	}
	*next = at + fixed + name_bytes;
	return BP_OK;
}

bp_status index_page_read(struct index_page *page, const struct page_expect *expect, bp_error *error)
{
	size_t at = PAGE_HEAD_BYTES;
	uint32_t name_bytes;
	if (memcmp(page->bytes, PAGE_MAGIC, 4) != 0)
		return error_set(error, BP_ERROR_CORRUPT, 0, "an index page should begin here");
	if (bytes_crc32(page->bytes, PAGE_BYTES - 4) != load_u32(page->bytes + PAGE_BYTES - 4))
		return error_set(error, BP_ERROR_CHECKSUM, PAGE_BYTES - 4, "the checksum of index page %u differs", expect->number);
	page->number = expect->number;
	page->level = load_u16(page->bytes + 4);
	page->count = load_u16(page->bytes + 6);
	page->first_ordinal = load_u64(page->bytes + 8);
	if (page->level != expect->level || page->first_ordinal != expect->first_ordinal || page->count == 0 ||
	    page->count > PAGE_ENTRIES_MAX)
		return error_set(error, BP_ERROR_CORRUPT, 4,
		                 "index page %u: level %u from material %llu on with %u entries, expected level %u from %llu on",
		                 page->number, page->level, (unsigned long long)page->first_ordinal, page->count, expect->level,
		                 (unsigned long long)expect->first_ordinal);
	for (uint32_t i = 0; i < page->count; i++) {
		page->entry_at[i] = (uint16_t)at;
		bp_status status = entry_check(page, i, at, &at, error);
		if (status)
			return status;
	}
	for (size_t i = at; i < PAGE_BYTES - 4; i++)
		if (page->bytes[i])
			return error_set(error, BP_ERROR_CORRUPT, i, "index page %u: bytes behind the last entry are not zero", page->number);
	const char *name = index_entry_name(page, 0, &name_bytes);
	if (expect->first_name && name_compare(name, name_bytes, expect->first_name, expect->first_name_bytes) != 0)
		return error_set(error, BP_ERROR_CORRUPT, PAGE_HEAD_BYTES, "index page %u does not begin with the name its parent says",
		                 page->number);
	return BP_OK;
}
