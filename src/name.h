/*
 * name.h: what may be a material's name: UTF-8, 1 to 255 bytes, no control character (U+0000..U+001F,
 * U+007F..U+009F), no '/', not "." and not "..". Names are ordered by their bytes (memcmp, the shorter first), and alone say to
 * which shard of a build a material belongs.
 */
#ifndef NAME_H
#define NAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "brdfpack.h"

/* NULL when `count` bytes at `name` are a legal name, otherwise why not, as a clause: "it is empty". */
const char *name_fault(const char *name, size_t count);

/*
 * Length of the well-formed UTF-8 sequence at s (RFC 3629: no overlong form, no surrogate, at most U+10FFFF), its character in
 * *code; or 0. A NUL ends a sequence, so text that one ends may say 4 for `left`.
 */
size_t name_character(const uint8_t *s, size_t left, uint32_t *code);

/* The last part of a path, in place. */
const char *name_in_path(const char *path);

/* Whether the bytes are UTF-8, whatever the characters. */
bool name_text(const char *name);

/* Of `count` (1 to 65536) shards the one that a material of this name belongs to, 1 to count: CRC32(name) mod count, plus 1. */
uint32_t name_shard(const char *name, uint32_t count);

/* -1, 0 or 1, in the archive's order. */
int name_compare(const char *a, size_t a_bytes, const char *b, size_t b_bytes);

#endif
