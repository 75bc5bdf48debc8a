/*
 * packed_fixture.h: a small glossy lattice.
 */
#ifndef PACKED_FIXTURE_H
#define PACKED_FIXTURE_H

#include "codec/record.h"

/* Every cell valid: a diffuse part, and a lobe that depends on all three angles; unit times as bright. The caller frees it. */
static void glossy_lattice_make(struct lattice_dims dims, double unit, struct lattice *out)
{
	assert_int_equal(lattice_alloc(dims, out, NULL), BP_OK);
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++)
			for (uint32_t k = 0; k < dims.phi_d; k++)
				for (int c = 0; c < 3; c++)
					out->rgb[c][lattice_index(dims, i, j, k)] =
						unit *
						(0.1 * (c + 1) + 3 * exp(-0.02 * i * i) * (1 + 0.01 * j * cos(2 * M_PI * k / dims.phi_d) + 0.02 * c * j));
	lattice_validate(out);
}

#endif
