/*
 * carried.h: bytes that a MERL file carries in its cells below the horizon, where no measurement can be.
 *
 * Readers take any negative value for "not measured", so a double from -1.0625 to -1 says that and six bytes more: they are
 * its 48 low bits, and 0xBFF0 is above them. All values of that kind, in file order, make one string of bytes:
 *
 *     8 bytes 8B "CAR" 0D 0A 1A 0A; uint32 n; n bytes; zeros, which are cells of exactly -1
 *
 * all little-endian. It begins with the first value of the file whose sign bit is set, or not at all.
 * format-spec/FORMAT.md, "Extracted files", says what the bytes are; here they are any.
 */
#ifndef MERL_CARRIED_H
#define MERL_CARRIED_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CARRIED_BYTES_MAX = 1 << 24 };

/* What a file carried: bytes from malloc, which the owner frees; NULL: nothing. */
struct carried {
	uint8_t *bytes;
	size_t count;
};

/* Whether `values` cells' values, three to a cell, can carry so many bytes. */
bool carried_fits(size_t bytes, size_t values);

/* The values to write: start from {bytes, count}. */
struct carried_writer {
	const uint8_t *bytes;
	size_t count, at; /* at: of the whole string, its head included */
};
/* The next value; -1 once all is written, and from the start where count is 0. */
double carried_write(struct carried_writer *writer);

/* What is found while a file is read: start from {values}. */
struct carried_reader {
	size_t values;     /* in the whole file, which bounds what can be carried */
	uint8_t *bytes;    /* malloc'ed; the caller frees it in any case, or takes it when `whole` */
	size_t count, at;  /* count: announced; at: of the whole string, its head included */
	bool whole, ended; /* ended: nothing more is looked for */
	uint8_t head[12];
};
/* Looks through the next values of the file, as they are stored there. False: no memory for the announced bytes. */
bool carried_read(struct carried_reader *reader, const double *values, size_t count);

#endif
