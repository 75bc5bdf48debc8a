/* paper_plane.h: on which plane of wavelets each field of the paper's model lies. */
#ifndef MODEL_PAPER_PAPER_PLANE_H
#define MODEL_PAPER_PAPER_PLANE_H

#include "paper.h"
#include "wavelet.h"

struct wavelet_plane paper_plane(struct lattice_dims dims, enum paper_field field);

#endif
