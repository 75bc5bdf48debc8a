/*
 * watch.h: who is told how far a long piece of work is, and may end it. Internal.
 */
#ifndef WATCH_H
#define WATCH_H

#include "error.h"

struct watch {
	bp_progress_fn *tell; /* not NULL */
	void *user;
};

/* Tells `share` of the work, 0 to 1: BP_OK to go on, or BP_ERROR_CANCELLED. NULL: nobody watches. */
static inline bp_status watch_tell(const struct watch *watch, double share, bp_error *error)
{
	if (!watch || watch->tell(watch->user, share) == 0)
		return BP_OK;
	return error_set(error, BP_ERROR_CANCELLED, BP_NO_OFFSET, "cancelled by the caller");
}

#endif
