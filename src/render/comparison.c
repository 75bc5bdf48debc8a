#include "comparison.h"

#include <string.h>

#include "error.h"

bp_status comparison_plans_make(struct comparison_plans *plans, struct lattice_dims dims, bp_error *error)
{
	bp_status status = BP_OK;
	if (plans->energy && lattice_dims_equal(plans->dims, dims))
		return BP_OK;
	comparison_plans_free(plans);
	plans->dims = dims;
	for (int l = 0; status == BP_OK && l < LIGHTING_COUNT; l++)
		if (plans->lightings >> l & 1)
			status = sphere_plan_make((enum lighting)l, plans->size, 0, plans->size, dims, &plans->plans[l], error);
	if (status == BP_OK)
		status = sphere_image_alloc(plans->size, &plans->reference, error);
	if (status == BP_OK)
		status = sphere_image_alloc(plans->size, &plans->estimate, error);
	if (status == BP_OK)
		status = energy_plan_make(dims, &plans->energy, error);
	if (status != BP_OK)
		comparison_plans_free(plans);
	return status;
}

void comparison_plans_free(struct comparison_plans *plans)
{
	for (int l = 0; l < LIGHTING_COUNT; l++)
		sphere_plan_free(plans->plans[l]);
	energy_plan_free(plans->energy);
	sphere_image_free(&plans->reference);
	sphere_image_free(&plans->estimate);
	*plans = (struct comparison_plans){.lightings = plans->lightings, .size = plans->size};
}

bp_status comparison_dims_check(struct lattice_dims a, struct lattice_dims b, bp_error *error)
{
	return lattice_dims_equal(a, b) ? BP_OK
	                                : error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
	                                            "the measured lattice has %u x %u x %u cells, the decoded one %u x %u x %u",
	                                            a.theta_h, a.theta_d, a.phi_d, b.theta_h, b.theta_d, b.phi_d);
}

bp_status comparison_measure(struct comparison_plans *plans, const struct lattice *truth, const struct expansion *table,
                             struct comparison *out, struct picture *pictures, bp_error *error)
{
	struct lookup_table measured = {0}, decoded = {0};
	const struct lookup_table *const tables[2] = {&measured, &decoded};
	struct sphere_image *const images[2] = {&plans->reference, &plans->estimate};
	bp_status status = comparison_dims_check(truth->dims, table->dims, error);
	memset(out, 0, sizeof *out); /* padding too: rows travel between processes as bytes */
	if (!status && !truth->valid_count)
		status = error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "the reference has no valid cell");
	if (!status)
		status = comparison_plans_make(plans, truth->dims, error);
	if (!status)
		status = fidelity_measure(truth, table, 1, &out->fidelity, error);
	if (!status)
		status = lookup_table_measured(truth, &measured, error);
	if (!status)
		status = lookup_table_decoded(table, truth->valid, measured.unit, &decoded, error);
	if (!status) {
		metrics_worst_cell(truth, table, &out->worst);
		energy_measure(plans->energy, &measured, &out->measured);
		energy_measure(plans->energy, &decoded, &out->decoded);
	}
	for (int l = 0; !status && l < LIGHTING_COUNT; l++) {
		if (!plans->plans[l])
			continue;
		sphere_plan_render(plans->plans[l], tables, 2, images);
		status = metrics_psnr(images[0], images[1], &out->psnr[l], error);
		if (!status)
			status = itp_mean(images[0], images[1], &out->itp[l], error);
		if (!status && pictures)
			status = picture_compare(images[0], images[1], &pictures[l], error);
	}
	lookup_table_free(&measured);
	lookup_table_free(&decoded);
	return status;
}
