/* solver.inc.h: the loops of sparse_fit.c and pairs.c: elementwise, and sums in eight lanes. See math/kernels.h. */

static double KERNEL(lanes8_sum)(const floats8 *v)
{
	return (((double)(*v)[0] + (double)(*v)[1]) + ((double)(*v)[2] + (double)(*v)[3])) +
	       (((double)(*v)[4] + (double)(*v)[5]) + ((double)(*v)[6] + (double)(*v)[7]));
}

static void KERNEL(residual)(const float *weight, const float *wanted, size_t n, float *value)
{
	for (size_t i = 0; i < n; i++)
		value[i] = weight[i] * (wanted[i] - value[i]);
}

static double KERNEL(weigh)(const float *weight, const float *in, size_t n, float *out)
{
	floats8 sum = {0};
	double rest = 0;
	size_t i = 0;

	for (; i + 8 <= n; i += 8) {
		const floats8 v = FLOATS8_LOAD(in + i), w = FLOATS8_LOAD(weight + i) * v;
		FLOATS8_STORE(out + i, w);
		sum += v * w;
	}
	for (; i < n; i++) {
		const float v = in[i];
		out[i] = weight[i] * v;
		rest += (double)(v * out[i]);
	}
	return KERNEL(lanes8_sum)(&sum) + rest;
}

static void KERNEL(add_scaled)(float factor, const float *x, size_t n, float *out)
{
	for (size_t i = 0; i < n; i++)
		out[i] += factor * x[i];
}

static void KERNEL(turn)(float factor, const float *x, size_t n, float *out)
{
	for (size_t i = 0; i < n; i++)
		out[i] = x[i] + factor * out[i];
}

static void KERNEL(gains)(const float *x, const float *gradient, const float *energy, float least, size_t n, float *gain)
{
	for (size_t i = 0; i < n; i++) {
		const float v = x[i] + 0.7f * gradient[i] / (energy[i] + least);
		gain[i] = v * v * energy[i];
	}
}

static void KERNEL(fit_row)(const float *weight, const float *value, const float *u, const float *v, size_t n, double out[2])
{
	floats8 a = {0}, b = {0};
	double rest_a = 0, rest_b = 0;
	size_t i = 0;

	for (; i + 8 <= n; i += 8) {
		const floats8 p = FLOATS8_LOAD(u + i) * FLOATS8_LOAD(v + i), w = FLOATS8_LOAD(weight + i) * p;
		a += w * FLOATS8_LOAD(value + i);
		b += w * p;
	}
	for (; i < n; i++) {
		const float p = u[i] * v[i], w = weight[i] * p;
		rest_a += (double)(w * value[i]);
		rest_b += (double)(w * p);
	}
	out[0] = KERNEL(lanes8_sum)(&a) + rest_a;
	out[1] = KERNEL(lanes8_sum)(&b) + rest_b;
}

static void KERNEL(fit_columns)(const float *weight, const float *value, float u, const float *v, size_t n, float *numerator,
                                float *denominator)
{
	for (size_t i = 0; i < n; i++) {
		const float p = u * v[i], w = weight[i] * p;
		numerator[i] += w * value[i];
		denominator[i] += w * p;
	}
}

static void KERNEL(quotients)(const float *weight, const float *value, float row, const float *column, size_t n, float *quotient,
                              float *energy)
{
	for (size_t k = 0; k < n; k++) {
		const float p = row * column[k];
		const bool usable = p > 1e-20f;
		quotient[k] = usable ? value[k] / p : 0;
		energy[k] = usable ? weight[k] * p * p : 0;
	}
}
