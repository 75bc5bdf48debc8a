/* spans.c: see spans.h. A row is folded about its middle: even harmonics come from the sums, odd ones from the differences. */
#include "spans.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cosines.h"
#include "error.h"
#include "spectral_kernels.h"

enum { COLUMNS = 16 }; /* cosine_product works on so many at once */

/* Of one span: cosines of even and of odd harmonics, [k][harmonic] forward, [harmonic][k] inverse, columns padded with zeros. */
struct matrices {
	float *matrix[2];
};

struct span_cosines {
	uint32_t p;
	float *work; /* even and odd halves, SPAN_ROWS of them; behind the matrices */
	struct matrices of[];
};

static uint32_t padded(uint32_t columns) { return (columns + COLUMNS - 1) / COLUMNS * COLUMNS; }

float spans_limit(const struct lattice *lattice)
{
	const struct lattice_dims d = lattice->dims;
	struct lattice_cosines c;
	double lowest = 1;

	lattice_highest(d, &c);
	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++) {
			const uint8_t *valid = lattice->valid + lattice_index(d, i, j, 0);
			uint32_t k = 0;
			while (k < (d.phi_d + 1) / 2 && !valid[k] && !valid[d.phi_d - 1 - k])
				k++;
			if (k == (d.phi_d + 1) / 2)
				continue;
			lowest = fmin(lowest, c.cos_h[i] * c.cos_d[j] - c.sin_h[i] * c.sin_d[j] * c.cos_p[k]);
		}
	/* A little less, so that neither rounding nor binary32 decides about the cell itself. */
	return fmaxf((float)(lowest * (1 - 0x1p-16)), SPAN_MARGIN);
}

void spans_find(struct lattice_dims d, float limit, uint16_t *span)
{
	const uint32_t half = (d.phi_d + 1) / 2;
	struct lattice_cosines c;

	lattice_highest(d, &c);
	for (uint32_t i = 0; i < d.theta_h; i++) {
		uint32_t k = 0; /* the first above the limit, or `half`: the larger theta_d, the later */
		for (uint32_t j = 0; j < d.theta_d; j++) {
			while (k < half && limit > 0 && !(c.cos_h[i] * c.cos_d[j] - c.sin_h[i] * c.sin_d[j] * c.cos_p[k] > (double)limit))
				k++;
			*span++ = (uint16_t)(k < half ? d.phi_d - 2 * k : 2 - d.phi_d % 2);
		}
	}
}

/* The matrices of span n, of p cells; false where there is no memory. */
static bool matrices_make(uint32_t n, uint32_t p, uint32_t harmonics, bool inverse, struct matrices *out)
{
	const double scale = inverse ? sqrt(2.0 / p) : sqrt(2.0 * p) / n; /* g sqrt(2/n), and sqrt(2/n) / g */
	float *cosine = malloc(4 * (size_t)n * sizeof *cosine);
	bool good = cosine != NULL;

	for (uint32_t a = 0; a <= n && good; a++) {
		const float x = (float)(scale * cosines_exact(a, n));
		cosine[a] = cosine[(4 * n - a) % (4 * n)] = x;
		cosine[2 * n - a] = cosine[2 * n + a] = -x;
	}
	for (uint32_t parity = 0; parity < 2 && good; parity++) {
		const uint32_t count = parity ? n / 2 : (n + 1) / 2, stride = padded(count), most = (harmonics + 1 - parity) / 2;
		float *matrix = out->matrix[parity] = calloc((size_t)(count ? count * stride : 1), sizeof *matrix);
		good = matrix != NULL;
		for (uint32_t r = 0; r < count && r < most && good; r++) {
			const uint32_t m = 2 * r + parity;
			for (uint32_t k = 0, a = m; k < count; k++) {
				matrix[inverse ? (size_t)r * stride + k : (size_t)k * stride + r] = m ? cosine[a] : (float)(scale * sqrt(0.5));
				a += 2 * m;
				a -= a >= 4 * n ? 4 * n : 0;
			}
		}
	}
	free(cosine);
	return good;
}

bp_status span_cosines_create(uint32_t p, const uint16_t *span, size_t rows, uint32_t harmonics, bool inverse,
                              struct span_cosines **out, bp_error *error)
{
	const size_t matrices = ((size_t)p + 1) * sizeof(struct matrices), work = 4 * (size_t)padded(p) * SPAN_ROWS * sizeof(float);
	const size_t bytes = sizeof(struct span_cosines) + matrices + work;
	struct span_cosines *c = calloc(1, bytes);
	bool good = c != NULL;

	if (!c)
		return error_memory(error, bytes);
	c->p = p;
	c->work = (float *)(c->of + p + 1);
	for (size_t r = 0; r < rows && good; r++)
		good = c->of[span[r]].matrix[0] || matrices_make(span[r], p, harmonics, inverse, &c->of[span[r]]);
	if (!good) {
		span_cosines_free(c);
		return error_memory(error, bytes);
	}
	*out = c;
	return BP_OK;
}

void span_cosines_free(struct span_cosines *c)
{
	for (uint32_t n = 0; c && n <= c->p; n++)
		for (int parity = 0; parity < 2; parity++)
			free(c->of[n].matrix[parity]);
	free(c);
}

void span_forward(struct span_cosines *c, uint32_t n, float base, float *row)
{
	const struct spectral_kernels *kernels = spectral_kernels_get();
	const uint32_t half = n / 2, more = n - half, p = c->p;
	const float *x = row + (p - n) / 2;
	float *sum = c->work, *difference = sum + padded(p), *even = difference + padded(p), *odd = even + padded(p);

	for (uint32_t k = 0; k < half; k++) {
		sum[k] = x[k] + x[n - 1 - k] - 2 * base;
		difference[k] = x[k] - x[n - 1 - k];
	}
	if (more > half)
		sum[half] = x[half] - base;
	kernels->cosine_product(sum, n, 1, more, c->of[n].matrix[0], padded(more), even, padded(p));
	kernels->cosine_product(difference, n, 1, half, c->of[n].matrix[1], padded(half), odd, padded(p));
	memset(row, 0, p * sizeof *row);
	memcpy(row, even, more * sizeof *row);
	memcpy(row + (p + 1) / 2, odd, half * sizeof *row);
}

void span_inverse(struct span_cosines *c, uint32_t n, const struct span_lanes *in, size_t rows, float *out, size_t out_stride)
{
	const struct spectral_kernels *kernels = spectral_kernels_get();
	const uint32_t half = n / 2, more = n - half, p = c->p, first = (p - n) / 2;
	const size_t stride = padded(p);
	float *sum = c->work, *difference = sum + SPAN_ROWS * stride;

	kernels->cosine_product(in->even, in->stride, rows, in->even_count < more ? in->even_count : more, c->of[n].matrix[0],
	                        padded(more), sum, stride);
	kernels->cosine_product(in->odd, in->stride, rows, in->odd_count < half ? in->odd_count : half, c->of[n].matrix[1],
	                        padded(half), difference, stride);
	for (size_t r = 0; r < rows; r++, out += out_stride) {
		float *x = out + first;
		kernels->span_unfold(sum + r * stride, difference + r * stride, n, x);
		for (uint32_t k = 0; k < first; k++)
			out[k] = x[0];
		for (uint32_t k = first + n; k < p; k++)
			out[k] = x[n - 1];
	}
}
