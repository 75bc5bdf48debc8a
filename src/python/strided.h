/*
 * strided.h: the library's batches over arrays of vectors, as NumPy has them. Internal to the Python package.
 *
 * Component c of vector n is at [n * row + c * column], in floats. What comes out has rows of 3, one after the other.
 */
#ifndef STRIDED_H
#define STRIDED_H

#include "brdfpack.h"

void strided_evaluate(const bp_material *material, size_t count, const float *wi, ptrdiff_t wi_row, ptrdiff_t wi_column,
                      const float *wo, ptrdiff_t wo_row, ptrdiff_t wo_column, float *rgb);
void strided_sample(const bp_material *material, size_t count, const float *wo, ptrdiff_t wo_row, ptrdiff_t wo_column,
                    const float *u, ptrdiff_t u_row, ptrdiff_t u_column, float *wi, float *pdf);
void strided_pdf(const bp_material *material, size_t count, const float *wi, ptrdiff_t wi_row, ptrdiff_t wi_column,
                 const float *wo, ptrdiff_t wo_row, ptrdiff_t wo_column, float *pdf);
void strided_albedo(const bp_material *material, size_t count, const float *theta, float *rgb);

#endif
