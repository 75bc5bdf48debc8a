/*
 * paper.h: the model of Bilgili, Ozturk and Kurt (2012), as `--profile paper` stores it: for each colour channel
 *
 *     b_ijk = K f_h f_d f_phi c_hd c_hphi c_dphi|h          (their eq. 7)
 *     value = max(0, diffuse + specular b)
 *
 * The product is an identity for any positive marginals, so these are chosen so that the rest is easy to say: geometric means.
 * c_hd and c_hphi have a sixteenth of their coefficients in Haar's wavelets, the conditional pairs a sixty-fourth in
 * Daubechies', dealt out over all slices to those that need them. From 40 degrees on all slices share one.
 */
#ifndef MODEL_PAPER_PAPER_H
#define MODEL_PAPER_PAPER_H

#include "model/fit.h"
#include "model/robust/robust.h"
#include "wavelet.h"

/*
 * Layers: what a prefix of the record holds. Layer 0: the marginals and the colours, every pair taken as
 * independent. Layer 1 adds c_hd and c_hphi, layer 2 the conditional pairs c_dphi|h.
 */
enum { PAPER_LAYER_MARGINALS, PAPER_LAYER_PAIRS, PAPER_LAYER_SLICES, PAPER_LAYERS };

enum { PAPER_KEEP_PAIR = 16, PAPER_KEEP_SLICE = 64, PAPER_LEVEL_MAX = (1 << 20) - 1 };

/* Wavelet coefficients of one 2-D field, quantised: coefficient[index] = level paper_step(step). */
struct sparse_field {
	uint32_t count;  /* coefficients kept; 0: the field is 1 everywhere (the pair is left out) */
	uint32_t *index; /* strictly ascending, column-major in the transform's plane, below paper_plane_cells */
	int32_t *level;  /* never 0, at most PAPER_LEVEL_MAX */
	uint16_t step;   /* the code of paper_step; anything where count is 0 */
};

enum paper_field { PAPER_HD, PAPER_HPHI, PAPER_SLICE };

/* The theta_h cell from which on all slices share one: the first i with (i/H)^2 90 >= 40 degrees; 60 of 90. */
uint32_t paper_shared_from(uint32_t theta_h);

/* Rows and columns of a field, its plane, and coefficients of that. */
void paper_field_extents(struct lattice_dims dims, enum paper_field field, uint32_t *rows, uint32_t *columns);
struct wavelet_plane paper_plane(struct lattice_dims dims, enum paper_field field);
uint32_t paper_plane_cells(struct lattice_dims dims, enum paper_field field);

/* How fine each coefficient of a field's plane is: its levels along rows and columns, 0 coarse, added. band[paper_plane_cells] */
void paper_plane_bands(struct lattice_dims dims, enum paper_field field, uint8_t *band);

/* Coefficients that a channel may keep in a field; of the slices, in all of them together. At least one. */
uint32_t paper_keep(struct lattice_dims dims, enum paper_field field);

/* Steps are stored as 2^((code - 32768)/256), marginals as 2^((code - 32768)/1024), code 0 being 0 there: within 0.03 %. */
enum { PAPER_STEP_ONE = 1 << 15, PAPER_STEP_LEAST = PAPER_STEP_ONE - 100 * 256, PAPER_STEP_MOST = PAPER_STEP_ONE + 30 * 256 };
float paper_step(uint16_t code);
uint16_t paper_code(float marginal); /* the nearest; of a positive number never 0 */
float paper_coded(uint16_t code);

struct paper_channel {
	double scale;       /* K, 1/sr: scale f_h f_d f_phi is the model when all pairs are independent */
	float *marginal[3]; /* theta_h, theta_d, phi_d, one behind the other: >= 0, about 1 in the mean, values of paper_coded */
	struct sparse_field hd, hphi; /* theta_h x theta_d and theta_h x phi_d: Haar */
	uint32_t slice_count;         /* paper_shared_from + 1: theta_h cells below it one each, the last shared by all above */
	struct sparse_field *slice;   /* c_dphi|h, theta_d x phi_d: Daubechies */
};

struct paper_model {
	struct lattice_dims dims;
	struct paper_channel channel[3]; /* of a model that was loaded for one alone only that one has marginals */
};

/*
 * *out, which paper_free frees, and the regression of each channel's measured values on its model. Nothing is kept on failure.
 * Values from 1e-300 to 1e300 are in range.
 */
bp_status paper_fit(const struct lattice *lattice, const struct watch *watch, struct paper_model **out,
                    struct colour_fit colour[3], bp_error *error);
void paper_free(struct paper_model *paper); /* NULL is allowed */
/* The three marginals' values; and room for them in a channel that paper_free frees. */
static inline size_t paper_marginal_values(struct lattice_dims dims) { return (size_t)dims.theta_h + dims.theta_d + dims.phi_d; }
bp_status paper_marginals_alloc(struct lattice_dims dims, struct paper_channel *channel, bp_error *error);
/* Room for `count` coefficients, 1 or more; sparse_field_free also after a failure. */
bp_status sparse_field_alloc(uint32_t count, struct sparse_field *field, bp_error *error);
void sparse_field_free(struct sparse_field *field);
void sparse_fields_free(struct sparse_field *fields, uint32_t count); /* the array too; NULL is allowed */

/* A field's values stay within these. A pair copula is nowhere 0, so that no cell of a slice is lost to it; a slice may be. */
#define FIELD_VALUE_MAX 1e6f
#define FIELD_PAIR_MIN 0.03125f

struct field_codec; /* memory for fields of one kind; use it from one thread at a time; freed with free() */
bp_status field_codec_create(struct lattice_dims dims, enum paper_field kind, struct field_codec **out, bp_error *error);
/* The field's values, row-major, within their limits; all 1 when count is 0. Indices beyond the plane are ignored. */
void field_expand(struct field_codec *codec, const struct sparse_field *field, float *value);

/* f_h f_d f_phi c_hd c_hphi c_dphi|h of a channel over the whole lattice: the model in units of its scale; >= 0 and finite. */
bp_status paper_channel_expand(struct lattice_dims dims, const struct paper_channel *channel, float *table, bp_error *error);
/* See model_expand. Channels that are not there become like the one that is. */
bp_status paper_expand(const struct paper_model *paper, const struct colour_fit colour[3], uint32_t layers, struct expansion *out,
                       bp_error *error);

#endif
