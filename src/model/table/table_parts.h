/*
 * table.h: the inside of struct table, shared by the builders and the evaluation kernels.
 */
#ifndef MODEL_TABLE_TABLE_PARTS_H
#define MODEL_TABLE_TABLE_PARTS_H

#include "direction.h"
#include "table.h"

/* The kernels of one form and channel count, for one instruction set. */
struct table_kernels {
	void (*evaluate)(const struct table *table, const float wi[3], const float wo[3], float rgb[3]);
	void (*nearest)(const struct table *table, const float wi[3], const float wo[3], float rgb[3]);
	void (*batch)(const struct table *table, size_t count, const float *const wi[3], const float *const wo[3], float *const rgb[3]);
};

/* Where the values of one phi_d stand. */
struct compact_place {
	uint16_t block;          /* bytes from the row's start to its block of an even theta_d */
	uint8_t residual, share; /* bytes from the block's start */
	float place;             /* of the cell's start, between the two share codes */
};

/* The rows of phi_d of one theta_d and of the next. */
struct compact_rows {
	uint32_t offset, step; /* bytes from the slice's start to the first one, and from there to the other */
};

struct table {
	struct table_kernels kernels;
	f32x4 scale;      /* lattice_scale_of */
	f32x4 top, inner; /* the last corners (H - 1, D - 1, P, 0), and less by a half: inside the last cell that has a next one */
	struct lattice_dims dims;
	enum table_form form;
	int channels;
	float unit;   /* value = unit * stored, 1/sr; finite */
	uint32_t row;     /* expanded: uint16_t in a row of phi_d; compact: bytes in a pair of rows */
	uint32_t slice;   /* ... from one theta_h to the next */

	/* compact only */
	uint32_t width, width_reciprocal, half, block_bytes; /* cells of a block, 65536/width rounded up; cells between share codes */
	float half_reciprocal;
	struct compact_place *place; /* of every phi_d, in the store after the cells */
	struct compact_rows *rows;   /* of every theta_d, behind them */
	/* (R, G, B, 0) in 1/sr = red sum times [0] + blue sum times [1] + sum of the means times [2]: of codes and means, with their weights */
	f32x4 mix[3];

	uint8_t *store; /* the cells, then TABLE_SLACK_BYTES that may be read and mean nothing */
	size_t store_bytes;
};

enum { TABLE_SLACK_BYTES = 32 };

/* [0]: one channel, [1]: RGB. */
extern const struct table_kernels table_expanded_plain[2], table_expanded_avx2[2], table_compact_plain[2], table_compact_avx2[2];

/* What brings values up to `largest` to [0, 1]; 0 for a table that is as good as all zero. */
static inline float table_factor(float largest)
{
	return largest >= 0x1p-125f ? 1 / largest : 0;
}

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
