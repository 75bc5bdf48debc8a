/*
 * demo.h: the demo materials: analytic reflectance measured by an imaginary instrument, so that
 * everything can be tried without measured data. Part of the tool, not of the library.
 *
 * The parameters are the rows of manifests/demo.tsv. With ci, co the cosines of the two directions (at least 0.05),
 * h, d the half and the difference angle, and colour by channel, a material is
 *
 *     base = 28/(23 pi) diffuse (1 - S) (1 - (1 - ci/2)^5) (1 - (1 - co/2)^5)   Ashikhmin and Shirley 2000
 *          + share GGX(roughness) F(specular) + (1 - share) GGX(roughness2) F(specular2)
 *          + sheen (1 - cos d)^5                                                Burley 2012
 *          + retro / (4 pi w^2 (1 + (sin d/w)^2)^2)                             w = retro_width
 *     value = (1 - C(ci)) (1 - C(co)) base + GGX(coat_roughness) C(cos d)
 *
 * GGX(a) = D(h) V(ci, co), the distribution of Walter et al. 2007 with Heitz's height-correlated
 * masking (2014); F(s) = s + (1 - s) (1 - cos d)^5, Schlick 1994, C the same with coat; S is the
 * larger of the two lobes' mean colour. A film multiplies F by an interference term: a cosine of the path
 * difference at 650, 532, 450 nm. Where there is an edge both lobes end there: times 1/(1 + (sin theta_h/edge)^8); speckle makes
 * them glitter (demo_speckle.h): this is what measured mirrors and flakes of other databases have, colour that turns with the
 * angle, speckle, next to nothing off the lobe. All terms are reciprocal; what goes out is less than what came in.
 *
 * The instrument: streaks along phi_d, noise that grows beyond theta_d = 70 degrees, drop-outs beyond 80,
 * dark readings that come out negative, and the database's pattern of cells below the horizon; or no direction further than
 * `reach` from the normal, so that there are holes above the horizon. It measures at
 * cell centres, as the database's did (lattice.h).
 */
#ifndef MERL_DEMO_H
#define MERL_DEMO_H

#include "lattice.h"

size_t demo_count(void);

/* index < demo_count(); in the table's order. Static text. */
const char *demo_name(size_t index);

/*
 * Fills a new lattice of any legal dims; clean: without faults, but with the horizon. Negative
 * readings stay in the planes (at cells that are not valid), so that lattice_save_path writes what the
 * instrument gave. The same on every machine: only + - * / and sqrt, and an own generator
 * seeded by the name. The caller frees *out.
 */
bp_status demo_generate(size_t index, struct lattice_dims dims, bool clean, struct lattice *out, bp_error *error);

#endif
