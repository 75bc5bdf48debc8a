#include "merl_file.h"

#include <errno.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "error.h"
#include "foreign.h"
#include "input.h"
#include "output_file.h"
#include "rgl_file.h"
#include "two_halves.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
               "the writing half of brdfpack is for little-endian machines: it takes MERL files as they lie in memory");

enum { HEADER_BYTES = 12, CHUNK_VALUES = 1 << 15 }; /* 256 KB: read, hashed and checked while in the cache */

uint64_t merl_file_bytes(struct lattice_dims dims) { return HEADER_BYTES + 3 * sizeof(double) * (uint64_t)lattice_cells(dims); }

/* What a file of another kind is told; `head`: what was read of it. */
static bp_status no_merl_file(struct input *in, const uint8_t head[HEADER_BYTES], bp_error *error)
{
	uint8_t more[FOREIGN_HEAD_BYTES];
	int32_t extent[3];
	size_t got = 0;
	memcpy(more, head, HEADER_BYTES);
	memcpy(extent, head, sizeof extent);
	bp_status status = input_fill(in, more + HEADER_BYTES, sizeof more - HEADER_BYTES, &got, error);
	const char *kind = status ? NULL : foreign_kind(more, HEADER_BYTES + got);
	if (status)
		return status;
	if (extent[0] == extent[1] && extent[0] == (int32_t)__builtin_bswap32(90) && extent[2] == (int32_t)__builtin_bswap32(180))
		return error_set(error, BP_ERROR_BAD_INPUT, 0,
		                 "the bytes of its numbers are the other way round (big-endian): a MERL file is little-endian");
	if (kind)
		return error_set(error, BP_ERROR_BAD_INPUT, 0, "neither a MERL file nor one of the RGL database: %s", kind);
	return error_set(error, BP_ERROR_BAD_INPUT, 0,
	                 "not a MERL file: expected the header 90 90 180%s, found %" PRId32 " %" PRId32 " %" PRId32,
	                 in->how.any_dims ? " (or other legal extents)" : "", extent[0], extent[1], extent[2]);
}

/* After the header: the planes, to the end of the stream; what is carried in them, if that is asked for. */
static bp_status planes_read(struct input *in, struct lattice *lattice, struct carried_reader *carried, bp_error *error)
{
	const size_t cells = lattice_cells(lattice->dims);
	const uint64_t expected = merl_file_bytes(lattice->dims);
	bp_status status;
	size_t got;
	for (int c = 0; c < 3; c++)
		for (size_t start = 0; start < cells; start += CHUNK_VALUES) {
			const size_t count = cells - start < CHUNK_VALUES ? cells - start : CHUNK_VALUES;
			double *values = lattice->rgb[c] + start;
			status = input_fill(in, values, count * sizeof *values, &got, error);
			if (status != BP_OK)
				return status;
			if (got < count * sizeof *values)
				return input_truncated(expected, in->done, error);
			if (in->how.carried && !carried_read(carried, values, count))
				return error_memory(error, carried->count);
			lattice->most = fmax(lattice->most, lattice_scan(values, count, MERL_SCALE[c], lattice->valid + start));
		}
	status = input_end(in, error);
	if (status != BP_OK)
		return status;
	lattice_scan_finish(lattice);
	return BP_OK;
}

/* A size that cannot be right is told before 35 MB are read in vain. */
static bp_status size_check(const struct input *in, uint64_t expected, bp_error *error)
{
	if (in->available < expected)
		return input_truncated(expected, in->available, error);
	if (in->available > expected && in->available != UINT64_MAX)
		return error_set(error, BP_ERROR_BAD_INPUT, expected, "trailing bytes: expected %" PRIu64 " bytes, found %" PRIu64,
		                 expected, in->available);
	return BP_OK;
}

/* A MERL file behind its header. *out is the caller's to free in any case. */
static bp_status table_read(struct input *in, struct lattice_dims dims, struct lattice *out, bp_error *error)
{
	struct carried_reader carried = {.values = 3 * lattice_cells(dims)};
	bp_status status = size_check(in, merl_file_bytes(dims), error);
	if (status == BP_OK)
		status = lattice_alloc(dims, out, error);
	if (status == BP_OK)
		status = planes_read(in, out, &carried, error);
	if (status == BP_OK && carried.whole)
		in->carried = (struct carried){carried.bytes, carried.count};
	else
		free(carried.bytes);
	return status;
}

/* By the first twelve bytes: a tensor file's magic, or a table's extents. */
static bp_status kind_read(struct input *in, struct lattice *out, struct origin *origin, bp_error *error)
{
	uint8_t head[HEADER_BYTES];
	int32_t extent[3];
	size_t got;
	bp_status status = input_fill(in, head, sizeof head, &got, error);
	if (status != BP_OK)
		return status;
	if (!got)
		return error_set(error, BP_ERROR_BAD_INPUT, 0, "empty: expected a MERL file of %" PRIu64 " bytes",
		                 merl_file_bytes(LATTICE_MERL));
	if (got < sizeof head)
		return input_truncated(merl_file_bytes(LATTICE_MERL), got, error);
	if (memcmp(head, TENSOR_MAGIC, sizeof head) == 0)
		return rgl_file_read(in, head, out, origin, error);
	memcpy(extent, head, sizeof extent);
	if (two_halves_extents(extent)) {
		status = size_check(in, two_halves_bytes(), error);
		return status ? status : two_halves_read(in, out, origin, error);
	}
	const struct lattice_dims dims = {(uint32_t)extent[0], (uint32_t)extent[1],
	                                  (uint32_t)extent[2]}; /* a negative one is too large */
	const bool merl = extent[0] == 90 && extent[1] == 90 && extent[2] == 180;
	if (merl || (in->how.any_dims && lattice_dims_legal(dims)))
		return table_read(in, dims, out, error);
	return no_merl_file(in, head, error);
}

static bp_status input_read(merl_read_fn *read, void *user, uint64_t available, const struct merl_reading *reading,
                            struct lattice *out, bp_error *error)
{
	struct input in = {.read = read, .user = user, .how = reading ? *reading : (struct merl_reading){0}, .available = available};
	struct origin origin = {.kind = ORIGIN_MERL};
	struct lattice lattice = {0};
	bp_status status = kind_read(&in, &lattice, &origin, error);
	if (status == BP_OK && !lattice.valid_count)
		status = error_set(
			error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "no valid cell: each of the %zu is %s", lattice_cells(lattice.dims),
			origin.kind == ORIGIN_MERL ? "negative, NaN or infinite in some channel" : "without data in some direction");
	if (status != BP_OK) {
		lattice_free(&lattice);
		free(in.carried.bytes);
		return status;
	}
	if (in.how.carried)
		*in.how.carried = in.carried;
	if (in.how.origin)
		*in.how.origin = origin;
	if (in.how.file_bytes)
		*in.how.file_bytes = in.done;
	*out = lattice;
	return BP_OK;
}

bp_status lattice_read(merl_read_fn *read, void *user, const struct merl_reading *reading, struct lattice *out, bp_error *error)
{
	return input_read(read, user, UINT64_MAX, reading, out, error);
}

/* merl_read_fn over a file descriptor */
static bp_status descriptor_read(void *user, void *bytes, size_t capacity, size_t *got, bp_error *error)
{
	const int *fd = user;
	ssize_t count;
	do
		count = read(*fd, bytes, capacity);
	while (count < 0 && errno == EINTR);
	if (count < 0)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot read: %s", strerror(errno));
	*got = (size_t)count;
	return BP_OK;
}

bp_status lattice_read_path(const char *path, const struct merl_reading *reading, struct lattice *out, bp_error *error)
{
	int fd;
	uint64_t bytes;
	bp_status status = input_open(path, &fd, &bytes, error);
	if (status)
		return status;
	status = input_read(descriptor_read, &fd, bytes, reading, out, error);
	close(fd);
	return status;
}

/* Fills values[count], in the file's units, from cell `start` of a channel; called in file order. */
typedef void chunk_fill_fn(void *user, int channel, size_t start, size_t count, double *values);

static bp_status planes_write(const char *path, enum output_rule rule, struct lattice_dims dims, chunk_fill_fn *fill, void *user,
                              bp_error *error)
{
	const size_t cells = lattice_cells(dims);
	const int32_t header[3] = {(int32_t)dims.theta_h, (int32_t)dims.theta_d, (int32_t)dims.phi_d};
	struct output_file file = {.fd = -1};
	double *values = malloc(CHUNK_VALUES * sizeof *values);
	bp_status status = values ? output_file_open(path, rule, &file, error) : error_memory(error, CHUNK_VALUES * sizeof *values);
	if (status == BP_OK)
		status = output_file_write(&file, header, sizeof header, error);
	for (int c = 0; c < 3; c++)
		for (size_t start = 0; start < cells && status == BP_OK; start += CHUNK_VALUES) {
			const size_t count = cells - start < CHUNK_VALUES ? cells - start : CHUNK_VALUES;
			fill(user, c, start, count, values);
			status = output_file_write(&file, values, count * sizeof *values, error);
		}
	if (status == BP_OK)
		status = output_file_commit(&file, error);
	free(values);
	output_file_discard(&file);
	return status;
}

struct decoded {
	const struct expansion *table;
	const uint8_t *below;
	struct carried_writer carried;
};

static void decoded_fill(void *user, int channel, size_t start, size_t count, double *values)
{
	struct decoded *decoded = user;
	const float *source = decoded->table->rgb[channel] + start;
	const uint8_t *below = decoded->below + start;
	const double unit = decoded->table->unit, scale = MERL_SCALE[channel];
	for (size_t n = 0; n < count; n++) {
		const double value = unit * (double)source[n] / scale;
		values[n] = value <= DBL_MAX ? value : DBL_MAX; /* a table near the end of the range */
	}
	for (size_t n = 0; n < count; n++)
		if (below[n])
			values[n] = carried_write(&decoded->carried);
}

bp_status lattice_write_path(const char *path, enum output_rule rule, const struct expansion *table, const uint8_t *below,
                             const uint8_t *carried, size_t carried_bytes, bp_error *error)
{
	struct decoded decoded = {.table = table, .below = below};
	size_t marked = 0;
	for (size_t n = 0; carried && n < lattice_cells(table->dims); n++)
		marked += below[n];
	if (carried && carried_fits(carried_bytes, 3 * marked))
		decoded.carried = (struct carried_writer){.bytes = carried, .count = carried_bytes};
	return planes_write(path, rule, table->dims, decoded_fill, &decoded, error);
}

bool lattice_is_written(const struct lattice *lattice, const struct expansion *table, const uint8_t *below)
{
	const size_t cells = lattice_cells(lattice->dims);
	struct decoded decoded = {.table = table, .below = below};
	double values[256];
	uint8_t state[256];

	for (int c = 0; c < 3; c++)
		for (size_t start = 0; start < cells; start += 256) {
			const size_t count = cells - start < 256 ? cells - start : 256;
			decoded_fill(&decoded, c, start, count, values);
			memset(state, 0, sizeof state);
			lattice_scan(values, count, MERL_SCALE[c], state);
			for (size_t n = 0; n < count; n++)
				if (lattice->valid[start + n] != (state[n] == 0) ||
				    (lattice->valid[start + n] && lattice->rgb[c][start + n] != values[n]))
					return false;
		}
	return true;
}

static void measured_fill(void *user, int channel, size_t start, size_t count, double *values)
{
	const struct lattice *lattice = user;
	for (size_t n = 0; n < count; n++) {
		const size_t cell = start + n;
		const bool told =
			lattice->valid[cell] || lattice->rgb[0][cell] < 0 || lattice->rgb[1][cell] < 0 || lattice->rgb[2][cell] < 0;
		values[n] = told ? lattice->rgb[channel][cell] / MERL_SCALE[channel] : -1;
	}
}

bp_status lattice_save_path(const char *path, enum output_rule rule, const struct lattice *lattice, bp_error *error)
{
	return planes_write(path, rule, lattice->dims, measured_fill, (void *)(uintptr_t)lattice, error);
}
