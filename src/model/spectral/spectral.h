/*
 * spectral.h: the model of `--profile spectral`.
 *
 * In the logarithm the paper's product of marginals and pair copulas (eq. 7) is a sum, and in the spectrum of
 * spectrum.h its terms lie apart: harmonic 0 is the (theta_h, theta_d) pair with its marginals, the coarse theta_d
 * coefficients of the other harmonics are the (theta_h, phi_d) pair, the rest is the conditional pair. Where a pair is
 * independent its coefficients are 0 and take no room.
 *
 *     y_c = log2(1 + b_c / unit)                      c = R, G, B; b in 1/sr
 *     x_f = sum over c of rotation[f][c] (y_c - base_c)   three fields, the first with most of the variation
 *     coefficients = spectrum of x_f
 *
 * The unit is where the logarithm turns linear: below it a relative error is not worth its bytes. It is a statistic of
 * the table's values that scales as they do, so a table s times as bright gives the same fields and s times the unit.
 *
 * A model that was fitted holds coefficients as they were found; one that was decoded holds levels, a coefficient
 * being about level * step times the factor of its place. What lies below the quantiser's step is lost in encoding, where the
 * budget is known.
 */
#ifndef MODEL_SPECTRAL_SPECTRAL_H
#define MODEL_SPECTRAL_SPECTRAL_H

#include "model/fit.h"
#include "model/robust/robust.h"
#include "dependent.h"
#include "spans.h"
#include "spectral_weights.h"
#include "spectrum.h"

/* Of the unit, in 1/sr: a normal number with a reciprocal, and the hundredth of any value is one. */
#define SPECTRAL_UNIT_LEAST 0x1p-1022
#define SPECTRAL_UNIT_MOST 0x1p999
#define SPECTRAL_CODES_UNIT 0x1p39 /* of spectral_codes (spectral_kernels.h): what its 1 is, in units */
enum { SPECTRAL_PLANES_MAX = 24 }; /* |level| < 2^24 */
#define SPECTRAL_CENTRE_BELOW 0.4f /* where a level lies whose lower planes are missing, as a share of them */

/* A level that is not 0. */
struct spectral_level {
	uint32_t at; /* field * cells + place in the spectrum (row, column, lane) */
	int32_t level;
};

/*
 * Order of coding: units (plane, field, harmonic), planes from planes - 1 down to 0, fields 0..2, harmonics 0..P-1; layer l
 * ends before unit end[l].
 */
struct spectral_model {
	struct lattice_dims dims;
	double unit;   /* SPECTRAL_UNIT_LEAST to SPECTRAL_UNIT_MOST */
	float base[3]; /* of every channel: the mean of its y over the valid cells, taken off first; keeps float exact enough */
	float rotation[3][3]; /* orthonormal */
	struct spectral_weights weights;
	float *coefficient[3]; /* fitted: spectra of the three fields, divided by the weights' factors; NULL when decoded */
	float limit;           /* rows of phi_d are cut there (spans.h); 0: they are whole */
	float noise;           /* fitted: level of the noise that was found and drawn towards 0 (spectral_denoise); 0: none */

	float step;     /* decoded, as all that follows */
	bool dependent; /* two quantisers take turns: dependent.h */
	/* Where values lie beyond their level, in steps: of 1, of 1 in the second quantiser, of larger ones; and of levels whose
	   last planes are not there, as a share of what is missing. */
	float centre[4];
	uint32_t planes;
	uint32_t end[LAYERS_MAX];
	struct spectral_level *levels; /* ordered by field and harmonic */
	uint32_t level_count;
};

/* *out, for spectral_free, and the regression of each channel on the measured mean of the three. Nothing is kept on failure. */
bp_status spectral_fit(const struct lattice *lattice, const struct fit_options *options, struct spectral_model **out,
                       struct colour_fit colour[3], bp_error *error);
/*
 * Layers 0..layers-1 of a decoded model; BP_ERROR_ARGUMENT for one that was fitted. half: every second value along each axis
 * (extents even); *out has half the model's extents.
 */
bp_status spectral_expand(const struct spectral_model *model, uint32_t layers, bool half, struct expansion *out, bp_error *error);
/*
 * The same as 16-bit floats of table.h's expanded form in units of SPECTRAL_CODES_UNIT times the model's unit:
 * `channels` of them for every cell, 3 or 1, the channels' mean; rows of phi_d begin `stride` codes apart. No floats are kept.
 */
bp_status spectral_expand_codes(const struct spectral_model *model, uint32_t layers, bool half, int channels, uint16_t *out,
                                size_t stride, bp_error *error);
void spectral_free(struct spectral_model *model); /* NULL is allowed */

/* The lowest plane that is coded of a field's harmonic in units 0..end-1; `planes` when none is. */
uint32_t spectral_lowest_plane(uint32_t planes, uint32_t harmonics, uint32_t end, uint32_t field, uint32_t harmonic);

/*
 * The coefficient that a level stands for when planes below `lowest` are not there, by the model's step and centres; quantiser:
 * 0 or 1, 0 where the model is not dependent or planes are missing.
 */
float spectral_level_value(const struct spectral_model *model, int32_t level, uint32_t lowest, uint32_t quantiser);

/*
 * spectral_denoise.c: draws coefficients that noise alone would explain towards 0, in the spectra of the three fields. *level:
 * the noise's standard deviation, in log2 units, which three quarters of the whole rows are below, the largest of the fields; 0
 * where there is too little for anything to be done.
 */
bp_status spectral_denoise(struct spectrum *spectrum, struct lattice_dims dims, const struct watch *watch, float *const field[3],
                           float *level, bp_error *error);

/*
 * spectral_project.c: `steps` improvements of the values for invalid cells of three filled tables of logarithms, for a record of
 * about so many bytes with such weights. The spectrum's rows are cut at `limit`.
 */
bp_status spectral_project(struct spectrum *spectrum, struct lattice_dims dims, const uint8_t *valid, const float base[3],
                           const struct spectral_weights *weights, float limit, double budget_bytes, int steps,
                           float *const table[3], bp_error *error);
/* Coefficients that a record of so many bytes has room for. */
double spectral_places(double budget_bytes);
/* The size above which there are about `count` of the coefficients [rows][lanes], from one row in `every`. */
float spectral_size_of_rank(const float *coefficient, size_t rows, size_t lanes, size_t every, double count);

/*
 * spectral_fill.c: values for invalid cells of three tables [theta_h][theta_d][phi_d] of logarithms. Where `ready` is set, it
 * makes all cells of a table up to `end`, or more, before they are looked at, slice after slice, while they lie in the cache.
 */
typedef void spectral_ready_fn(void *user, int table, size_t end);
bp_status spectral_fill(struct lattice_dims dims, const uint8_t *valid, float *const table[3], spectral_ready_fn *ready,
                        void *user, bp_error *error);

#endif
