/* The evaluation kernels of both memory forms, for any processor. */
#define KERNEL(name) name##_plain
#include "expanded.inc.h"

#include "compact.inc.h"
#include "compact_row.inc.h"
