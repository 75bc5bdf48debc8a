#include "demo.h"

#include <math.h>
#include <stdlib.h>

#include "demo_speckle.h"
#include "error.h"

struct demo_material {
	const char *name;
	double diffuse[3];
	double specular[3], roughness, share, specular2[3], roughness2;
	double sheen[3], retro[3], retro_width;
	double coat, coat_roughness;
	double film; /* nm */
	double speckle, edge;
	double reach; /* degrees */
	double noise;
};

static const struct demo_material MATERIALS[] = {
#include "demo_table.inc"
};

static const double PI = 3.14159265358979323846;

/* Directions lower than this get its values, so also measured ones below the horizon: mirrors reach 1e5 /sr, as real ones do. */
static const double COSINE_MIN = 0.05;

size_t demo_count(void) { return sizeof MATERIALS / sizeof *MATERIALS; }

const char *demo_name(size_t index) { return MATERIALS[index].name; }

static double fifth_power(double x) { return x * x * x * x * x; }

/* Walter et al. 2007, eq. 33, alpha = roughness */
static double ggx_distribution(double roughness, double cos_h)
{
	const double a2 = roughness * roughness, s = cos_h * cos_h * (a2 - 1) + 1;
	return a2 / (PI * s * s);
}

/* Heitz 2014, eq. 99, divided by 4 ci co */
static double ggx_visibility(double roughness, double ci, double co)
{
	const double a2 = roughness * roughness;
	return 0.5 / (co * sqrt(ci * ci * (1 - a2) + a2) + ci * sqrt(co * co * (1 - a2) + a2));
}

static double schlick(double normal, double cosine) { return normal + (1 - normal) * fifth_power(1 - cosine); }

/* 1 where the two sides of a film of refractive index 1.5 add up, 0.1 where they cancel. */
static double film_factor(double thickness, double wavelength, double sin_d)
{
	const double path = 2 * thickness * sqrt(2.25 - sin_d * sin_d) / wavelength;                 /* in wavelengths */
	const double turn = path - (double)(long)path, quarter = 4 * (turn < 0.5 ? turn : 1 - turn); /* cos is even */
	double cosine, sine;
	quarter_cos_sin(quarter <= 1 ? quarter : 2 - quarter, &cosine, &sine);
	return 0.55 + 0.45 * (quarter <= 1 ? cosine : -cosine);
}

/* What depends on theta_h alone; angles are those of cell centres. */
struct half_terms {
	double cosine, sine;
	double lobe, lobe2, coat; /* distributions */
};

static struct half_terms half_terms(const struct demo_material *m, const struct lattice_cosines *centres, uint32_t i)
{
	struct half_terms t = {.cosine = centres->cos_h[i], .sine = centres->sin_h[i]};
	t.lobe = m->share * ggx_distribution(m->roughness, t.cosine);
	t.lobe2 = (1 - m->share) * ggx_distribution(m->roughness2, t.cosine);
	t.coat = ggx_distribution(m->coat_roughness, t.cosine);
	if (m->edge > 0) {
		const double x2 = t.sine * t.sine / (m->edge * m->edge), end = 1 / (1 + x2 * x2 * x2 * x2);
		t.lobe *= end;
		t.lobe2 *= end;
	}
	return t;
}

/* What depends on theta_d alone. */
struct difference_terms {
	double cosine, sine;
	double fresnel[3], fresnel2[3], coat;
	double added[3]; /* sheen and retroreflection */
};

static struct difference_terms difference_terms(const struct demo_material *m, const struct lattice_cosines *centres, uint32_t j)
{
	static const double WAVELENGTH[3] = {650, 532, 450};
	struct difference_terms t = {.cosine = centres->cos_d[j], .sine = centres->sin_d[j]};
	const double width2 = m->retro_width * m->retro_width, spread = 1 + t.sine * t.sine / width2;
	for (int c = 0; c < 3; c++) {
		const double film = m->film > 0 ? film_factor(m->film, WAVELENGTH[c], t.sine) : 1;
		t.fresnel[c] = film * schlick(m->specular[c], t.cosine);
		t.fresnel2[c] = film * schlick(m->specular2[c], t.cosine);
		t.added[c] = m->sheen[c] * fifth_power(1 - t.cosine) + m->retro[c] / (4 * PI * width2 * spread * spread);
	}
	t.coat = m->coat > 0 ? schlick(m->coat, t.cosine) : 0;
	return t;
}

static double mean(const double colour[3]) { return (colour[0] + colour[1] + colour[2]) / 3; }

static void material_evaluate(const struct demo_material *m, const struct half_terms *h, const struct difference_terms *d,
                              double cos_phi, const double glitter[3], double value[3])
{
	const double a = d->cosine * h->cosine, q = d->sine * cos_phi * h->sine;
	const double ci = a - q > COSINE_MIN ? a - q : COSINE_MIN, co = a + q > COSINE_MIN ? a + q : COSINE_MIN;
	const double below = mean(m->specular) > mean(m->specular2) ? mean(m->specular) : mean(m->specular2);
	const double matte = 28 / (23 * PI) * (1 - below) * (1 - fifth_power(1 - ci / 2)) * (1 - fifth_power(1 - co / 2));
	const double lobe = h->lobe * ggx_visibility(m->roughness, ci, co);
	const double lobe2 = m->share < 1 ? h->lobe2 * ggx_visibility(m->roughness2, ci, co) : 0;
	double through = 1, coat = 0;
	if (m->coat > 0) {
		through = (1 - schlick(m->coat, ci)) * (1 - schlick(m->coat, co));
		coat = h->coat * ggx_visibility(m->coat_roughness, ci, co) * d->coat;
	}
	for (int c = 0; c < 3; c++)
		value[c] = through * (m->diffuse[c] * matte + glitter[c] * (lobe * d->fresnel[c]) +
		                      glitter[c] * (lobe2 * d->fresnel2[c]) + d->added[c]) +
		           coat;
}

/* splitmix64 (Steele, Lea and Flood 2014) */
static uint64_t draw(uint64_t *state)
{
	uint64_t z = *state += 0x9E3779B97F4A7C15u;
	z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
	z = (z ^ z >> 27) * 0x94D049BB133111EBu;
	return z ^ z >> 31;
}

static double draw_uniform(uint64_t *state) { return (double)(draw(state) >> 11) * 0x1p-53; }

/* Mean 0, variance 1: the sum of the four 16-bit numbers of one draw. */
static double draw_bell(uint64_t *state)
{
	const uint64_t z = draw(state);
	const double sum = (double)((z & 0xFFFF) + (z >> 16 & 0xFFFF) + (z >> 32 & 0xFFFF) + (z >> 48));
	return (sum / 65536 - 2) * 1.7320508;
}

static uint64_t seed_of(const char *name)
{
	uint64_t hash = 0xCBF29CE484222325u; /* FNV-1a */
	for (; *name; name++)
		hash = (hash ^ (uint8_t)*name) * 0x100000001B3u;
	return hash;
}

/* The instrument's faults for one row of cells along phi_d. */
struct faults {
	double amount; /* 0: a clean table */
	uint64_t *state;
	double streak;  /* this row's */
	double grazing; /* growth of the noise at this theta_d */
	bool drops_out;
};

static void faults_start_row(struct faults *faults, double theta_d_share)
{
	const double beyond_70 = theta_d_share - 70.0 / 90;
	faults->grazing = faults->amount * (beyond_70 > 0 ? 1 + 18 * beyond_70 : 1); /* 5 times at 90 degrees */
	faults->streak = 0.01 * faults->amount * draw_bell(faults->state);
	faults->drops_out = theta_d_share > 80.0 / 90;
}

/* False for a drop-out. */
static bool faults_apply(struct faults *faults, double value[3])
{
	if (faults->drops_out && draw_uniform(faults->state) < 0.01)
		return false;
	const double common = faults->streak + 0.015 * faults->grazing * draw_bell(faults->state);
	for (int c = 0; c < 3; c++) {
		const double x = common + 0.01 * faults->grazing * draw_bell(faults->state);
		value[c] *= 1 + x + x * x / 2; /* exp(x) for the few percent that occur, and positive for all */
		if (value[c] < 1e-4 && draw_uniform(faults->state) < 0.2)
			value[c] = -value[c];
	}
	return true;
}

/* Cells beyond what the imaginary instrument reaches. */
static void out_of_reach(const struct demo_material *m, struct lattice_dims dims, uint8_t *cells)
{
	double cosine, sine;
	quarter_cos_sin(m->reach / 90, &cosine, &sine);
	if (m->reach < 90)
		lattice_centre_below(dims, cosine, cells);
	else
		lattice_below_horizon(dims, LATTICE_MERL_HORIZON, cells);
}

bp_status demo_generate(size_t index, struct lattice_dims dims, bool clean, struct lattice *out, bp_error *error)
{
	if (index >= demo_count())
		return error_argument(error, "demo material %zu: there are %zu", index, demo_count());
	const struct demo_material *m = &MATERIALS[index];
	struct lattice lattice;
	bp_status status = lattice_alloc(dims, &lattice, error);
	if (status != BP_OK)
		return status;
	out_of_reach(m, dims, lattice.valid);
	uint64_t state = seed_of(m->name);
	struct speckle *speckle = m->speckle > 0 ? speckle_create(m->speckle, draw_uniform, &state) : NULL;
	if (m->speckle > 0 && !speckle) {
		lattice_free(&lattice);
		return error_memory(error, 0);
	}
	struct faults faults = {.amount = clean ? 0 : m->noise, .state = &state};
	struct lattice_cosines centres;
	lattice_centres(dims, &centres);
	size_t n = 0;
	for (uint32_t i = 0; i < dims.theta_h; i++) {
		const struct half_terms h = half_terms(m, &centres, i);
		for (uint32_t j = 0; j < dims.theta_d; j++) {
			const struct difference_terms d = difference_terms(m, &centres, j);
			faults_start_row(&faults, (j + 0.5) / dims.theta_d);
			for (uint32_t k = 0; k < dims.phi_d; k++, n++) {
				double value[3], glitter[3] = {1, 1, 1};
				bool read = !lattice.valid[n]; /* so far: out of reach */
				if (read) {
					if (speckle)
						speckle_factor(speckle, (i + 0.5) / dims.theta_h, (j + 0.5) / dims.theta_d, (k + 0.5) / dims.phi_d,
						               glitter);
					material_evaluate(m, &h, &d, centres.cos_p[k], glitter, value);
					read = faults.amount <= 0 || faults_apply(&faults, value);
				}
				lattice.valid[n] = read && value[0] >= 0 && value[1] >= 0 && value[2] >= 0;
				lattice.valid_count += lattice.valid[n];
				for (int c = 0; c < 3; c++)
					lattice.rgb[c][n] = read ? value[c] : -MERL_SCALE[c];
			}
		}
	}
	free(speckle);
	*out = lattice;
	return BP_OK;
}
