/* Draws a sphere of one material under a sky with a sun: sphere ARCHIVE NAME OUT.ppm */
#include <brdfpack.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 160, SAMPLES = 64 };

static float uniform(void) { return (float)rand() / ((float)RAND_MAX + 1); }
static float dot(const float a[3], const float b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Radiance from direction d: brighter upwards, and a small sun. */
static float sky(const float d[3])
{
	const float sun[3] = {-0.6f, 0.5f, 0.62f};
	return 0.3f + 0.7f * fmaxf(0, d[1]) + 20 * powf(fmaxf(0, dot(d, sun)), 200);
}

/* Adds the light from the point with normal n towards the viewer, who looks along -z. */
static void shade(const bp_material *material, const float n[3], float rgb[3])
{
	float sign = n[2] >= 0 ? 1 : -1, a = -1 / (sign + n[2]), b = n[0] * n[1] * a; /* a frame around n (Duff et al. 2017) */
	float t[3] = {1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]}, s[3] = {b, sign + n[1] * n[1] * a, -n[1]};
	const float wo[3] = {t[2], s[2], n[2]}; /* (0, 0, 1) in that frame */
	for (int k = 0; k < SAMPLES; k++) {
		float u[3] = {uniform(), uniform(), uniform()}, wi[3], f[3], world[3];
		float pdf = bp_material_sample(material, wo, u, wi);
		if (pdf <= 0)
			continue;
		bp_material_evaluate(material, wi, wo, f);
		for (int c = 0; c < 3; c++)
			world[c] = wi[0] * t[c] + wi[1] * s[c] + wi[2] * n[c];
		for (int c = 0; c < 3; c++)
			rgb[c] += f[c] * wi[2] * sky(world) / (pdf * SAMPLES);
	}
}

int main(int argc, char **argv)
{
	bp_load_options options = {.struct_bytes = sizeof options, .form = BP_FORM_COMPACT, .sampling = 1};
	bp_archive *archive = NULL;
	bp_material *material = NULL;
	bp_error error = {0};
	uint64_t index;
	FILE *out = argc == 4 ? fopen(argv[3], "wb") : NULL;
	if (!out || bp_archive_open(argv[1], &archive, &error) || bp_archive_find(archive, argv[2], &index, &error) ||
	    bp_material_load(archive, index, &options, &material, &error))
		return fprintf(stderr, "sphere: %s\n", out ? error.message : "usage: sphere ARCHIVE NAME OUT.ppm"), 1;
	fprintf(out, "P6 %d %d 255\n", SIZE, SIZE);
	for (int p = 0; p < SIZE * SIZE; p++) {
		const float column = (float)(p % SIZE) + 0.5f, row = (float)(p / SIZE) + 0.5f;
		float x = column / SIZE * 2 - 1, y = 1 - row / SIZE * 2, rgb[3] = {0}, rest = 1 - x * x - y * y;
		if (rest > 0)
			shade(material, (const float[]){x, y, sqrtf(rest)}, rgb);
		for (int c = 0; c < 3; c++)
			putc((int)(255 * powf(fminf(1, rgb[c] * 2), 1 / 2.2f) + 0.5f), out);
	}
	bp_material_free(material);
	bp_archive_close(archive); /* could as well have been closed after loading */
	return fclose(out) ? 1 : 0;
}
