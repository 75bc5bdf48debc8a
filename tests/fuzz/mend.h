/*
 * mend.h: puts right the checksums of a damaged record or archive, so that a fuzzer gets past them to what lies behind.
 */
#ifndef TESTS_FUZZ_MEND_H
#define TESTS_FUZZ_MEND_H

#include <string.h>

#include "archive/format.h"
#include "codec/bytes.h"
#include "codec/record.h"

/* The head's checksum and those in its section table, as far as the record's own numbers lead. */
static inline void mend_record(uint8_t *record, size_t count)
{
	uint32_t head_bytes, record_bytes, layers, sections;
	if (count < RECORD_HEAD_BYTES_MIN || record_probe(record, &head_bytes, &record_bytes, NULL) != BP_OK || head_bytes > count)
		return;
	layers = record[31];
	sections = load_u16(record + 32);
	for (uint32_t i = 0; i < sections && 208 + 32 * (layers + i + 1) <= head_bytes; i++) {
		uint8_t *entry = record + 208 + 32 * (layers + i);
		uint32_t offset = load_u32(entry + 12), bytes = load_u32(entry + 16);
		if (offset <= count && bytes <= count - offset)
			store_u32(entry + 20, bytes_crc32(record + offset, bytes));
	}
	store_u32(record + head_bytes - 4, bytes_crc32(record, head_bytes - 4));
}

/* Every record and every page by its magic, and the header. */
static inline void mend_archive(uint8_t *file, size_t count)
{
	for (size_t at = 0; at + 8 <= count; at++) {
		if (memcmp(file + at, RECORD_MAGIC, RECORD_MAGIC_BYTES) == 0)
			mend_record(file + at, count - at);
		if (memcmp(file + at, PAGE_MAGIC, 4) == 0 && count - at >= PAGE_BYTES)
			store_u32(file + at + PAGE_BYTES - 4, bytes_crc32(file + at, PAGE_BYTES - 4));
	}
	if (count >= ARCHIVE_HEADER_BYTES)
		store_u32(file + 60, bytes_crc32(file, 60));
}

#endif
