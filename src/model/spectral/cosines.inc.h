/* cosines.inc.h: the steps of cosines.h, on rows of 16 values. See spectral_kernels.h. */
#define ROW(p, k) ((p) + (size_t)(k)*16)

static void KERNEL(cosine_fold)(const float *x, size_t n, float *sum, float *difference)
{
	for (size_t k = 0; k < n / 2; k++) {
		const float *a = ROW(x, k), *b = ROW(x, n - 1 - k);
		for (int q = 0; q < 16; q += 8) {
			const floats8 u = FLOATS8_LOAD(a + q), v = FLOATS8_LOAD(b + q);
			FLOATS8_STORE(ROW(sum, k) + q, u + v);
			FLOATS8_STORE(ROW(difference, k) + q, u - v);
		}
	}
	if (n % 2)
		memcpy(ROW(sum, n / 2), ROW(x, n / 2), 16 * sizeof *x);
}

static void KERNEL(cosine_rotate)(const float *x, size_t n, const float *angle, float *a, float *b)
{
	for (size_t k = 0; k < n / 2; k++) {
		const float c = angle[k], s = angle[n / 2 + k], flip = k % 2 ? -1.0f : 1.0f;
		for (int q = 0; q < 16; q += 8) {
			const floats8 u = FLOATS8_LOAD(ROW(x, k) + q), v = FLOATS8_LOAD(ROW(x, n - 1 - k) + q);
			FLOATS8_STORE(ROW(a, k) + q, u * c + v * s);
			FLOATS8_STORE(ROW(b, k) + q, (v * c - u * s) * flip);
		}
	}
}

static void KERNEL(cosine_join)(const float *a, const float *b, size_t n, float *out, size_t stride)
{
	memcpy(out, a, 16 * sizeof *a);
	for (size_t p = 1; p < n / 2; p++)
		for (int q = 0; q < 16; q += 8) {
			const floats8 u = FLOATS8_LOAD(ROW(a, p) + q), v = FLOATS8_LOAD(ROW(b, n / 2 - p) + q);
			FLOATS8_STORE(out + 2 * p * stride + q, u + v);
			FLOATS8_STORE(out + (2 * p - 1) * stride + q, u - v);
		}
	for (int q = 0; q < 16; q += 8)
		FLOATS8_STORE(out + (n - 1) * stride + q, -FLOATS8_LOAD(b + q));
}

/* Eight rows of eight, from_stride apart, become eight columns, to_stride apart. */
static ALWAYS_INLINE void KERNEL(transpose8)(const float *from, size_t from_stride, float base, float *to, size_t to_stride)
{
	floats8 r[8], s[8];
	for (size_t i = 0; i < 8; i++)
		r[i] = FLOATS8_LOAD(from + i * from_stride) - base;
	for (int i = 0; i < 8; i += 2) {
		s[i] = __builtin_shufflevector(r[i], r[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
		s[i + 1] = __builtin_shufflevector(r[i], r[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
	}
	for (int i = 0; i < 8; i += 4)
		for (int j = 0; j < 2; j++) {
			r[i + 2 * j] = __builtin_shufflevector(s[i + j], s[i + j + 2], 0, 1, 8, 9, 4, 5, 12, 13);
			r[i + 2 * j + 1] = __builtin_shufflevector(s[i + j], s[i + j + 2], 2, 3, 10, 11, 6, 7, 14, 15);
		}
	for (size_t i = 0; i < 4; i++) {
		FLOATS8_STORE(to + i * to_stride, __builtin_shufflevector(r[i], r[i + 4], 0, 1, 2, 3, 8, 9, 10, 11));
		FLOATS8_STORE(to + (i + 4) * to_stride, __builtin_shufflevector(r[i], r[i + 4], 4, 5, 6, 7, 12, 13, 14, 15));
	}
}

static void KERNEL(cosine_gather)(const float *rows, size_t n, float base, float *out)
{
	size_t k = 0;
	for (; k + 8 <= n; k += 8)
		for (size_t r = 0; r < 16; r += 8)
			KERNEL(transpose8)(rows + r * n + k, n, base, ROW(out, k) + r, 16);
	for (; k < n; k++)
		for (size_t r = 0; r < 16; r++)
			ROW(out, k)[r] = rows[r * n + k] - base;
}

static void KERNEL(cosine_scatter)(const float *in, size_t count, size_t n, float *rows)
{
	size_t k = 0;
	for (; k + 8 <= count; k += 8)
		for (size_t r = 0; r < 16; r += 8)
			KERNEL(transpose8)(ROW(in, 2 * k) + r, 32, 0, rows + r * n + k, n);
	for (; k < count; k++)
		for (size_t r = 0; r < 16; r++)
			rows[r * n + k] = ROW(in, 2 * k)[r];
}
#undef ROW
