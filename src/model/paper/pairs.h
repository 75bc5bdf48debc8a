/*
 * pairs.h: c_hd, c_hphi and the shared slice of one channel, by turns.
 *
 * Above 40 degrees x_ijk ~ A_ij B_ik S_jk with A = K f_h f_d c_hd, B = f_phi c_hphi and S the shared slice: weighted least
 * squares of each against the others, first as free as they are, then with c_hd and c_hphi as their coefficients say. So what the
 * one loses the others mend, and the last of them, the slice, is fitted to what a decoder has. Below 40 degrees every theta_h has
 * a slice of its own, which says all; there c_hd is the geometric means' and c_hphi is 1, with little weight.
 */
#ifndef MODEL_PAPER_PAIRS_H
#define MODEL_PAPER_PAIRS_H

#include "marginal.h"
#include "sparse_fit.h"

/* One channel on its way to a model. */
struct channel_fit {
	struct lattice_dims dims;
	const float *value, *weight; /* [cells], of importance_weigh */
	struct marginals marginal;
	float level;                   /* K in the unit of value */
	float *hd, *hphi;              /* c_hd, c_hphi as they decode */
	float *shared, *shared_weight; /* theta_d x phi_d: what the shared slice should be */
};

/* fit: of the two pairs' planes. The marginal of theta_h is fitted anew from 40 degrees on, and all are scaled to a mean of 1. */
bp_status pairs_fit(struct channel_fit *channel, struct sparse_fit fit[2], struct sparse_field *hd, struct sparse_field *hphi,
                    bp_error *error);

#endif
