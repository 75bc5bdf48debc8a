/* density.inc.h: one row of the achromatic table. See paper_kernels.h. */

static double KERNEL(density_row)(const double *const rgb[3], const uint8_t *valid, size_t n, double factor, double *value,
                                  double *column_sum, uint32_t *column_count, uint32_t *count)
{
	lanes4 sum = LANES_ALL(0);
	uint32_t present = 0;
	const double *r = rgb[0], *g = rgb[1], *b = rgb[2];

	for (size_t k = 0; k < n; k++) {
		double v = (r[k] * factor + g[k] * factor) + b[k] * factor;
		value[k] = valid[k] ? v : 0;
	}
	for (size_t k = 0; k < n; k++) {
		uint32_t one = valid[k] != 0;
		column_sum[k] += value[k];
		column_count[k] += one;
		present += one;
	}
	size_t k = 0;
	for (; k + 4 <= n; k += 4)
		sum += LANES_LOAD(value + k);
	double rest = 0;
	for (; k < n; k++)
		rest += value[k];
	*count = present;
	return lanes_sum(&sum) + rest;
}
