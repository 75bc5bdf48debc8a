/*
 * lights.h: the fixed, noise-free lightings of the rendered sphere.
 *
 *   key    5 strong and 24 weak directional lights
 *   env    400 directions of a smooth sky, brighter upwards, with one window
 *   point  4 point lights: direct illumination only, as in the figures of Bilgili, Ozturk
 *          and Kurt (2012); the paper does not give its lights, so the positions are ours
 *
 * key and env are the lightings behind the project's published figures; a change of any
 * number in lights.c makes new figures incomparable with old ones.
 *
 * Axes: x right, y up, z towards the viewer; the sphere has radius 1 and its centre at 0.
 */
#ifndef RENDER_LIGHTS_H
#define RENDER_LIGHTS_H

#include <stdbool.h>

enum lighting { LIGHTING_KEY, LIGHTING_ENV, LIGHTING_POINT, LIGHTING_COUNT };
enum { LIGHTS_MAX = 400 };

struct light {
	double at[3];  /* directional: unit vector towards the light; point: its position, outside the sphere */
	double weight; /* directional: irradiance at normal incidence; point: intensity, divided by the squared distance */
	bool is_point;
};

/* Fills lights[LIGHTS_MAX] and returns how many there are. */
int lights_make(enum lighting lighting, struct light *lights);

/* Bit 1 << lighting of one lighting, or of all for LIGHTING_COUNT. */
static inline unsigned lightings_of(enum lighting lighting)
{
	return lighting < LIGHTING_COUNT ? 1u << lighting : (1u << LIGHTING_COUNT) - 1;
}

/* "key", "env" or "point". */
const char *lighting_name(enum lighting lighting);

/* The lighting of a name; false when there is none. */
bool lighting_find(const char *name, enum lighting *out);

#endif
