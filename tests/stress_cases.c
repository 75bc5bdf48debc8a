/* stress_cases.c: see stress_cases.h. A kind is one function and one row of the table at the end. */
#include "stress_cases.h"

#include <float.h>
#include <math.h>

double stress_uniform(uint64_t *state)
{
	uint64_t z = *state += 0x9e3779b97f4a7c15u; /* splitmix64 */
	z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
	z = (z ^ z >> 27) * 0x94d049bb133111ebu;
	return ((double)((z ^ z >> 31) >> 12) + 0.5) * 0x1p-52;
}

double stress_normal(uint64_t *state)
{
	const double radius = sqrt(-2 * log(stress_uniform(state)));
	return radius * cos(6.283185307179586 * stress_uniform(state));
}

/* ---- what the kinds are made of ---- */

struct cell {
	uint32_t i, j, k;
	double h, d, p; /* 0..1 along each axis */
};

static struct cell cell_at(struct lattice_dims d, size_t n)
{
	struct cell c = {
		.k = (uint32_t)(n % d.phi_d), .j = (uint32_t)(n / d.phi_d % d.theta_d), .i = (uint32_t)(n / d.phi_d / d.theta_d)};
	c.h = (double)c.i / d.theta_h;
	c.d = (double)c.j / d.theta_d;
	c.p = (double)c.k / d.phi_d;
	return c;
}

/* Declares `at` and runs over all cells; n is the cell's index. */
#define FOR_EACH_CELL(lattice, n, at) \
	struct cell at = cell_at((lattice)->dims, 0); \
	for (size_t n = 0; n < lattice_cells((lattice)->dims); at = cell_at((lattice)->dims, ++n))

static void grey(struct lattice *lattice, size_t n, double value)
{
	for (int c = 0; c < 3; c++)
		lattice->rgb[c][n] = value;
}

/* A plain material: diffuse floor, Gaussian lobe, a rise towards grazing, a little anisotropy of the differences. */
static double plain(const struct cell *c, double width)
{
	const double lobe = exp(-c->h * c->h * c->h * c->h / (width * width));
	return 0.1 + 5 * lobe * (1 + 3 * pow(c->d, 5)) * (1 + 0.2 * c->d * cos(6.283185307179586 * c->p));
}

static void plain_fill(struct lattice *lattice, uint64_t seed)
{
	const double width = 0.02 + 0.3 * stress_uniform(&seed);
	FOR_EACH_CELL(lattice, n, c)
	{
		const double value = plain(&c, width);
		lattice->rgb[0][n] = value;
		lattice->rgb[1][n] = 0.6 * value + 0.02;
		lattice->rgb[2][n] = 0.3 * value + 0.05;
	}
}

/* ---- the kinds ---- */

static void make_plain(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	(void)variant;
	plain_fill(lattice, seed);
}

static void make_constant(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	static const double values[] = {0, 1e-300, 1e-150, 1e-30, 1e-9, 1e-3, 1, 1e3, 1e9, 1e30, 1e150, 1e300};
	(void)seed;
	for (size_t n = 0; n < lattice_cells(lattice->dims); n++)
		grey(lattice, n, values[variant]);
}

static void make_bright_cell(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	const size_t cells = lattice_cells(lattice->dims);
	const size_t at = variant % 3 == 0 ? 0 : variant % 3 == 1 ? cells - 1 : (size_t)(stress_uniform(&seed) * (double)cells);
	for (size_t n = 0; n < lattice_cells(lattice->dims); n++)
		grey(lattice, n, n == at ? 1e12 : variant < 3 ? 0 : 1e-6);
}

static void make_checkerboard(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	static const double low[] = {0, 1e-12, 1e-300, 1e-3}, high[] = {1e6, 1e12, 1e300, 1e3};
	(void)seed;
	FOR_EACH_CELL(lattice, n, c) grey(lattice, n, (c.i + c.j + c.k) % 2 ? low[variant] : high[variant]);
}

/* A mirror: one cell of theta_h holds everything; over a floor or over nothing. */
/* A mirror, whose lobe is one slice wide, over three kinds of darkness; and one cell alone that is bright, in a plain material. */
static void make_delta_lobe(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	if (variant < 3) {
		FOR_EACH_CELL(lattice, n, c) grey(lattice, n, c.i == 0 ? 1e5 * (1 + c.d) : variant == 0 ? 0 : variant == 1 ? 1e-4 : 0.3);
		return;
	}
	plain_fill(lattice, seed);
	grey(lattice, (size_t)(stress_uniform(&seed) * (double)lattice_cells(lattice->dims)), 1e5);
}

static void make_step(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	const double edge = variant < 3 ? 0.5 : 0.1 + 0.8 * stress_uniform(&seed);
	FOR_EACH_CELL(lattice, n, c)
	{
		const double along = variant % 3 == 0 ? c.h : variant % 3 == 1 ? c.d : c.p;
		grey(lattice, n, along < edge ? 100 : 0.01);
	}
}

static void make_one_valid(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	const size_t cells = lattice_cells(lattice->dims);
	const size_t at = variant == 0 ? 0 : variant == 1 ? cells - 1 : (size_t)(stress_uniform(&seed) * (double)cells);
	plain_fill(lattice, seed);
	for (size_t n = 0; n < lattice_cells(lattice->dims); n++) {
		if (n != at)
			grey(lattice, n, -1);
	}
}

/* Whole slices of theta_h, rows of theta_d, columns of phi_d are missing: every other one, or a third in one piece. */
static void make_missing_slices(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	plain_fill(lattice, seed);
	FOR_EACH_CELL(lattice, n, c)
	{
		const uint32_t at = variant % 3 == 0 ? c.i : variant % 3 == 1 ? c.j : c.k;
		const double along = variant % 3 == 0 ? c.h : variant % 3 == 1 ? c.d : c.p;
		if (variant < 3 ? at % 2 == 0 : along >= 0.33 && along < 0.67)
			grey(lattice, n, -1);
	}
}

static void make_random_validity(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	static const double share[] = {0.01, 0.5, 0.99};
	uint64_t random = seed + 1;
	plain_fill(lattice, seed);
	for (size_t n = 0; n < lattice_cells(lattice->dims); n++) {
		if (stress_uniform(&random) > share[variant] && n)
			grey(lattice, n, -1);
	}
}

static void make_odd_channel(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	plain_fill(lattice, seed);
	for (size_t n = 0; n < lattice_cells(lattice->dims); n++) {
		double *value = &lattice->rgb[seed % 3][n];
		*value = variant == 0 ? 0 : variant == 1 ? -*value : variant == 2 ? *value * 1e9 : *value * 1e-9;
	}
}

static void make_anticorrelated(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	const double width = 0.02 + 0.3 * stress_uniform(&seed);
	FOR_EACH_CELL(lattice, n, c)
	{
		const double value = plain(&c, width);
		lattice->rgb[0][n] = value;
		lattice->rgb[1][n] = variant == 0 ? 1 / value : 20 - value > 0 ? 20 - value : 0;
		lattice->rgb[2][n] = variant == 0 ? 0.1 : value * value;
	}
}

/* What the colours' regression meets: x is the mean of the channels. */
static void make_regression(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	uint64_t random = seed + 1;
	plain_fill(lattice, seed);
	FOR_EACH_CELL(lattice, n, c)
	{
		double *r = &lattice->rgb[0][n], *g = &lattice->rgb[1][n], *b = &lattice->rgb[2][n];
		if (variant == 0) { /* x constant, y not */
			*r = 0.5 + 0.25 * c.d;
			*g = 0.5 - 0.25 * c.d;
			*b = 0.5;
		} else if (variant == 1) { /* two values of x */
			grey(lattice, n, c.i % 2 ? 1 : 3);
			*g = c.i % 2 ? 2 : 0.5;
		} else if (variant == 2) { /* 49 % outliers */
			if (stress_uniform(&random) < 0.49)
				*r *= 1 + 50 * stress_uniform(&random);
		} else { /* most residuals are 0, so MAD = 0 */
			*r = *g = *b = (double)(1 + n % 16);
			*g += n % 5 == 0 ? (double)(n % 7) : 0;
		}
	}
}

static void make_nonfinite(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	static const double share[] = {0.001, 0.1, 0.9};
	const double faults[] = {NAN, -NAN, INFINITY, -INFINITY, -0.0};
	uint64_t random = seed + 1;
	plain_fill(lattice, seed);
	for (size_t n = 0; n < lattice_cells(lattice->dims); n++) {
		if (n && stress_uniform(&random) < share[variant])
			lattice->rgb[(int)(3 * stress_uniform(&random))][n] = faults[(int)(5 * stress_uniform(&random))];
	}
}

static void make_denormal(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	uint64_t random = seed + 1;
	plain_fill(lattice, seed);
	FOR_EACH_CELL(lattice, n, c)
	{
		if (variant == 0)
			grey(lattice, n, DBL_TRUE_MIN * floor(1 + 1e6 * stress_uniform(&random)));
		else if (variant == 1)
			grey(lattice, n, plain(&c, 0.1) * 1e-310);
		else if (stress_uniform(&random) < 0.5)
			grey(lattice, n, DBL_TRUE_MIN);
	}
}

static void make_noise(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	uint64_t random = seed + 1;
	plain_fill(lattice, seed);
	for (int p = 0; p < 3; p++)
		for (size_t n = 0; n < lattice_cells(lattice->dims); n++) {
			double *value = &lattice->rgb[p][n];
			*value = variant == 0   ? fabs(*value * (1 + stress_normal(&random))) /* 100 % */
			         : variant == 1 ? *value * exp(3 * stress_normal(&random))    /* heavy tails */
			                        : stress_uniform(&random);                    /* nothing but noise */
		}
}

/* What genuine mirrors and flakes have: a lobe that glitters from cell to cell and turns its colour, nothing beside it, holes from 85 degrees on. */
static void make_speckled_mirror(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	const double dark = variant == 0 ? 1e-6 : variant == 1 ? 1e-12 : 0;
	uint64_t random = seed + 1;
	FOR_EACH_CELL(lattice, n, c)
	{
		const double h = (c.h + 0.5 / lattice->dims.theta_h), theta_h = h * h * 1.5707963267948966;
		const double theta_d = (c.d + 0.5 / lattice->dims.theta_d) * 1.5707963267948966;
		const double phi = (c.p + 0.5 / lattice->dims.phi_d) * 3.141592653589793;
		const double smaller = cos(theta_h) * cos(theta_d) - fabs(sin(theta_h) * sin(theta_d) * cos(phi));
		const double glitter = 1e4 * exp(2 * stress_normal(&random) - 30 * theta_h * theta_h * 30), turn = sin(4 * theta_d);
		lattice->rgb[0][n] = glitter * (1 + 0.9 * turn) + dark;
		lattice->rgb[1][n] = glitter + dark;
		lattice->rgb[2][n] = glitter * (1 - 0.9 * turn) + dark;
		if (smaller < 0.08715574274765817) /* cos 85 degrees */
			grey(lattice, n, -1);
	}
}

static void make_just_above_zero(struct lattice *lattice, unsigned variant, uint64_t seed)
{
	static const double values[] = {DBL_TRUE_MIN, DBL_MIN, FLT_MIN, 1e-38, 1e-20};
	(void)seed;
	for (size_t n = 0; n < lattice_cells(lattice->dims); n++)
		grey(lattice, n, values[variant] * (double)(1 + n % 3));
}

const struct stress_kind STRESS_KINDS[] = {
	{"plain", 1, make_plain},
	{"constant", 12, make_constant},
	{"bright-cell", 6, make_bright_cell},
	{"checkerboard", 4, make_checkerboard},
	{"delta-lobe", 4, make_delta_lobe},
	{"step", 6, make_step},
	{"one-valid", 3, make_one_valid},
	{"missing-slices", 6, make_missing_slices},
	{"random-validity", 3, make_random_validity},
	{"odd-channel", 4, make_odd_channel},
	{"anticorrelated", 2, make_anticorrelated},
	{"regression", 4, make_regression},
	{"nonfinite", 3, make_nonfinite},
	{"denormal", 3, make_denormal},
	{"noise", 3, make_noise},
	{"speckled-mirror", 3, make_speckled_mirror},
	{"just-above-zero", 5, make_just_above_zero},
};
const unsigned STRESS_KIND_COUNT = sizeof STRESS_KINDS / sizeof *STRESS_KINDS;

bp_status stress_case_make(const struct stress_kind *kind, unsigned variant, uint64_t seed, struct lattice_dims dims,
                           struct lattice *out, bp_error *error)
{
	bp_status status = lattice_alloc(dims, out, error);
	if (status)
		return status;
	kind->make(out, variant, seed);
	lattice_validate(out);
	return BP_OK;
}
