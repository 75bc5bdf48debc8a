/*
 * importance.h: what an error in a cell does to a picture, and the channels in the unit that this is counted in.
 *
 * A material is seen under several lights at once: a pixel's brightness is a sum over lights of value cos theta_i, and what the
 * eye gets is about its root. An error e of a cell whose two directions have the cosines i and o then weighs
 *
 *     area/2 (o (2 i)^2 S(2 x i + 1/4) + i (2 o)^2 S(2 x o + 1/4)) e^2        S(p) = 1/(p + p^2/5)
 *
 * with x the value in units of one pixel's usual brightness: a strong light makes twice that, the others leave 1/4, and what is
 * brighter than white counts by its relative error. Both terms since a cell stands for both orders of its directions
 * (reciprocity); o is the share of a pixel in the picture, area that of all pairs of directions. Added is a little of the
 * relative error, 0.01/H (e/(x + 0.02))^2, less where a direction grazes and least below the horizon, where nothing is ever asked
 * for.
 */
#ifndef MODEL_PAPER_IMPORTANCE_H
#define MODEL_PAPER_IMPORTANCE_H

#include "merl/lattice.h"

struct importance;

/* For lattices of this size; freed with free(). */
bp_status importance_create(struct lattice_dims dims, struct importance **out, bp_error *error);

/*
 * The unit, in 1/sr: the brightness of the tenth-brightest of a hundred pixels under 29 lights of which five are strong, drawn
 * from the lattice's cells by a fixed sequence; the mean where that is 0. It is as large for a table as the table's values are.
 */
double importance_unit(const struct importance *importance, const struct lattice *lattice);

/* A channel in units of `unit`, at most 1e15, 0 where invalid, and its weights, 0 where invalid: [cells] each. */
void importance_weigh(const struct importance *importance, const struct lattice *lattice, int channel, double unit, float *value,
                      float *weight);

/* How far a cell is seen, 0.01 to 1, and 0 where invalid: shown[cells]. */
void importance_shown(const struct importance *importance, const struct lattice *lattice, float *shown);

#endif
