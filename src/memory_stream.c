#include "memory_stream.h"

#include <sys/types.h>

static ssize_t stream_write(void *user, const char *bytes, size_t count)
{
	struct byte_buffer *out = user;
	write_bytes(out, bytes, count);
	return out->failed ? 0 : (ssize_t)count;
}

FILE *memory_stream_open(struct byte_buffer *out)
{
	return fopencookie(out, "w", (cookie_io_functions_t){.write = stream_write});
}
