/*
 * sparse_fit.h: a field by few wavelet coefficients: weighted least squares with a limit on how many are not 0.
 *
 * Coefficients x, field y, weights w, the inverse transform T: minimise the sum of w (y - T x)^2. *Energy* e of a coefficient is
 * the sum of w t^2, t its basis function: e x^2 is what leaving it out costs, and g/e what a step along the gradient g = T'w(y -
 * T x) gives. A round keeps the coefficients of the largest gain e (x + 0.7 g/e)^2, zeroes the others, and takes
 * conjugate-gradient steps on the kept ones, preconditioned by their energies. Where weights vanish energies do too, so the
 * preconditioner has a twentieth of the mean weight more.
 */
#ifndef MODEL_PAPER_SPARSE_FIT_H
#define MODEL_PAPER_SPARSE_FIT_H

#include "paper.h"
#include "wavelet.h"

/* What one kind of field shares: transform, squares of its basis, scratch. One thread at a time. */
struct sparse_fit {
	struct wavelet_plane plane;
	size_t cells, coefficients;
	float *row_squares, *column_squares;
	float *scratch;                                    /* 3 planes, of the transform; owns those that follow */
	float *field;                                      /* T of something */
	float *gradient, *inverse, *z, *direction, *image; /* of coefficients */
	float *gain;
};

bp_status sparse_fit_create(const struct wavelet_plane *plane, struct sparse_fit *out, bp_error *error);
void sparse_fit_free(struct sparse_fit *fit);

/* What a field should be, how much each cell of it matters, and what follows from that: of sparse_fit_energies. */
struct sparse_target {
	float *wanted, *weight; /* [cells] */
	float *energy;          /* [coefficients] */
	float least;            /* what the preconditioner adds to them */
};

/* Sets what target->energy points to, and target->least, from the weights. */
void sparse_fit_energies(struct sparse_fit *fit, struct sparse_target *target);

/* fit->gradient for the coefficients x. */
void sparse_fit_gradient(struct sparse_fit *fit, const struct sparse_target *target, const float *x);
/* Gains of all coefficients, from x and fit->gradient. */
void sparse_fit_gains(const struct sparse_fit *fit, const struct sparse_target *target, const float *x, float *gain);

/*
 * kept[n]: 1 for the `keep` largest gains, to within 1/64, the first of those that are as good; gains of 0 are never kept.
 * Returns about the least that is.
 */
float gains_keep(const float *gain, size_t n, size_t keep, uint8_t *kept);

/*
 * Zeroes x where not kept and takes `steps` conjugate-gradient steps on those that are; fit->gradient must belong to x when
 * called, and does when it returns.
 */
void sparse_fit_refine(struct sparse_fit *fit, const struct sparse_target *target, const uint8_t *kept, uint32_t steps, float *x);

/* `rounds` rounds from x, `keep` coefficients each. Returns what the last round's gains_keep does. */
float sparse_fit_rounds(struct sparse_fit *fit, const struct sparse_target *target, size_t keep, uint32_t rounds, uint32_t steps,
                        uint8_t *kept, float *x);

/* Whether the field is 1 within a thousandth, rms over the cells with a weight. */
bool sparse_fit_is_one(const struct sparse_fit *fit, const struct sparse_target *target);

/*
 * Quantises: levels of step `unit` / sqrt(the geometric mean of the energies of what is not 0). A field that is 1 is left out
 * (count 0). The caller owns out's arrays.
 */
bp_status sparse_fit_quantise(const struct sparse_fit *fit, const struct sparse_target *target, float unit, const float *x,
                              struct sparse_field *out, bp_error *error);

#endif
