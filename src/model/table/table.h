/*
 * table.h: a decoded table in the memory form a renderer evaluates from.
 *
 *     model_expand -> expansion -> table_build -> table_evaluate      or: model -> table_build_model -> table_evaluate
 *
 * A stored value stands for its cell's CENTRE (merl/lattice.h). Interpolation is trilinear between
 * centres, in 1/sr, periodic in phi_d; before the first and beyond the last centre of theta_h and
 * theta_d the value stays. The expansion holds a value in every cell, also below the horizon, where
 * it continues the material smoothly, so no "not measured" mark enters an interpolation; directions
 * below the horizon give 0. A table of every second value keeps each where it stood: the centre of
 * the first of two cells, a quarter into a cell of its own lattice.
 *
 * Expanded form: per cell and channel one unsigned 16-bit float, 6 exponent bits and 10 of mantissa:
 * relative error at most 2^-11 down to 2^-61 of the table's largest value, 0 below. Rows of phi_d
 * hold one cell more, a copy of the first. MERL, RGB: 8.80 MB.
 *
 * Compact form: compact.h.
 */
#ifndef MODEL_TABLE_TABLE_H
#define MODEL_TABLE_TABLE_H

#include "merl/lattice.h"
#include "model/model.h"
#include "direction.h"

/* A table's largest value, in 1/sr, is cut to this: a float holds it with room to spare. */
#define TABLE_LARGEST 1e34

enum table_form { TABLE_EXPANDED = 0, TABLE_COMPACT = 1 };

struct table; /* immutable once built: any number of threads may evaluate it */

/* channels: 3 (RGB), or 1: the mean of the three, given back in all of them. The expansion is not needed afterwards. */
bp_status table_build(const struct expansion *expansion, enum table_form form, int channels, struct table **out, bp_error *error);
/*
 * The same of all of a model's layers, or, with `half`, of every second value of it (model_expand_half), and quicker: of a
 * decoded spectral profile's expanded form no table of floats is made. BP_ERROR_ARGUMENT where there is no half.
 */
bp_status table_build_model(const struct model *model, bool half, enum table_form form, int channels, struct table **out,
                            bp_error *error);
void table_free(struct table *table); /* NULL is allowed */
size_t table_bytes(const struct table *table);

/* How a compact table of three channels lies in memory (compact.h), for who looks values up elsewhere, as a shader does. */
struct table_layout {
	const uint8_t *blocks; /* inside the table */
	size_t bytes;
	struct lattice_dims dims;
	uint32_t row, slice;  /* bytes from one pair of theta_d to the next, from one theta_h to the next */
	uint32_t width, half; /* cells of a block; cells between two share codes */
	float first;          /* where the first value stands, in cells: 1/2, or 1/4 where the table has every second value */
	float mix[3][3];      /* what brings sums of red codes, of blue codes and of means to R, G, B in 1/sr */
};
/* False for tables of another form. */
bool table_layout(const struct table *table, struct table_layout *out);

/*
 * The value for one pair of directions in 1/sr, finite and >= 0 in each channel.
 * 0 where either direction is below or on the horizon, is zero, infinite or NaN; other lengths than 1 are normalised.
 */
void table_evaluate(const struct table *table, const float wi[3], const float wo[3], float rgb[3]);
/* The value of the cell into which the directions fall (the MERL database's own look-up). */
void table_nearest(const struct table *table, const float wi[3], const float wo[3], float rgb[3]);
/* table_evaluate for `count` pairs in separate arrays of components; the same values to the bit. */
void table_evaluate_batch(const struct table *table, size_t count, const float *const wi[3], const float *const wo[3],
                          float *const rgb[3]);

#endif
