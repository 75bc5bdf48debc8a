/* spectral_rank.c: which coefficients a record has room for. */
#include "spectral.h"
#include "model/math/fast_math.h"

enum {
	BIN_SHIFT = 19, /* of a float's bits: 16 bins to the octave */
	BINS = 1 << (31 - BIN_SHIFT),
};
static const double BITS_EACH = 4.3; /* of a record, for each coefficient that is not 0: 3.8 to 4.9 on surrogates */

double spectral_places(double budget_bytes) { return budget_bytes * 8 / BITS_EACH; }

float spectral_size_of_rank(const float *coefficient, size_t rows, size_t lanes, size_t every, double count)
{
	uint32_t bins[BINS] = {0}, bin = BINS;
	double above = 0;

	for (size_t r = every / 2; r < rows; r += every)
		for (size_t k = r * lanes; k < (r + 1) * lanes; k++)
			bins[(bits_of_float(coefficient[k]) & 0x7fffffff) >> BIN_SHIFT]++;
	while (bin > 1 && above + (double)every * bins[bin - 1] <= count)
		above += (double)every * bins[--bin];
	return float_of_bits(bin << BIN_SHIFT < 0x7f800000 ? bin << BIN_SHIFT : 0x7f7fffff);
}
