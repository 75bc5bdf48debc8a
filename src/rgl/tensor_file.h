/*
 * tensor_file.h: the container of the RGL material database (and of Mitsuba 3): named arrays in one file.
 *
 *     12 bytes  "tensor_file" and a NUL
 *      2        u8 major, u8 minor: 1, 0
 *      4        u32 fields
 *     of each field: u16 bytes of its name; the name; u16 rank; u8 type; u64 offset from the file's start; u64 shape[rank]
 *
 * then the arrays, wherever the offsets say, the last index running fastest; all little-endian. Source of the layout: the
 * public reader rgl-epfl/brdf-loader, and the database's own files, whose arrays begin at multiples of 8.
 */
#ifndef RGL_TENSOR_FILE_H
#define RGL_TENSOR_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "brdfpack.h"

#define TENSOR_MAGIC "tensor_file" /* with its NUL */
enum {
	TENSOR_MAGIC_BYTES = 12,
	TENSOR_HEAD_BYTES = 18,
	TENSOR_MAJOR = 1,
	TENSOR_MINOR = 0,
	TENSOR_FIELDS_MAX = 64,
	TENSOR_NAME_BYTES_MAX = 63,
	TENSOR_RANK_MAX = 8,
	TENSOR_TABLE_BYTES_MAX = TENSOR_HEAD_BYTES + TENSOR_FIELDS_MAX * (2 + TENSOR_NAME_BYTES_MAX + 11 + 8 * TENSOR_RANK_MAX)
};

/* As numbered in the file. */
enum tensor_type {
	TENSOR_U8 = 1,
	TENSOR_I8,
	TENSOR_U16,
	TENSOR_I16,
	TENSOR_U32,
	TENSOR_I32,
	TENSOR_U64,
	TENSOR_I64,
	TENSOR_F16,
	TENSOR_F32,
	TENSOR_F64
};

struct tensor_field {
	char name[TENSOR_NAME_BYTES_MAX + 1];
	enum tensor_type type;
	uint32_t rank; /* at most TENSOR_RANK_MAX; 0: one element */
	uint64_t shape[TENSOR_RANK_MAX];
	uint64_t offset; /* from the file's start */
	uint64_t count;  /* elements: the product of the shape */
};

/* What stands in a file; of its arrays the places only. */
struct tensor_table {
	uint32_t count;
	struct tensor_field field[TENSOR_FIELDS_MAX];
};

/* Bytes of one element. */
size_t tensor_type_bytes(enum tensor_type type);
const char *tensor_type_name(enum tensor_type type); /* "uint8" ... "float64" */

/*
 * Parses the table of fields from the file's first `count` bytes, which must hold all of it; file_bytes is the whole file's
 * size, within which every array must lie (UINT64_MAX: not known yet). BP_ERROR_BAD_INPUT, naming the field and the offset, for
 * what is cut off, a version other than 1, types, ranks and names that are not known or too long, two fields of one name, and
 * arrays that do not fit or overlap.
 */
bp_status tensor_table_parse(const uint8_t *bytes, size_t count, uint64_t file_bytes, struct tensor_table *out, bp_error *error);

/* The field of that name, or NULL. */
const struct tensor_field *tensor_field_find(const struct tensor_table *table, const char *name);

/* Whether the field has exactly this shape. */
bool tensor_field_has_shape(const struct tensor_field *field, uint32_t rank, const uint64_t *shape);

/*
 * Elements `first` to first + count - 1 of a field of floats (types 9 to 11), as double. `file` is the whole file, whose table
 * was parsed with its size. False where the type is none of them, or the elements are not there.
 */
bool tensor_floats(const uint8_t *file, const struct tensor_field *field, uint64_t first, size_t count, double *out);

#endif
