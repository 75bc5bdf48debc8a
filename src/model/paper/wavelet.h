/*
 * wavelet.h: orthonormal wavelets on planes of any extents from 4 x 4.
 *
 * A field of n cells along an axis is carried on a transform axis of m >= n cells, m = 2^L ceil(n/2^L) with
 * L = floor(log2(n/2)) levels, so that 2 to 4 coarse cells remain (90 -> 96 = 2^5 3, 180 -> 192 = 2^6 3). The
 * transform is periodic along both axes; cells from n to m belong to nobody.
 *
 * phi_d is *mirrored* first: with P cells, k and P - 1 - k make an even part (x[k] + x[P-1-k])/sqrt 2 and an odd one
 * (x[k] - x[P-1-k])/sqrt 2, each of h = ceil(P/2) cells (of an odd P the middle cell is even as it is), and each is carried
 * on an axis of its own. Materials whose lobes look the same from both sides have no odd part, and no jump at the even one's end.
 *
 * Both families are compactly supported and orthonormal: the sum of squares is kept and the inverse is the transpose.
 */
#ifndef MODEL_PAPER_WAVELET_H
#define MODEL_PAPER_WAVELET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum wavelet {
	WAVELET_HAAR,      /* 2 taps: the pair copulas */
	WAVELET_DAUBECHIES /* Daubechies' 4 taps, 2 vanishing moments: the conditional ones */
};

struct wavelet_axis {
	uint32_t field, plane; /* n and m */
	uint32_t levels;       /* L */
};

/* The axis for a field of n >= 2 cells. */
struct wavelet_axis wavelet_axis_for(uint32_t n);

/* A field of rows x columns cells and where its coefficients are. */
struct wavelet_plane {
	enum wavelet kind;
	bool mirrored; /* along the columns' index */
	uint32_t field_columns;
	struct wavelet_axis rows, columns; /* columns: of one part where mirrored */
	uint32_t parts;                    /* 2 where mirrored, else 1 */
};

struct wavelet_plane wavelet_plane_for(enum wavelet kind, uint32_t rows, uint32_t columns, bool mirrored);
static inline size_t wavelet_field_cells(const struct wavelet_plane *p) { return (size_t)p->rows.field * p->field_columns; }
/* Coefficients, and values of one scratch plane. */
static inline size_t wavelet_cells(const struct wavelet_plane *p) { return (size_t)p->rows.plane * p->columns.plane * p->parts; }

/*
 * field[rows.field * field_columns], row-major, 0 outside <-> coefficient[(part * columns.plane + column) * rows.plane + row].
 * Every axis is taken apart completely: along it, coefficients 0..m/2^L-1 are the coarse ones, then the details of each
 * level from coarse to fine, cells in order. scratch: 3 planes.
 */
void wavelet_forward(const struct wavelet_plane *p, const float *field, float *coefficient, float *scratch);
void wavelet_inverse(const struct wavelet_plane *p, const float *coefficient, float *field, float *scratch);

/*
 * Squares of the basis: of coefficient a of an axis at cell n, square[a * field + n]. One axis of one part, not mirrored; the
 * caller frees it. NULL when there is no memory.
 */
float *wavelet_squares(enum wavelet kind, struct wavelet_axis axis);

#endif
