/*
 * foreign.h: what a file is that was taken for a measured one and is none that is read.
 */
#ifndef MERL_FOREIGN_H
#define MERL_FOREIGN_H

#include <stddef.h>
#include <stdint.h>

enum { FOREIGN_HEAD_BYTES = 512 };

/* By its first bytes, as many as there are up to FOREIGN_HEAD_BYTES; NULL: nothing that is known. */
const char *foreign_kind(const uint8_t *head, size_t count);

#endif
