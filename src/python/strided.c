#include "strided.h"

#include <string.h>

enum { BLOCK = 512 }; /* vectors that are turned at once: 18 KB, which stay in the first cache */

struct vectors {
	float at[3][BLOCK];
};

typedef float f32x4 __attribute__((vector_size(16)));

static f32x4 load(const float *from)
{
	f32x4 to;
	memcpy(&to, from, sizeof to);
	return to;
}

static void store(float *to, f32x4 from) { memcpy(to, &from, sizeof from); }

/* Rows of x y z, four at a time: these shuffles become two or three instructions each, a plain loop many more. */
static void rows_gather(const float *from, size_t count, struct vectors *to)
{
	size_t n = 0;
	for (; n + 4 <= count; n += 4, from += 12) {
		const f32x4 a = load(from), b = load(from + 4), c = load(from + 8);
		const f32x4 x = __builtin_shufflevector(b, c, 2, -1, 5, -1), y0 = __builtin_shufflevector(a, b, 1, -1, 4, -1);
		const f32x4 y1 = __builtin_shufflevector(b, c, 3, -1, 6, -1), z = __builtin_shufflevector(a, b, 2, -1, 5, -1);
		store(to->at[0] + n, __builtin_shufflevector(a, x, 0, 3, 4, 6));
		store(to->at[1] + n, __builtin_shufflevector(y0, y1, 0, 2, 4, 6));
		store(to->at[2] + n, __builtin_shufflevector(z, c, 0, 2, 4, 7));
	}
	for (; n < count; n++, from += 3)
		for (int k = 0; k < 3; k++)
			to->at[k][n] = from[k];
}

/* The components of `count` vectors, one after the other. */
static void gather(const float *from, ptrdiff_t row, ptrdiff_t column, size_t count, struct vectors *to)
{
	if (row == 3 && column == 1) {
		rows_gather(from, count, to);
		return;
	}
	for (size_t n = 0; n < count; n++, from += row)
		for (int k = 0; k < 3; k++)
			to->at[k][n] = from[k * column];
}

static void scatter(const struct vectors *from, size_t count, float *to)
{
	size_t n = 0;
	for (; n + 4 <= count; n += 4, to += 12) {
		const f32x4 x = load(from->at[0] + n), y = load(from->at[1] + n), z = load(from->at[2] + n);
		const f32x4 xy = __builtin_shufflevector(x, y, 0, 2, 4, 6), yz = __builtin_shufflevector(y, z, 1, 3, 5, 7);
		const f32x4 zx = __builtin_shufflevector(z, x, 0, 2, 5, 7);
		store(to, __builtin_shufflevector(xy, zx, 0, 2, 4, 6));
		store(to + 4, __builtin_shufflevector(yz, xy, 0, 2, 5, 7));
		store(to + 8, __builtin_shufflevector(zx, yz, 1, 3, 5, 7));
	}
	for (; n < count; n++, to += 3)
		for (int k = 0; k < 3; k++)
			to[k] = from->at[k][n];
}

#define COMPONENTS(v) \
	(const float *const[]) { (v).at[0], (v).at[1], (v).at[2] }
#define COMPONENTS_OUT(v) \
	(float *const[]) { (v).at[0], (v).at[1], (v).at[2] }

void strided_evaluate(const bp_material *material, size_t count, const float *wi, ptrdiff_t wi_row, ptrdiff_t wi_column,
                      const float *wo, ptrdiff_t wo_row, ptrdiff_t wo_column, float *rgb)
{
	struct vectors in, out, value;
	for (size_t n = 0; n < count; n += BLOCK) {
		const size_t block = count - n < BLOCK ? count - n : BLOCK;
		gather(wi + (ptrdiff_t)n * wi_row, wi_row, wi_column, block, &in);
		gather(wo + (ptrdiff_t)n * wo_row, wo_row, wo_column, block, &out);
		bp_material_evaluate_batch(material, block, COMPONENTS(in), COMPONENTS(out), COMPONENTS_OUT(value));
		scatter(&value, block, rgb + 3 * n);
	}
}

void strided_sample(const bp_material *material, size_t count, const float *wo, ptrdiff_t wo_row, ptrdiff_t wo_column,
                    const float *u, ptrdiff_t u_row, ptrdiff_t u_column, float *wi, float *pdf)
{
	struct vectors out, number, in;
	for (size_t n = 0; n < count; n += BLOCK) {
		const size_t block = count - n < BLOCK ? count - n : BLOCK;
		gather(wo + (ptrdiff_t)n * wo_row, wo_row, wo_column, block, &out);
		gather(u + (ptrdiff_t)n * u_row, u_row, u_column, block, &number);
		bp_material_sample_batch(material, block, COMPONENTS(out), COMPONENTS(number), COMPONENTS_OUT(in), pdf + n);
		scatter(&in, block, wi + 3 * n);
	}
}

void strided_pdf(const bp_material *material, size_t count, const float *wi, ptrdiff_t wi_row, ptrdiff_t wi_column,
                 const float *wo, ptrdiff_t wo_row, ptrdiff_t wo_column, float *pdf)
{
	struct vectors in, out;
	for (size_t n = 0; n < count; n += BLOCK) {
		const size_t block = count - n < BLOCK ? count - n : BLOCK;
		gather(wi + (ptrdiff_t)n * wi_row, wi_row, wi_column, block, &in);
		gather(wo + (ptrdiff_t)n * wo_row, wo_row, wo_column, block, &out);
		bp_material_pdf_batch(material, block, COMPONENTS(in), COMPONENTS(out), pdf + n);
	}
}

void strided_albedo(const bp_material *material, size_t count, const float *theta, float *rgb)
{
	for (size_t n = 0; n < count; n++)
		bp_material_albedo(material, theta[n], rgb + 3 * n);
}
