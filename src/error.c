#include "error.h"

#include <stdarg.h>
#include <stdio.h>

#include "shown.h"

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
		shown_text(error->message, sizeof error->message, text); /* whatever names and paths stand in it */
	}
	return status;
}

bp_status error_shift(bp_status status, uint64_t base, bp_error *error)
{
	if (status && error && error->offset != BP_NO_OFFSET)
		error->offset += base;
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
