/*
 * random_tables.h: extents of all kinds, and numbers that look random and are the same in every run.
 */
#ifndef RANDOM_TABLES_H
#define RANDOM_TABLES_H

#include "merl/lattice.h"

static uint64_t state = 5;
static double uniform(void)
{
	state = state * 6364136223846793005u + 1442695040888963407u;
	return (double)(state >> 11) * 0x1p-53;
}

static const struct lattice_dims DIMS[] = {{4, 4, 4},   {5, 7, 9},    {15, 16, 5},  {16, 15, 6},
                                           {31, 33, 7}, {29, 18, 33}, {90, 30, 20}, {4, 60, 17}};
enum { DIMS_COUNT = sizeof DIMS / sizeof *DIMS };

#endif
