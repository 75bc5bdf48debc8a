/*
 * compact.h: the compact memory form: at most 3 MB for the MERL lattice, 32 bytes where the raw
 * table has 432.
 *
 * A row of phi_d is cut into blocks of `width` cells (18 for MERL). A block is 32 bytes, half a
 * cache line; the other half is the block of the next theta_d (of an even and the next odd one), so
 * a look-up touches two lines or four:
 *
 *     0  uint16 base, uint16 step     bits 14 to 29 of a float in [0, 1]: 7 of exponent, 9 of mantissa
 *     4  uint8  residual[19]          of the block's cells and, last, of the next block's first
 *    23  3 x (12 bit, 12 bit)         R/(R+G+B), B/(R+G+B) at the block's cells 0, half and 2 half
 *
 *     S = (base + step residual)^4 3 unit      R = S r      B = S b      G = S (1 - r - b)
 *     r = base + step code, linear in phi_d between the three codes; b likewise
 *
 * The fourth root stands for the logarithm: an error that is nearly relative, an exact 0, and
 * decoding by two multiplications. The shares are smooth where a channel goes to 0, which ratios are not; those of dark
 * cells count little in the fit of the codes.
 * With one channel (the mean), blocks have 24 bytes and no shares.
 */
#ifndef MODEL_TABLE_COMPACT_H
#define MODEL_TABLE_COMPACT_H

#include "table_parts.h"

enum { COMPACT_HEAD_SHIFT = 14 }; /* of the 16-bit floats */
enum { COMPACT_WIDTH_MAX = 18, COMPACT_RESIDUALS = 4, COMPACT_SHARES = 23, COMPACT_BLOCK_RGB = 32, COMPACT_BLOCK_MONO = 24 };

/* A block's numbers have their low byte first, whatever the machine's order: from its own order to that, or back. */
#if defined __BYTE_ORDER__ && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#define LOW_FIRST_16(number) __builtin_bswap16(number)
#define LOW_FIRST_32(number) __builtin_bswap32(number)
#define LOW_FIRST_64(number) __builtin_bswap64(number)
#else
#define LOW_FIRST_16(number) (number)
#define LOW_FIRST_32(number) (number)
#define LOW_FIRST_64(number) (number)
#endif

/* ---- rows of phi_d on their way into blocks ---- */

/* Cells 0..width of a block, and what makes them a whole number of vectors: read, but of no weight. */
enum { CELLS_MAX = (COMPACT_WIDTH_MAX + 1 + 3) / 4 * 4 };

/*
 * Hat functions h at cells 0, half and 2 half; 0 past the width. Those at 0 and at 2 half do not meet, so least squares are a
 * tridiagonal system. Every hat function has a cell of its own as long as width > half (a block of MERL has 18 and 9).
 */
struct compact_hats {
	uint32_t width, half;
	float h[3][CELLS_MAX];
	float product[5][CELLS_MAX]; /* h0 h0, h0 h1, h1 h1, h1 h2, h2 h2 */
	float fit[3][CELLS_MAX];     /* the codes for weights that are all alike: sums of fit times share */
};

void compact_hats_make(uint32_t width, uint32_t half, struct compact_hats *out);

/* A row for the blocks: `padded` values, those past the row's end being its first ones again; CELLS_MAX more may be read. */
struct compact_row {
	float *root;     /* fourth root of the mean of the channels, in [0, 1] */
	float *share[2]; /* R and B as shares of the sum; 1/3 where the cell is black */
	float *mean;     /* of the channels, in [0, 1] */
};

/* What all rows of a table have in common. */
struct compact_rows_plan {
	struct compact_hats hats;
	uint32_t period, padded, blocks, width, block_bytes;
	int channels;
	float third;            /* brings the sum of the channels to a mean in [0, 1] */
	float dark;             /* shares of cells well below it count little */
	struct compact_row row; /* scratch */
};

/*
 * A row of values in the compact form, its first block at `block`, but for the shares' codes: three of R and three of B for every
 * block go to knots, as they are. For any processor, and for those with AVX2 (math/kernels.h): the same bits.
 */
typedef void compact_row_fn(const struct compact_rows_plan *plan, const float *const rgb[3], uint8_t *block,
                            float *const knots[2]);
compact_row_fn compact_row_plain, compact_row_avx2;

/* m: the five different elements of a system of hat functions; x: its right-hand side, then its solution. */
static inline void compact_solve(const float m[5], float x[3])
{
	const float up = m[1] / m[0], middle = m[2] - up * m[1], down = m[3] / middle;
	x[1] -= up * x[0];
	x[2] = (x[2] - down * x[1]) / (m[4] - down * m[3]);
	x[1] = (x[1] - m[3] * x[2]) / middle;
	x[0] = (x[0] - m[1] * x[1]) / m[0];
}

/* ---- a table ---- */

/* Sets the table's row, width, shares and store from an expansion whose largest value (in its own unit) is `largest`. */
bp_status compact_fill(struct table *table, const struct expansion *expansion, float largest, bp_error *error);

#endif
