#include "reflectance.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

bool pairs_alloc(size_t count, struct pairs *out)
{
	float *block = count > SIZE_MAX / (9 * sizeof *block) ? NULL : malloc(9 * count * sizeof *block);
	*out = (struct pairs){.count = count};
	for (size_t n = 0; block && n < 3; n++) {
		out->wi[n] = block + n * count;
		out->wo[n] = block + (3 + n) * count;
		out->rgb[n] = block + (6 + n) * count;
	}
	return block != NULL;
}

void pairs_free(struct pairs *pairs)
{
	free(pairs->wi[0]);
	*pairs = (struct pairs){0};
}

void pairs_set(struct pairs *pairs, size_t n, const double wi[3], const double wo[3])
{
	for (int axis = 0; axis < 3; axis++) {
		pairs->wi[axis][n] = (float)wi[axis];
		pairs->wo[axis][n] = (float)wo[axis];
	}
}

void pairs_evaluate(struct pairs *pairs, const struct reflectance *reflectance)
{
	reflectance->evaluate(reflectance->user, pairs->count, (const float *const *)pairs->wi, (const float *const *)pairs->wo,
	                      pairs->rgb);
}

void direction_at(double theta, double phi, double w[3])
{
	w[0] = sin(theta) * cos(phi);
	w[1] = sin(theta) * sin(phi);
	w[2] = cos(theta);
}
