#include "cosines.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "spectral_kernels.h"
#include "merl/lattice.h"

enum { WIDTH = 16, SMALL = 8 }; /* rows at once; from here on a product is as good */

/* A transform of n values, and what it is made of. */
struct node {
	uint32_t n;
	int fourth; /* DCT-IV, otherwise DCT-II */
	/* Split: II(n/2) and IV(n/2), or the one II(n/2) that IV(n) needs twice, with its angles: n/2 cosines, then n/2 sines. */
	struct node *child[2];
	float *angle;
	float *table[2]; /* not split: of even and odd harmonics, or of all in the first, [harmonic][k] */
};

struct cosines {
	uint32_t n;
	struct node *root;
	float *out, *scratch, *rest, in[]; /* [n][WIDTH], rest [WIDTH][n]; all in one block */
};

/* From the first quadrant only, so that equal angles give equal values. */
double cosines_exact(uint64_t a, uint32_t p)
{
	double c, s;
	a %= 4 * (uint64_t)p;
	if (a > 2 * (uint64_t)p)
		a = 4 * (uint64_t)p - a;
	const int negative = a > p;
	if (negative)
		a = 2 * (uint64_t)p - a;
	quarter_cos_sin((double)a / p, &c, &s);
	return negative ? -c : c;
}

static void node_free(struct node *node)
{
	if (!node)
		return;
	node_free(node->child[0]);
	node_free(node->child[1]);
	free(node->angle);
	free(node->table[0]);
	free(node->table[1]);
	free(node);
}

/* scale cos(pi (2 m + parity) (2 k + 1) / 2 p), [m][k], `count` of both. */
static float *table_make(uint32_t count, uint32_t parity, uint32_t p, float scale)
{
	float *table = malloc((size_t)(count ? count * count : 1) * sizeof *table);
	for (uint32_t m = 0; m < count && table; m++)
		for (uint32_t k = 0; k < count; k++)
			table[m * count + k] = (float)((double)scale * cosines_exact((uint64_t)(2 * m + parity) * (2 * k + 1), p));
	return table;
}

static float *angles(uint32_t n)
{
	float *angle = malloc(n * sizeof *angle);
	for (uint32_t k = 0; k < n / 2 && angle; k++) {
		angle[k] = (float)cosines_exact(2 * k + 1, 2 * n);
		angle[n / 2 + k] = (float)cosines_exact(2 * n - (2 * k + 1), 2 * n);
	}
	return angle;
}

/* NULL when there is no memory. Every path to a value passes one table, which has the scale. */
static struct node *node_make(uint32_t n, int fourth, float scale)
{
	struct node *node = calloc(1, sizeof *node);
	if (!node)
		return NULL;
	node->n = n;
	node->fourth = fourth;
	int good;
	if (n % 2 || n <= SMALL) {
		node->table[0] = fourth ? table_make(n, 1, 2 * n, scale) : table_make((n + 1) / 2, 0, n, scale);
		node->table[1] = fourth ? NULL : table_make(n / 2, 1, n, scale);
		good = node->table[0] && (fourth || node->table[1]);
	} else {
		node->child[0] = node_make(n / 2, 0, scale);
		node->child[1] = fourth ? NULL : node_make(n / 2, 1, scale);
		node->angle = fourth ? angles(n) : NULL;
		good = node->child[0] && (fourth ? node->angle != NULL : node->child[1] != NULL);
	}
	if (good)
		return node;
	node_free(node);
	return NULL;
}

bp_status cosines_create(uint32_t n, struct cosines **out, bp_error *error)
{
	/* A node leaves at most 2 n rows behind for its children's work, which have half as many values. */
	const size_t bytes = sizeof(struct cosines) + (size_t)n * WIDTH * 7 * sizeof(float);
	struct cosines *c = malloc(bytes);
	struct node *root = node_make(n, 0, (float)sqrt(2.0 / n));

	if (!c || !root) {
		node_free(root);
		free(c);
		return error_memory(error, bytes);
	}
	c->n = n;
	c->root = root;
	c->out = c->in + (size_t)n * WIDTH;
	c->rest = c->out + (size_t)n * WIDTH;
	c->scratch = c->rest + (size_t)n * WIDTH;
	*out = c;
	return BP_OK;
}

void cosines_free(struct cosines *cosines)
{
	if (!cosines)
		return;
	node_free(cosines->root);
	free(cosines);
}

/* x[n][WIDTH] to out[harmonic], `step` rows apart. */
static void node_run(const struct node *node, const float *x, float *out, size_t step, float *scratch)
{
	const struct spectral_kernels *kernels = spectral_kernels_get();
	const size_t n = node->n, half = n / 2;
	float *first = scratch, *second = scratch + (n - half) * WIDTH, *left = scratch + n * WIDTH;

	if (node->fourth && !node->child[0]) {
		kernels->cosine_product(node->table[0], n, n, n, x, WIDTH, out, step * WIDTH);
	} else if (node->fourth) {
		float *a = left, *b = left + half * WIDTH;
		kernels->cosine_rotate(x, n, node->angle, first, second);
		node_run(node->child[0], first, a, 1, left + n * WIDTH);
		node_run(node->child[0], second, b, 1, left + n * WIDTH);
		kernels->cosine_join(a, b, n, out, step * WIDTH);
	} else {
		kernels->cosine_fold(x, n, first, second);
		if (node->child[0]) {
			node_run(node->child[0], first, out, 2 * step, left);
			node_run(node->child[1], second, out + step * WIDTH, 2 * step, left);
		} else {
			kernels->cosine_product(node->table[0], n - half, n - half, n - half, first, WIDTH, out, 2 * step * WIDTH);
			kernels->cosine_product(node->table[1], half, half, half, second, WIDTH, out + step * WIDTH, 2 * step * WIDTH);
		}
	}
}

static void strip_forward(struct cosines *c, float *rows, float base)
{
	const struct spectral_kernels *kernels = spectral_kernels_get();
	const size_t n = c->n, even = (n + 1) / 2;

	kernels->cosine_gather(rows, n, base, c->in);
	node_run(c->root, c->in, c->out, 1, c->scratch);
	for (int q = 0; q < WIDTH; q++)
		c->out[q] *= 0.707106781f;
	kernels->cosine_scatter(c->out, even, n, rows);
	kernels->cosine_scatter(c->out + WIDTH, n - even, n, rows + even);
}

void cosines_forward(struct cosines *c, float *rows, size_t count, float base)
{
	size_t r = 0;
	for (; r + WIDTH <= count; r += WIDTH)
		strip_forward(c, rows + r * c->n, base);
	if (r == count)
		return;
	memset(c->rest, 0, (size_t)c->n * WIDTH * sizeof *c->rest);
	memcpy(c->rest, rows + r * c->n, (count - r) * c->n * sizeof *rows);
	strip_forward(c, c->rest, base);
	memcpy(rows + r * c->n, c->rest, (count - r) * c->n * sizeof *rows);
}
