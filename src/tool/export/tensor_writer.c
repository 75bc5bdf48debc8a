#include "tensor_writer.h"

#include <string.h>

enum { ALIGNMENT = 8, FIXED = 2 + 2 + 1 + 8 };

static uint64_t elements(const struct tensor *field)
{
	uint64_t count = 1;
	for (uint32_t n = 0; n < field->rank; n++)
		count *= field->shape[n];
	return count;
}

static uint64_t bytes_of(const struct tensor *field) { return elements(field) * tensor_type_bytes(field->type); }

static uint64_t aligned(uint64_t at) { return (at + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT; }

static uint64_t header_bytes(const struct tensor *fields, size_t count)
{
	uint64_t bytes = TENSOR_HEAD_BYTES;
	for (size_t n = 0; n < count; n++)
		bytes += FIXED + strlen(fields[n].name) + 8 * fields[n].rank;
	return bytes;
}

uint64_t tensor_file_bytes(const struct tensor *fields, size_t count)
{
	uint64_t at = header_bytes(fields, count);
	for (size_t n = 0; n < count; n++)
		at = aligned(at) + bytes_of(&fields[n]);
	return at;
}

static void values_write(const struct tensor *field, struct byte_buffer *out)
{
	const uint64_t count = elements(field);
	if (field->type == TENSOR_U8) {
		write_bytes(out, field->values, (size_t)count);
		return;
	}
	for (uint64_t n = 0; n < count; n++) {
		uint32_t bits;
		memcpy(&bits, (const uint8_t *)field->values + 4 * n, sizeof bits);
		write_u32(out, bits);
	}
}

void tensor_file_write(const struct tensor *fields, size_t count, struct byte_buffer *out)
{
	const size_t start = out->count;
	uint64_t at = header_bytes(fields, count);
	write_bytes(out, TENSOR_MAGIC, TENSOR_MAGIC_BYTES);
	write_u8(out, TENSOR_MAJOR);
	write_u8(out, TENSOR_MINOR);
	write_u32(out, (uint32_t)count);
	for (size_t n = 0; n < count; n++) {
		at = aligned(at);
		write_u16(out, (uint16_t)strlen(fields[n].name));
		write_bytes(out, fields[n].name, strlen(fields[n].name));
		write_u16(out, (uint16_t)fields[n].rank);
		write_u8(out, (uint8_t)fields[n].type);
		write_u64(out, at);
		for (uint32_t axis = 0; axis < fields[n].rank; axis++)
			write_u64(out, fields[n].shape[axis]);
		at += bytes_of(&fields[n]);
	}
	for (size_t n = 0; n < count && !out->failed; n++) {
		write_zeros(out, (size_t)(aligned(out->count - start) - (out->count - start)));
		values_write(&fields[n], out);
	}
}
