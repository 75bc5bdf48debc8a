/*
 * figures.h: the error figures of one decoded table against the measured one: PSNR of the rendered sphere
 * under each lighting (render/metrics.h) and the figures over cells (model/fidelity.h).
 */
#ifndef BENCH_FIGURES_H
#define BENCH_FIGURES_H

#include "model/fidelity.h"
#include "render/metrics.h"

struct figures {
	struct psnr psnr[LIGHTING_COUNT];
	struct fidelity fidelity;
};

/* What does not depend on the estimate: made once for all materials of one lattice, and again per material. */
struct figure_plans {
	struct sphere_plan *plan[LIGHTING_COUNT];
};
bp_status figure_plans_make(struct lattice_dims dims, struct figure_plans *out, bp_error *error);
void figure_plans_free(struct figure_plans *plans);

struct figure_reference {
	const struct figure_plans *plans;
	const struct lattice *lattice;
	struct sphere_image image[LIGHTING_COUNT];
};
bp_status figure_reference_make(const struct figure_plans *plans, const struct lattice *lattice, struct figure_reference *out,
                                bp_error *error);
void figure_reference_free(struct figure_reference *reference);

bp_status figures_measure(const struct figure_reference *reference, const struct expansion *table, struct figures *out,
                          bp_error *error);

#endif
