/*
 * tensor_maker.h: tensor files made by code: any fields, and a material of the RGL database whose function is known in closed form.
 */
#ifndef TESTS_TENSOR_MAKER_H
#define TESTS_TENSOR_MAKER_H

#include <stdlib.h>
#include <string.h>

#include "bytes.h"
#include "half.h"
#include "rgl/tensor_file.h"

#define MAKER __attribute__((unused)) static

struct made_field {
	const char *name;
	enum tensor_type type; /* TENSOR_U8, or of floats */
	uint32_t rank;
	uint64_t shape[TENSOR_RANK_MAX];
	double *values; /* malloc'ed; the product of the shape */
};

struct made_file {
	struct made_field field[16];
	uint32_t count;
};

MAKER uint64_t made_count(const struct made_field *field)
{
	uint64_t count = 1;
	for (uint32_t n = 0; n < field->rank; n++)
		count *= field->shape[n];
	return count;
}

MAKER struct made_field *made_find(struct made_file *file, const char *name)
{
	for (uint32_t n = 0; n < file->count; n++)
		if (!strcmp(file->field[n].name, name))
			return &file->field[n];
	return NULL;
}

/* Adds a field, or replaces the one of that name, every value of it the same. */
MAKER struct made_field *made_set(struct made_file *file, const char *name, enum tensor_type type, uint32_t rank,
                                  const uint64_t *shape, double value)
{
	struct made_field *field = made_find(file, name);
	if (field)
		free(field->values);
	else
		field = &file->field[file->count++];
	*field = (struct made_field){.name = name, .type = type, .rank = rank};
	memcpy(field->shape, shape, rank * sizeof *shape);
	field->values = malloc(made_count(field) * sizeof(double));
	for (uint64_t n = 0; n < made_count(field); n++)
		field->values[n] = value;
	return field;
}

MAKER void made_remove(struct made_file *file, const char *name)
{
	struct made_field *field = made_find(file, name);
	free(field->values);
	*field = file->field[--file->count];
}

MAKER void made_free(struct made_file *file)
{
	for (uint32_t n = 0; n < file->count; n++)
		free(file->field[n].values);
	file->count = 0;
}

/* The bytes of the file: the table of fields, then the arrays, each from a multiple of 8 on. */
MAKER void made_write(const struct made_file *file, struct byte_buffer *out)
{
	uint64_t at = TENSOR_HEAD_BYTES;
	for (uint32_t n = 0; n < file->count; n++)
		at += 2 + strlen(file->field[n].name) + 11 + 8 * file->field[n].rank;
	write_bytes(out, TENSOR_MAGIC, TENSOR_MAGIC_BYTES);
	write_u8(out, TENSOR_MAJOR);
	write_u8(out, TENSOR_MINOR);
	write_u32(out, file->count);
	for (uint32_t n = 0; n < file->count; n++) {
		const struct made_field *field = &file->field[n];
		at = (at + 7) / 8 * 8;
		write_u16(out, (uint16_t)strlen(field->name));
		write_bytes(out, field->name, strlen(field->name));
		write_u16(out, (uint16_t)field->rank);
		write_u8(out, (uint8_t)field->type);
		write_u64(out, at);
		for (uint32_t k = 0; k < field->rank; k++)
			write_u64(out, field->shape[k]);
		at += made_count(field) * tensor_type_bytes(field->type);
	}
	for (uint32_t n = 0; n < file->count; n++) {
		const struct made_field *field = &file->field[n];
		write_zeros(out, (8 - out->count % 8) % 8);
		for (uint64_t k = 0; k < made_count(field); k++) {
			if (field->type == TENSOR_U8)
				write_u8(out, (uint8_t)field->values[k]);
			else if (field->type == TENSOR_F16)
				write_u16(out, half_of(field->values[k]));
			else if (field->type == TENSOR_F32)
				write_f32(out, (float)field->values[k]);
			else
				write_f64(out, field->values[k]);
		}
	}
}

enum { MADE_ANGLES = 3, MADE_SIDE = 4, MADE_SAMPLES = 4 };

/*
 * A material whose visible normals are spread evenly, so that the warp changes nothing, ndf 1 and sigma 1/4: f cos theta_o is the sample at u_m.
 * All samples are (0.5, 0.25, 0.125), measured, at angles of incidence from 0 to 90 degrees.
 */
MAKER void made_material(struct made_file *file)
{
	const uint64_t one[1] = {1}, angles[1] = {MADE_ANGLES}, grid[2] = {2, MADE_SIDE},
				   vndf[4] = {1, MADE_ANGLES, MADE_SIDE, MADE_SIDE}, luminance[4] = {1, MADE_ANGLES, MADE_SAMPLES, MADE_SAMPLES},
				   rgb[5] = {1, MADE_ANGLES, 3, MADE_SAMPLES, MADE_SAMPLES},
				   valid[1] = {MADE_ANGLES * MADE_SAMPLES * MADE_SAMPLES / 8};
	made_set(file, "phi_i", TENSOR_F32, 1, one, 0);
	struct made_field *theta = made_set(file, "theta_i", TENSOR_F32, 1, angles, 0);
	for (int n = 0; n < MADE_ANGLES; n++)
		theta->values[n] = n * (1.5707963 / (MADE_ANGLES - 1));
	made_set(file, "ndf", TENSOR_F32, 2, grid, 1);
	made_set(file, "sigma", TENSOR_F32, 2, grid, 0.25);
	made_set(file, "vndf", TENSOR_F32, 4, vndf, 1);
	made_set(file, "luminance", TENSOR_F32, 4, luminance, 0.3);
	struct made_field *samples = made_set(file, "rgb", TENSOR_F32, 5, rgb, 0);
	for (uint64_t n = 0; n < made_count(samples); n++)
		samples->values[n] = 0.5 / (double)(1 << n / (MADE_SAMPLES * MADE_SAMPLES) % 3);
	made_set(file, "jacobian", TENSOR_U8, 1, one, 1);
	made_set(file, "valid", TENSOR_U8, 1, valid, 255);
}

#endif
