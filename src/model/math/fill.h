/*
 * fill.h: smooth values for the invalid cells of a plane.
 *
 * The answer is close to a membrane stretched over the valid cells (each filled cell near the mean of its four
 * neighbours; the border is free), found in one pass over a pyramid: every level halves both extents, a coarse cell with any
 * valid child holds their mean and is itself valid; from the coarsest level down, invalid cells start from the
 * bilinear interpolation of the level above and are smoothed in place by SWEEPS sweeps. Work and memory are
 * proportional to the cells; the result depends on nothing but the arguments.
 *
 * A filled value lies between the least and the largest valid value (up to rounding). Valid cells are not touched.
 */
#ifndef MODEL_MATH_FILL_H
#define MODEL_MATH_FILL_H

#include <stdint.h>

#include "brdfpack.h"

struct fill; /* the pyramid's memory, for planes of one size; use it from one thread at a time */

/* 1 x 1 or more; *out is freed with free(). */
bp_status fill_create(uint32_t rows, uint32_t columns, struct fill **out, bp_error *error);

/* Fills the cells of plane[rows * columns] (row-major) where !valid. Without any valid cell, all become `when_empty`. */
void fill_plane(struct fill *fill, float *plane, const uint8_t *valid, float when_empty);

#endif
