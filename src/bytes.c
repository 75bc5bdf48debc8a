#include "bytes.h"

#include <stdlib.h>
#include <string.h>
#ifndef BP_PORTABLE
#include <zlib.h>
#endif

union float_bits {
	float value;
	uint32_t bits;
};
union double_bits {
	double value;
	uint64_t bits;
};

struct byte_reader byte_reader_over(const void *bytes, size_t count)
{
	return (struct byte_reader){.bytes = bytes, .count = count};
}

size_t byte_reader_left(const struct byte_reader *reader) { return reader->count - reader->at; }

const uint8_t *read_span(struct byte_reader *reader, size_t count)
{
	if (reader->failed || count > byte_reader_left(reader)) {
		reader->failed = true;
		return NULL;
	}
	const uint8_t *span = reader->bytes + reader->at;
	reader->at += count;
	return span;
}

void read_bytes(struct byte_reader *reader, void *out, size_t count)
{
	const uint8_t *span = read_span(reader, count);
	if (!count)
		return;
	if (span)
		memcpy(out, span, count);
	else
		memset(out, 0, count);
}

static uint64_t little_endian(const uint8_t *at, unsigned count)
{
	uint64_t value = 0;
	while (count-- > 0)
		value = value << 8 | at[count];
	return value;
}

uint16_t load_u16(const uint8_t *at) { return (uint16_t)little_endian(at, 2); }
uint32_t load_u32(const uint8_t *at) { return (uint32_t)little_endian(at, 4); }
uint64_t load_u64(const uint8_t *at) { return little_endian(at, 8); }

static uint64_t read_little_endian(struct byte_reader *reader, unsigned count)
{
	const uint8_t *span = read_span(reader, count);
	return span ? little_endian(span, count) : 0;
}

uint8_t read_u8(struct byte_reader *reader) { return (uint8_t)read_little_endian(reader, 1); }
uint16_t read_u16(struct byte_reader *reader) { return (uint16_t)read_little_endian(reader, 2); }
uint32_t read_u32(struct byte_reader *reader) { return (uint32_t)read_little_endian(reader, 4); }
uint64_t read_u64(struct byte_reader *reader) { return read_little_endian(reader, 8); }

float read_f32(struct byte_reader *reader) { return (union float_bits){.bits = read_u32(reader)}.value; }
double read_f64(struct byte_reader *reader) { return (union double_bits){.bits = read_u64(reader)}.value; }

static uint8_t *buffer_extend(struct byte_buffer *buffer, size_t count)
{
	if (!buffer->failed && count > buffer->capacity - buffer->count) {
		size_t capacity = buffer->capacity ? buffer->capacity : 256;
		while (capacity - buffer->count < count && capacity <= SIZE_MAX / 2)
			capacity *= 2;
		uint8_t *grown = capacity - buffer->count < count ? NULL : realloc(buffer->bytes, capacity);
		if (grown) {
			buffer->bytes = grown;
			buffer->capacity = capacity;
		}
		buffer->failed = !grown;
	}
	if (buffer->failed)
		return NULL;
	buffer->count += count;
	return buffer->bytes + buffer->count - count;
}

void write_bytes(struct byte_buffer *buffer, const void *bytes, size_t count)
{
	uint8_t *to = count ? buffer_extend(buffer, count) : NULL;
	if (to)
		memcpy(to, bytes, count);
}

void write_zeros(struct byte_buffer *buffer, size_t count)
{
	uint8_t *to = count ? buffer_extend(buffer, count) : NULL;
	if (to)
		memset(to, 0, count);
}

static void little_endian_store(uint8_t *at, uint64_t value, unsigned count)
{
	for (unsigned i = 0; i < count; i++)
		at[i] = (uint8_t)(value >> 8 * i);
}

void store_u32(uint8_t *at, uint32_t value) { little_endian_store(at, value, 4); }

static void write_little_endian(struct byte_buffer *buffer, uint64_t value, unsigned count)
{
	uint8_t *to = buffer_extend(buffer, count);
	if (to)
		little_endian_store(to, value, count);
}

void write_u8(struct byte_buffer *buffer, uint8_t value) { write_little_endian(buffer, value, 1); }
void write_u16(struct byte_buffer *buffer, uint16_t value) { write_little_endian(buffer, value, 2); }
void write_u32(struct byte_buffer *buffer, uint32_t value) { write_little_endian(buffer, value, 4); }
void write_u64(struct byte_buffer *buffer, uint64_t value) { write_little_endian(buffer, value, 8); }

void write_f32(struct byte_buffer *buffer, float value) { write_u32(buffer, (union float_bits){.value = value}.bits); }
void write_f64(struct byte_buffer *buffer, double value) { write_u64(buffer, (union double_bits){.value = value}.bits); }

void byte_buffer_free(struct byte_buffer *buffer)
{
	free(buffer->bytes);
	*buffer = (struct byte_buffer){0};
}

uint32_t bytes_crc32_more(uint32_t crc, const void *bytes, size_t count)
{
#ifdef BP_PORTABLE /* by half bytes: a record takes 0.3 ms */
	static const uint32_t REMAINDER[16] = {
		0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4, 0x4DB26158, 0x5005713C,
		0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C, 0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C,
	};
	const uint8_t *byte = bytes;
	crc = ~crc;
	for (size_t n = 0; n < count; n++) {
		crc = REMAINDER[(crc ^ byte[n]) & 15] ^ crc >> 4;
		crc = REMAINDER[(crc ^ (uint32_t)byte[n] >> 4) & 15] ^ crc >> 4;
	}
	return ~crc;
#else
	return (uint32_t)crc32_z(crc, bytes, count);
#endif
}

uint32_t bytes_crc32(const void *bytes, size_t count) { return bytes_crc32_more(0, count ? bytes : (const void *)"", count); }
