/* wavelet.inc.h: one level of a transform along the rows' index, and the mirrored parts of a row. See wavelet.h. */

/*
 * n rows of `width` values: row i of low is sum_k h_k in row (2 i + k), of high the same with g; row numbers are modulo n. n is
 * even. Two and four taps apart, so that a row is written once.
 */
static void KERNEL(wavelet_split)(const struct wavelet_filter *f, const float *in, size_t n, size_t width, float *low,
                                  float *high)
{
	const float h0 = f->low[0], h1 = f->low[1], g0 = f->high[0], g1 = f->high[1];

	for (size_t i = 0; i < n / 2; i++) {
		const float *a = in + 2 * i * width, *b = a + width;
		float *restrict lo = low + i * width, *restrict hi = high + i * width;
		if (f->taps == 2) {
			for (size_t c = 0; c < width; c++) {
				lo[c] = h0 * a[c] + h1 * b[c];
				hi[c] = g0 * a[c] + g1 * b[c];
			}
			continue;
		}
		const float h2 = f->low[2], h3 = f->low[3], g2 = f->high[2], g3 = f->high[3];
		const float *d = in + (2 * i + 2) % n * width, *e = in + (2 * i + 3) % n * width;
		for (size_t c = 0; c < width; c++) {
			lo[c] = (h0 * a[c] + h1 * b[c]) + (h2 * d[c] + h3 * e[c]);
			hi[c] = (g0 * a[c] + g1 * b[c]) + (g2 * d[c] + g3 * e[c]);
		}
	}
}

/* The transpose of wavelet_split, which is its inverse. */
static void KERNEL(wavelet_join)(const struct wavelet_filter *f, const float *low, const float *high, size_t n, size_t width,
                                 float *out)
{
	const size_t half = n / 2;
	const float h0 = f->low[0], h1 = f->low[1], g0 = f->high[0], g1 = f->high[1];

	for (size_t i = 0; i < half; i++) {
		const float *lo = low + i * width, *hi = high + i * width;
		float *restrict even = out + 2 * i * width, *restrict odd = even + width;
		if (f->taps == 2) {
			for (size_t c = 0; c < width; c++) {
				even[c] = h0 * lo[c] + g0 * hi[c];
				odd[c] = h1 * lo[c] + g1 * hi[c];
			}
			continue;
		}
		const float h2 = f->low[2], h3 = f->low[3], g2 = f->high[2], g3 = f->high[3];
		const size_t before = i ? i - 1 : half - 1;
		const float *lo2 = low + before * width, *hi2 = high + before * width;
		for (size_t c = 0; c < width; c++) {
			even[c] = (h0 * lo[c] + g0 * hi[c]) + (h2 * lo2[c] + g2 * hi2[c]);
			odd[c] = (h1 * lo[c] + g1 * hi[c]) + (h3 * lo2[c] + g3 * hi2[c]);
		}
	}
}

static const float KERNEL(ROOT_HALF) = 0.707106781f;

static void KERNEL(mirror_split)(const float *row, size_t n, float *even, float *odd)
{
	for (size_t k = 0; k < n / 2; k++) {
		const float a = row[k], b = row[n - 1 - k];
		even[k] = (a + b) * KERNEL(ROOT_HALF);
		odd[k] = (a - b) * KERNEL(ROOT_HALF);
	}
	if (n % 2)
		even[n / 2] = row[n / 2];
}

static void KERNEL(mirror_join)(const float *even, const float *odd, size_t n, float *row)
{
	for (size_t k = 0; k < n / 2; k++) {
		row[k] = (even[k] + odd[k]) * KERNEL(ROOT_HALF);
		row[n - 1 - k] = (even[k] - odd[k]) * KERNEL(ROOT_HALF);
	}
	if (n % 2)
		row[n / 2] = even[n / 2];
}
