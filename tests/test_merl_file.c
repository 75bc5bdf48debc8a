/*
 * Reading and writing MERL files: what is refused, with which words, and the layout byte for byte.
 */
#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "merl/merl_file.h"
#include "scratch.h"
#include "words.h"

static char folder[SCRATCH_BYTES];

static const char *in_folder(const char *name) { return scratch_in(folder, name); }

/* A MERL file in memory, as another program would lay it out. */
struct image {
	unsigned char *bytes;
	size_t count;
	size_t next;  /* reading position */
	size_t piece; /* most bytes that one read delivers */
};

static struct image image_make(int32_t h, int32_t d, int32_t p)
{
	const int32_t header[3] = {h, d, p};
	const size_t cells = (size_t)h * (size_t)d * (size_t)p;
	struct image image = {.count = 12 + 24 * cells, .piece = SIZE_MAX};
	image.bytes = malloc(image.count + 1);
	memcpy(image.bytes, header, 12);
	for (size_t n = 0; n < 3 * cells; n++) {
		const double value = (double)(n % cells) + 1000.0 * (double)(n / cells);
		memcpy(image.bytes + 12 + 8 * n, &value, 8);
	}
	return image;
}

static void image_set(struct image *image, size_t value_index, double value)
{
	memcpy(image->bytes + 12 + 8 * value_index, &value, 8);
}

static bp_status image_read(void *user, void *bytes, size_t capacity, size_t *read, bp_error *error)
{
	struct image *image = user;
	(void)error;
	size_t count = image->count - image->next;
	count = count < capacity ? count : capacity;
	count = count < image->piece ? count : image->piece;
	memcpy(bytes, image->bytes + image->next, count);
	image->next += count;
	*read = count;
	return BP_OK;
}

static bp_status broken_read(void *user, void *bytes, size_t capacity, size_t *read, bp_error *error)
{
	(void)user, (void)bytes, (void)capacity, (void)read;
	error->status = BP_ERROR_IO;
	strcpy(error->message, "the disk is gone");
	return BP_ERROR_IO;
}

struct transcript {
	unsigned char *bytes;
	size_t count;
};

static void transcript_add(void *user, const void *bytes, size_t count)
{
	struct transcript *transcript = user;
	transcript->bytes = realloc(transcript->bytes, transcript->count + count);
	memcpy(transcript->bytes + transcript->count, bytes, count);
	transcript->count += count;
}

static void expect_refusal(struct image *image, bool any_dims, const char *words)
{
	struct lattice lattice = {0};
	bp_error error = {0};
	assert_int_equal(lattice_read(image_read, image, &(struct merl_reading){.any_dims = any_dims}, &lattice, &error),
	                 BP_ERROR_BAD_INPUT);
	expect_words(error.message, words);
	assert_null(lattice.block);
	free(image->bytes);
}

static void a_lattice_is_scaled_and_lies_plane_by_plane(void **state)
{
	(void)state;
	const size_t pieces[] = {SIZE_MAX, 1, 7, 4096};
	for (size_t t = 0; t < sizeof pieces / sizeof *pieces; t++) {
		struct image image = image_make(4, 5, 6);
		struct transcript seen = {0};
		struct lattice lattice;
		image.piece = pieces[t];
		image_set(&image, 17, -1);
		image_set(&image, 120 + 18, -1e-9);
		image_set(&image, 240 + 19, NAN);
		image_set(&image, 240 + 20, INFINITY);
		assert_int_equal(lattice_read(image_read, &image,
		                              &(struct merl_reading){.seen = transcript_add, .seen_user = &seen, .any_dims = true},
		                              &lattice, NULL),
		                 BP_OK);
		assert_int_equal(lattice.dims.theta_h, 4);
		assert_int_equal(lattice.dims.theta_d, 5);
		assert_int_equal(lattice.dims.phi_d, 6);
		assert_int_equal(lattice.valid_count, 116);
		assert_int_equal(lattice.nonfinite_count, 2);
		for (size_t n = 0; n < 120; n++) {
			assert_int_equal(lattice.valid[n], n < 17 || n > 20);
			for (int c = 0; c < 3 && lattice.valid[n]; c++)
				assert_true(lattice.rgb[c][n] == ((double)n + 1000 * c) * MERL_SCALE[c]);
			for (int c = 0; c < 3; c++)
				assert_true(isfinite(lattice.rgb[c][n]));
		}
		assert_int_equal(seen.count, image.count);
		assert_memory_equal(seen.bytes, image.bytes, image.count);
		free(seen.bytes);
		free(image.bytes);
		lattice_free(&lattice);
	}
}

static void headers_other_than_90_90_180_are_refused_with_what_was_found(void **state)
{
	(void)state;
	struct image image = image_make(4, 5, 6);
	expect_refusal(&image, false, "expected the header 90 90 180, found 4 5 6");
	image = image_make(3, 5, 6);
	expect_refusal(&image, true, "found 3 5 6");
	image = image_make(4, 4, 4);
	memcpy(image.bytes, "PK\3\4\0\0\0\0\xff\xff\xff\xff", 12);
	expect_refusal(&image, true, "not a MERL file");
}

static void numbers_of_another_machine_or_of_half_the_size_are_told(void **state)
{
	(void)state;
	struct image image = image_make(4, 4, 4);
	memcpy(image.bytes, "\0\0\0\132\0\0\0\132\0\0\0\264", 12); /* 90 90 180 */
	expect_refusal(&image, false, "big-endian");
	image = image_make(4, 4, 4);
	image.count = 12 + (image.count - 12) / 2;
	expect_refusal(&image, true, "truncated: expected 1548 bytes, found 780, as many as values of 4 bytes take");
}

static void truncation_at_any_byte_is_told_with_expected_and_found(void **state)
{
	(void)state;
	struct image whole = image_make(4, 4, 4);
	for (size_t count = 0; count < whole.count; count++) {
		char words[80];
		struct image part = image_make(4, 4, 4);
		part.count = count;
		if (!count)
			snprintf(words, sizeof words, "empty: expected a MERL file of 34992012 bytes");
		else
			snprintf(words, sizeof words, "truncated: expected %d bytes, found %zu", count < 12 ? 34992012 : 1548, count);
		expect_refusal(&part, true, words);
	}
	free(whole.bytes);
}

static void trailing_bytes_are_refused(void **state)
{
	(void)state;
	struct image image = image_make(4, 4, 4);
	image.bytes[image.count++] = 0;
	expect_refusal(&image, true, "trailing bytes: expected the end after 1548 bytes");
}

static void a_table_without_a_valid_cell_is_refused(void **state)
{
	(void)state;
	struct image image = image_make(4, 4, 4);
	for (size_t n = 0; n < 64; n++)
		image_set(&image, 64 * (n % 3) + n, n % 2 ? -1 : NAN);
	expect_refusal(&image, true, "no valid cell");
}

static void zeros_and_extreme_values_are_legal(void **state)
{
	(void)state;
	const double values[] = {0, 1e-300, 1e300, DBL_MAX, 5e-324};
	for (size_t v = 0; v < sizeof values / sizeof *values; v++) {
		struct image image = image_make(4, 4, 4);
		struct lattice lattice;
		for (size_t n = 0; n < 192; n++)
			image_set(&image, n, values[v]);
		assert_int_equal(lattice_read(image_read, &image, &(struct merl_reading){.any_dims = true}, &lattice, NULL), BP_OK);
		assert_int_equal(lattice.valid_count, 64);
		for (size_t n = 0; n < 64; n++)
			assert_true(isfinite(lattice.rgb[2][n]) && lattice.rgb[2][n] >= 0);
		lattice_free(&lattice);
		free(image.bytes);
	}
}

static void an_error_of_the_stream_is_passed_on(void **state)
{
	(void)state;
	struct lattice lattice;
	bp_error error;
	assert_int_equal(lattice_read(broken_read, NULL, NULL, &lattice, &error), BP_ERROR_IO);
	assert_string_equal(error.message, "the disk is gone");
}

static void put_file(const char *path, const void *bytes, size_t count)
{
	FILE *file = fopen(path, "wb");
	assert_non_null(file);
	assert_int_equal(fwrite(bytes, 1, count, file), count);
	assert_int_equal(fclose(file), 0);
}

static bp_status read_path(const char *path, bp_error *error)
{
	struct lattice lattice = {0};
	const bp_status status = lattice_read_path(path, &(struct merl_reading){.any_dims = true}, &lattice, error);
	lattice_free(&lattice);
	return status;
}

static void files_are_refused_by_their_size_with_expected_and_found(void **state)
{
	(void)state;
	bp_error error;
	struct image image = image_make(4, 4, 4);
	put_file(in_folder("a.binary"), image.bytes, image.count);
	assert_int_equal(read_path(in_folder("a.binary"), &error), BP_OK);
	put_file(in_folder("a.binary"), image.bytes, image.count - 5);
	assert_int_equal(read_path(in_folder("a.binary"), &error), BP_ERROR_BAD_INPUT);
	assert_string_equal(error.message, "truncated: expected 1548 bytes, found 1543");
	put_file(in_folder("a.binary"), image.bytes, image.count + 1);
	assert_int_equal(read_path(in_folder("a.binary"), &error), BP_ERROR_BAD_INPUT);
	assert_string_equal(error.message, "trailing bytes: expected 1548 bytes, found 1549");
	put_file(in_folder("a.binary"), image.bytes, 0);
	assert_int_equal(read_path(in_folder("a.binary"), &error), BP_ERROR_BAD_INPUT);
	unlink(in_folder("a.binary"));
	free(image.bytes);
}

static void what_is_not_a_file_is_refused_without_waiting(void **state)
{
	(void)state;
	bp_error error;
	assert_int_equal(mkfifo(in_folder("fifo"), 0600), 0);
	assert_int_equal(read_path(in_folder("fifo"), &error), BP_ERROR_BAD_INPUT);
	unlink(in_folder("fifo"));
	assert_int_equal(read_path("/dev/zero", &error), BP_ERROR_BAD_INPUT);
	assert_int_equal(read_path(folder, &error), BP_ERROR_BAD_INPUT);
	assert_int_equal(read_path(in_folder("missing"), &error), BP_ERROR_IO);
	assert_non_null(strstr(error.message, "No such file"));
}

static void a_written_table_is_laid_out_byte_for_byte_and_reads_back(void **state)
{
	(void)state;
	const struct lattice_dims dims = {5, 4, 7};
	struct expansion table;
	uint8_t below[140] = {0};
	assert_int_equal(expansion_alloc(dims, &table, NULL), BP_OK);
	table.unit = 0.25;
	for (size_t n = 0; n < 140; n++)
		for (int c = 0; c < 3; c++)
			table.rgb[c][n] = (float)(n + 1) * (float)(c + 1);
	below[3] = below[139] = 1;
	put_file(in_folder("out.binary"), "older", 5);
	assert_int_equal(lattice_write_path(in_folder("out.binary"), OUTPUT_REPLACE, &table, below, NULL, 0, NULL), BP_OK);
	unsigned char bytes[12 + 24 * 140 + 1];
	FILE *file = fopen(in_folder("out.binary"), "rb");
	assert_int_equal(fread(bytes, 1, sizeof bytes, file), sizeof bytes - 1);
	fclose(file);
	assert_memory_equal(bytes, "\5\0\0\0\4\0\0\0\7\0\0\0", 12);
	for (size_t n = 0; n < 420; n++) {
		double value;
		memcpy(&value, bytes + 12 + 8 * n, 8);
		if (below[n % 140])
			assert_true(value == -1);
		else
			assert_true(value == 0.25 * (double)((n % 140 + 1) * (n / 140 + 1)) / MERL_SCALE[n / 140]);
	}
	struct lattice lattice;
	assert_int_equal(lattice_read_path(in_folder("out.binary"), &(struct merl_reading){.any_dims = true}, &lattice, NULL), BP_OK);
	assert_int_equal(lattice.valid_count, 138);
	lattice_free(&lattice);
	expansion_free(&table);
	unlink(in_folder("out.binary"));
}

static void values_beyond_the_range_of_the_file_stay_finite(void **state)
{
	(void)state;
	struct expansion table;
	struct lattice lattice;
	uint8_t below[64] = {0};
	assert_int_equal(expansion_alloc((struct lattice_dims){4, 4, 4}, &table, NULL), BP_OK);
	table.unit = 1e306;
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < 64; n++)
			table.rgb[c][n] = 100;
	assert_int_equal(lattice_write_path(in_folder("huge.binary"), OUTPUT_REPLACE, &table, below, NULL, 0, NULL), BP_OK);
	assert_int_equal(lattice_read_path(in_folder("huge.binary"), &(struct merl_reading){.any_dims = true}, &lattice, NULL),
	                 BP_OK);
	assert_int_equal(lattice.valid_count, 64);
	lattice_free(&lattice);
	expansion_free(&table);
	unlink(in_folder("huge.binary"));
}

static void a_failed_write_names_the_path_and_leaves_nothing(void **state)
{
	(void)state;
	struct expansion table;
	uint8_t below[64] = {0};
	bp_error error;
	assert_int_equal(expansion_alloc((struct lattice_dims){4, 4, 4}, &table, NULL), BP_OK);
	assert_int_equal(lattice_write_path(in_folder("none/out.binary"), OUTPUT_REPLACE, &table, below, NULL, 0, &error),
	                 BP_ERROR_IO);
	assert_non_null(strstr(error.message, in_folder("none/out.binary")));
	assert_int_equal(mkdir(in_folder("taken"), 0700), 0); /* a folder of that name cannot be replaced */
	assert_int_equal(lattice_write_path(in_folder("taken"), OUTPUT_REPLACE, &table, below, NULL, 0, &error), BP_ERROR_IO);
	assert_int_equal(rmdir(in_folder("taken")), 0);
	expansion_free(&table);
}

static int make_folder(void **state)
{
	(void)state;
	return scratch_folder(folder);
}

/* rmdir fails, and so does the group, when a test left a temporary file behind. */
static int remove_folder(void **state)
{
	(void)state;
	return rmdir(folder);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_lattice_is_scaled_and_lies_plane_by_plane),
		cmocka_unit_test(headers_other_than_90_90_180_are_refused_with_what_was_found),
		cmocka_unit_test(numbers_of_another_machine_or_of_half_the_size_are_told),
		cmocka_unit_test(truncation_at_any_byte_is_told_with_expected_and_found),
		cmocka_unit_test(trailing_bytes_are_refused),
		cmocka_unit_test(a_table_without_a_valid_cell_is_refused),
		cmocka_unit_test(zeros_and_extreme_values_are_legal),
		cmocka_unit_test(an_error_of_the_stream_is_passed_on),
		cmocka_unit_test(files_are_refused_by_their_size_with_expected_and_found),
		cmocka_unit_test(what_is_not_a_file_is_refused_without_waiting),
		cmocka_unit_test(a_written_table_is_laid_out_byte_for_byte_and_reads_back),
		cmocka_unit_test(values_beyond_the_range_of_the_file_stay_finite),
		cmocka_unit_test(a_failed_write_names_the_path_and_leaves_nothing),
	};
	return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
