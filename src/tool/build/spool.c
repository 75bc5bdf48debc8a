#include "spool.h"

#include "error.h"
#include "output_file.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

bp_status spool_open(const char *output_path, struct spool *out, bp_error *error)
{
	int fd;
	bp_status status = output_scratch_open(output_path, &fd, error);
	if (status)
		return status;
	*out = (struct spool){.fd = fd};
	return BP_OK;
}

bp_status spool_add(struct spool *spool, const uint8_t *bytes, size_t count, uint64_t *offset, bp_error *error)
{
	for (size_t done = 0; done < count;) {
		ssize_t put = pwrite(spool->fd, bytes + done, count - done, (off_t)(spool->bytes + done));
		if (put < 0 && errno == EINTR)
			continue;
		if (put <= 0)
			return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot write beside it: %s", strerror(put < 0 ? errno : ENOSPC));
		done += (size_t)put;
	}
	*offset = spool->bytes;
	spool->bytes += count;
	return BP_OK;
}

bp_status spool_read(const struct spool *spool, uint64_t offset, uint8_t *bytes, size_t count, bp_error *error)
{
	for (size_t done = 0; done < count;) {
		ssize_t got = pread(spool->fd, bytes + done, count - done, (off_t)(offset + done));
		if (got < 0 && errno == EINTR)
			continue;
		if (got <= 0)
			return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot read the scratch file beside it: %s",
			                 strerror(got < 0 ? errno : EIO));
		done += (size_t)got;
	}
	return BP_OK;
}

void spool_close(struct spool *spool)
{
	if (spool->fd >= 0)
		close(spool->fd);
	spool->fd = -1;
}
