/*
 * albedo.h: the directional albedo, the integral of f cos theta_i dw_i for a given theta_o.
 *
 * By quadrature over the half-angle, 65,536 values of f: about a millisecond. An albedo_cache keeps what was
 * integrated at fixed angles, dense at both ends, and interpolates between them: each angle is integrated where
 * it is first needed, not at loading, which would take longer than the loading itself.
 */
#ifndef MODEL_SAMPLE_ALBEDO_H
#define MODEL_SAMPLE_ALBEDO_H

#include "model/table/table.h"

/* theta_o in radians in [0, pi/2); outside, and for NaN: 0. */
void albedo_integrate(const struct table *table, float theta_o, float rgb[3]);

struct albedo_cache; /* any number of threads may use it: what it gives does not depend on who asked before */

bp_status albedo_cache_make(struct albedo_cache **out, bp_error *error);
void albedo_cache_free(struct albedo_cache *cache); /* NULL is allowed */
size_t albedo_cache_bytes(void);

/*
 * The albedo at theta_o by a cubic through the four nearest angles of the cache; `table` must be the same in every call.
 * Against albedo_integrate the difference is below 1e-3 of the value (tests; of eight surrogates at most 5e-4).
 */
void albedo_cached(struct albedo_cache *cache, const struct table *table, float theta_o, float rgb[3]);

#endif
