#include "sha256.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "error.h"

void sha256_start(struct sha256 *sha) { sha256_init(&sha->context); }

void sha256_add(void *user, const void *bytes, size_t count)
{
	struct sha256 *sha = user;
	sha256_update(&sha->context, count, bytes);
}

void sha256_finish(struct sha256 *sha, uint8_t digest[32]) { sha256_digest(&sha->context, SHA256_DIGEST_SIZE, digest); }

void sha256_to_hex(const uint8_t digest[32], char hex[SHA256_HEX_CHARACTERS + 1])
{
	static const char digits[] = "0123456789abcdef";
	for (int n = 0; n < 32; n++) {
		hex[2 * n] = digits[digest[n] >> 4];
		hex[2 * n + 1] = digits[digest[n] & 15];
	}
	hex[SHA256_HEX_CHARACTERS] = '\0';
}

/* 0..15, or -1; never reads the locale */
static int digit_value(char digit)
{
	if (digit >= '0' && digit <= '9')
		return digit - '0';
	if (digit >= 'a' && digit <= 'f')
		return digit - 'a' + 10;
	if (digit >= 'A' && digit <= 'F')
		return digit - 'A' + 10;
	return -1;
}

bool sha256_from_hex(const char *hex, uint8_t digest[32])
{
	if (strlen(hex) != SHA256_HEX_CHARACTERS)
		return false;
	for (int n = 0; n < 32; n++) {
		const int high = digit_value(hex[2 * n]), low = digit_value(hex[2 * n + 1]);
		if (high < 0 || low < 0)
			return false;
		digest[n] = (uint8_t)(high << 4 | low);
	}
	return true;
}

bp_status sha256_of_file(const char *path, char hex[SHA256_HEX_CHARACTERS + 1], bp_error *error)
{
	uint8_t bytes[1 << 16], digest[32];
	struct sha256 sha;
	bp_status status = BP_OK;
	FILE *file = fopen(path, "rbe");

	if (!file)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot open: %s", strerror(errno));
	sha256_start(&sha);
	for (size_t got; (got = fread(bytes, 1, sizeof bytes, file)) > 0;)
		sha256_add(&sha, bytes, got);
	if (ferror(file))
		status = error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot read: %s", strerror(errno));
	fclose(file);
	if (status)
		return status;
	sha256_finish(&sha, digest);
	sha256_to_hex(digest, hex);
	return BP_OK;
}
