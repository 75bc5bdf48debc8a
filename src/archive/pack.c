/* Packing from memory: the caller's table -> lattice -> record. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "codec/record_carried.h"
#include "environment.h"
#include "error.h"

_Static_assert((int)BP_ZEROS_HOLES == (int)ZEROS_HOLES && (int)BP_ZEROS_MEASURED == (int)ZEROS_MEASURED,
               "the public rules for zeros");

enum { CHANNELS = 3, EFFORT_MOST = 9 };
#define ERROR_LEAST 1e-6
#define ERROR_MOST 10.0
#define VALUE_MOST 0x1p1015 /* 1/sr, beyond what a MERL file can say: sums and ratios of a few such values are still numbers */

static bp_status options_read(const bp_pack_options *options, struct fit_options *fit, bp_error *error)
{
	static const bp_pack_options USUAL = {.struct_bytes = sizeof USUAL};
	options = options ? options : &USUAL;
	if (options->struct_bytes != sizeof *options)
		return error_argument(error, "struct_bytes is %zu, not sizeof(bp_pack_options) = %zu", options->struct_bytes,
		                      sizeof *options);
	if (options->profile && options->profile != PROFILE_PAPER && options->profile != PROFILE_SPECTRAL)
		return error_argument(error, "there is no profile %u; 1 is paper, 2 spectral", options->profile);
	if (options->budget_bytes && (options->budget_bytes < RECORD_BUDGET_MIN || options->budget_bytes > RECORD_BUDGET_MAX))
		return error_argument(error, "a budget of %u bytes: %d to %d are possible", options->budget_bytes, RECORD_BUDGET_MIN,
		                      RECORD_BUDGET_MAX);
	if (options->max_error != 0 && !(options->max_error >= ERROR_LEAST && options->max_error <= ERROR_MOST))
		return error_argument(error, "an error bound of %g: %g to %g are possible", options->max_error, ERROR_LEAST, ERROR_MOST);
	if (options->budget_bytes && options->max_error != 0)
		return error_argument(error, "a budget and an error bound exclude each other");
	if (options->effort > EFFORT_MOST)
		return error_argument(error, "an effort of %u: 1 to %d are possible", options->effort, EFFORT_MOST);
	if (options->zeros > BP_ZEROS_MEASURED)
		return error_argument(error, "there is no rule %u for zeros; 0 is auto, 1 holes, 2 measured", options->zeros);
	*fit = (struct fit_options){
		.profile = options->profile ? (enum profile)options->profile : PROFILE_SPECTRAL,
		.budget_bytes = options->max_error > 0  ? RECORD_BUDGET_MAX
	                    : options->budget_bytes ? options->budget_bytes
	                                            : BUDGET_USUAL,
		.max_error = options->max_error,
		.effort = options->effort ? (int)options->effort : EFFORT_USUAL,
		.zeros = (enum zeros_rule)options->zeros,
	};
	return BP_OK;
}

static bp_status measured_check(const bp_measured *measured, bp_error *error)
{
	if (!measured || measured->struct_bytes != sizeof *measured)
		return error_argument(error, "struct_bytes is not set to sizeof(bp_measured)");
	if (!measured->values)
		return error_argument(error, "there are no values");
	if (measured->number != BP_NUMBER_FLOAT && measured->number != BP_NUMBER_DOUBLE)
		return error_argument(error, "measured values are float or double, not of kind %d", (int)measured->number);
	if (measured->layout != BP_LAYOUT_PLANES && measured->layout != BP_LAYOUT_INTERLEAVED)
		return error_argument(error, "there is no layout %d", (int)measured->layout);
	for (int c = 0; c < CHANNELS; c++)
		if (!(measured->scale[c] >= 0 && measured->scale[c] <= 1e300))
			return error_argument(error, "channel %d has the scale %g", c, measured->scale[c]);
	return BP_OK;
}

/* Channel c in 1/sr, finite values up to VALUE_MOST, and what the mask takes out as not measured. */
static void plane_copy(const bp_measured *measured, size_t cells, int c, double scale, double *plane)
{
	const size_t step = measured->layout == BP_LAYOUT_INTERLEAVED ? CHANNELS : 1;
	const size_t first = measured->layout == BP_LAYOUT_INTERLEAVED ? (size_t)c : (size_t)c * cells;
	for (size_t n = 0; n < cells; n++) {
		const size_t at = first + n * step;
		const double value = scale * (measured->number == BP_NUMBER_DOUBLE ? ((const double *)measured->values)[at]
		                                                                   : (double)((const float *)measured->values)[at]);
		plane[n] = measured->mask && !measured->mask[n] ? -1 : value > VALUE_MOST && value <= DBL_MAX ? VALUE_MOST : value;
	}
}

static bp_status lattice_make(const bp_measured *measured, struct lattice *lattice, bp_error *error)
{
	const struct lattice_dims dims = {measured->theta_h, measured->theta_d, measured->phi_d};
	const bool unscaled = measured->scale[0] == 0 && measured->scale[1] == 0 && measured->scale[2] == 0;
	const bp_status status = lattice_alloc(dims, lattice, error);
	if (status)
		return status;
	for (int c = 0; c < CHANNELS; c++)
		plane_copy(measured, lattice_cells(dims), c, unscaled ? 1 : measured->scale[c], lattice->rgb[c]);
	lattice_validate(lattice);
	return BP_OK;
}

/* What an extracted file's values carry below the horizon, found as they lie in the file only. The caller frees *carried. */
static bp_status carried_take(const bp_measured *measured, size_t cells, struct carried *carried, bp_error *error)
{
	struct carried_reader reader = {.values = CHANNELS * cells};
	if (measured->number != BP_NUMBER_DOUBLE || measured->layout != BP_LAYOUT_PLANES || measured->mask)
		return BP_OK;
	const bool found = carried_read(&reader, measured->values, reader.values);
	if (found && reader.whole)
		*carried = (struct carried){reader.bytes, reader.count};
	else
		free(reader.bytes);
	return found ? BP_OK : error_memory(error, reader.count);
}

/* The record that came with the lattice, if it still is that table's, as `build` does; or one that is fitted. */
static bp_status record_make(const bp_measured *measured, const struct lattice *lattice, const struct holes *holes,
                             const char *name, const struct fit_options *options, uint8_t **record, size_t *record_bytes,
                             bp_error *error)
{
	struct record_source source = {
		.bytes = measured->source_bytes, .nonfinite_count = lattice->nonfinite_count, .hole_count = (uint32_t)holes->count};
	struct carried carried = {0};
	uint8_t *kept = NULL;
	size_t kept_bytes = 0;
	memcpy(source.sha256, measured->source_sha256, sizeof source.sha256);
	bp_status status = carried_take(measured, lattice_cells(lattice->dims), &carried, error);
	if (!status)
		status = record_carried(lattice, &carried, name, options, &kept, &kept_bytes, error);
	free(carried.bytes);
	if (!status && kept) {
		*record = kept;
		*record_bytes = kept_bytes;
	} else if (!status) {
		status = record_encode(lattice, name, &source, options, record, record_bytes, NULL, error);
	}
	return status;
}

bp_status bp_pack(const bp_measured *measured, const char *name, const bp_pack_options *options, uint8_t **record,
                  size_t *record_bytes, bp_error *error)
{
	struct fit_options fit;
	struct lattice lattice = {0};
	struct holes holes;
	fenv_t before;

	if (!name || !record || !record_bytes)
		return error_argument(error, "a name, and places for the record and its size are needed");
	bp_status status = measured_check(measured, error);
	if (!status)
		status = options_read(options, &fit, error);
	if (status)
		return status;
	const struct watch watch = {options ? options->progress : NULL, options ? options->user : NULL};
	fit.watch = watch.tell ? &watch : NULL;
	environment_enter(&before);
	status = watch_tell(fit.watch, 0, error);
	if (!status)
		status = lattice_make(measured, &lattice, error);
	if (!status)
		status = lattice_take_holes(&lattice, fit.zeros, &holes, error);
	if (!status)
		status = record_make(measured, &lattice, &holes, name, &fit, record, record_bytes, error);
	lattice_free(&lattice);
	environment_leave(&before);
	return status;
}

bp_status bp_record_rename(const uint8_t *record, size_t record_bytes, const char *name, uint8_t **out, size_t *out_bytes,
                           bp_error *error)
{
	if (!record || !name || !out || !out_bytes)
		return error_argument(error, "a record, a name, and places for the copy and its size are needed");
	return record_rename(record, record_bytes, name, out, out_bytes, error);
}
