#include "rgl_file.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "rgl_lattice.h"

enum { FIRST_BYTES = 1 << 16 };
_Static_assert((int)FIRST_BYTES >= (int)TENSOR_TABLE_BYTES_MAX, "the table of fields is read before the arrays");

/* The file as far as it has been read. */
struct image {
	uint8_t *bytes;
	size_t count, room;
	bool ended;
};

/* Reads on until `wanted` bytes are there, or the end. */
static bp_status image_fill(struct image *image, struct input *in, size_t wanted, bp_error *error)
{
	if (wanted > image->room) {
		uint8_t *bytes = realloc(image->bytes, wanted);
		if (!bytes)
			return error_memory(error, wanted);
		image->bytes = bytes;
		image->room = wanted;
	}
	size_t got = 0;
	bp_status status = input_fill(in, image->bytes + image->count, wanted - image->count, &got, error);
	image->count += got;
	image->ended = image->count < wanted;
	return status;
}

static bp_status too_large(bp_error *error)
{
	return error_set(error, BP_ERROR_BAD_INPUT, RGL_FILE_BYTES_MAX, "a tensor file of more than %d bytes, which is not read",
	                 RGL_FILE_BYTES_MAX);
}

/*
 * How far to read on: a byte past the end that is known, to see that it is one; twice as far where none is, or where the file has
 * grown past it, or has bytes although it was said to be empty.
 */
static size_t goal_of(const struct image *image, uint64_t available, size_t most)
{
	if (available >= image->count && available < most)
		return (size_t)available + 1;
	const size_t twice = image->count < FIRST_BYTES / 2 ? FIRST_BYTES : 2 * image->count;
	return twice < most ? twice : most;
}

/* All of the file, refused early where its table says enough. */
static bp_status image_read(struct image *image, struct input *in, struct tensor_table *table, bp_error *error)
{
	const size_t most = RGL_FILE_BYTES_MAX + 1;
	bp_status status = image_fill(image, in, goal_of(image, in->available, FIRST_BYTES), error);
	const uint64_t size = image->ended ? image->count : in->available < image->count ? UINT64_MAX : in->available;
	if (!status)
		status = tensor_table_parse(image->bytes, image->count, size, table, error);
	if (!status)
		status = rgl_table_check(table, error);
	if (!status && in->available != UINT64_MAX && in->available > RGL_FILE_BYTES_MAX)
		status = too_large(error);
	while (!status && !image->ended)
		status = image->count == most ? too_large(error) : image_fill(image, in, goal_of(image, in->available, most), error);
	return status ? status : tensor_table_parse(image->bytes, image->count, image->count, table, error);
}

bp_status rgl_file_read(struct input *in, const uint8_t head[TENSOR_MAGIC_BYTES], struct lattice *out, struct origin *origin,
                        bp_error *error)
{
	struct image image = {.bytes = malloc(FIRST_BYTES), .room = FIRST_BYTES, .count = TENSOR_MAGIC_BYTES};
	struct tensor_table *table = malloc(sizeof *table);
	struct rgl_material material = {0};
	bp_status status = image.bytes && table ? BP_OK : error_memory(error, FIRST_BYTES);
	if (status)
		goto out;
	memcpy(image.bytes, head, TENSOR_MAGIC_BYTES);
	status = image_read(&image, in, table, error);
	if (!status)
		status = rgl_material_make(image.bytes, table, &material, error);
	free(image.bytes);
	image.bytes = NULL;
	if (!status)
		status = rgl_lattice_make(&material, out, origin, error);
out:
	rgl_material_free(&material);
	free(image.bytes);
	free(table);
	return status;
}
