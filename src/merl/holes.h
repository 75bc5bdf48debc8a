/*
 * holes.h: cells that were never measured, in tables that do not say so.
 *
 * The database marks them by negative values. Who reads a file and writes it back may lose these: common readers clamp at 0,
 * others put a small constant there, take absolute values, or stretch all values to [0, 1]. What is left is one value, the same
 * in every such cell, and the pattern. In a table without any negative value, where
 *
 *     v = what the cell furthest below the horizon holds, in each channel
 *     L = the lowest smaller cosine at the centre of a cell that lies wholly below the horizon and holds something else, or 0
 *
 * (and where that is above the database's own limit of -0.061 by less than 0.01 that limit, so that dark cells at the edge stay
 * measured), cells that hold v and whose centre is below L are holes, provided that
 *
 * - some cell holds something else, and at least half of the cells that lie wholly below the horizon have their centre below L;
 * - where L is below -sin 5 degrees, deeper than a measurement reaches, at most half of the wholly hidden cells above it hold v:
 *   otherwise v is what the material has there;
 * - where v is not 0 in all channels, at most half of the cells that can be seen hold v.
 *
 * A cell that lies partly above the horizon is one only where no such cell with its centre below L holds anything else: then
 * centres decide in this table. L is never above 0: what is 0 above the horizon was measured and is black.
 */
#ifndef MERL_HOLES_H
#define MERL_HOLES_H

#include "lattice.h"

/* What to think of cells that are 0 in all channels. The numbers are those of records. */
enum zeros_rule {
	ZEROS_AUTO = 0,    /* the above */
	ZEROS_HOLES = 1,   /* the above, and every cell that is 0 in all channels is a hole, wherever it is */
	ZEROS_MEASURED = 2 /* none is a hole */
};

struct holes {
	size_t count;       /* cells that were taken as holes */
	size_t black_count; /* cells that can be seen, hold 0 in all channels, and stay measured; counted where there are holes */
	double value[3];    /* what the holes of the pattern held, 1/sr; all 0 where count is 0 */
};

/*
 * Makes holes of the lattice by that rule: they become invalid, their planes 0. Costs a comparison where the table has a
 * negative value and the rule is not ZEROS_HOLES. Errors: BP_ERROR_MEMORY (two bytes per cell), BP_ERROR_BAD_INPUT where no cell
 * is left; the lattice is then unspecified.
 */
bp_status lattice_take_holes(struct lattice *lattice, enum zeros_rule rule, struct holes *out, bp_error *error);

#endif
