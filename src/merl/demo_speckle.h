/*
 * demo_speckle.h: glitter of a demo material: a factor that varies smoothly from one direction to the next, not far.
 *
 * Noise on a grid of 45 x 20 x 12 steps over sqrt(theta_h), theta_d and |phi_d - pi/2|, interpolated linearly: one part for all
 * channels and a smaller one for each. With noise n the factor is
 * (1 + amount n)/(1 - amount n), so that its logarithm is symmetric. Mirrored about phi_d = pi/2, as reflection of an isotropic
 * surface is. Only + - * /, and draws of the caller's generator: the same on every machine.
 */
#ifndef MERL_DEMO_SPECKLE_H
#define MERL_DEMO_SPECKLE_H

#include <stdint.h>

struct speckle;

/* amount in (0, 1). uniform(state) is in [0, 1). NULL where memory runs out (0.4 MB); freed with free(). */
struct speckle *speckle_create(double amount, double (*uniform)(uint64_t *state), uint64_t *state);

/* At shares 0 to 1 of each axis: root of theta_h/(pi/2), theta_d/(pi/2), phi_d/pi. */
void speckle_factor(const struct speckle *speckle, double root, double theta_d, double phi_d, double factor[3]);

#endif
