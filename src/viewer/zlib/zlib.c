#include <stdint.h>
#include <zlib.h>

/* Eight bytes a step (Kounavis and Berry 2005): table[n][b] is the CRC of byte b and n zero bytes behind it. */
static uint32_t table[8][256];

static void table_make(void)
{
	for (uint32_t b = 0; b < 256; b++) {
		uint32_t crc = b;
		for (int bit = 0; bit < 8; bit++)
			crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
		table[0][b] = crc;
	}
	for (int n = 1; n < 8; n++)
		for (uint32_t b = 0; b < 256; b++)
			table[n][b] = table[n - 1][b] >> 8 ^ table[0][table[n - 1][b] & 255];
}

uLong crc32_z(uLong start, const Bytef *bytes, size_t count)
{
	uint32_t crc = ~(uint32_t)start;
	if (!table[0][1])
		table_make();
	for (; count >= 8; count -= 8, bytes += 8) {
		const uint32_t low = crc ^ ((uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24);
		crc = table[7][low & 255] ^ table[6][low >> 8 & 255] ^ table[5][low >> 16 & 255] ^ table[4][low >> 24] ^ table[3][bytes[4]] ^
		      table[2][bytes[5]] ^ table[1][bytes[6]] ^ table[0][bytes[7]];
	}
	for (; count; count--, bytes++)
		crc = crc >> 8 ^ table[0][(crc ^ *bytes) & 255];
	return ~crc;
}

uLong crc32(uLong start, const Bytef *bytes, uInt count)
{
	return crc32_z(start, bytes, count);
}
