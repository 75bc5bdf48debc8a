/*
 * bytes.h: little-endian bytes, read with bounds checks and written into a growing buffer.
 *
 * Both keep a sticky `failed`: a caller reads or writes a whole structure and asks once at its end.
 */
#ifndef BYTES_H
#define BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads from bytes[at] on; a read past `count` gives zeros and sets failed. The bytes belong to the caller. */
struct byte_reader {
	const uint8_t *bytes;
	size_t count, at;
	bool failed;
};

struct byte_reader byte_reader_over(const void *bytes, size_t count);
size_t byte_reader_left(const struct byte_reader *reader);
uint8_t read_u8(struct byte_reader *reader);
uint16_t read_u16(struct byte_reader *reader);
uint32_t read_u32(struct byte_reader *reader);
uint64_t read_u64(struct byte_reader *reader);
float read_f32(struct byte_reader *reader);  /* IEEE 754 binary32 */
double read_f64(struct byte_reader *reader); /* IEEE 754 binary64 */
/* Copies count bytes into out; out is zeroed when they are not there. */
void read_bytes(struct byte_reader *reader, void *out, size_t count);
/* The next `count` bytes in place, or NULL (and failed). */
const uint8_t *read_span(struct byte_reader *reader, size_t count);

/* Grows as needed; failed is set when memory runs out, and then writes do nothing. Start from a zeroed struct. */
struct byte_buffer {
	uint8_t *bytes;
	size_t count, capacity;
	bool failed;
};

void write_u8(struct byte_buffer *buffer, uint8_t value);
void write_u16(struct byte_buffer *buffer, uint16_t value);
void write_u32(struct byte_buffer *buffer, uint32_t value);
void write_u64(struct byte_buffer *buffer, uint64_t value);
void write_f32(struct byte_buffer *buffer, float value);
void write_f64(struct byte_buffer *buffer, double value);
void write_bytes(struct byte_buffer *buffer, const void *bytes, size_t count);
void write_zeros(struct byte_buffer *buffer, size_t count);
void byte_buffer_free(struct byte_buffer *buffer); /* leaves it empty and usable */

/* zlib's CRC-32 (polynomial 0xEDB88320, reflected, initial and final complement). */
uint32_t bytes_crc32(const void *bytes, size_t count);
/* The same, continued: start from 0. */
uint32_t bytes_crc32_more(uint32_t crc, const void *bytes, size_t count);

/* Stores at a place; for patching what was written before its value was known. */
void store_u32(uint8_t *at, uint32_t value);
uint16_t load_u16(const uint8_t *at);
uint32_t load_u32(const uint8_t *at);
uint64_t load_u64(const uint8_t *at);

#endif
