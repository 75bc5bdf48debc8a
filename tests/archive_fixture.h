/*
 * archive_fixture.h: small records and archives for tests, and a folder to keep them in.
 *
 * The records here have heads as they should be and sections of arbitrary bytes that no decoder
 * understands; tests that decode make their own.
 */
#ifndef ARCHIVE_FIXTURE_H
#define ARCHIVE_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "archive/reader.h"
#include "archive/writer.h"
#include "codec/section.h"
#include "scratch.h"

#define FIXTURE __attribute__((unused)) static

/* A folder of this test program's own; removed by fixture_folder_remove. */
static char fixture_folder[SCRATCH_BYTES];

FIXTURE int fixture_folder_make(void **state)
{
	(void)state;
	return scratch_folder(fixture_folder);
}

FIXTURE int fixture_folder_remove(void **state)
{
	(void)state;
	return scratch_remove(fixture_folder);
}

FIXTURE const char *fixture_path(const char *name) { return scratch_in(fixture_folder, name); }

FIXTURE void fixture_head(struct record_head *head, const char *name)
{
	memset(head, 0, sizeof *head);
	strcpy(head->name, name);
	head->profile = PROFILE_PAPER;
	head->codec_version = 1;
	head->dims = (struct lattice_dims){4, 5, 6};
	head->horizon_limit = -0.0625;
	for (int c = 0; c < 3; c++)
		head->colour[c] = (struct colour_fit){0.25 * (c + 1), 1.5 - c, 7u + (uint32_t)c, 1, 0.125};
	head->options = (struct fit_options){.profile = PROFILE_PAPER, .budget_bytes = 60400, .effort = 5};
	head->source.bytes = 34992012;
	for (int i = 0; i < SHA256_BYTES; i++)
		head->source.sha256[i] = (uint8_t)(i * 7 + name[0]);
	head->source.nonfinite_count = 3;
	head->left_out = 2;
}

/* A record of `layers` layers with two sections of `section_bytes` bytes each. */
FIXTURE uint8_t *fixture_record(const char *name, uint32_t layers, size_t section_bytes, size_t *record_bytes)
{
	struct section_list sections = {0};
	struct record_head head;
	uint8_t *record = NULL;
	fixture_head(&head, name);
	head.layer_count = layers;
	for (uint32_t l = 0; l < layers; l++) {
		head.layers[l].fidelity = (struct fidelity){0.5 / (l + 1), 0.375 / (l + 1), 0.25 / (l + 1), 3.0 / (l + 1)};
		for (int s = 0; s < 2; s++) {
			struct byte_buffer *bytes =
				section_add(&sections, SECTION_SLICES, 1, 1, l, s == 0 ? SECTION_REQUIRED : 0, s == 0 ? 0.125 : NAN);
			for (size_t i = 0; i < section_bytes; i++)
				write_u8(bytes, (uint8_t)(i * 31 + l * 5 + (size_t)s + (unsigned char)name[0]));
		}
	}
	assert_int_equal(sections_join(&head, &sections, &record, record_bytes, NULL), BP_OK);
	section_list_free(&sections);
	return record;
}

/* An archive of these names (ascending). */
FIXTURE void fixture_archive(const char *path, const char *const *names, size_t count, size_t section_bytes)
{
	struct archive_writer *writer = NULL;
	bp_error error = {0};
	assert_int_equal(archive_writer_open(path, &writer, &error), BP_OK);
	for (size_t i = 0; i < count; i++) {
		size_t bytes;
		uint8_t *record = fixture_record(names[i], 2, section_bytes, &bytes);
		assert_int_equal(archive_writer_add(writer, record, bytes, &error), BP_OK);
		free(record);
	}
	assert_int_equal(archive_writer_commit(writer, &error), BP_OK);
}

FIXTURE uint8_t *fixture_file_read(const char *path, size_t *count)
{
	FILE *file = fopen(path, "rb");
	long size;
	assert_non_null(file);
	fseek(file, 0, SEEK_END);
	size = ftell(file);
	rewind(file);
	uint8_t *bytes = malloc((size_t)size + 1);
	assert_int_equal(fread(bytes, 1, (size_t)size, file), (size_t)size);
	fclose(file);
	*count = (size_t)size;
	return bytes;
}

FIXTURE void fixture_file_write(const char *path, const void *bytes, size_t count)
{
	FILE *file = fopen(path, "wb");
	assert_non_null(file);
	assert_int_equal(fwrite(bytes, 1, count, file), count);
	assert_int_equal(fclose(file), 0);
}

#endif
