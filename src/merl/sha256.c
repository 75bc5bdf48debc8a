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
	for (int n = 0; n < 32; n++)
		snprintf(hex + 2 * n, 3, "%02x", digest[n]);
}

bool sha256_from_hex(const char *hex, uint8_t digest[32])
{
	if (strlen(hex) != SHA256_HEX_CHARACTERS || strspn(hex, "0123456789abcdefABCDEF") != SHA256_HEX_CHARACTERS)
		return false;
	for (int n = 0; n < 32; n++)
		sscanf(hex + 2 * n, "%2hhx", &digest[n]);
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
