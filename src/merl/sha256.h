/*
 * sha256.h: the SHA-256 of a source file, taken while it is read. Part of the tool, not of the library.
 */
#ifndef MERL_SHA256_H
#define MERL_SHA256_H

#include <nettle/sha2.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "brdfpack.h"

enum { SHA256_HEX_CHARACTERS = 64 };

struct sha256 {
	struct sha256_ctx context;
};

void sha256_start(struct sha256 *sha);

/* A merl_seen_fn: user is the struct sha256. */
void sha256_add(void *user, const void *bytes, size_t count);

void sha256_finish(struct sha256 *sha, uint8_t digest[32]);

/* Of a whole file, as hexadecimal digits and a NUL. */
bp_status sha256_of_file(const char *path, char hex[SHA256_HEX_CHARACTERS + 1], bp_error *error);

/* 64 lower-case digits and a NUL. */
void sha256_to_hex(const uint8_t digest[32], char hex[SHA256_HEX_CHARACTERS + 1]);

/* False unless hex is exactly 64 hexadecimal digits of either case. */
bool sha256_from_hex(const char *hex, uint8_t digest[32]);

#endif
