#include "demo_speckle.h"

#include <stdlib.h>

enum { STEPS_H = 45, STEPS_D = 20, STEPS_P = 12, NOISES = 4 }; /* noise 0 is that of all channels, 1 to 3 are their own */

/* How much of the noise is a channel's own. */
static const double OWN_SHARE = 0.25;

struct speckle {
	double amount;
	double node[STEPS_H + 1][STEPS_D + 1][STEPS_P + 1][NOISES]; /* -1 to 1 */
};

struct speckle *speckle_create(double amount, double (*uniform)(uint64_t *state), uint64_t *state)
{
	struct speckle *speckle = malloc(sizeof *speckle);
	if (!speckle)
		return NULL;
	speckle->amount = amount;
	for (int h = 0; h <= STEPS_H; h++)
		for (int d = 0; d <= STEPS_D; d++)
			for (int p = 0; p <= STEPS_P; p++)
				for (int n = 0; n < NOISES; n++)
					speckle->node[h][d][p][n] = 2 * uniform(state) - 1;
	return speckle;
}

/* Where a share of the axis lies between two nodes. */
static int step_at(double share, int steps, double *rest)
{
	const double x = share * steps;
	const int step = x < steps - 1 ? (int)x : steps - 1;
	*rest = x - step;
	return step;
}

void speckle_factor(const struct speckle *speckle, double root, double theta_d, double phi_d, double factor[3])
{
	double rest[3], noise[NOISES] = {0};
	const int h = step_at(root, STEPS_H, &rest[0]), d = step_at(theta_d, STEPS_D, &rest[1]);
	const int p = step_at(phi_d < 0.5 ? 1 - 2 * phi_d : 2 * phi_d - 1, STEPS_P, &rest[2]);
	for (int corner = 0; corner < 8; corner++) {
		const int up[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
		double weight = 1;
		for (int a = 0; a < 3; a++)
			weight *= up[a] ? rest[a] : 1 - rest[a];
		for (int n = 0; n < NOISES; n++)
			noise[n] += weight * speckle->node[h + up[0]][d + up[1]][p + up[2]][n];
	}
	for (int c = 0; c < 3; c++) {
		const double n = speckle->amount * ((1 - OWN_SHARE) * noise[0] + OWN_SHARE * noise[1 + c]);
		factor[c] = (1 + n) / (1 - n);
	}
}
