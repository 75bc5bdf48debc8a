#include "merl_file.h"

#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "error.h"
#include "output_file.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
               "the writing half of brdfpack is for little-endian machines: it takes MERL files as they lie in memory");

enum { HEADER_BYTES = 12, CHUNK_VALUES = 1 << 15 }; /* 256 KB: read, hashed and checked while in the cache */

uint64_t merl_file_bytes(struct lattice_dims dims) { return HEADER_BYTES + 3 * sizeof(double) * (uint64_t)lattice_cells(dims); }

/* Where the bytes come from and who looks on. */
struct input {
	merl_read_fn *read;
	void *user;
	struct merl_reading how;
	uint64_t done;
};

/* Reads `count` bytes, or fewer at the end of the stream: *got says how many. */
static bp_status input_fill(struct input *in, void *bytes, size_t count, size_t *got, bp_error *error)
{
	char *next = bytes;
	size_t filled = 0;
	while (filled < count) {
		size_t once = 0;
		bp_status status = in->read(in->user, next + filled, count - filled, &once, error);
		if (status != BP_OK)
			return status;
		if (!once)
			break;
		filled += once;
	}
	if (in->how.seen && filled)
		in->how.seen(in->how.seen_user, bytes, filled);
	in->done += filled;
	*got = filled;
	return BP_OK;
}

static bp_status truncated(uint64_t expected, uint64_t found, bp_error *error)
{
	return error_set(error, BP_ERROR_BAD_INPUT, found, "truncated: expected %" PRIu64 " bytes, found %" PRIu64, expected, found);
}

static bp_status header_read(struct input *in, struct lattice_dims *dims, bp_error *error)
{
	int32_t extent[3];
	size_t got;
	bp_status status = input_fill(in, extent, sizeof extent, &got, error);
	if (status != BP_OK)
		return status;
	if (!got)
		return error_set(error, BP_ERROR_BAD_INPUT, 0, "empty: expected a MERL file of %" PRIu64 " bytes",
		                 merl_file_bytes(LATTICE_MERL));
	if (got < sizeof extent)
		return truncated(merl_file_bytes(LATTICE_MERL), got, error);
	*dims =
		(struct lattice_dims){(uint32_t)extent[0], (uint32_t)extent[1], (uint32_t)extent[2]}; /* a negative one is too large */
	const bool merl = extent[0] == 90 && extent[1] == 90 && extent[2] == 180;
	if (merl || (in->how.any_dims && lattice_dims_legal(*dims)))
		return BP_OK;
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
				return truncated(expected, in->done, error);
			if (in->how.carried && !carried_read(carried, values, count))
				return error_memory(error, carried->count);
			lattice_scan(values, count, MERL_SCALE[c], lattice->valid + start);
		}
	char extra;
	status = in->read(in->user, &extra, 1, &got, error);
	if (status != BP_OK)
		return status;
	if (got)
		return error_set(error, BP_ERROR_BAD_INPUT, expected,
		                 "trailing bytes: expected the end after %" PRIu64 " bytes, found more", expected);
	lattice_scan_finish(lattice);
	if (!lattice->valid_count)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
		                 "no valid cell: each of the %zu is negative, NaN or infinite in some channel", cells);
	return BP_OK;
}

static struct input input_over(merl_read_fn *read, void *user, const struct merl_reading *reading)
{
	return (struct input){.read = read, .user = user, .how = reading ? *reading : (struct merl_reading){0}};
}

/* `available`: the bytes that are there, where that is known; a size that cannot be right is told before 35 MB are read in vain. */
static bp_status input_read(struct input *in, uint64_t available, struct lattice *out, bp_error *error)
{
	struct carried_reader carried = {0};
	struct lattice lattice = {0};
	struct lattice_dims dims;
	bp_status status = header_read(in, &dims, error);
	if (status != BP_OK)
		return status;
	const uint64_t expected = merl_file_bytes(dims);
	if (available < expected)
		return truncated(expected, available, error);
	if (available > expected && available != UINT64_MAX)
		return error_set(error, BP_ERROR_BAD_INPUT, expected, "trailing bytes: expected %" PRIu64 " bytes, found %" PRIu64,
		                 expected, available);
	status = lattice_alloc(dims, &lattice, error);
	if (status != BP_OK)
		return status;
	carried.values = 3 * lattice_cells(dims);
	status = planes_read(in, &lattice, &carried, error);
	if (status != BP_OK || !carried.whole) {
		free(carried.bytes);
		carried.bytes = NULL;
	}
	if (status != BP_OK) {
		lattice_free(&lattice);
		return status;
	}
	if (in->how.carried)
		*in->how.carried = (struct carried){.bytes = carried.bytes, .count = carried.bytes ? carried.count : 0};
	*out = lattice;
	return BP_OK;
}

bp_status lattice_read(merl_read_fn *read, void *user, const struct merl_reading *reading, struct lattice *out, bp_error *error)
{
	struct input in = input_over(read, user, reading);
	return input_read(&in, UINT64_MAX, out, error);
}

/* merl_read_fn over a file descriptor */
static bp_status descriptor_read(void *user, void *bytes, size_t capacity, size_t *got, bp_error *error)
{
	const int *fd = user;
	for (;;) {
		const ssize_t count = read(*fd, bytes, capacity);
		if (count >= 0) {
			*got = (size_t)count;
			return BP_OK;
		}
		if (errno != EINTR)
			return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot read: %s", strerror(errno));
	}
}

bp_status lattice_read_path(const char *path, const struct merl_reading *reading, struct lattice *out, bp_error *error)
{
	bp_status status;
	struct stat about;
	/* O_NONBLOCK: opening a FIFO or a device must not wait for its other side */
	int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
	if (fd < 0 || fstat(fd, &about) != 0) {
		status = error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot open: %s", strerror(errno));
		goto out;
	}
	if (!S_ISREG(about.st_mode)) {
		status = error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "%s",
		                   S_ISDIR(about.st_mode) ? "a folder, not a file" : "not a regular file");
		goto out;
	}
	struct input in = input_over(descriptor_read, &fd, reading);
	status = input_read(&in, (uint64_t)about.st_size, out, error);
out:
	if (fd >= 0)
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
	struct output_file file;
	bp_status status = output_file_open(path, rule, &file, error);
	if (status != BP_OK)
		return status;
	double *values = malloc(CHUNK_VALUES * sizeof *values);
	if (!values) {
		status = error_memory(error, CHUNK_VALUES * sizeof *values);
		goto out;
	}
	status = output_file_write(&file, header, sizeof header, error);
	for (int c = 0; c < 3; c++)
		for (size_t start = 0; start < cells && status == BP_OK; start += CHUNK_VALUES) {
			const size_t count = cells - start < CHUNK_VALUES ? cells - start : CHUNK_VALUES;
			fill(user, c, start, count, values);
			status = output_file_write(&file, values, count * sizeof *values, error);
		}
	if (status == BP_OK)
		status = output_file_commit(&file, error);
out:
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

static size_t marked(const uint8_t *mask, size_t cells)
{
	size_t count = 0;
	for (size_t n = 0; n < cells; n++)
		count += mask[n];
	return count;
}

bp_status lattice_write_path(const char *path, enum output_rule rule, const struct expansion *table, const uint8_t *below,
                             const uint8_t *carried, size_t carried_bytes, bp_error *error)
{
	struct decoded decoded = {.table = table, .below = below};
	if (carried && carried_fits(carried_bytes, 3 * marked(below, lattice_cells(table->dims))))
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
