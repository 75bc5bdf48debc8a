#include "half.h"

#include <math.h>

uint16_t half_of(double value)
{
	const uint16_t sign = value < 0 ? 0x8000 : 0;
	const double size = fabs(value);
	int exponent;
	if (!(size > 0))
		return 0;
	if (size >= 65504)
		return sign | 0x7BFF;
	frexp(size, &exponent); /* size in [2^(exponent - 1), 2^exponent) */
	if (exponent < -13)
		exponent = -13; /* denormal: the step stays 2^-24 */
	/* A double's own rounding at 2^52 does it; a carry into the next exponent gives that one's first code. */
	const double steps = ldexp(size, 11 - exponent) + 0x1p52 - 0x1p52;
	return (uint16_t)(sign | (((uint32_t)(exponent + 13) << 10) + (uint32_t)steps));
}
