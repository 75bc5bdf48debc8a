/* spectral_worths.inc.h: what errors of many values are worth. See spectral_kernels.h and spectral_weights_find.c. */

static void KERNEL(spectral_log2s)(double *x, size_t n)
{
	for (size_t i = 0; i < n; i++)
		x[i] = fast_log2(x[i]);
}

static void KERNEL(spectral_worths)(const double *radiance, size_t n, const struct spectral_light *lights, size_t light_count,
                                    double ambient, double *restrict out)
{
	for (size_t i = 0; i < n; i++)
		out[i] = 0;
	for (size_t l = 0; l < light_count; l++) {
		const double light = lights[l].radiance, count = lights[l].count;
		for (size_t i = 0; i < n; i++) {
			/* A pixel x + ambient, x being this light's; the curve is a power of 1/2.4. Above white there is nothing to see. */
			const double x = radiance[i] * light, share = x + 0.02 * light;
			const double slope = fast_exp2(2 * (1 / 2.4 - 1) * fast_log2(x + ambient)), dimmed = slope / (x * x);
			out[i] += count * (x > 1 ? dimmed : slope) * share * share;
		}
	}
}
