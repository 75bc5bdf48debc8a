#include "lights.h"

#include <math.h>
#include <string.h>

static const char *const NAMES[LIGHTING_COUNT] = {"key", "env", "point"};

/* Golden angle in radians, to the digits that the figures were made with. */
static const double GOLDEN_ANGLE = 2.39996323;

static struct light light_directional(double x, double y, double z, double weight)
{
	double scale = 1 / sqrt(x * x + y * y + z * z);
	return (struct light){.at = {x * scale, y * scale, z * scale}, .weight = weight};
}

/* Direction `i` of `count` on the spherical Fibonacci lattice, descending in z. */
static struct light light_fibonacci(int i, int count)
{
	double z = 1 - 2 * (i + 0.5) / count, radius = sqrt(1 - z * z), phi = i * GOLDEN_ANGLE;
	return (struct light){.at = {radius * cos(phi), radius * sin(phi), z}};
}

static int lights_key(struct light *lights)
{
	enum { FILL = 24 };
	int count = 0;
	lights[count++] = light_directional(0.5, 0.6, 0.8, 3);
	lights[count++] = light_directional(-0.7, 0.2, 0.6, 1);
	lights[count++] = light_directional(0.1, -0.5, 0.7, 0.6);
	lights[count++] = light_directional(0.9, 0.1, -0.25, 1.5);
	lights[count++] = light_directional(-0.5, 0.8, -0.4, 1.5);
	for (int i = 0; i < FILL; i++) {
		lights[count] = light_fibonacci(i, FILL);
		lights[count++].weight = 0.15;
	}
	return count;
}

static int lights_env(struct light *lights)
{
	const struct light window = light_directional(-0.6, 0.5, 0.6, 0);
	const double solid_angle = 4 * M_PI / LIGHTS_MAX;
	for (int i = 0; i < LIGHTS_MAX; i++) {
		struct light light = light_fibonacci(i, LIGHTS_MAX);
		double towards = light.at[0] * window.at[0] + light.at[1] * window.at[1] + light.at[2] * window.at[2];
		double radiance = 0.3 + 0.7 * fmax(0, light.at[1]) + 4 * pow(fmax(0, towards), 40);
		light.weight = radiance * solid_angle;
		lights[i] = light;
	}
	return LIGHTS_MAX;
}

static int lights_point(struct light *lights)
{
	static const struct light POINTS[] = {
		{{1.8, 2.4, 3.0}, 40, true},
		{{-3.0, 0.8, 2.6}, 16, true},
		{{2.6, -1.2, -0.6}, 14, true},
		{{-1.4, 2.6, -1.0}, 14, true},
	};
	memcpy(lights, POINTS, sizeof POINTS);
	return (int)(sizeof POINTS / sizeof *POINTS);
}

int lights_make(enum lighting lighting, struct light *lights)
{
	switch (lighting) {
	case LIGHTING_KEY: return lights_key(lights);
	case LIGHTING_ENV: return lights_env(lights);
	case LIGHTING_POINT: return lights_point(lights);
	case LIGHTING_COUNT: break;
	}
	return 0;
}

const char *lighting_name(enum lighting lighting) { return NAMES[lighting]; }

bool lighting_find(const char *name, enum lighting *out)
{
	for (int i = 0; i < LIGHTING_COUNT; i++)
		if (!strcmp(name, NAMES[i])) {
			*out = (enum lighting)i;
			return true;
		}
	return false;
}
