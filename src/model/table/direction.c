#include "direction.h"

#define ALL(x) \
	{ \
		x, x, x, x \
	}
const f32x4 quarter_turns_x4[9] = {
	ALL(FLT_MIN),         ALL(QUARTER_TURNS_7), ALL(QUARTER_TURNS_6), ALL(QUARTER_TURNS_5), ALL(QUARTER_TURNS_4),
	ALL(QUARTER_TURNS_3), ALL(QUARTER_TURNS_2), ALL(QUARTER_TURNS_1), ALL(QUARTER_TURNS_0),
};

bool direction_to_lattice(struct lattice_dims dims, const float wi[3], const float wo[3], struct lattice_point *out)
{
	f32x4 at;
	if (!direction_locate(lattice_scale_of(dims), wi, wo, &at))
		return false;
	*out = (struct lattice_point){at[0], at[1], at[2]};
	return true;
}
