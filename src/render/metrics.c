#include "metrics.h"

#include <math.h>

bp_status metrics_psnr(const struct sphere_image *reference, const struct sphere_image *estimate, struct psnr *out,
                       bp_error *error)
{
	double exposure, sum = 0, sum_eight = 0;
	bp_status status = image_exposure(reference, &exposure, error);
	if (status != BP_OK)
		return status;
	size_t pixels = (size_t)reference->size * reference->size;
	for (size_t n = 0; n < pixels; n++) {
		if (!reference->covered[n])
			continue;
		for (size_t c = 0; c < 3; c++) {
			double a, b;
			image_pair(reference, estimate, 3 * n + c, exposure, image_srgb, &a, &b);
			double d = round(255 * a) - round(255 * b);
			sum += (a - b) * (a - b);
			sum_eight += d * d;
		}
	}
	double terms = 3 * (double)reference->covered_count;
	out->eight_bit = 10 * log10(255 * 255 / fmax(1e-6, sum_eight / terms));
	out->real = 10 * log10(1 / fmax(1e-12, sum / terms));
	return BP_OK;
}

void metrics_worst_cell(const struct lattice *truth, const struct expansion *table, struct worst_cell *out)
{
	const struct lattice_dims dims = truth->dims;
	size_t cells = lattice_cells(dims), worst = 0;
	double largest = 0;
	int channel = 0;
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < cells; n++) {
			if (!truth->valid[n])
				continue;
			double b = truth->rgb[c][n], relative = fabs(table->unit * table->rgb[c][n] - b) / (b + 1e-2);
			if (relative > largest || (relative == largest && relative > 0 && n < worst)) {
				largest = relative;
				worst = n;
				channel = c;
			}
		}
	uint32_t k = (uint32_t)(worst % dims.phi_d), j = (uint32_t)(worst / dims.phi_d % dims.theta_d);
	uint32_t i = (uint32_t)(worst / dims.phi_d / dims.theta_d);
	double root = (i + 0.5) / dims.theta_h;
	*out = (struct worst_cell){.value = largest,
	                           .i = i,
	                           .j = j,
	                           .k = k,
	                           .channel = channel,
	                           .theta_h = root * root * 90,
	                           .theta_d = 90 * (j + 0.5) / dims.theta_d,
	                           .phi_d = 180 * (k + 0.5) / dims.phi_d};
}
