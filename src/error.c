#include "error.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Makes one line of whatever names and paths stand in the text: control characters as \xHH. What does not fit is cut between characters. */
static void message_put(char *to, size_t room, const char *from)
{
	size_t used = 0;
	for (; *from; from++) {
		const unsigned char c = (unsigned char)*from;
		const bool control = c < 0x20 || c == 0x7F;
		if (used + (control ? 4 : 1) >= room)
			break;
		if (control)
			used += (size_t)snprintf(to + used, room - used, "\\x%02x", c);
		else
			to[used++] = *from;
	}
	if (((unsigned char)*from & 0xC0) == 0x80) { /* within a character: go back to before it */
		while (used > 0 && ((unsigned char)to[used - 1] & 0xC0) == 0x80)
			used--;
		used -= used > 0;
	}
	to[used] = 0;
}

bp_status error_set(bp_error *error, bp_status status, uint64_t offset, const char *format, ...)
{
	if (error) {
		char text[2 * sizeof error->message]; /* what is cut here does not fit there */
		va_list arguments;
		error->status = status;
		error->offset = offset;
		va_start(arguments, format);
		vsnprintf(text, sizeof text, format, arguments);
		va_end(arguments);
		message_put(error->message, sizeof error->message, text);
	}
	return status;
}

bp_status error_memory(bp_error *error, size_t bytes)
{
	return error_set(error, BP_ERROR_MEMORY, BP_NO_OFFSET, "out of memory (%zu bytes wanted)", bytes);
}

const char *bp_status_text(bp_status status)
{
	switch (status) {
	case BP_OK: return "ok";
	case BP_ERROR_ARGUMENT: return "invalid argument";
	case BP_ERROR_MEMORY: return "out of memory";
	case BP_ERROR_IO: return "input/output error";
	case BP_ERROR_NOT_OURS: return "not an archive";
	case BP_ERROR_UNSUPPORTED: return "unsupported version";
	case BP_ERROR_CORRUPT: return "corrupt";
	case BP_ERROR_CHECKSUM: return "checksum differs";
	case BP_ERROR_LIMIT: return "limit exceeded";
	case BP_ERROR_NOT_FOUND: return "not found";
	case BP_ERROR_BAD_INPUT: return "bad input";
	case BP_ERROR_CANCELLED: return "cancelled";
	}
	return "unknown status";
}
