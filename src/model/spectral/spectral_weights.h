/*
 * spectral_weights.h: how finely each part of the (theta_h, theta_d) plane is coded.
 *
 * An error of the logarithm is worth what it does to a picture: nothing below the horizon, little where light only grazes, in a
 * highlight far above white or where cells are few directions, much where a material is as bright as its pictures are exposed for.
 * A spectrum's coefficients lie at places of that plane, so each is divided by a factor before it is quantised, and multiplied by
 * it when it is decoded: the step is coarser where errors are worth less. At a given rate the sum of the worth of all errors is
 * least where steps go as worth^(-1/2).
 *
 * The factors are 2^(w/16) with w interpolated between the centres of a grid of 10 x 10 regions, [theta_h][theta_d], 0 where the
 * table is coded finest. Worth is a statistic of what is measured, and does not change where the table is made s times as bright.
 */
#ifndef MODEL_SPECTRAL_SPECTRAL_WEIGHTS_H
#define MODEL_SPECTRAL_SPECTRAL_WEIGHTS_H

#include "merl/lattice.h"
#include "spectrum_inverse.h"

enum { SPECTRAL_WEIGHTS_EDGE = 10, SPECTRAL_WEIGHTS = SPECTRAL_WEIGHTS_EDGE * SPECTRAL_WEIGHTS_EDGE };

/* spectral_worth.c: from the measured values, in units of `unit` (1/sr). A lattice of fewer than 20 cells along theta_h or theta_d gets zeros. */
void spectral_weights_find(const struct lattice *lattice, double unit, uint8_t weights[SPECTRAL_WEIGHTS]);

/* factor[theta_h theta_d]: of every row of a spectrum (spectrum.h). */
void spectral_weights_factors(struct lattice_dims dims, const uint8_t weights[SPECTRAL_WEIGHTS], float *factor);

/* Takes the factors into the gains of an inverse transform. */
bp_status spectral_weights_apply(const uint8_t weights[SPECTRAL_WEIGHTS], struct spectrum_inverse *inverse, bp_error *error);

/* Divides the spectrum by the factors. */
void spectral_weights_divide(struct lattice_dims dims, const float *factor, float *spectrum);

#endif
