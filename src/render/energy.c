#include "energy.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"

enum { THETA_STEPS = 180, PHI_STEPS = 90, PLACES_MAX = THETA_STEPS * PHI_STEPS };

struct energy_plan {
	size_t first[ENERGY_DIRECTIONS + 1]; /* places of direction n: first[n] .. first[n + 1] - 1 */
	struct place places[ENERGY_DIRECTIONS * PLACES_MAX];
};

/*
 * Half vectors h = (sin theta_h cos phi, sin theta_h sin phi, cos theta_h) seen from o = (sin theta_o, 0, cos theta_o);
 * i = 2 (o.h) h - o. phi_d as in sphere.c with the view o and n = z:
 *
 *     tan phi_d = i.(n x h) / (i.(h cos theta_h - n)) = sin theta_o h_y / (cos theta_d cos theta_h - cos theta_i)
 */
static size_t plan_direction(const struct angle_tables *angles, struct lattice_dims dims, double theta_o, struct place *places)
{
	double sin_o = sin(theta_o), cos_o = cos(theta_o), du = 1.0 / THETA_STEPS, dphi = M_PI / PHI_STEPS;
	size_t count = 0;
	for (int s = 0; s < THETA_STEPS; s++) {
		double u = (s + 0.5) * du, theta_h = u * u * M_PI_2, sin_h = sin(theta_h), cos_h = cos(theta_h);
		double solid_angle = 2 * sin_h * M_PI * u * du * dphi; /* d theta_h = pi u du; both halves of phi_h */
		for (int t = 0; t < PHI_STEPS; t++) {
			double phi = (t + 0.5) * dphi, cos_d = sin_o * sin_h * cos(phi) + cos_o * cos_h, cos_i = 2 * cos_d * cos_h - cos_o;
			if (cos_d <= 0 || cos_i <= 0)
				continue;
			double y = sin_o * sin_h * sin(phi), x = cos_d * cos_h - cos_i;
			places[count++] = place_make(angles, dims, cos_h, cos_d, y, x, 4 * cos_d * cos_i * solid_angle);
		}
	}
	return count;
}

bp_status energy_plan_make(struct lattice_dims dims, struct energy_plan **out, bp_error *error)
{
	struct energy_plan *plan = malloc(sizeof *plan);
	struct angle_tables *angles = angle_tables_make();
	if (!plan || !angles) {
		free(angles);
		free(plan);
		return error_memory(error, sizeof *plan);
	}
	plan->first[0] = 0;
	for (int n = 0; n < ENERGY_DIRECTIONS; n++) {
		double theta_o = n * ENERGY_STEP_DEGREES * M_PI / 180;
		plan->first[n + 1] = plan->first[n] + plan_direction(angles, dims, theta_o, plan->places + plan->first[n]);
	}
	free(angles);
	*out = plan;
	return BP_OK;
}

void energy_measure(const struct energy_plan *plan, const struct lookup_table *table, struct energy *out)
{
	*out = (struct energy){.largest = 0};
	for (int n = 0; n < ENERGY_DIRECTIONS; n++) {
		double sum[3] = {0, 0, 0};
		for (size_t p = plan->first[n]; p < plan->first[n + 1]; p++) {
			float4 value = place_look_up(&plan->places[p], table);
			for (int c = 0; c < 3; c++)
				sum[c] += (double)value[c];
		}
		for (int c = 0; c < 3; c++) {
			out->albedo[n][c] = sum[c] * table->unit;
			if (out->albedo[n][c] > out->largest) {
				out->largest = out->albedo[n][c];
				out->theta_o = n * ENERGY_STEP_DEGREES;
				out->channel = c;
			}
		}
	}
}
