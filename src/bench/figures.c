#include "figures.h"

bp_status figure_plans_make(struct lattice_dims dims, struct figure_plans *out, bp_error *error)
{
	bp_status status = BP_OK;

	*out = (struct figure_plans){{NULL}};
	for (int l = 0; l < LIGHTING_COUNT && !status; l++)
		status = sphere_plan_make((enum lighting)l, SPHERE_SIZE, 0, SPHERE_SIZE, dims, &out->plan[l], error);
	if (status)
		figure_plans_free(out);
	return status;
}

void figure_plans_free(struct figure_plans *plans)
{
	for (int l = 0; l < LIGHTING_COUNT; l++)
		sphere_plan_free(plans->plan[l]);
}

static bp_status render(const struct figure_plans *plans, const struct lookup_table *table, struct sphere_image *images,
                        bp_error *error)
{
	bp_status status;

	for (int l = 0; l < LIGHTING_COUNT; l++) {
		struct sphere_image *image = &images[l];
		if ((status = sphere_image_alloc(SPHERE_SIZE, image, error)))
			return status;
		sphere_plan_render(plans->plan[l], &table, 1, &image);
	}
	return BP_OK;
}

bp_status figure_reference_make(const struct figure_plans *plans, const struct lattice *lattice, struct figure_reference *out,
                                bp_error *error)
{
	struct lookup_table table = {0};
	bp_status status;

	*out = (struct figure_reference){.plans = plans, .lattice = lattice};
	if (!(status = lookup_table_measured(lattice, &table, error)))
		status = render(plans, &table, out->image, error);
	lookup_table_free(&table);
	if (status)
		figure_reference_free(out);
	return status;
}

void figure_reference_free(struct figure_reference *reference)
{
	for (int l = 0; l < LIGHTING_COUNT; l++)
		sphere_image_free(&reference->image[l]);
}

bp_status figures_measure(const struct figure_reference *reference, const struct expansion *estimate, struct figures *out,
                          bp_error *error)
{
	struct sphere_image image[LIGHTING_COUNT] = {{0}};
	struct lookup_table table = {0};
	bp_status status;

	if ((status = lookup_table_decoded(estimate, reference->lattice->valid, reference->image[0].unit, &table, error)) ||
	    (status = render(reference->plans, &table, image, error)))
		goto out;
	for (int l = 0; l < LIGHTING_COUNT; l++)
		if ((status = metrics_psnr(&reference->image[l], &image[l], &out->psnr[l], error)))
			goto out;
	status = fidelity_measure(reference->lattice, estimate, &out->fidelity, error);
out:
	for (int l = 0; l < LIGHTING_COUNT; l++)
		sphere_image_free(&image[l]);
	lookup_table_free(&table);
	return status;
}
