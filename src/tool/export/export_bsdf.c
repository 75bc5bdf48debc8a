#include "export.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "error.h"
#include "warped.h"
#include "tensor_writer.h"
#include "upsampling.h"

enum { DESCRIPTION_BYTES = BP_NAME_BYTES_MAX + 128, FIELDS_MAX = 12 };

/* Samples along s and t, from file to file some 1.4 times as many bytes. */
static const uint32_t SIZES[] = {12, 16, 20, 24, 28, 32, 40, 48, 56, 64, 72, 80, 96, 112, 128, 160, 192, 224, 256};
enum { SIZE_COUNT = sizeof SIZES / sizeof *SIZES };

/* The other axes follow: more samples pay where visible normals and angles of incidence are known as well. */
static struct warped_shape shape_of(uint32_t size)
{
	return (struct warped_shape){.angles = 6 + size / 3, .width = 16 + size / 2, .height = 13 + size / 3, .size = size};
}

/* What a file holds beside the fields' own arrays. */
struct parts {
	const uint32_t version[2], phi_i; /* 1.0; one azimuth, 0, as the bits of a float */
	uint8_t jacobian;
	char description[DESCRIPTION_BYTES];
	float ndf[2][WARPED_NORMALS], sigma[2][WARPED_NORMALS]; /* the two rows of an isotropic file are equal */
	float *spectra;                                         /* NULL: the file has rgb */
};

/* The tensors of a file; `fields` may lack its arrays where only the bytes are asked for. Returns how many there are. */
static size_t tensors_list(const struct warped *warped, const struct parts *parts, bool spectral, uint64_t description_bytes,
                           struct tensor *tensor)
{
	const struct warped_shape *shape = &warped->shape;
	const uint64_t angles = shape->angles, size = shape->size;
	const struct tensor list[] = {
		{"version", TENSOR_U32, 1, {2}, parts->version},
		{"description", TENSOR_U8, 1, {description_bytes}, parts->description},
		{"phi_i", TENSOR_F32, 1, {1}, &parts->phi_i},
		{"theta_i", TENSOR_F32, 1, {angles}, warped->theta_i},
		{"ndf", TENSOR_F32, 2, {2, WARPED_NORMALS}, parts->ndf},
		{"sigma", TENSOR_F32, 2, {2, WARPED_NORMALS}, parts->sigma},
		{"vndf", TENSOR_F32, 4, {1, angles, shape->height, shape->width}, warped->visible.density},
		{"luminance", TENSOR_F32, 4, {1, angles, size, size}, warped->luminance},
		{"jacobian", TENSOR_U8, 1, {1}, &parts->jacobian},
	};
	size_t count = sizeof list / sizeof *list;
	for (size_t n = 0; n < count; n++)
		tensor[n] = list[n];
	if (spectral) {
		tensor[count++] = (struct tensor){"wavelengths", TENSOR_F32, 1, {UPSAMPLING_COUNT}, UPSAMPLING_WAVELENGTHS};
		tensor[count++] = (struct tensor){"spectra", TENSOR_F32, 5, {1, angles, UPSAMPLING_COUNT, size, size}, parts->spectra};
	} else {
		tensor[count++] = (struct tensor){"rgb", TENSOR_F32, 5, {1, angles, 3, size, size}, warped->rgb};
	}
	return count;
}

static uint64_t bytes_of(uint32_t size, bool spectral)
{
	const struct warped warped = {.shape = shape_of(size)};
	const struct parts parts = {0};
	struct tensor tensor[FIELDS_MAX];
	return tensor_file_bytes(tensor, tensors_list(&warped, &parts, spectral, DESCRIPTION_BYTES, tensor));
}

uint64_t export_bsdf_least(bool spectral) { return bytes_of(SIZES[0], spectral); }

static void evaluate(const void *exported, const float wi[3], const float wo[3], double rgb[3])
{
	warped_evaluate(exported, wi, wo, rgb);
}

/* Where samples may lie, and the size at which it is tried. */
static const struct visible_mix MIXES[] = {{0.3, 0.05}, {0.6, 0.05}, {0.97, 0.01}};
enum { MIX_COUNT = sizeof MIXES / sizeof *MIXES, MIX_TRIED_AT = 32 };

struct choice {
	const struct reflectance *reflectance;
	const struct export_options *options;
	struct deviation_reference *reference;
};

static bool fits(const struct choice *choice, uint32_t size)
{
	return bytes_of(size, choice->options->spectral) <= choice->options->most_bytes;
}

/* One shape's fields, and how near they come. warped_free *out in any case. */
static bp_status warped_try(const struct choice *choice, uint32_t size, struct visible_mix mix, struct warped *out,
                            struct deviation *deviation, bp_error *error)
{
	struct warped_shape shape = shape_of(size);
	shape.mix = mix;
	bp_status status = warped_make(choice->reflectance, &shape, out, error);
	return status ? status : deviation_measure(choice->reference, evaluate, out, deviation, error);
}

/* The mix that is best at a middle size: which one that is, depends on the lobe, little on the size. */
static bp_status mix_choose(const struct choice *choice, struct visible_mix *out, bp_error *error)
{
	struct deviation best = DEVIATION_WORST;
	*out = MIXES[0];
	uint32_t size = MIX_TRIED_AT;
	while (size > SIZES[0] && !fits(choice, size))
		size -= 4;
	bp_status status = BP_OK;
	for (int n = 0; !status && n < MIX_COUNT; n++) {
		struct warped warped = {0};
		struct deviation reached = DEVIATION_WORST;
		status = warped_try(choice, size, MIXES[n], &warped, &reached, error);
		warped_free(&warped);
		if (reached.psnr > best.psnr) {
			best = reached;
			*out = MIXES[n];
		}
	}
	return status;
}

/* The smallest of the shapes that reaches the figure and fits; else the best that fits. warped_free *out in any case. */
static bp_status warped_choose(const struct choice *choice, struct warped *out, struct deviation *deviation, bp_error *error)
{
	struct visible_mix mix;
	bp_status status = mix_choose(choice, &mix, error);
	*deviation = DEVIATION_WORST;
	for (int n = 0; !status && n < SIZE_COUNT && !deviation_suffices(deviation) && fits(choice, SIZES[n]); n++) {
		struct warped warped = {0};
		struct deviation reached = DEVIATION_WORST;
		status = warped_try(choice, SIZES[n], mix, &warped, &reached, error);
		if (!status && reached.psnr > deviation->psnr) {
			*deviation = reached;
			warped_free(out);
			*out = warped;
		} else {
			warped_free(&warped);
		}
	}
	return status;
}

bp_status export_bsdf(const struct reflectance *reflectance, const char *name, const struct export_options *options,
                      struct byte_buffer *out, struct deviation *deviation, bp_error *error)
{
	struct parts parts = {.version = {1, 0}, .jacobian = 1};
	struct warped warped = {0};
	struct tensor tensor[FIELDS_MAX];
	struct choice choice = {.reflectance = reflectance, .options = options};
	bp_status status = deviation_reference_make(reflectance, &choice.reference, error);
	if (!status)
		status = warped_choose(&choice, &warped, deviation, error);
	deviation_reference_free(choice.reference);
	const size_t points = (size_t)warped.shape.size * warped.shape.size;
	if (!status && options->spectral) {
		const size_t count = points * warped.shape.angles * UPSAMPLING_COUNT;
		parts.spectra = malloc(count * sizeof *parts.spectra);
		if (parts.spectra)
			upsample(warped.rgb, warped.shape.angles, points, parts.spectra);
		else
			status = error_memory(error, count * sizeof *parts.spectra);
	}
	if (!status) {
		for (uint32_t n = 0; n < 2 * WARPED_NORMALS; n++) {
			parts.ndf[n / WARPED_NORMALS][n % WARPED_NORMALS] = (float)warped.normals.density[n % WARPED_NORMALS];
			parts.sigma[n / WARPED_NORMALS][n % WARPED_NORMALS] = (float)warped.normals.area[n % WARPED_NORMALS];
		}
		const int length = snprintf(parts.description, sizeof parts.description,
		                            "%s; by brdfpack %s, %.1f dB from its record (spheres under point and key lights)", name,
		                            bp_version_text(), deviation->psnr);
		tensor_file_write(tensor, tensors_list(&warped, &parts, options->spectral, (uint64_t)length, tensor), out);
		if (out->failed)
			status = error_memory(error, out->count);
	}
	free(parts.spectra);
	warped_free(&warped);
	return status;
}
