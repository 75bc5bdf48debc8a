/*
 * paper.h: the model of Bilgili, Ozturk and Kurt (2012), as `--profile paper` stores it.
 *
 *     b_ijk = K f_h f_d f_phi c_hd c_hphi c_dphi|h          (their eq. 7)
 *     value_c = max(0, diffuse_c + specular_c b)
 */
#ifndef MODEL_PAPER_PAPER_H
#define MODEL_PAPER_PAPER_H

#include "merl/lattice.h"
#include "model/fit.h"
#include "model/robust/robust.h"

/*
 * Layers: what a prefix of the record holds. Layer 0: the marginals and the colours, every pair taken as
 * independent. Layer 1 adds c_hd and c_hphi, layer 2 the conditional pairs c_dphi|h.
 */
enum { PAPER_LAYER_MARGINALS, PAPER_LAYER_PAIRS, PAPER_LAYER_SLICES, PAPER_LAYERS };

/* The largest wavelet coefficients of one 2-D field, quantised: coefficient[index] = level * step. */
struct sparse_field {
	uint32_t rows, columns; /* of the field; the transform's plane is larger, see wavelet.h */
	uint32_t count;         /* coefficients kept; 0: the field is 1 everywhere (the pair is left out) */
	uint32_t *index;        /* strictly ascending, row-major in the transform's plane, below paper_plane_cells */
	int16_t *level;         /* never 0 */
	float step;             /* > 0, finite; 0 where count is 0 */
};

/* Cells of the transform's plane of a field: the product of wavelet_axis_for(rows).plane and that of columns. */
uint32_t paper_plane_cells(uint32_t rows, uint32_t columns);

/* The theta_h cell from which on all slices share one: the first i with (i/H)^2 90 >= 40 degrees; 60 of 90. */
uint32_t paper_shared_from(uint32_t theta_h);

struct paper_model {
	struct lattice_dims dims;
	double scale;                  /* K, 1/sr: scale f_h f_d f_phi is the model when all pairs are independent */
	float *marginal[3];            /* theta_h, theta_d, phi_d; mean 1 each, >= 0, finite */
	struct sparse_field hd, hphi;  /* theta_h x theta_d and theta_h x phi_d: Haar, at most 1/16 of their cells */
	uint32_t slice_count;          /* paper_shared_from + 1: theta_h cells below it one each, the last shared by all above */
	struct sparse_field *slice;    /* c_dphi|h, theta_d x phi_d: Daubechies, at most 1/64 of their cells */
};

/* *out, which paper_free frees, and the regression of each channel on it. Nothing is kept on failure. */
bp_status paper_fit(const struct lattice *lattice, const struct watch *watch, struct paper_model **out, struct colour_fit colour[3],
                    bp_error *error);
void paper_free(struct paper_model *paper); /* NULL is allowed */
/* f_h f_d f_phi c_hd c_hphi c_dphi|h over the whole lattice: the model in units of scale; >= 0 and finite. */
bp_status paper_achromatic(const struct paper_model *paper, uint32_t layers, float *table, bp_error *error);
/* See model_expand. */
bp_status paper_expand(const struct paper_model *paper, const struct colour_fit colour[3], uint32_t layers, struct expansion *out, bp_error *error);

#endif
