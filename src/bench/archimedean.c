#include "archimedean.h"

#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "angles.h"
#include "baseline.h"

static const double EDGE = 1e-6; /* a single evaluation keeps this far from the corners */

void archimedean_accumulate(struct lattice_dims dims, struct archimedean_channel *channel)
{
	for (int axis = 0; axis < 3; axis++) {
		const uint32_t extent = archimedean_extent(dims, axis);
		double *edge = channel->edge[axis];
		edge[0] = 0;
		for (uint32_t n = 0; n < extent; n++)
			edge[n + 1] = edge[n] + (double)channel->marginal[axis][n];
		for (uint32_t n = 1; n <= extent; n++)
			edge[n] = edge[extent] > 0 && n < extent ? edge[n] / edge[extent] : (double)n / extent; /* black: anything will do */
	}
}

/* F or 1 - F. */
static double turn(const struct archimedean_channel *channel, int axis, double f)
{
	return channel->turned >> axis & 1 ? 1 - f : f;
}

double archimedean_edges(struct lattice_dims dims, const struct archimedean_channel *channel, double alpha,
                         struct copula_edge *room, const struct copula_edge *out[3])
{
	double sign = 1;

	for (int axis = 0; axis < 3; axis++) {
		const uint32_t extent = archimedean_extent(dims, axis);
		out[axis] = room;
		for (uint32_t n = 0; n <= extent; n++)
			*room++ = copula_edge(channel->family, alpha, turn(channel, axis, channel->edge[axis][n]));
		sign = channel->turned >> axis & 1 ? -sign : sign;
	}
	return sign;
}

static double finite_or_zero(double x) { return isfinite(x) ? x : 0; }

/* C at all corners of one edge of theta_h: D + 1 rows of P + 1. */
static void corners_fill(struct lattice_dims dims, const struct copula *copula, const struct copula_edge *const edges[3],
                         uint32_t i, double *out)
{
	for (uint32_t j = 0; j <= dims.theta_d; j++)
		for (uint32_t k = 0; k <= dims.phi_d; k++)
			*out++ = copula_value(copula, edges[0][i], edges[1][j], edges[2][k]);
}

/* Cells share corners, so the eight of each are looked up in the two layers around it: low and high. */
static void channel_expand(struct lattice_dims dims, const struct archimedean_channel *channel, struct copula_edge *room,
                           double *low, double *high, float *out)
{
	const struct copula copula = copula_make(channel->family, (double)channel->alpha);
	const struct copula_edge *edges[3];
	const double sign = archimedean_edges(dims, channel, (double)channel->alpha, room, edges);
	const double scale = sign * (double)channel->scale * (double)lattice_cells(dims);
	const size_t row = (size_t)dims.phi_d + 1;

	corners_fill(dims, &copula, edges, 0, low);
	for (uint32_t i = 0; i < dims.theta_h; i++) {
		corners_fill(dims, &copula, edges, i + 1, high);
		for (uint32_t j = 0; j < dims.theta_d; j++) {
			const double *a = low + j * row, *b = high + j * row;
			for (uint32_t k = 0; k < dims.phi_d; k++) {
				const double near = (b[k] - a[k]) - (b[k + row] - a[k + row]);
				const double far = (b[k + 1] - a[k + 1]) - (b[k + 1 + row] - a[k + 1 + row]);
				*out++ = channel->diffuse + (float)finite_or_zero(fmax(0, scale * (near - far)));
			}
		}
		double *swap = low;
		low = high;
		high = swap;
	}
}

static bp_status archimedean_expand(const void *opaque, struct expansion *out, bp_error *error)
{
	const struct archimedean_state *state = opaque;
	const size_t layer = ((size_t)state->dims.theta_d + 1) * (state->dims.phi_d + 1);
	struct copula_edge *room = malloc(ARCHIMEDEAN_EDGES_MAX * sizeof *room);
	double *corners = malloc(2 * layer * sizeof *corners);
	bp_status status = BP_OK;

	if (!room || !corners)
		status = error_memory(error, ARCHIMEDEAN_EDGES_MAX * sizeof *room + 2 * layer * sizeof *corners);
	out->unit = 1;
	for (int c = 0; !status && c < 3; c++)
		channel_expand(state->dims, &state->channel[c], room, corners, corners + layer, out->rgb[c]);
	free(room);
	free(corners);
	return status;
}

/* Marginals and the middles of their cells are interpolated linearly between centres, which phi_d too begins and ends with. */
static void archimedean_evaluate(const void *opaque, const double wi[3], const double wo[3], double rgb[3])
{
	const struct archimedean_state *state = opaque;
	double at[3];

	lattice_coordinates(state->dims, wi, wo, at);
	for (int c = 0; c < 3; c++) {
		const struct archimedean_channel *channel = &state->channel[c];
		double f = (double)channel->scale, u[3];
		for (int axis = 0; axis < 3; axis++) {
			const uint32_t extent = archimedean_extent(state->dims, axis);
			double x;
			uint32_t n = centre_before(at[axis], extent, &x), next = n + 1 < extent ? n + 1 : n;
			double f0 = (double)channel->marginal[axis][n], f1 = (double)channel->marginal[axis][next];
			const double *edge = channel->edge[axis];
			double low = (edge[n] + edge[n + 1]) / 2, high = (edge[next] + edge[next + 1]) / 2;
			f *= f0 + x * (f1 - f0);
			u[axis] = fmin(1 - EDGE, fmax(EDGE, turn(channel, axis, low + x * (high - low))));
		}
		if (f > 0)
			f *= archimedean_density(channel->family, (double)channel->alpha, u[0], u[1], u[2]);
		rgb[c] = (double)channel->diffuse + finite_or_zero(f);
	}
}

const struct baseline BASELINE_ARCHIMEDEAN = {
	.reference = "Ozturk et al. 2010, Frank or Clayton copula",
	.fit = archimedean_fit,
	.expand = archimedean_expand,
	.evaluate = archimedean_evaluate,
	.free_state = free,
};
