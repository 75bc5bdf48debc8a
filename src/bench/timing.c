#include "timing.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "error.h"
#include "model/math/select.h"
#include "angles.h"

enum { READ_BYTES = 128 * 1024 };

double median_of(double *values, int count) { return select_kth(values, (size_t)count, (size_t)(count - 1) / 2); }

double uniform_next(unsigned long long *u)
{
	/* xorshift64* (Vigna 2016) */
	*u ^= *u >> 12;
	*u ^= *u << 25;
	*u ^= *u >> 27;
	return (double)(*u * 0x2545F4914F6CDD1D >> 11) * 0x1p-53;
}

void pairs_make(struct pairs *out)
{
	const double lowest = 3.0458649e-4; /* sin^2 of 1 degree */
	unsigned long long u = 1;

	for (int n = 0; n < 2 * PAIRS; n++) {
		double *w = n < PAIRS ? out->wi[n] : out->wo[n - PAIRS];
		double z2 = lowest + (1 - lowest) * uniform_next(&u), phi = 2 * M_PI * uniform_next(&u), r = sqrt(1 - z2);
		w[0] = r * cos(phi);
		w[1] = r * sin(phi);
		w[2] = sqrt(z2);
	}
}

/* The sum keeps the compiler from dropping the work, and shows what is not finite or negative. */
static bp_status check_sum(double sum, bool negative, bp_error *error)
{
	if (isfinite(sum) && !negative)
		return BP_OK;
	return error_set(error, BP_ERROR_CORRUPT, BP_NO_OFFSET, "an evaluation gave a value that is %s",
	                 negative ? "negative" : "not finite");
}

bp_status time_evaluation(evaluate_fn *evaluate, const void *state, const struct pairs *pairs, double *ns, bp_error *error)
{
	double seconds[REPEATS], sum = 0;
	bool negative = false;

	for (int r = 0; r < REPEATS; r++) {
		double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
		for (int n = 0; n < PAIRS; n++) {
			double rgb[3];
			evaluate(state, pairs->wi[n], pairs->wo[n], rgb);
			negative |= rgb[0] < 0 || rgb[1] < 0 || rgb[2] < 0;
			sum += rgb[0] + rgb[1] + rgb[2];
		}
		seconds[r] = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
	}
	*ns = median_of(seconds, REPEATS) / PAIRS * 1e9;
	return check_sum(sum, negative, error);
}

static size_t nearest_cell(struct lattice_dims dims, const double wi[3], const double wo[3])
{
	double at[3];

	lattice_coordinates(dims, wi, wo, at);
	return lattice_index(dims, (uint32_t)at[0], (uint32_t)at[1], (uint32_t)at[2]);
}

void evaluate_expansion(const void *state, const double wi[3], const double wo[3], double rgb[3])
{
	const struct expansion *table = state;
	const size_t cell = nearest_cell(table->dims, wi, wo);

	for (int c = 0; c < 3; c++)
		rgb[c] = table->unit * (double)table->rgb[c][cell];
}

void evaluate_lattice(const void *state, const double wi[3], const double wo[3], double rgb[3])
{
	const struct lattice *lattice = state;
	const size_t cell = nearest_cell(lattice->dims, wi, wo);

	for (int c = 0; c < 3; c++)
		rgb[c] = lattice->valid[cell] ? lattice->rgb[c][cell] : 0;
}

bp_status time_read(const char *path, double *seconds, uint8_t **bytes, size_t *count, bp_error *error)
{
	double start = clock_seconds(CLOCK_MONOTONIC);
	uint8_t *block = malloc(READ_BYTES), *whole = NULL;
	int file = open(path, O_RDONLY | O_CLOEXEC);
	struct stat info;
	size_t at = 0;
	ssize_t got;
	bp_status status = BP_OK;

	if (file < 0 || fstat(file, &info)) {
		status = error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: %s", path, strerror(errno));
		goto out;
	}
	if (!block || (bytes && !(whole = malloc((size_t)info.st_size + 1)))) {
		status = error_memory(error, (size_t)info.st_size);
		goto out;
	}
	while ((got = read(file, block, READ_BYTES)) > 0) {
		if (whole && at + (size_t)got <= (size_t)info.st_size)
			memcpy(whole + at, block, (size_t)got);
		at += (size_t)got;
	}
	if (got < 0 || at != (size_t)info.st_size) {
		status = error_set(error, BP_ERROR_IO, at, "%s: read %zu of %lld bytes", path, at, (long long)info.st_size);
		goto out;
	}
	*seconds = clock_seconds(CLOCK_MONOTONIC) - start;
	*count = at;
	if (bytes) {
		*bytes = whole;
		whole = NULL;
	}
out:
	if (file >= 0)
		close(file);
	free(block);
	free(whole);
	return status;
}
