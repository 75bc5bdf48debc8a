/*
 * wavelet.h: orthonormal wavelets on planes of any extents from 4 x 4.
 *
 * A field of n cells along an axis is carried on a transform axis of m >= n cells, m = 2^L ceil(n/2^L) with
 * L = floor(log2(n/2)) levels, so that 2 to 4 coarse cells remain (90 -> 96 = 2^5 3, 180 -> 192 = 2^6 3). The
 * transform is periodic along both axes. What stands in the cells from n to m is the caller's choice; a smooth
 * bridge from the last cell to the first (fill.h does it) keeps periodisation from making a jump.
 *
 * Both families are compactly supported and orthonormal: the sum of squares is kept, so the largest
 * coefficients are the best ones to keep, and the inverse is the transpose.
 */
#ifndef MODEL_PAPER_WAVELET_H
#define MODEL_PAPER_WAVELET_H

#include <stdint.h>

enum wavelet {
	WAVELET_HAAR,      /* 2 taps: for the pair copulas, whose steep parts are local */
	WAVELET_DAUBECHIES /* Daubechies' 4 taps, 2 vanishing moments: see paper.h */
};

struct wavelet_axis {
	uint32_t field, plane; /* n and m */
	uint32_t levels;       /* L >= 1 */
};

/* The axis for a field of n >= 4 cells. */
struct wavelet_axis wavelet_axis_for(uint32_t n);

/*
 * Transforms a plane of rows.plane x columns.plane values in place, row-major. Every axis is taken apart
 * completely: along an axis, coefficient 0..m/2^L-1 are the coarse ones, then the details of each level from coarse to
 * fine, cells in order. `scratch` holds as many values as the plane.
 */
void wavelet_forward(enum wavelet kind, struct wavelet_axis rows, struct wavelet_axis columns, double *plane, double *scratch);
void wavelet_inverse(enum wavelet kind, struct wavelet_axis rows, struct wavelet_axis columns, double *plane, double *scratch);

#endif
