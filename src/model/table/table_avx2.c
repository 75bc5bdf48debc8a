/* The evaluation kernels of both memory forms, for processors with AVX2. */
#define KERNEL(name) name##_avx2
#include "expanded.inc.h"

#include "compact.inc.h"
#include "compact_row.inc.h"
