#include "watch.h"

#include "error.h"

bp_status watch_tell(const struct watch *watch, double share, bp_error *error)
{
	if (!watch || watch->tell(watch->user, share) == 0)
		return BP_OK;
	return error_set(error, BP_ERROR_CANCELLED, BP_NO_OFFSET, "cancelled by the caller");
}
