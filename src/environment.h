/*
 * environment.h: arithmetic as it is meant, whatever the caller set.
 *
 * A host may round another way (FE_DOWNWARD) or flush denormals. What is decoded, packed or kept must not depend on that: the
 * public functions that do so stand between the two calls. Evaluation does not: it rounds as its caller wants.
 */
#ifndef ENVIRONMENT_H
#define ENVIRONMENT_H

#include <fenv.h>

/* To nearest, no exceptions trapped, denormals kept; *before is what was. */
static inline void environment_enter(fenv_t *before)
{
	fegetenv(before);
	fesetenv(FE_DFL_ENV);
}

static inline void environment_leave(const fenv_t *before) { fesetenv(before); }

#endif
