#include "origin.h"

#include <math.h>

void reciprocity_add(struct reciprocity *reciprocity, double a, double b)
{
	const double difference = a == b ? 0 : fabs(a - b) / (0.5 * (a + b));
	reciprocity->bins[(int)(fmin(difference, 2) * (RECIPROCITY_BINS / 2))]++;
	reciprocity->count++;
}

static double quantile(const struct reciprocity *reciprocity, double share)
{
	uint64_t below = 0;
	int bin = 0;
	while (bin < RECIPROCITY_BINS && (double)(below + reciprocity->bins[bin]) < share * (double)reciprocity->count)
		below += reciprocity->bins[bin++];
	return bin == 0 && reciprocity->bins[0] == reciprocity->count ? 0 : (bin + 0.5) / (RECIPROCITY_BINS / 2);
}

void reciprocity_tell(const struct reciprocity *reciprocity, struct origin *origin)
{
	origin->compared = reciprocity->count;
	origin->median = quantile(reciprocity, 0.5);
	origin->percentile95 = quantile(reciprocity, 0.95);
}
