/* export_bsdf.h: tensor files of the RGL database. */
#ifndef TOOL_EXPORT_EXPORT_BSDF_H
#define TOOL_EXPORT_EXPORT_BSDF_H

#include "export.h"

/* export_material and the bytes of its smallest file, of this format. */
uint64_t export_bsdf_least(bool spectral);
bp_status export_bsdf(const struct reflectance *reflectance, const char *name, const struct export_options *options,
                      struct byte_buffer *out, struct deviation *deviation, bp_error *error);

#endif
