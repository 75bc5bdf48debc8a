#include "whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "descriptor.h"
#include "error.h"

bp_status whole_file_read(const char *path, size_t most, char **out, size_t *out_bytes, bp_error *error)
{
	struct stat facts;
	char *text = NULL;
	size_t used = 0;
	bp_status status = BP_OK;

	int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* O_NONBLOCK: a FIFO must not hang us */
	if (fd < 0)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot open: %s", strerror(errno));
	if (fstat(fd, &facts) != 0 || !S_ISREG(facts.st_mode))
		status = error_set(error, BP_ERROR_BAD_INPUT, BP_NO_OFFSET, "not a regular file");
	else if ((uint64_t)facts.st_size > most)
		status = error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "more than %zu bytes", most);
	else if (!(text = malloc((size_t)facts.st_size + 1)))
		status = error_memory(error, (size_t)facts.st_size);
	else if ((used = descriptor_read(fd, text, (size_t)facts.st_size, -1)) < (size_t)facts.st_size && errno)
		status = error_set(error, BP_ERROR_IO, used, "cannot read: %s", strerror(errno));
	close(fd);
	if (status != BP_OK) {
		free(text);
		return status;
	}
	text[used] = '\0';
	*out = text;
	*out_bytes = used;
	return BP_OK;
}
