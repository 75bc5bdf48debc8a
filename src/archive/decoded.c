/* Decoded tables in the layouts that brdfpack.h describes. */
#include <float.h>
#include <stdlib.h>

#include "environment.h"
#include "error.h"
#include "half.h"
#include "reader.h"

enum { CHANNELS = 3 };

/* 0: there is no such number. */
static size_t number_bytes(bp_number number)
{
	static const size_t BYTES[] = {
		[BP_NUMBER_FLOAT] = sizeof(float), [BP_NUMBER_DOUBLE] = sizeof(double), [BP_NUMBER_HALF] = sizeof(uint16_t)};
	return (size_t)number < sizeof BYTES / sizeof *BYTES ? BYTES[number] : 0;
}

size_t bp_table_bytes(uint32_t theta_h, uint32_t theta_d, uint32_t phi_d, const bp_table_options *options)
{
	const struct lattice_dims dims = {theta_h, theta_d, phi_d};
	return lattice_dims_legal(dims) ? lattice_cells(dims) * CHANNELS * number_bytes(options ? options->number : BP_NUMBER_FLOAT)
	                                : 0;
}

static bp_status options_check(const bp_table_options *options, bp_error *error)
{
	if (options->struct_bytes != sizeof *options)
		return error_argument(error, "struct_bytes is %zu, not sizeof(bp_table_options) = %zu", options->struct_bytes,
		                      sizeof *options);
	if (!number_bytes(options->number))
		return error_argument(error, "there is no kind of number %d", (int)options->number);
	if (options->layout != BP_LAYOUT_PLANES && options->layout != BP_LAYOUT_INTERLEAVED)
		return error_argument(error, "there is no layout %d", (int)options->layout);
	if (options->continued != 0 && options->continued != 1)
		return error_argument(error, "continued is %d, it must be 0 or 1", options->continued);
	if (!(options->max_log_rmse >= 0))
		return error_argument(error, "max_log_rmse is %g, it must be 0 or more", options->max_log_rmse);
	return BP_OK;
}

/* Channel c of the table; below: NULL, or where -1 belongs. */
static void channel_put(const struct expansion *table, int c, const uint8_t *below, const bp_table_options *options, void *values)
{
	const size_t cells = lattice_cells(table->dims), step = options->layout == BP_LAYOUT_INTERLEAVED ? CHANNELS : 1;
	const size_t first = options->layout == BP_LAYOUT_INTERLEAVED ? (size_t)c : (size_t)c * cells;
	for (size_t n = 0; n < cells; n++) {
		const double value = below && below[n] ? -1 : table->unit * (double)table->rgb[c][n];
		const size_t at = first + n * step;
		if (options->number == BP_NUMBER_DOUBLE)
			((double *)values)[at] = value <= DBL_MAX ? value : DBL_MAX;
		else if (options->number == BP_NUMBER_FLOAT)
			((float *)values)[at] = value <= (double)FLT_MAX ? (float)value : FLT_MAX;
		else
			((uint16_t *)values)[at] = half_of(value);
	}
}

static bp_status table_put(const struct expansion *table, double horizon_limit, const bp_table_options *options, void *values,
                           bp_error *error)
{
	uint8_t *below = NULL;
	if (!options->continued) {
		below = malloc(lattice_cells(table->dims));
		if (!below)
			return error_memory(error, lattice_cells(table->dims));
		lattice_below_horizon(table->dims, horizon_limit, below);
	}
	for (int c = 0; c < CHANNELS; c++)
		channel_put(table, c, below, options, values);
	free(below);
	return BP_OK;
}

bp_status bp_archive_table(const bp_archive *archive, uint64_t index, const bp_table_options *options, void *values, size_t bytes,
                           bp_error *error)
{
	const bp_table_options usual = {.struct_bytes = sizeof usual};
	struct index_entry entry;
	struct record_head head;
	struct expansion table = {0};
	fenv_t before;

	options = options ? options : &usual;
	bp_status status = options_check(options, error);
	if (!status)
		status = archive_record_head(archive, index, &entry, &head, error);
	if (status)
		return status;
	const size_t wanted = bp_table_bytes(head.dims.theta_h, head.dims.theta_d, head.dims.phi_d, options);
	if (!values || bytes != wanted)
		return error_argument(error, "%s: a table of %u x %u x %u cells takes %zu bytes, there is room for %zu", head.name,
		                      head.dims.theta_h, head.dims.theta_d, head.dims.phi_d, wanted, values ? bytes : 0);
	environment_enter(&before);
	status = archive_entry_expand(archive, &entry, &head, record_layers_for(&head, options->max_log_rmse), &table, error);
	if (!status)
		status = table_put(&table, head.horizon_limit, options, values, error);
	expansion_free(&table);
	environment_leave(&before);
	return status;
}
