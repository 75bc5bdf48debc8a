#include "input.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "error.h"

bp_status input_open(const char *path, int *fd, uint64_t *bytes, bp_error *error)
{
	struct stat about;
	bp_status status = BP_OK;
	*fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
	if (*fd < 0 || fstat(*fd, &about) != 0)
		status = error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot open: %s", strerror(errno));
	else if (!S_ISREG(about.st_mode))
		status = error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "%s",
		                   S_ISDIR(about.st_mode) ? "a folder, not a file" : "not a regular file");
	else
		*bytes = (uint64_t)about.st_size;
	if (status && *fd >= 0)
		close(*fd);
	*fd = status ? -1 : *fd;
	return status;
}

bp_status input_fill(struct input *in, void *bytes, size_t count, size_t *got, bp_error *error)
{
	char *next = bytes;
	size_t filled = 0;
	while (filled < count) {
		size_t once = 0;
		bp_status status = in->read(in->user, next + filled, count - filled, &once, error);
		if (status != BP_OK)
			return status;
		if (!once)
			break;
		filled += once;
	}
	if (in->how.seen && filled)
		in->how.seen(in->how.seen_user, bytes, filled);
	in->done += filled;
	*got = filled;
	return BP_OK;
}

bp_status input_end(struct input *in, bp_error *error)
{
	char extra;
	size_t got = 0;
	bp_status status = in->read(in->user, &extra, 1, &got, error);
	if (status == BP_OK && got)
		status = error_set(error, BP_ERROR_BAD_INPUT, in->done,
		                   "trailing bytes: expected the end after %" PRIu64 " bytes, found more", in->done);
	return status;
}

bp_status input_truncated(uint64_t expected, uint64_t found, bp_error *error)
{
	const bool floats = 2 * found == expected + 12; /* all there, behind a table's header, but as 4 bytes each */
	return error_set(error, BP_ERROR_BAD_INPUT, found, "truncated: expected %" PRIu64 " bytes, found %" PRIu64 "%s", expected,
	                 found, floats ? ", as many as values of 4 bytes take: a MERL file has values of 8 (float64)" : "");
}
