#include "descriptor.h"

#include <errno.h>
#include <stdint.h>
#include <unistd.h>

size_t descriptor_read(int fd, void *bytes, size_t count, off_t at)
{
	size_t done = 0;
	while (done < count) {
		uint8_t *const next = (uint8_t *)bytes + done;
		const ssize_t got = at < 0 ? read(fd, next, count - done) : pread(fd, next, count - done, at + (off_t)done);
		if (got < 0 && errno == EINTR)
			continue;
		errno = got < 0 ? errno : 0;
		if (got <= 0)
			break;
		done += (size_t)got;
	}
	return done;
}

size_t descriptor_write(int fd, const void *bytes, size_t count, off_t at)
{
	size_t done = 0;
	while (done < count) {
		const uint8_t *const next = (const uint8_t *)bytes + done;
		const ssize_t put = at < 0 ? write(fd, next, count - done) : pwrite(fd, next, count - done, at + (off_t)done);
		if (put < 0 && errno == EINTR)
			continue;
		errno = put ? errno : ENOSPC;
		if (put <= 0)
			break;
		done += (size_t)put;
	}
	return done;
}
