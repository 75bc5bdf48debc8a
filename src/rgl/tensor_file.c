#include "tensor_file.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "bytes.h"
#include "error.h"

static const struct {
	const char *name;
	size_t bytes;
} TYPES[] = {
	[TENSOR_U8] = {"uint8", 1},    [TENSOR_I8] = {"int8", 1},     [TENSOR_U16] = {"uint16", 2},  [TENSOR_I16] = {"int16", 2},
	[TENSOR_U32] = {"uint32", 4},  [TENSOR_I32] = {"int32", 4},   [TENSOR_U64] = {"uint64", 8},  [TENSOR_I64] = {"int64", 8},
	[TENSOR_F16] = {"float16", 2}, [TENSOR_F32] = {"float32", 4}, [TENSOR_F64] = {"float64", 8},
};

/* Far beyond any file, and so that the sum over all fields cannot overflow. */
#define ARRAY_BYTES_MAX (UINT64_MAX / TENSOR_FIELDS_MAX)

static bool type_known(unsigned type) { return type >= TENSOR_U8 && type <= TENSOR_F64; }

size_t tensor_type_bytes(enum tensor_type type) { return type_known(type) ? TYPES[type].bytes : 0; }

const char *tensor_type_name(enum tensor_type type) { return type_known(type) ? TYPES[type].name : "unknown"; }

static bp_status cut(uint64_t at, bp_error *error)
{
	return error_set(error, BP_ERROR_BAD_INPUT, at,
	                 "truncated: the tensor file's table of fields goes on after %" PRIu64 " bytes", at);
}

/* Names are shown in messages, so they have to be plain text. */
static bool name_plain(const char *name, size_t bytes)
{
	for (size_t n = 0; n < bytes; n++)
		if (name[n] < 0x20 || name[n] > 0x7e)
			return false;
	return bytes > 0;
}

static bp_status name_parse(struct byte_reader *in, uint32_t number, struct tensor_field *field, bp_error *error)
{
	const size_t at = in->at, bytes = read_u16(in);
	if (in->failed)
		return cut(in->count, error);
	if (bytes > TENSOR_NAME_BYTES_MAX)
		return error_set(error, BP_ERROR_BAD_INPUT, at, "field %" PRIu32 ": a name of %zu bytes; %d are possible", number, bytes,
		                 TENSOR_NAME_BYTES_MAX);
	read_bytes(in, field->name, bytes);
	if (in->failed)
		return cut(in->count, error);
	if (!name_plain(field->name, bytes))
		return error_set(error, BP_ERROR_BAD_INPUT, at, "field %" PRIu32 ": its name is no plain text", number);
	return BP_OK;
}

/* Elements, and whether they lie within the file, each step without overflow. */
static bp_status extent_check(struct tensor_field *field, uint64_t at, uint64_t file_bytes, bp_error *error)
{
	const uint64_t size = tensor_type_bytes(field->type);
	field->count = 1;
	for (uint32_t n = 0; n < field->rank; n++) {
		if (field->shape[n] == 0)
			return error_set(error, BP_ERROR_BAD_INPUT, at, "field %s: dimension %" PRIu32 " of its shape is 0", field->name, n);
		if (field->count > ARRAY_BYTES_MAX / size / field->shape[n])
			return error_set(error, BP_ERROR_BAD_INPUT, at,
			                 "field %s: its shape overflows (dimension %" PRIu32 " is %" PRIu64 ")", field->name, n,
			                 field->shape[n]);
		field->count *= field->shape[n];
	}
	if (field->offset > file_bytes || field->count * size > file_bytes - field->offset)
		return error_set(error, BP_ERROR_BAD_INPUT, field->offset,
		                 "field %s: %" PRIu64 " bytes at offset %" PRIu64 " go beyond the file's end at %" PRIu64
		                 ": it was cut, or is damaged",
		                 field->name, field->count * size, field->offset, file_bytes);
	return BP_OK;
}

static bp_status field_parse(struct byte_reader *in, uint32_t number, uint64_t file_bytes, struct tensor_field *field,
                             bp_error *error)
{
	bp_status status = name_parse(in, number, field, error);
	if (status)
		return status;
	const size_t at = in->at;
	field->rank = read_u16(in);
	const unsigned type = read_u8(in);
	field->offset = read_u64(in);
	if (in->failed)
		return cut(in->count, error);
	if (field->rank > TENSOR_RANK_MAX)
		return error_set(error, BP_ERROR_BAD_INPUT, at, "field %s: rank %" PRIu32 "; at most %d is possible", field->name,
		                 field->rank, TENSOR_RANK_MAX);
	if (!type_known(type))
		return error_set(error, BP_ERROR_BAD_INPUT, at + 2, "field %s: type %u is not known (1 to 11 are)", field->name, type);
	field->type = (enum tensor_type)type;
	for (uint32_t n = 0; n < field->rank; n++)
		field->shape[n] = read_u64(in);
	if (in->failed)
		return cut(in->count, error);
	return extent_check(field, at, file_bytes, error);
}

bp_status tensor_table_parse(const uint8_t *bytes, size_t count, uint64_t file_bytes, struct tensor_table *out, bp_error *error)
{
	struct byte_reader in = byte_reader_over(bytes, count);
	if (count < TENSOR_MAGIC_BYTES || memcmp(bytes, TENSOR_MAGIC, TENSOR_MAGIC_BYTES) != 0)
		return error_set(error, BP_ERROR_BAD_INPUT, 0, "not a tensor file");
	read_span(&in, TENSOR_MAGIC_BYTES);
	const unsigned major = read_u8(&in), minor = read_u8(&in);
	const uint32_t fields = read_u32(&in);
	if (in.failed)
		return cut(count, error);
	if (major != TENSOR_MAJOR)
		return error_set(error, BP_ERROR_BAD_INPUT, TENSOR_MAGIC_BYTES, "a tensor file of version %u.%u; version 1 is read",
		                 major, minor);
	if (fields > TENSOR_FIELDS_MAX)
		return error_set(error, BP_ERROR_BAD_INPUT, TENSOR_MAGIC_BYTES + 2, "%" PRIu32 " fields; at most %d are possible", fields,
		                 TENSOR_FIELDS_MAX);
	uint64_t taken = 0;
	memset(out, 0, sizeof *out);
	for (uint32_t n = 0; n < fields; n++) {
		bp_status status = field_parse(&in, n, file_bytes, &out->field[n], error);
		if (status)
			return status;
		if (tensor_field_find(out, out->field[n].name))
			return error_set(error, BP_ERROR_BAD_INPUT, in.at, "two fields named %s", out->field[n].name);
		taken += out->field[n].count * tensor_type_bytes(out->field[n].type);
		out->count++;
	}
	if (taken > file_bytes)
		return error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET,
		                 "the fields' arrays take %" PRIu64 " bytes, and the file has %" PRIu64 ": they overlap", taken,
		                 file_bytes);
	return BP_OK;
}

const struct tensor_field *tensor_field_find(const struct tensor_table *table, const char *name)
{
	for (uint32_t n = 0; n < table->count; n++)
		if (!strcmp(table->field[n].name, name))
			return &table->field[n];
	return NULL;
}

bool tensor_field_has_shape(const struct tensor_field *field, uint32_t rank, const uint64_t *shape)
{
	return field->rank == rank && !memcmp(field->shape, shape, rank * sizeof *shape);
}

/* IEEE 754 binary16: sign, 5 bits of exponent, 10 of fraction. */
static double half_value(uint16_t half)
{
	const int exponent = half >> 10 & 31, fraction = half & 1023;
	const double size = exponent == 31 ? (fraction ? (double)NAN : (double)INFINITY)
	                    : exponent     ? ldexp(1024 + fraction, exponent - 25)
	                                   : ldexp(fraction, -24);
	return half & 0x8000 ? -size : size;
}

bool tensor_floats(const uint8_t *file, const struct tensor_field *field, uint64_t first, size_t count, double *out)
{
	if (first > field->count || count > field->count - first)
		return false;
	const size_t size = tensor_type_bytes(field->type);
	struct byte_reader in = byte_reader_over(file + field->offset + first * size, count * size);
	switch (field->type) {
	case TENSOR_F16:
		for (size_t n = 0; n < count; n++)
			out[n] = half_value(read_u16(&in));
		return true;
	case TENSOR_F32:
		for (size_t n = 0; n < count; n++)
			out[n] = (double)read_f32(&in);
		return true;
	case TENSOR_F64:
		for (size_t n = 0; n < count; n++)
			out[n] = read_f64(&in);
		return true;
	default: return false;
	}
}
