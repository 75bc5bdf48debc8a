/*
 * tensor_writer.h: writes the container whose layout rgl/tensor_file.h has. Arrays begin at multiples of 8 bytes.
 */
#ifndef TOOL_EXPORT_TENSOR_WRITER_H
#define TOOL_EXPORT_TENSOR_WRITER_H

#include "bytes.h"
#include "rgl/tensor_file.h"

/* One field, of bytes or of numbers of four; its values belong to the caller, and are in the machine's order. */
struct tensor {
	const char *name;
	enum tensor_type type;
	uint32_t rank;
	uint64_t shape[TENSOR_RANK_MAX];
	const void *values;
};

/* Bytes of a file of these fields. */
uint64_t tensor_file_bytes(const struct tensor *fields, size_t count);

/* Appends the file; out->failed tells that memory ran out. */
void tensor_file_write(const struct tensor *fields, size_t count, struct byte_buffer *out);

#endif
