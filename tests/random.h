/* random.h: numbers that look random and are the same in every run; RANDOM_SEED before it begins another sequence. */
#ifndef TESTS_RANDOM_H
#define TESTS_RANDOM_H

#include <stdint.h>

#ifndef RANDOM_SEED
#define RANDOM_SEED 5
#endif

static uint64_t state = RANDOM_SEED;
__attribute__((unused)) static double uniform(void)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

#endif
