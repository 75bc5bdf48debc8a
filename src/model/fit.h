/* fit.h: what a fit is asked for, and a limit that all wings keep. */
#ifndef MODEL_FIT_H
#define MODEL_FIT_H

#include <stdint.h>

#include "merl/holes.h"
#include "watch.h"

enum profile { PROFILE_PAPER = 1, PROFILE_SPECTRAL = 2 };
enum { LAYERS_MAX = 16 };
enum { BUDGET_USUAL = 60400, EFFORT_USUAL = 5 }; /* where nothing else is asked for */

struct fit_options {
	enum profile profile;
	uint32_t budget_bytes;     /* largest record, everything included */
	double max_error;          /* > 0: instead, the smallest record whose log RMSE is at most this */
	int effort;                /* 1..9 */
	enum zeros_rule zeros;     /* what was done before the fit (merl/holes.h): a fit sees the lattice that came of it */
	const struct watch *watch; /* NULL: nobody; not a part of what a record says */
};

#endif
