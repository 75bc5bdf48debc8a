/*
 * brdfpack.h: read archives of measured materials. The only installed header.
 *
 * Words. A *lattice* is the raw table of one measured isotropic material over
 * (theta_h, theta_d, phi_d); a *record* is one fitted material's bytes in an
 * archive; a *section* is a separately checksummed part of a record; a *layer*
 * is a set of sections that lowers the error to a recorded value.
 *
 * Threads. Functions may be called from any thread. An object that is passed as
 * a pointer to const may be used by several threads at once.
 *
 * Errors. Functions that can fail return a bp_status and fill the bp_error that
 * the caller supplies (NULL is allowed). After a failure, out-parameters are
 * unchanged unless their description says otherwise. The library never prints
 * and never exits.
 */
#ifndef BRDFPACK_H
#define BRDFPACK_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default) /* the library hides every symbol that is not declared here */
#endif

#define BP_VERSION "0.1.0"

/* Status of a call. The values are pinned: they never change their meaning. */
typedef enum bp_status {
	BP_OK = 0,
	BP_ERROR_ARGUMENT = 1,    /* the caller's mistake */
	BP_ERROR_MEMORY = 2,      /* an allocation failed */
	BP_ERROR_IO = 3,          /* the system refused to read or write */
	BP_ERROR_NOT_OURS = 4,    /* this is not a brdfpack archive (or not a MERL file) */
	BP_ERROR_UNSUPPORTED = 5, /* intact, but made for a newer reader */
	BP_ERROR_CORRUPT = 6,     /* damaged: a value that no writer writes */
	BP_ERROR_CHECKSUM = 7,    /* damaged: a CRC32 differs */
	BP_ERROR_LIMIT = 8,       /* beyond a limit that the specification sets */
	BP_ERROR_NOT_FOUND = 9,   /* no material of that name or number */
	BP_ERROR_BAD_INPUT = 10   /* a measured file that cannot be packed */
} bp_status;

#define BP_NO_OFFSET UINT64_MAX

/* What went wrong, for a person: the library fills it, the caller owns it. */
typedef struct bp_error {
	bp_status status;
	uint64_t offset;   /* byte in the file where it was seen, or BP_NO_OFFSET */
	char message[512]; /* one line, no newline, NUL-terminated */
} bp_error;

/* A short text for a status: static, never NULL. */
const char *bp_status_text(bp_status status);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
