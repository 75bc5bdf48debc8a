/*
 * comparison.h: every figure between one measured table and a decoded one.
 */
#ifndef RENDER_COMPARISON_H
#define RENDER_COMPARISON_H

#include "model/fidelity.h"
#include "energy.h"
#include "itp.h"
#include "metrics.h"
#include "picture.h"

struct comparison {
	struct psnr psnr[LIGHTING_COUNT]; /* of the lightings that were asked for; 0 otherwise */
	double itp[LIGHTING_COUNT];       /* mean dE ITP, likewise */
	struct fidelity fidelity;
	struct worst_cell worst;         /* where fidelity.largest_relative is */
	struct energy measured, decoded; /* both with invalid cells as 0 */
};

/*
 * What does not depend on the material, for one lattice; made at the first comparison and again when the
 * extents change. Zero it before use, then set lightings and size. About 80 MB with all lightings at 160 pixels.
 */
struct comparison_plans {
	unsigned lightings; /* bit 1 << lighting for each that is wanted */
	uint32_t size;
	struct lattice_dims dims;
	struct sphere_plan *plans[LIGHTING_COUNT];
	struct energy_plan *energy;
	struct sphere_image reference, estimate;
};

/* Makes the plans for `dims` unless they are there; before a fork, so that processes share them. */
bp_status comparison_plans_make(struct comparison_plans *plans, struct lattice_dims dims, bp_error *error);
void comparison_plans_free(struct comparison_plans *plans); /* a zeroed struct is allowed */

/* BP_ERROR_BAD_INPUT where the extents differ. */
bp_status comparison_dims_check(struct lattice_dims measured, struct lattice_dims decoded, bp_error *error);

/*
 * Fills *out, which is unspecified after an error. With pictures not NULL, pictures[lighting] becomes picture_compare of that
 * lighting; the caller frees them, also after an error. BP_ERROR_BAD_INPUT: the extents differ, or no cell is valid.
 */
bp_status comparison_measure(struct comparison_plans *plans, const struct lattice *truth, const struct expansion *table,
                             struct comparison *out, struct picture *pictures, bp_error *error);

#endif
