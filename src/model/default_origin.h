/*
 * default_origin.h: a table that was decoded from a record of this profile gives back the levels it was decoded from.
 *
 * Packed like a measurement it would be quantised once more, with a step and axes of its own, and each generation would lose a
 * decibel or two. But its spectrum shows where it comes from: every coefficient lies on one grid (default_grid.h). A measurement
 * never looks like that.
 *
 *     channels' spectra -> origin_find: is there a grid? -> origin_restore: levels
 *
 * All of this is in the logarithm, so a table that was scaled since is recognised too. Extraction drops what lies below the horizon, so
 * only the coefficients that do not reach there are exact at first; the others follow turn by turn.
 */
#ifndef MODEL_DEFAULT_ORIGIN_H
#define MODEL_DEFAULT_ORIGIN_H

#include "default_grid.h"

struct default_origin {
	struct default_grid grid;
	float base[3];  /* of the channels, so that harmonic 0 lies on the grid */
	double missed;  /* default_grid_missed; INFINITY: no sign that the table was decoded, or too little of it is left */
	uint8_t *known; /* of the cells: 1 where the three values are known, 0 where the cell is invalid or a channel is 0, which may have been less */
	uint8_t *exact; /* of the spectrum's rows: 1 where no coefficient reaches a cell that is not known */
};

/*
 * From the spectra of the three channels' logarithms less `base`, in any order; `rotation` is a guess at the axes. A hundredth of a fit where
 * nothing is found. Free *out in any case, also before the next call.
 */
bp_status default_origin_find(const struct lattice *lattice, float *const spectrum[3], const float base[3], const float rotation[3][3],
                              struct default_origin *out, bp_error *error);
void default_origin_free(struct default_origin *origin);

/*
 * default_restore.c: the levels of a table of that origin, from its filled logarithms, which are used up; channel k is the lattice's
 * order[k]. Sets the model's step, centres, planes, end, levels and what they miss, or nothing where there are no levels.
 */
bp_status default_origin_restore(const struct lattice *lattice, const int order[3], const struct default_origin *origin, struct spectrum *spectrum,
                                 float *const table[3], struct default_model *model, bp_error *error);

#endif
