/*
 * held_archive.h: an archive of one record, in memory.
 */
#ifndef TESTS_HELD_ARCHIVE_H
#define TESTS_HELD_ARCHIVE_H

#include "brdfpack.h"

struct held {
	uint8_t *bytes; /* the archive's, which it reads from */
	size_t count;
	bp_archive *archive;
};

/* The record is copied; held_free when done. */
static struct held held_of(const uint8_t *record, size_t record_bytes)
{
	struct held held;
	bp_writer *writer;
	assert_int_equal(bp_writer_create(&writer, NULL), BP_OK);
	assert_int_equal(bp_writer_add(writer, record, record_bytes, NULL), BP_OK);
	assert_int_equal(bp_writer_save_memory(writer, &held.bytes, &held.count, NULL), BP_OK);
	assert_int_equal(bp_archive_open_memory(held.bytes, held.count, &held.archive, NULL), BP_OK);
	bp_writer_free(writer);
	return held;
}

static void held_free(struct held *held)
{
	bp_archive_close(held->archive);
	bp_free(held->bytes);
}

#endif
