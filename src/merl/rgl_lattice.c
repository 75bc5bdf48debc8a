#include "rgl_lattice.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "error.h"

#define PI 3.14159265358979323846
#define COSINE_LEAST 1e-3 /* of a part of a cell whose centre is measured */
#define STRAIGHT 0.1      /* of a value at a cell's edge */
enum { PROBED = 6 };      /* values of theta_d at which that is looked at */

/* A half angle on the lattice's axis, 0 to 1, and two directions around it: d = (theta_d, phi_d) turned by theta_h. */
struct pair {
	double theta_m, theta[2], phi[2], cosine[2]; /* of wi, wo; phi counts from the half vector's azimuth */
};

/* A quarter turn's parts, 0 to 1, as cosine and sine. */
struct angle {
	double cosine, sine;
};

static struct angle angle_of(double quarter)
{
	struct angle angle;
	quarter_cos_sin(quarter, &angle.cosine, &angle.sine);
	return angle;
}

static void pair_make(double axis, struct angle d, struct angle p, struct pair *pair)
{
	const struct angle h = angle_of(axis * axis);
	const double x = d.sine * p.cosine, y = d.sine * p.sine;
	pair->theta_m = axis * axis * (PI / 2);
	pair->cosine[0] = h.cosine * d.cosine - h.sine * x;
	pair->cosine[1] = h.cosine * d.cosine + h.sine * x;
	pair->phi[0] = atan2(y, h.cosine * x + h.sine * d.cosine);
	pair->phi[1] = atan2(-y, -h.cosine * x + h.sine * d.cosine);
	for (int n = 0; n < 2; n++)
		pair->theta[n] = acos(fmax(fmin(pair->cosine[n], 1), -1));
}

/* The cell with pi - phi_d: both directions change places and sides. */
static struct pair pair_mirrored(const struct pair *pair)
{
	return (struct pair){.theta_m = pair->theta_m,
	                     .theta = {pair->theta[1], pair->theta[0]},
	                     .phi = {-pair->phi[1], -pair->phi[0]},
	                     .cosine = {pair->cosine[1], pair->cosine[0]}};
}

/* Both directions of one cell, summed over its parts. */
struct cell {
	struct rgl_value way[2];
};

static void cell_add(const struct rgl_material *material, const struct pair *pair, double weight, struct cell *cell)
{
	for (int n = 0; n < 2; n++) {
		struct rgl_value value;
		rgl_evaluate(material, pair->theta[n], pair->phi[n], pair->theta_m, fmax(pair->cosine[1 - n], COSINE_LEAST), &value);
		for (int c = 0; c < 3; c++)
			cell->way[n].rgb[c] += weight * value.rgb[c];
		cell->way[n].data += weight * value.data;
	}
}

struct filling {
	const struct rgl_material *material;
	struct lattice *lattice;
	struct reciprocity *reciprocity;
	double cosine_least;
	uint32_t parts; /* of the cells of this theta_h */
};

static void cell_store(struct filling *filling, size_t index, const struct cell *cell)
{
	struct lattice *lattice = filling->lattice;
	const struct rgl_value *a = &cell->way[0], *b = &cell->way[1];
	bool valid = a->data > 0.5 && b->data > 0.5;
	for (int c = 0; c < 3; c++)
		valid = valid && a->rgb[c] <= DBL_MAX / 8 && b->rgb[c] <= DBL_MAX / 8; /* false for NaN too */
	for (int c = 0; c < 3; c++)
		lattice->rgb[c][index] = valid ? 0.5 * (a->rgb[c] + b->rgb[c]) : 0;
	lattice->valid[index] = valid;
	lattice->valid_count += valid;
	if (valid)
		reciprocity_add(filling->reciprocity, a->rgb[0] + a->rgb[1] + a->rgb[2], b->rgb[0] + b->rgb[1] + b->rgb[2]);
}

/* The cell (i, j, k), k below P/2, and its mirror image (i, j, P - 1 - k), which has the same angles. */
static void cells_fill(struct filling *filling, uint32_t i, uint32_t j, uint32_t k, struct angle d, struct angle p)
{
	const struct lattice_dims dims = filling->lattice->dims;
	const size_t index = lattice_index(dims, i, j, k), mirror = lattice_index(dims, i, j, dims.phi_d - 1 - k);
	struct pair pair;
	pair_make((i + 0.5) / dims.theta_h, d, p, &pair);
	if (fmin(pair.cosine[0], pair.cosine[1]) < filling->cosine_least) {
		for (int c = 0; c < 3; c++)
			filling->lattice->rgb[c][index] = filling->lattice->rgb[c][mirror] = 0;
		return;
	}
	struct cell cell = {0}, mirrored = {0};
	for (uint32_t part = 0; part < filling->parts; part++) {
		if (filling->parts > 1)
			pair_make((i + (part + 0.5) / filling->parts) / dims.theta_h, d, p, &pair);
		const struct pair other = pair_mirrored(&pair);
		cell_add(filling->material, &pair, 1.0 / filling->parts, &cell);
		cell_add(filling->material, &other, 1.0 / filling->parts, &mirrored);
	}
	cell_store(filling, index, &cell);
	cell_store(filling, mirror, &mirrored);
}

/* Both directions' values, summed, at a place of the lattice's axis; of theta_d, and phi_d = 90 degrees. */
static double level_at(const struct rgl_material *material, double axis, struct angle d)
{
	struct pair pair;
	struct cell cell = {0};
	pair_make(axis, d, angle_of(1), &pair);
	cell_add(material, &pair, 1, &cell);
	return cell.way[0].rgb[0] + cell.way[0].rgb[1] + cell.way[0].rgb[2] + cell.way[1].rgb[0] + cell.way[1].rgb[1] +
	       cell.way[1].rgb[2];
}

/*
 * Whether the lattice resolves the function here: at the cell's edges it is what a reader of the table interpolates between the
 * cells' centres. Then a centre's value is the better one, since a mean over the cell would make the lobe wider.
 */
static bool centres_suffice(const struct rgl_material *material, uint32_t i, uint32_t extent)
{
	for (int j = 0; j < PROBED; j++) {
		const struct angle d = angle_of((j + 0.5) / PROBED);
		const double centre = level_at(material, (i + 0.5) / extent, d);
		for (int side = -1; side <= 1; side += 2) {
			const double next = i + 0.5 + side, at = i + 0.5 + 0.5 * side;
			if (next > extent)
				continue;
			const double edge = level_at(material, at / extent, d);
			const double straight = 0.5 * (centre + level_at(material, fabs(next) / extent, d));
			if (!(fabs(edge - straight) <= STRAIGHT * edge))
				return false;
		}
	}
	return true;
}

/* As many parts as the material has samples within the cell, at the incidence where there are most; one where centres suffice. */
static uint32_t parts_of(const struct rgl_material *material, uint32_t i, uint32_t extent)
{
	const double from = (double)i / extent, to = (i + 1.0) / extent;
	double most = 1;
	for (size_t angle = 0; angle < material->angles; angle++)
		most = fmax(most, rgl_samples_between(material, angle, from * from * (PI / 2), to * to * (PI / 2)));
	return most > 1 && centres_suffice(material, i, extent) ? 1 : (uint32_t)fmin(ceil(most), RGL_PARTS_MOST);
}

bp_status rgl_lattice_make(const struct rgl_material *material, struct lattice *out, struct origin *origin, bp_error *error)
{
	const struct lattice_dims dims = LATTICE_MERL;
	struct lattice lattice = {0};
	struct reciprocity *reciprocity = calloc(1, sizeof *reciprocity);
	struct angle *p = malloc(dims.phi_d / 2 * sizeof *p);
	bp_status status = reciprocity && p ? lattice_alloc(dims, &lattice, error) : error_memory(error, sizeof *reciprocity);
	if (status)
		goto out;
	for (uint32_t k = 0; k < dims.phi_d / 2; k++)
		p[k] = angle_of((k + 0.5) / (dims.phi_d / 2.0));
	const double last = fmin(material->theta_i[material->angles - 1], (material->measured ? RGL_ANGLE_MOST : 90) * (PI / 180));
	struct filling filling = {.material = material, .lattice = &lattice, .reciprocity = reciprocity, .cosine_least = cos(last)};
	for (uint32_t i = 0; i < dims.theta_h; i++) {
		filling.parts = parts_of(material, i, dims.theta_h);
		for (uint32_t j = 0; j < dims.theta_d; j++) {
			const struct angle d = angle_of((j + 0.5) / dims.theta_d);
			for (uint32_t k = 0; k < dims.phi_d / 2; k++)
				cells_fill(&filling, i, j, k, d, p[k]);
		}
	}
	*origin = (struct origin){.kind = material->wavelengths ? ORIGIN_RGL_SPECTRA : ORIGIN_RGL_RGB,
	                          .wavelengths = material->wavelengths,
	                          .first_nm = material->first,
	                          .last_nm = material->last};
	reciprocity_tell(reciprocity, origin);
	*out = lattice;
out:
	free(reciprocity);
	free(p);
	return status;
}
