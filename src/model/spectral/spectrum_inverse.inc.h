/* spectrum_inverse.inc.h: planes of SPECTRUM_BLOCK = 16 values a row of phi_d. See spectral_kernels.h and spectrum_inverse.h. */
#include "spectrum_inverse.h"

/*
 * One inverse step along a line of n >= 3 vectors, `stride` floats apart, the gains being in them: the four lifting steps in one
 * pass, each two places behind the one before. `half`: only x[0], x[2], ... are wanted.
 */
static ALWAYS_INLINE void KERNEL(cdf97_line)(float *x, size_t n, size_t stride, int half)
{
	/* After the first step: even1; the second: odd2; the third: even3, all of the last place that has it. */
	floats_wide odd = FLOATS_WIDE_LOAD(x + stride), even1 = FLOATS_WIDE_LOAD(x) - CDF97_D * (odd + odd);
	floats_wide odd2 = odd, even3 = even1;
	size_t e;

	for (e = 2; e < n; e += 2) {
		float *here = x + e * stride;
		const floats_wide next = e + 1 < n ? FLOATS_WIDE_LOAD(here + stride) : odd;
		const floats_wide even = FLOATS_WIDE_LOAD(here) - CDF97_D * (odd + next);
		const floats_wide between = odd - CDF97_C * (even1 + even);
		const floats_wide done = even1 - CDF97_B * ((e == 2 ? between : odd2) + between);
		if (!half && e > 2)
			FLOATS_WIDE_STORE(here - 3 * stride, odd2 - CDF97_A * (even3 + done));
		FLOATS_WIDE_STORE(here - 2 * stride, done);
		odd = next;
		even1 = even;
		odd2 = between;
		even3 = done;
	}
	float *last = x + (e - 2) * stride; /* the last even place */
	if (n % 2 == 0) {
		const floats_wide between = odd - CDF97_C * (even1 + even1);
		const floats_wide done = even1 - CDF97_B * (odd2 + between);
		FLOATS_WIDE_STORE(last, done);
		if (!half) {
			FLOATS_WIDE_STORE(last - stride, odd2 - CDF97_A * (even3 + done));
			FLOATS_WIDE_STORE(last + stride, between - CDF97_A * (done + done));
		}
	} else {
		const floats_wide done = even1 - CDF97_B * (odd2 + odd2);
		FLOATS_WIDE_STORE(last, done);
		if (!half)
			FLOATS_WIDE_STORE(last - stride, odd2 - CDF97_A * (even3 + done));
	}
}

static void KERNEL(cdf97_plane)(float *plane, size_t rows, size_t columns, unsigned levels, int half)
{
	for (unsigned l = levels; l-- > 0;) {
		const size_t h = (rows + ((size_t)1 << l) - 1) >> l, d = (columns + ((size_t)1 << l) - 1) >> l;
		const size_t cell = (size_t)SPECTRUM_BLOCK << l, row = columns * cell;
		if (l == 0 && half) {
			for (size_t j = 0; j < d * SPECTRUM_BLOCK; j += FLOATS_WIDE)
				KERNEL(cdf97_line)(plane + j, h, row, 1);
			for (size_t i = 0; i < h; i += 2)
				for (size_t q = 0; q < SPECTRUM_BLOCK; q += FLOATS_WIDE)
					KERNEL(cdf97_line)(plane + i * row + q, d, cell, 1);
		} else {
			for (size_t j = 0; j < d; j++)
				for (size_t q = 0; q < SPECTRUM_BLOCK; q += FLOATS_WIDE)
					KERNEL(cdf97_line)(plane + j * cell + q, h, row, 0);
			for (size_t i = 0; i < h; i++)
				for (size_t q = 0; q < SPECTRUM_BLOCK; q += FLOATS_WIDE)
					KERNEL(cdf97_line)(plane + i * row + q, d, cell, 0);
		}
	}
}
