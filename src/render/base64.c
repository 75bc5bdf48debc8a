#include "base64.h"

void base64_write(FILE *out, const uint8_t *bytes, size_t count)
{
	static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
	for (size_t n = 0; n < count; n += 3) {
		const size_t left = count - n;
		const uint32_t triple =
			(uint32_t)bytes[n] << 16 | (left > 1 ? (uint32_t)bytes[n + 1] << 8 : 0) | (left > 2 ? bytes[n + 2] : 0);
		char four[4];
		for (size_t d = 0; d < 4; d++)
			four[d] = d > left ? '=' : DIGITS[triple >> (18 - 6 * d) & 63];
		fwrite(four, 1, sizeof four, out);
	}
}
