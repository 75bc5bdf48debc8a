#include "select.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Moves what comes before the pivot (smaller; or equal too) to the front of v[from..n-1] and returns where it ends. Every
 * value is exchanged, wanted or not: a branch on unsorted values is mispredicted every other time.
 */
static size_t partition(double *v, size_t from, size_t n, double pivot, bool equal)
{
	size_t end = from;
	for (size_t i = from; i < n; i++) {
		const double x = v[i];
		v[i] = v[end];
		v[end] = x;
		end += equal ? x <= pivot : x < pivot;
	}
	return end;
}

static double middle_of_three(double a, double b, double c)
{
	const double low = a < b ? a : b, high = a < b ? b : a;
	return c < low ? low : c > high ? high : c;
}

/*
 * Hoare's selection with the median of three as pivot; values equal to it are set aside where they are many. The three are
 * picked at random (by a generator that always begins alike): no order of the values makes that a bad choice again and again.
 */
double select_kth(double *v, size_t n, size_t k)
{
	size_t left = 0, right = n; /* v[k] belongs into v[left..right-1] */
	uint64_t state = 1;

	while (right - left > 1) {
		double picked[3];
		for (int p = 0; p < 3; p++) {
			state = state * 6364136223846793005u + 1442695040888963407u;
			picked[p] = v[left + (size_t)((state >> 32) * (uint64_t)(right - left) >> 32)];
		}
		const double pivot = middle_of_three(picked[0], picked[1], picked[2]);
		const size_t smaller = partition(v, left, right, pivot, false);
		if (k < smaller) {
			right = smaller;
			continue;
		}
		const size_t equal = partition(v, smaller, right, pivot, true);
		if (k < equal)
			return v[k];
		left = equal;
	}
	return v[k];
}
