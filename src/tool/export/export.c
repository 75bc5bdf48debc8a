#include "export.h"

#include "model/table/table.h"

enum { USUAL_BSDF = 2000000, USUAL_SPECTRAL = 8000000, USUAL_MBSDF = 20000000 };

uint64_t export_bytes_usual(enum export_format format, bool spectral)
{
	return format == EXPORT_MBSDF ? USUAL_MBSDF : spectral ? USUAL_SPECTRAL : USUAL_BSDF;
}

uint64_t export_bytes_least(enum export_format format, bool spectral)
{
	return format == EXPORT_MBSDF ? export_mbsdf_least() : export_bsdf_least(spectral);
}

static void table_look_up(const void *user, size_t count, const float *const wi[3], const float *const wo[3], float *const rgb[3])
{
	table_evaluate_batch(user, count, wi, wo, rgb);
}

bp_status export_material(const struct model *model, const char *name, const struct export_options *options,
                          struct byte_buffer *out, struct deviation *deviation, bp_error *error)
{
	struct table *table = NULL;
	bp_status status = table_build_model(model, false, TABLE_EXPANDED, 3, &table, error);
	const struct reflectance reflectance = {table_look_up, table};
	if (!status)
		status = options->format == EXPORT_MBSDF ? export_mbsdf(&reflectance, name, options, out, deviation, error)
		                                         : export_bsdf(&reflectance, name, options, out, deviation, error);
	table_free(table);
	return status;
}
