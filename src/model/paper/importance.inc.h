/* importance.inc.h: one row of weights. See importance.h for the formula. */

static void KERNEL(importance_row)(const struct importance_place *place, const float *cos_phi, const float *value,
                                   const uint8_t *valid, size_t n, float *weight)
{
	const float seen = 2, ambient = 0.25f, bend = 0.2f, dark = 0.02f;
	const float even = place->even, odd = place->odd, area = place->area, relative = place->relative;

	for (size_t k = 0; k < n; k++) {
		const float t = odd * cos_phi[k], i0 = even - t, o0 = even + t;
		const float i = i0 > 0 ? i0 : 0, o = o0 > 0 ? o0 : 0, x = value[k];
		const float p = seen * x * i + ambient, q = seen * x * o + ambient;
		const float a = seen * i, b = seen * o;
		const float picture = o * a * a / (p + bend * p * p) + i * b * b / (q + bend * q * q);
		const float least = i < o ? i : o, share = 0.1f + 4 * least, r = 1 / (x + dark);
		const float shown = least > 0 ? (share < 1 ? share : 1) : 0.02f;
		const float w = 0.5f * area * picture + relative * shown * r * r;
		weight[k] = valid[k] ? w : 0;
	}
}

static void KERNEL(normalise_row)(const double *value, const uint8_t *valid, const double factor[2], size_t n, float *out)
{
	const double a = factor[0], b = factor[1];

	for (size_t k = 0; k < n; k++) {
		double v = value[k] * a * b;
		v = v < 1e15 ? v : 1e15;
		out[k] = valid[k] ? (float)(v > 1e-30 ? v : 0) : 0;
	}
}
