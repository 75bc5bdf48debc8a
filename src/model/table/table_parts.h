/*
 * table_parts.h: the inside of struct table, shared by the builders and the evaluation kernels.
 */
#ifndef MODEL_TABLE_TABLE_PARTS_H
#define MODEL_TABLE_TABLE_PARTS_H

#include "direction.h"
#include "table.h"

/* The kernels of one form and channel count, for one instruction set. */
struct table_kernels {
	void (*evaluate)(const struct table *table, const float wi[3], const float wo[3], float rgb[3]);
	void (*nearest)(const struct table *table, const float wi[3], const float wo[3], float rgb[3]);
	void (*batch)(const struct table *table, size_t count, const float *const wi[3], const float *const wo[3],
	              float *const rgb[3]);
};

/*
 * Where the two neighbours of a point along one axis stand, by the point's coordinate in cells plus `shift`, cut off to a number:
 * number n lies between values n - 1 and n. Before the first and after the last both neighbours are that one, so that the value
 * stays; along phi_d they are the last and the first. Offsets count uint16_t in the expanded form, bytes in the compact one.
 */
struct table_pair {        /* along theta_h or theta_d: */
	uint32_t offset, step; /* to the first neighbour, and from there to the other */
};
struct table_place {         /* along phi_d, where the other is the next: */
	uint16_t offset;         /* within the row; compact: to its block of an even theta_d */
	uint8_t residual, share; /* compact: bytes from the block's start */
	float place;             /* compact: of the first neighbour, between the two share codes */
};

/* Where the first value stands, in cells: at its own centre, or, where every second value is left, at the first of its two. */
#define CENTRE 0.5f
#define CENTRE_OF_HALF 0.25f

struct table {
	struct table_kernels kernels;
	f32x4 scale; /* lattice_scale_of */
	f32x4 shift; /* 1 - where the first value stands */
	f32x4 last;  /* inside the last cells of theta_h and theta_d, P, and 0 */
	struct lattice_dims dims;
	enum table_form form;
	int channels;
	float unit;     /* value = unit * stored, 1/sr; finite */
	uint32_t row;   /* expanded: uint16_t in a row of phi_d; compact: bytes in a pair of rows */
	uint32_t slice; /* ... from one theta_h to the next */

	/* compact only */
	uint32_t width, width_reciprocal, half, block_bytes; /* cells of a block, 65536/width rounded up; cells between share codes */
	float half_reciprocal;
	/* (R, G, B, 0) in 1/sr = sum of red codes times [0] + of blue ones times [1] + of means times [2], all weighted */
	f32x4 mix[3];

	uint8_t *store;                   /* the cells, TABLE_SLACK_BYTES that may be read and mean nothing, then: */
	struct table_pair *slices, *rows; /* H + 1, D + 1 */
	struct table_place *places;       /* P + 2: the last is the first value's own, for phi_d = P */
	size_t store_bytes;
};

enum { TABLE_SLACK_BYTES = 32 };

/* [0]: one channel, [1]: RGB. */
extern const struct table_kernels table_expanded_plain[2], table_expanded_avx2[2], table_compact_plain[2], table_compact_avx2[2];

/*
 * The store with so many bytes of cells, which are not set, and slices, rows and places, which are: by `row`, `slice` and what
 * else the form has.
 */
bp_status table_store_alloc(struct table *table, size_t cells_bytes, bp_error *error);

/* What brings values up to `largest` to [0, 1]; 0 for a table that is as good as all zero. */
static inline float table_factor(float largest) { return largest >= 0x1p-125f ? 1 / largest : 0; }

/* A value of [0, 1] as 6 bits of exponent and 10 of mantissa, to nearest; 0 below 2^-62. 1.0 has exponent 63. */
static inline uint16_t table_encode(float value)
{
	union {
		float value;
		uint32_t bits;
	} u = {value};
	int32_t code = (int32_t)((u.bits + 0x1000) >> 13) - ((127 - 63) << 10);
	return (uint16_t)(code < 1 << 10 ? 0 : code);
}

#endif
