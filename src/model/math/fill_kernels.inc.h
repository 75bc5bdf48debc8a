/* fill_kernels.inc.h: the loops of fill_kernels.h, for the including file's target. KERNEL(name) must be defined. */
#include <string.h>

#include "fill_kernels.h"
#include "vector.h"

typedef int32_t KERNEL(ints8) __attribute__((vector_size(32)));
typedef uint16_t KERNEL(pairs8) __attribute__((vector_size(16)));
typedef int16_t KERNEL(words8) __attribute__((vector_size(16)));
typedef uint8_t KERNEL(bytes8) __attribute__((vector_size(8)));

/* Of eight pairs of cells from p on: the sums of those that are valid; and in *count how many. */
static ALWAYS_INLINE void KERNEL(pairs_sum)(const float *p, const uint8_t *valid, floats8 *sum, KERNEL(words8) *count)
{
	typedef KERNEL(ints8) ints;
	KERNEL(pairs8) pair; /* the even cell's mark in its lower half: little-endian, as all of the writing half */
	memcpy(&pair, valid, sizeof pair);
	const KERNEL(words8) even = (pair & 0xff) != 0, odd = (pair >> 8) != 0;
	const floats8 x = FLOATS8_LOAD(p), y = FLOATS8_LOAD(p + 8);
	const ints left = (ints)__builtin_shufflevector(x, y, 0, 2, 4, 6, 8, 10, 12, 14);
	const ints right = (ints)__builtin_shufflevector(x, y, 1, 3, 5, 7, 9, 11, 13, 15);
	*sum = (floats8)(left & __builtin_convertvector(even, ints)) + (floats8)(right & __builtin_convertvector(odd, ints));
	*count -= even + odd;
}

/* Coarse cells from fine ones; returns how many coarse cells have no valid child. */
static size_t KERNEL(fill_halve)(const struct fill_level *fine, const struct fill_level *coarse)
{
	const size_t columns = fine->columns, half = columns / 2;
	size_t missing = 0;

	for (size_t r = 0; r < coarse->rows; r++) {
		/* An odd last row or column is its own second child. */
		const size_t second = 2 * r + 1 < fine->rows ? 2 * r + 1 : 2 * r;
		const float *a = fine->value + 2 * r * columns, *b = fine->value + second * columns;
		const uint8_t *va = fine->valid + 2 * r * columns, *vb = fine->valid + second * columns;
		float *value = coarse->value + r * coarse->columns;
		uint8_t *valid = coarse->valid + r * coarse->columns;
		size_t c = 0, full = 0;

		for (; c + 8 <= half; c += 8) {
			KERNEL(words8) n = {0};
			floats8 up, down;
			KERNEL(pairs_sum)(a + 2 * c, va + 2 * c, &up, &n);
			KERNEL(pairs_sum)(b + 2 * c, vb + 2 * c, &down, &n);
			const KERNEL(words8) none = n == 0;
			const KERNEL(bytes8) has = __builtin_convertvector(none + 1, KERNEL(bytes8));
			FLOATS8_STORE(value + c,
			              (up + down) / __builtin_convertvector(__builtin_convertvector(n - none, KERNEL(ints8)), floats8));
			memcpy(valid + c, &has, sizeof has);
		}
		for (; c < half; c++) {
			int p = va[2 * c] != 0, q = va[2 * c + 1] != 0, s = vb[2 * c] != 0, t = vb[2 * c + 1] != 0, n = p + q + s + t;
			float sum = ((p ? a[2 * c] : 0) + (q ? a[2 * c + 1] : 0)) + ((s ? b[2 * c] : 0) + (t ? b[2 * c + 1] : 0));
			value[c] = sum / (float)(n ? n : 1);
			valid[c] = n != 0;
		}
		if (columns % 2) {
			int p = va[columns - 1] != 0, s = vb[columns - 1] != 0, n = p + s;
			float sum = (p ? a[columns - 1] : 0) + (s ? b[columns - 1] : 0);
			value[half] = sum / (float)(n ? n : 1);
			valid[half] = n != 0;
		}
		for (c = 0; c < coarse->columns; c++)
			full += valid[c];
		missing += coarse->columns - full;
	}
	return missing;
}

/* A row's neighbour on either side, `size` rows in all. The border is its own. */
static inline size_t KERNEL(before)(size_t i) { return i ? i - 1 : 0; }
static inline size_t KERNEL(after)(size_t i, size_t size) { return i + 1 < size ? i + 1 : i; }

/* A row with one more cell on both sides. */
static inline void KERNEL(border)(float *row, size_t n)
{
	row[-1] = row[0];
	row[n] = row[n - 1];
}

static inline unsigned KERNEL(row_complete)(const uint8_t *valid, size_t n)
{
	unsigned all = 1;
	for (size_t c = 0; c < n; c++)
		all &= valid[c] != 0;
	return all;
}

/* Invalid fine cells from the coarse level: 3/4 of the parent and 1/4 of its nearer neighbour, along both axes. */
static void KERNEL(fill_interpolate)(const struct fill_level *coarse, const struct fill_level *fine, float *scratch)
{
	const size_t n = coarse->columns, columns = fine->columns;
	float *blend = scratch + 1; /* a coarse row with one more cell on both sides */

	for (size_t r = 0; r < fine->rows; r++) {
		const size_t parent = r / 2;
		const size_t other = r % 2 ? KERNEL(after)(parent, coarse->rows) : KERNEL(before)(parent);
		const float *a = coarse->value + parent * n, *b = coarse->value + other * n;
		float *value = fine->value + r * columns;
		const uint8_t *valid = fine->valid + r * columns;

		if (KERNEL(row_complete)(valid, columns))
			continue;
		for (size_t c = 0; c < n; c++)
			blend[c] = 0.75f * a[c] + 0.25f * b[c];
		KERNEL(border)(blend, n);
		for (size_t c = 0; c < columns / 2; c++) {
			float left = 0.75f * blend[c] + 0.25f * blend[(ptrdiff_t)c - 1], right = 0.75f * blend[c] + 0.25f * blend[c + 1];
			value[2 * c] = valid[2 * c] ? value[2 * c] : left;
			value[2 * c + 1] = valid[2 * c + 1] ? value[2 * c + 1] : right;
		}
		if (columns % 2 && !valid[columns - 1])
			value[columns - 1] = 0.75f * blend[n - 1] + 0.25f * blend[(ptrdiff_t)n - 2];
	}
}

/* Sweeps down and up the rows: an invalid cell becomes the mean of its neighbours, those of the row just passed being new. */
static void KERNEL(fill_smooth)(const struct fill_level *level, unsigned sweeps, float *scratch)
{
	const size_t rows = level->rows, columns = level->columns;
	float *copy = scratch + 1;

	for (unsigned s = 0; s < sweeps; s++)
		for (size_t q = 0; q < rows; q++) {
			const size_t r = s % 2 ? rows - 1 - q : q;
			const float *up = level->value + KERNEL(before)(r) * columns;
			const float *down = level->value + KERNEL(after)(r, rows) * columns;
			float *value = level->value + r * columns;
			const uint8_t *valid = level->valid + r * columns;

			if (KERNEL(row_complete)(valid, columns))
				continue;
			for (size_t c = 0; c < columns; c++)
				copy[c] = value[c];
			KERNEL(border)(copy, columns);
			for (size_t c = 0; c < columns; c++) {
				float mean = 0.25f * ((copy[(ptrdiff_t)c - 1] + copy[c + 1]) + (up[c] + down[c]));
				value[c] = valid[c] ? copy[c] : mean;
			}
		}
}

const struct fill_kernels KERNEL(fill_kernels) = {
	.fill_halve = KERNEL(fill_halve),
	.fill_interpolate = KERNEL(fill_interpolate),
	.fill_smooth = KERNEL(fill_smooth),
};
