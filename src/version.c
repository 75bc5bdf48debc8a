/* What can be asked of the library itself. */
#include <stdlib.h>

#include "brdfpack.h"

#define TEXT_OF(number) #number
#define TEXT(number) TEXT_OF(number)

int bp_version(void) { return BP_VERSION_NUMBER; }

const char *bp_version_text(void)
{
	/* of the numbers, so that a test tells where they and BP_VERSION differ */
	return TEXT(BP_VERSION_MAJOR) "." TEXT(BP_VERSION_MINOR) "." TEXT(BP_VERSION_PATCH);
}

void bp_free(void *block) { free(block); }
