#include "rgl_material.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "colour.h"
#include "error.h"

/* Beyond any file that was published, and so that a hostile one takes no longer than some seconds. */
enum { ANGLES_MAX = 256, SIDE_MAX = 2048, WAVELENGTHS_MAX = 4096, WAVELENGTHS_MIN = 3 };
#define ANGLE_MOST 1.6 /* radians: the files' last angle is a quarter turn, more or less rounded */

/* What is wrong with a field, at the place of its array. */
#define refuse(error, field, format, ...) \
	error_set(error, BP_ERROR_BAD_INPUT, (field)->offset, "field %s: " format, (field)->name, __VA_ARGS__)

static bp_status field_get(const struct tensor_table *table, const char *name, const struct tensor_field **out, bp_error *error)
{
	*out = tensor_field_find(table, name);
	return *out ? BP_OK
	            : error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
	                        "a tensor file, but not a material of the RGL database: no field %s", name);
}

/* A field of floats of this rank. */
static bp_status floats_get(const struct tensor_table *table, const char *name, uint32_t rank, const struct tensor_field **out,
                            bp_error *error)
{
	bp_status status = field_get(table, name, out, error);
	if (status)
		return status;
	if ((*out)->type < TENSOR_F16)
		return refuse(error, *out, "type %s, where floats are expected", tensor_type_name((*out)->type));
	if ((*out)->rank != rank)
		return refuse(error, *out, "rank %" PRIu32 ", expected %" PRIu32, (*out)->rank, rank);
	return BP_OK;
}

static bp_status sides_check(const struct tensor_field *field, bp_error *error)
{
	for (uint32_t n = field->rank - 2; n < field->rank; n++)
		if (field->shape[n] < 2 || field->shape[n] > SIDE_MAX)
			return refuse(error, field, "dimension %" PRIu32 " is %" PRIu64 "; 2 to %d are possible", n, field->shape[n],
			              SIDE_MAX);
	return BP_OK;
}

/* Its first two dimensions are those of phi_i and theta_i. */
static bp_status angles_check(const struct tensor_field *field, uint64_t azimuths, uint64_t angles, bp_error *error)
{
	if (field->shape[0] != azimuths || field->shape[1] != angles)
		return refuse(error, field,
		              "%" PRIu64 " x %" PRIu64 " directions of incidence, phi_i and theta_i have %" PRIu64 " x %" PRIu64,
		              field->shape[0], field->shape[1], azimuths, angles);
	return sides_check(field, error);
}

static const struct tensor_field *samples_find(const struct tensor_table *table)
{
	const struct tensor_field *rgb = tensor_field_find(table, "rgb");
	return rgb ? rgb : tensor_field_find(table, "spectra");
}

static bp_status samples_check(const struct tensor_table *table, uint64_t azimuths, uint64_t angles, bp_error *error)
{
	const struct tensor_field *samples = samples_find(table), *field;
	if (!samples)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
		                 "a tensor file, but not a material of the RGL database: neither field rgb nor spectra");
	const bool spectral = !strcmp(samples->name, "spectra");
	bp_status status = floats_get(table, samples->name, 5, &samples, error);
	if (!status)
		status = angles_check(samples, azimuths, angles, error);
	if (!status && spectral)
		status = floats_get(table, "wavelengths", 1, &field, error);
	if (status)
		return status;
	const uint64_t channels = spectral ? field->shape[0] : 3;
	if (spectral && (channels < WAVELENGTHS_MIN || channels > WAVELENGTHS_MAX))
		return refuse(error, field, "%" PRIu64 " of them; %d to %d are possible", channels, WAVELENGTHS_MIN, WAVELENGTHS_MAX);
	if (samples->shape[2] != channels)
		return refuse(error, samples, "%" PRIu64 " channels, expected %" PRIu64, samples->shape[2], channels);
	field = tensor_field_find(table, "luminance");
	const uint64_t shape[4] = {azimuths, angles, samples->shape[3], samples->shape[4]};
	return field && !tensor_field_has_shape(field, 4, shape) ? refuse(error, field, "%s", "its shape is not that of the samples")
	                                                         : BP_OK;
}

/* What the bits of `valid`, or bytes in their place, are for. */
static bp_status valid_check(const struct tensor_table *table, bp_error *error)
{
	const struct tensor_field *valid = tensor_field_find(table, "valid"), *samples = samples_find(table);
	if (!valid)
		return BP_OK;
	const uint64_t count = samples->count / samples->shape[2];
	if (valid->type != TENSOR_U8 || valid->count != (count + 7) / 8)
		return refuse(error, valid, "%" PRIu64 " elements of type %s, expected %" PRIu64 " of uint8, a bit for each sample",
		              valid->count, tensor_type_name(valid->type), (count + 7) / 8);
	return BP_OK;
}

bp_status rgl_table_check(const struct tensor_table *table, bp_error *error)
{
	const struct tensor_field *phi, *theta, *field;
	bp_status status = floats_get(table, "phi_i", 1, &phi, error);
	if (status)
		return status;
	if (phi->shape[0] > 2)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
		                 "an anisotropic material (field phi_i has %" PRIu64
		                 " azimuths): only isotropic ones are packed, since a MERL "
		                 "table knows no azimuth of incidence",
		                 phi->shape[0]);
	status = floats_get(table, "theta_i", 1, &theta, error);
	if (!status && theta->shape[0] > ANGLES_MAX)
		status = refuse(error, theta, "%" PRIu64 " angles; at most %d are possible", theta->shape[0], ANGLES_MAX);
	static const char *const GRIDS[] = {"ndf", "sigma"};
	for (int n = 0; n < 2 && !status; n++)
		if (!(status = floats_get(table, GRIDS[n], 2, &field, error)))
			status = sides_check(field, error);
	if (!status)
		status = floats_get(table, "vndf", 4, &field, error);
	if (!status)
		status = angles_check(field, phi->shape[0], theta->shape[0], error);
	if (!status)
		status = samples_check(table, phi->shape[0], theta->shape[0], error);
	if (!status)
		status = valid_check(table, error);
	if (!status)
		status = field_get(table, "jacobian", &field, error);
	if (!status && (field->type != TENSOR_U8 || field->count != 1))
		status = refuse(error, field, "%s", "one uint8 is expected");
	return status;
}

static bp_status not_finite(const struct tensor_field *field, uint64_t element, const char *negative, bp_error *error)
{
	return error_set(error, BP_ERROR_BAD_INPUT, field->offset + element * tensor_type_bytes(field->type),
	                 "field %s: element %" PRIu64 " is %sNaN or infinite", field->name, element, negative);
}

/* Ascending numbers from `least` to `most`; *values is malloc'ed. */
static bp_status ascending_read(const uint8_t *file, const struct tensor_field *field, double least, double most, double **values,
                                bp_error *error)
{
	const size_t count = (size_t)field->count;
	double *read = malloc(count * sizeof *read);
	if (!read)
		return error_memory(error, count * sizeof *read);
	tensor_floats(file, field, 0, count, read);
	for (size_t n = 0; n < count; n++)
		if (!(read[n] >= least && read[n] <= most) || (n && !(read[n] > read[n - 1]))) {
			const bp_status status =
				error_set(error, BP_ERROR_BAD_INPUT, field->offset + n * tensor_type_bytes(field->type),
			              "field %s: element %zu is %g; they must ascend, from %g to %g", field->name, n, read[n], least, most);
			free(read);
			return status;
		}
	*values = read;
	return BP_OK;
}

/* A grid that is nowhere negative and somewhere positive. */
static bp_status grid_read(const uint8_t *file, const struct tensor_field *field, struct rgl_grid *grid, bp_error *error)
{
	double row[SIDE_MAX], largest = 0;
	*grid = (struct rgl_grid){(size_t)field->shape[0], (size_t)field->shape[1], malloc((size_t)field->count * sizeof(float))};
	if (!grid->values)
		return error_memory(error, (size_t)field->count * sizeof(float));
	for (size_t y = 0; y < grid->height; y++) {
		tensor_floats(file, field, y * grid->width, grid->width, row);
		for (size_t x = 0; x < grid->width; x++) {
			if (!(row[x] >= 0 && row[x] <= FLT_MAX))
				return not_finite(field, y * grid->width + x, "negative, ", error);
			largest = fmax(largest, row[x]);
			grid->values[y * grid->width + x] = (float)row[x];
		}
	}
	return largest > 0 ? BP_OK : refuse(error, field, "%s", "0 everywhere");
}

static bp_status vndf_read(const uint8_t *file, const struct tensor_field *field, struct warp *warp, bp_error *error)
{
	const size_t slices = (size_t)field->shape[1], nodes = (size_t)(field->shape[2] * field->shape[3]);
	double *values = malloc(nodes * sizeof *values);
	bp_status status = BP_OK;
	if (!warp_alloc(warp, slices, (size_t)field->shape[2], (size_t)field->shape[3], 1, 1) || !values)
		status = error_memory(error, (3 * slices + 2) * nodes * sizeof(float));
	for (size_t slice = 0; slice < slices && !status; slice++) {
		size_t at = 0;
		tensor_floats(file, field, slice * nodes, nodes, values);
		const int fault = warp_fill(warp, slice, values, &at);
		if (fault == -1)
			status = not_finite(field, slice * nodes + at, "negative, ", error);
		else if (fault)
			status = refuse(error, field, "the density at theta_i number %zu is 0 everywhere, or beyond all bounds", slice);
	}
	if (!status)
		warp_round(warp);
	free(values);
	return status;
}

/* One channel's or wavelength's samples at one angle, by weight into red, green and blue. row[SIDE_MAX]: scratch. */
static bp_status plane_add(const uint8_t *file, const struct tensor_field *field, uint64_t first, const double weights[3],
                           const struct rgl_material *material, double *sums, double *row, bp_error *error)
{
	for (size_t y = 0; y < material->height; y++) {
		tensor_floats(file, field, first + y * material->width, material->width, row);
		for (size_t x = 0; x < material->width; x++) {
			if (!(fabs(row[x]) <= FLT_MAX))
				return not_finite(field, first + y * material->width + x, "", error);
			for (int c = 0; c < 3; c++)
				sums[3 * (y * material->width + x) + (size_t)c] += weights[c] * row[x];
		}
	}
	return BP_OK;
}

static bool bit_at(const uint8_t *bits, size_t n) { return bits[n / 8] >> (7 - n % 8) & 1; }

/* Notes where there is no data: what `valid` says of a sample that is 0. */
static void data_mark(const uint8_t *bits, struct rgl_material *material)
{
	const size_t count = material->angles * material->height * material->width;
	size_t set = 0;
	for (size_t n = 0; n < count; n++)
		set += bit_at(bits, n);
	const bool measured = 2 * set >= count; /* the bit of the greater part */
	for (size_t n = 0; n < count; n++) {
		float *sample = material->samples + 4 * n;
		if (bit_at(bits, n) != measured && sample[0] == 0 && sample[1] == 0 && sample[2] == 0)
			sample[3] = 0;
	}
}

static bp_status samples_read(const uint8_t *file, const struct tensor_table *table, struct rgl_material *material,
                              bp_error *error)
{
	static const double RGB[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
	const struct tensor_field *field = samples_find(table), *valid = tensor_field_find(table, "valid");
	const size_t channels = (size_t)field->shape[2];
	material->height = (size_t)field->shape[3];
	material->width = (size_t)field->shape[4];
	const size_t nodes = material->height * material->width;
	double *wavelengths = NULL, *weights = malloc(3 * channels * sizeof *weights), *row = malloc(SIDE_MAX * sizeof *row);
	double *sums = malloc(3 * nodes * sizeof *sums);
	bp_status status = BP_OK;

	material->samples = malloc(material->angles * nodes * 4 * sizeof(float));
	if (!weights || !row || !sums || !material->samples) {
		status = error_memory(error, material->angles * nodes * 4 * sizeof(float));
		goto out;
	}
	memcpy(weights, RGB, sizeof RGB); /* 3 channels at least */
	if (!strcmp(field->name, "spectra")) {
		status = ascending_read(file, tensor_field_find(table, "wavelengths"), 1, 1e5, &wavelengths, error);
		if (status)
			goto out;
		colour_weights(wavelengths, channels, weights);
		material->wavelengths = (uint32_t)channels;
		material->first = wavelengths[0];
		material->last = wavelengths[channels - 1];
	}
	for (size_t angle = 0; angle < material->angles; angle++) {
		memset(sums, 0, 3 * nodes * sizeof *sums);
		for (size_t c = 0; c < channels && !status; c++)
			status = plane_add(file, field, (angle * channels + c) * nodes, weights + 3 * c, material, sums, row, error);
		if (status)
			goto out;
		float *samples = material->samples + 4 * angle * nodes;
		for (size_t n = 0; n < nodes; n++) {
			for (size_t c = 0; c < 3; c++)
				samples[4 * n + c] = (float)fmax(fmin(sums[3 * n + c], (double)FLT_MAX), -(double)FLT_MAX);
			samples[4 * n + 3] = 1;
		}
	}
	material->measured = valid != NULL;
	if (valid)
		data_mark(file + valid->offset, material);
out:
	free(wavelengths);
	free(weights);
	free(row);
	free(sums);
	return status;
}

bp_status rgl_material_make(const uint8_t *file, const struct tensor_table *table, struct rgl_material *out, bp_error *error)
{
	struct rgl_material material = {0};
	bp_status status = rgl_table_check(table, error);
	if (status)
		return status;
	material.angles = (size_t)tensor_field_find(table, "theta_i")->count;
	material.jacobian = file[tensor_field_find(table, "jacobian")->offset] != 0;
	status = ascending_read(file, tensor_field_find(table, "theta_i"), 0, ANGLE_MOST, &material.theta_i, error);
	if (!status)
		status = grid_read(file, tensor_field_find(table, "ndf"), &material.ndf, error);
	if (!status)
		status = grid_read(file, tensor_field_find(table, "sigma"), &material.sigma, error);
	if (!status)
		status = vndf_read(file, tensor_field_find(table, "vndf"), &material.vndf, error);
	if (!status)
		status = samples_read(file, table, &material, error);
	if (status)
		rgl_material_free(&material);
	else
		*out = material;
	return status;
}

void rgl_material_free(struct rgl_material *material)
{
	free(material->theta_i);
	free(material->ndf.values);
	free(material->sigma.values);
	free(material->samples);
	warp_free(&material->vndf);
	*material = (struct rgl_material){0};
}
