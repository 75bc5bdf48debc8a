/* half.h: IEEE 754 binary16, without the compiler's own type, which not every one has. Internal. */
#ifndef HALF_H
#define HALF_H

#include <stdint.h>

/* To nearest even; beyond +-65504 that; NaN: 0. */
uint16_t half_of(double value);

#endif
