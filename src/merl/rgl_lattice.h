/*
 * rgl_lattice.h: a material of the RGL database (rgl/rgl_material.h) on MERL's lattice.
 */
#ifndef MERL_RGL_LATTICE_H
#define MERL_RGL_LATTICE_H

#include "lattice.h"
#include "origin.h"
#include "rgl/rgl_material.h"

/*
 * Degrees from the normal beyond which the instrument measured nothing; the files' values there are extrapolated. A file that
 * does not say what was measured was computed, and has values to the horizon.
 */
#define RGL_ANGLE_MOST 85.0

/*
 * Fills a new lattice of MERL's extents, in 1/sr. A cell has the mean of both directions' values at its centre; where the
 * material's samples lie closer along theta_h than the cell is wide, and its values at the cell's edges are not what is
 * interpolated between centres to a tenth (its lobe is narrower than the lattice), the mean over up to RGL_PARTS_MOST parts of
 * the cell's theta_h, equally wide on the lattice's axis. A cell is valid where both angles are at most RGL_ANGLE_MOST (of a
 * measured file) and the file's last theta_i, and in either direction more than half the weight is on samples with data. *origin
 * tells how far the two directions were apart before. The caller frees *out.
 */
enum { RGL_PARTS_MOST = 8 };
bp_status rgl_lattice_make(const struct rgl_material *material, struct lattice *out, struct origin *origin, bp_error *error);

#endif
