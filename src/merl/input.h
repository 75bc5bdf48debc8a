/*
 * input.h: where a measured file's bytes come from. Internal to this wing.
 */
#ifndef MERL_INPUT_H
#define MERL_INPUT_H

#include "merl_file.h"

/* Where the bytes come from and who looks on. */
struct input {
	merl_read_fn *read;
	void *user;
	struct merl_reading how;
	uint64_t available; /* bytes of the whole, where that is known; else UINT64_MAX */
	uint64_t done;
	struct carried carried; /* what the file carried, where how.carried asks for it */
};

/*
 * Opens a regular file and tells its size; a FIFO or a device is refused without waiting for its other side. BP_ERROR_IO,
 * BP_ERROR_BAD_INPUT: *fd is -1 then, else the caller's to close. Messages do not repeat the path.
 */
bp_status input_open(const char *path, int *fd, uint64_t *bytes, bp_error *error);

/* Reads `count` bytes, or fewer at the end of the stream: *got says how many. */
bp_status input_fill(struct input *in, void *bytes, size_t count, size_t *got, bp_error *error);

/* BP_OK at the end of the stream; BP_ERROR_BAD_INPUT where there is more. */
bp_status input_end(struct input *in, bp_error *error);

/* The message of a file that ends after `found` bytes. */
bp_status input_truncated(uint64_t expected, uint64_t found, bp_error *error);

#endif
