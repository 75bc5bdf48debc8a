#include "select.h"

static void swap(double *a, double *b)
{
	double t = *a;
	*a = *b;
	*b = t;
}

/* Hoare's selection with the median of three as pivot: equal values do no harm. */
double select_kth(double *v, size_t n, size_t k)
{
	size_t left = 0, right = n - 1;

	while (left < right) {
		size_t middle = left + (right - left) / 2;
		if (v[middle] < v[left])
			swap(&v[middle], &v[left]);
		if (v[right] < v[left])
			swap(&v[right], &v[left]);
		if (v[right] < v[middle])
			swap(&v[right], &v[middle]);
		const double pivot = v[middle];
		size_t i = left, j = right;
		for (;;) {
			while (v[i] < pivot)
				i++;
			while (pivot < v[j])
				j--;
			if (i >= j)
				break;
			swap(&v[i], &v[j]);
			i++;
			j--;
		}
		/* v[left..j] <= pivot <= v[j+1..right] */
		if (k <= j)
			right = j;
		else
			left = j + 1;
	}
	return v[k];
}
