/*
 * rivals.h: what importance sampling of a measured material is compared with: cosine sampling, and the usual choice, a
 * GGX lobe (Walter et al. 2007; its visible normals drawn as Heitz 2018 does) mixed with cosine samples, fitted to the
 * material by trying a grid of roughnesses and shares and keeping the one with the smallest spread.
 */
#ifndef BENCH_RIVALS_H
#define BENCH_RIVALS_H

#include "brdfpack.h"

struct ggx_mixture {
	double roughness; /* alpha */
	double share;     /* of samples that go to the lobe; 0: cosine sampling */
};

/* Relative standard deviation of the weights mean(R, G, B) cos / pdf for wo at theta_o (radians), and their mean. */
struct spread {
	double deviation, albedo;
};

/* Samples of the mixture, or of the material itself (NULL). `u` is the state of a generator of uniform numbers (timing.h). */
struct spread spread_of(const bp_material *material, const struct ggx_mixture *mixture, double theta_o, int samples,
                        unsigned long long *u);

/* The mixture with the smallest mean square deviation over the angles. */
struct ggx_mixture ggx_fit(const bp_material *material, const double *theta_o, int angles, unsigned long long *u);

#endif
