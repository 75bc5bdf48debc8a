#include "carried.h"

#include <stdlib.h>
#include <string.h>

static const uint8_t MAGIC[8] = {0x8B, 'C', 'A', 'R', '\r', '\n', 0x1A, '\n'};
enum { HEAD_BYTES = 12, VALUE_BYTES = 6, SIGNATURE = 0xBFF0, SIGNATURE_SHIFT = 48 };

_Static_assert(HEAD_BYTES % VALUE_BYTES == 0, "the reader takes the head value by value");

bool carried_fits(size_t bytes, size_t values)
{
	return bytes <= CARRIED_BYTES_MAX && values >= (HEAD_BYTES + bytes + VALUE_BYTES - 1) / VALUE_BYTES;
}

static uint8_t string_byte(const struct carried_writer *writer, size_t at)
{
	if (at < sizeof MAGIC)
		return MAGIC[at];
	if (at < HEAD_BYTES)
		return (uint8_t)(writer->count >> 8 * (at - sizeof MAGIC));
	return at - HEAD_BYTES < writer->count ? writer->bytes[at - HEAD_BYTES] : 0;
}

double carried_write(struct carried_writer *writer)
{
	uint64_t bits = (uint64_t)SIGNATURE << SIGNATURE_SHIFT;
	double value;

	if (writer->count == 0 || writer->at >= HEAD_BYTES + writer->count)
		return -1;
	for (size_t n = 0; n < VALUE_BYTES; n++)
		bits |= (uint64_t)string_byte(writer, writer->at++) << 8 * n;
	memcpy(&value, &bits, sizeof value);
	return value;
}

/* The head is there: is it one? */
static bool head_read(struct carried_reader *reader)
{
	for (size_t n = 0; n < HEAD_BYTES - sizeof MAGIC; n++)
		reader->count |= (size_t)reader->head[sizeof MAGIC + n] << 8 * n;
	reader->ended =
		memcmp(reader->head, MAGIC, sizeof MAGIC) != 0 || reader->count == 0 || !carried_fits(reader->count, reader->values);
	if (reader->ended)
		return true;
	reader->bytes = malloc(reader->count);
	return reader->bytes != NULL;
}

static bool value_read(struct carried_reader *reader, uint64_t bits)
{
	for (size_t n = 0; n < VALUE_BYTES && !reader->whole; n++, reader->at++) {
		const uint8_t byte = (uint8_t)(bits >> 8 * n);
		if (reader->at < HEAD_BYTES)
			reader->head[reader->at] = byte;
		else
			reader->bytes[reader->at - HEAD_BYTES] = byte;
		reader->whole = reader->bytes && reader->at + 1 == HEAD_BYTES + reader->count;
	}
	reader->ended = reader->whole;
	return reader->at != HEAD_BYTES || head_read(reader);
}

bool carried_read(struct carried_reader *reader, const double *values, size_t count)
{
	for (size_t n = 0; n < count && !reader->ended; n++) {
		uint64_t bits;
		memcpy(&bits, &values[n], sizeof bits);
		if (bits >> 63 == 0)
			continue;
		if (bits >> SIGNATURE_SHIFT != SIGNATURE)
			reader->ended = reader->at == 0; /* another program's way to say it: most files end here */
		else if (!value_read(reader, bits))
			return false;
	}
	return true;
}
