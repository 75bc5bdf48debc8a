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

/* Sets the table's row, width, shares and store from an expansion whose largest value (in its own unit) is `largest`. */
bp_status compact_fill(struct table *table, const struct expansion *expansion, float largest, bp_error *error);

#endif
