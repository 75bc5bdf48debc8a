#include "direction.h"

bool direction_to_lattice(struct lattice_dims dims, const float wi[3], const float wo[3], struct lattice_point *out)
{
	return direction_locate(lattice_scale_of(dims), wi, wo, out);
}
