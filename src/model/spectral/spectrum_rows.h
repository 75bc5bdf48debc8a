/*
 * spectrum_rows.h: tables from spectra, their rows cut or whole (spans.h), of which most coefficients are 0.
 *
 * Rows of different spans have different cosines, so the wavelets come first, on planes of SPECTRUM_BLOCK harmonics, of those
 * that are in use; then the cosines, row by row, up to the last harmonic that is not 0 there.
 */
#ifndef MODEL_SPECTRAL_SPECTRUM_ROWS_H
#define MODEL_SPECTRAL_SPECTRUM_ROWS_H

#include "spectrum_inverse.h"

enum { SPECTRUM_FIELDS = 3 };

struct spectrum_rows; /* of up to SPECTRUM_FIELDS fields; one thread at a time */

/* half: every second row along theta_h and theta_d, every second cell of them. limit: spans.h. Fields have up to `harmonics`. */
bp_status spectrum_rows_create(const struct spectrum_inverse *inverse, float limit, uint32_t harmonics, bool half,
                               struct spectrum_rows **out, bp_error *error);
void spectrum_rows_free(struct spectrum_rows *rows); /* NULL is allowed */

/* The wavelets of one field, from the terms start[m]..start[m + 1] - 1 of every harmonic m. */
bp_status spectrum_rows_field(struct spectrum_rows *rows, int field, const struct spectrum_term *terms, const uint32_t *start,
                              bp_error *error);

/* The cells of the rows first..first + count - 1 of those that are wanted, at most SPECTRUM_BLOCK of them, `stride` apart. */
void spectrum_rows_cells(struct spectrum_rows *rows, int field, uint32_t first, uint32_t count, float *out, size_t stride);

/* Row r of those wanted: cells *first..*first + *count - 1 hold all there is; those on either side repeat the one beside them. */
void spectrum_rows_seen(const struct spectrum_rows *rows, uint32_t r, uint32_t *first, uint32_t *count);

#endif
