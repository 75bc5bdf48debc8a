/*
 * tensor_writer.h: tensor files, the container of the RGL database and of Mitsuba 3: named arrays with a type and a shape.
 *
 *     "tensor_file\0"   u8 major 1   u8 minor 0   u32 count of fields
 *     for each field: u16 bytes of its name, the name, u16 rank, u8 type, u64 offset in the file, u64 shape[rank]
 *     the arrays, each from a multiple of 8 bytes on, its last index running fastest
 *
 * All numbers are little-endian.
 */
#ifndef TOOL_EXPORT_TENSOR_WRITER_H
#define TOOL_EXPORT_TENSOR_WRITER_H

#include "bytes.h"

enum tensor_number { TENSOR_NUMBER_U8 = 1, TENSOR_NUMBER_U32 = 5, TENSOR_NUMBER_F32 = 10 };
enum { TENSOR_RANK_MOST = 5 };

/* One field; its values belong to the caller, and are in the machine's order. */
struct tensor {
	const char *name;
	enum tensor_number number;
	uint32_t rank;
	uint64_t shape[TENSOR_RANK_MOST];
	const void *values;
};

/* Bytes of a file of these fields. */
uint64_t tensor_file_bytes(const struct tensor *fields, size_t count);

/* Appends the file; out->failed tells that memory ran out. */
void tensor_file_write(const struct tensor *fields, size_t count, struct byte_buffer *out);

#endif
