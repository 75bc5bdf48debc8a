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

/* splitmix64 (Steele, Lea, Flood 2014), in [0, 1). */
static double random_unit(uint64_t *state)
{
	uint64_t z = *state += 0x9E3779B97F4A7C15;

	z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9;
	z = (z ^ z >> 27) * 0x94D049BB133111EB;
	return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

void pairs_make(struct pairs *out)
{
	const double lowest = 3.0458649e-4; /* sin^2 of 1 degree */
	uint64_t state = 1;

	for (int n = 0; n < 2 * PAIRS; n++) {
		double *w = n < PAIRS ? out->wi[n] : out->wo[n - PAIRS];
		double z2 = lowest + (1 - lowest) * random_unit(&state), phi = 2 * M_PI * random_unit(&state), r = sqrt(1 - z2);
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

bp_status time_model(const struct baseline *method, const void *state, const struct pairs *pairs, double *ns, bp_error *error)
{
	double seconds[REPEATS], sum = 0;
	bool negative = false;

	for (int r = 0; r < REPEATS; r++) {
		double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
		for (int n = 0; n < PAIRS; n++) {
			double rgb[3];
			method->evaluate(state, pairs->wi[n], pairs->wo[n], rgb);
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

bp_status time_table(const struct expansion *table, const struct pairs *pairs, double *ns, bp_error *error)
{
	double seconds[REPEATS], sum = 0;
	bool negative = false;

	for (int r = 0; r < REPEATS; r++) {
		double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
		for (int n = 0; n < PAIRS; n++) {
			size_t cell = nearest_cell(table->dims, pairs->wi[n], pairs->wo[n]);
			float red = table->rgb[0][cell], green = table->rgb[1][cell], blue = table->rgb[2][cell];
			negative |= red < 0 || green < 0 || blue < 0;
			sum += table->unit * (double)(red + green + blue);
		}
		seconds[r] = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
	}
	*ns = median_of(seconds, REPEATS) / PAIRS * 1e9;
	return check_sum(sum, negative, error);
}

bp_status time_raw_table(const struct lattice *lattice, const struct pairs *pairs, double *ns, bp_error *error)
{
	double seconds[REPEATS], sum = 0;

	for (int r = 0; r < REPEATS; r++) {
		double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
		for (int n = 0; n < PAIRS; n++) {
			size_t cell = nearest_cell(lattice->dims, pairs->wi[n], pairs->wo[n]);
			if (lattice->valid[cell])
				sum += lattice->rgb[0][cell] + lattice->rgb[1][cell] + lattice->rgb[2][cell];
		}
		seconds[r] = clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
	}
	*ns = median_of(seconds, REPEATS) / PAIRS * 1e9;
	return check_sum(sum, sum < 0, error);
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
