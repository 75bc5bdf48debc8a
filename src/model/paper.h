/*
 * paper.h: the model of Bilgili, Ozturk and Kurt (2012), as `--profile paper` stores it.
 *
 *     b_ijk = K f_h f_d f_phi c_hd c_hphi c_dphi|h          (their eq. 7)
 *     value_c = max(0, diffuse_c + specular_c b)
 */
#ifndef MODEL_PAPER_H
#define MODEL_PAPER_H

#include "model.h"

/* The largest wavelet coefficients of one 2-D field, quantised: coefficient[index] = level * step. */
struct sparse_field {
	uint32_t rows, columns; /* of the field; the transform's plane is larger, see wavelet.h */
	uint32_t count;         /* coefficients kept; 0: the field is 1 everywhere (the pair is left out) */
	uint32_t *index;        /* strictly ascending, row-major in the transform's plane */
	int16_t *level;         /* never 0 */
	float step;             /* > 0, finite */
};

struct paper_model {
	double scale;                  /* K of step 0, 1/sr: the mean of the achromatic table over valid cells */
	float *marginal[3];            /* theta_h, theta_d, phi_d; mean 1 each, >= 0 */
	struct sparse_field hd, hphi;  /* Haar, 1/16 of the coefficients */
	uint32_t slice_count;          /* slices stored: theta_h cells 0..slice_count-2 one each, the last shared by all above */
	struct sparse_field *slice;    /* c_dphi|h, Daubechies, 1/64 of the coefficients */
};

#endif
