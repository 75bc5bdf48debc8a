#include "lattice.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "clones.h"
#include "error.h"
#include "memory.h"

const struct lattice_dims LATTICE_MERL = {90, 90, 180};
const double MERL_SCALE[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};

enum { ALIGNMENT = 64 };

bool lattice_dims_legal(struct lattice_dims dims)
{
	const uint32_t extent[3] = {dims.theta_h, dims.theta_d, dims.phi_d};
	for (int a = 0; a < 3; a++)
		if (extent[a] < LATTICE_EXTENT_MIN || extent[a] > LATTICE_EXTENT_MAX)
			return false;
	return lattice_cells(dims) <= LATTICE_CELLS_MAX;
}

size_t lattice_cells(struct lattice_dims dims) { return (size_t)dims.theta_h * dims.theta_d * dims.phi_d; }

/*
 * Three planes of values of `size` bytes and `extra` bytes for each cell in one block; planes[3] is where the extra ones start.
 */
static bp_status planes_alloc(struct lattice_dims dims, size_t size, size_t extra, void **block, void *planes[4], bp_error *error)
{
	if (!lattice_dims_legal(dims))
		return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET,
		                 "lattice of %u x %u x %u: each extent must be %d to %d, %d cells at most", dims.theta_h, dims.theta_d,
		                 dims.phi_d, LATTICE_EXTENT_MIN, LATTICE_EXTENT_MAX, LATTICE_CELLS_MAX);
	const size_t stride = (lattice_cells(dims) * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
	const size_t bytes = 3 * stride + lattice_cells(dims) * extra + ALIGNMENT;
	/* Not aligned_alloc: a worker's heap, which is kept from material to material, would fill with gaps. */
	*block = malloc(bytes);
	if (!*block)
		return error_memory(error, bytes);
	memory_prefer_huge(*block, bytes);
	const size_t ahead = (ALIGNMENT - (uintptr_t)*block % ALIGNMENT) % ALIGNMENT;
	for (size_t c = 0; c < 4; c++)
		planes[c] = (unsigned char *)*block + ahead + c * stride;
	return BP_OK;
}

bp_status lattice_alloc(struct lattice_dims dims, struct lattice *out, bp_error *error)
{
	void *block, *planes[4];
	const bp_status status = planes_alloc(dims, sizeof(double), 1, &block, planes, error);
	if (status)
		return status;
	*out = (struct lattice){.dims = dims, .rgb = {planes[0], planes[1], planes[2]}, .valid = planes[3], .block = block};
	memset(out->valid, 0, lattice_cells(dims));
	return BP_OK;
}

void lattice_free(struct lattice *lattice)
{
	free(lattice->block);
	*lattice = (struct lattice){0};
}

bp_status expansion_alloc(struct lattice_dims dims, struct expansion *out, bp_error *error)
{
	void *block, *planes[4];
	const bp_status status = planes_alloc(dims, sizeof(float), 0, &block, planes, error);
	if (status)
		return status;
	*out = (struct expansion){.dims = dims, .unit = 1, .rgb = {planes[0], planes[1], planes[2]}, .block = block};
	return BP_OK;
}

void expansion_free(struct expansion *expansion)
{
	free(expansion->block);
	*expansion = (struct expansion){0};
}

enum { CELL_NEGATIVE = 1, CELL_NONFINITE = 2 };

/* The largest of some values >= 0, or `largest` if that is larger; in lanes, which vectorise. */
static ALWAYS_INLINE double block_largest(const double *v, size_t count, double largest)
{
	enum { LANES = 16 };
	double lane[LANES];
	size_t n = 0;
	for (int m = 0; m < LANES; m++)
		lane[m] = largest;
	for (; n + LANES <= count; n += LANES)
		for (size_t m = 0; m < LANES; m++)
			lane[m] = v[n + m] > lane[m] ? v[n + m] : lane[m];
	for (; n < count; n++)
		lane[0] = v[n] > lane[0] ? v[n] : lane[0];
	for (int m = 0; m < LANES; m++)
		largest = lane[m] > largest ? lane[m] : largest;
	return largest;
}

enum { SCAN_BLOCK = 256 };

/* Flags as wide as the values, so that both loops vectorise. */
AVX2_CLONE static double block_scan(double *restrict v, size_t count, double scale, uint8_t *restrict state, double largest)
{
	double flags[SCAN_BLOCK];
	for (size_t n = 0; n < count; n++) {
		const bool finite = fabs(v[n]) <= DBL_MAX; /* false for NaN, as is the next */
		const bool measured = v[n] >= 0;
		flags[n] = (measured ? 0.0 : CELL_NEGATIVE) + (finite ? 0.0 : CELL_NONFINITE);
		v[n] = ((measured & finite) ? v[n] : 0.0) * scale + 0.0; /* + 0.0 turns -0.0 into 0.0 */
	}
	for (size_t n = 0; n < count; n++)
		state[n] |= (uint8_t)(int)flags[n];
	return block_largest(v, count, largest);
}

double lattice_scan(double *restrict values, size_t count, double scale, uint8_t *restrict state)
{
	double largest = 0;
	for (size_t start = 0; start < count; start += SCAN_BLOCK)
		largest =
			block_scan(values + start, count - start < SCAN_BLOCK ? count - start : SCAN_BLOCK, scale, state + start, largest);
	return largest;
}

void lattice_scan_finish(struct lattice *lattice)
{
	const size_t cells = lattice_cells(lattice->dims);
	uint8_t *restrict state = lattice->valid;
	size_t valid = 0, nonfinite = 0;
	for (size_t start = 0; start < cells; start += 128) { /* short sums, which stay in bytes */
		const size_t end = start + 128 < cells ? start + 128 : cells;
		uint8_t ok = 0, strange = 0;
		for (size_t n = start; n < end; n++) {
			strange = (uint8_t)(strange + (state[n] >> 1));
			state[n] = state[n] == 0;
			ok = (uint8_t)(ok + state[n]);
		}
		valid += ok;
		nonfinite += strange;
	}
	lattice->valid_count = valid;
	lattice->nonfinite_count = nonfinite;
}

void lattice_validate(struct lattice *lattice)
{
	const size_t cells = lattice_cells(lattice->dims);
	memset(lattice->valid, 0, cells);
	lattice->most = 0;
	for (int c = 0; c < 3; c++)
		lattice->most = fmax(lattice->most, lattice_scan(lattice->rgb[c], cells, 1, lattice->valid));
	lattice_scan_finish(lattice);
}

double lattice_largest(const struct lattice *lattice)
{
	const size_t cells = lattice_cells(lattice->dims);
	double largest = 0;
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < cells; n++)
			if (lattice->valid[n] && lattice->rgb[c][n] > largest)
				largest = lattice->rgb[c][n];
	return largest;
}
