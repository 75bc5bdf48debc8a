#include "direction.h"

#define ALL(x) \
	{ \
		x, x, x, x \
	}
const f32x4 quarter_turns_x4[9] = {
	ALL(FLT_MIN),         ALL(QUARTER_TURNS_7), ALL(QUARTER_TURNS_6), ALL(QUARTER_TURNS_5), ALL(QUARTER_TURNS_4),
	ALL(QUARTER_TURNS_3), ALL(QUARTER_TURNS_2), ALL(QUARTER_TURNS_1), ALL(QUARTER_TURNS_0),
};
