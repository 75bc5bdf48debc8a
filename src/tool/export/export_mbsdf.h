/* export_mbsdf.h: measured BSDFs of NVIDIA's Material Definition Language. */
#ifndef TOOL_EXPORT_EXPORT_MBSDF_H
#define TOOL_EXPORT_EXPORT_MBSDF_H

#include "export.h"

/* export_material and the bytes of its smallest file, of this format. */
uint64_t export_mbsdf_least(void);
bp_status export_mbsdf(const struct reflectance *reflectance, const char *name, const struct export_options *options,
                       struct byte_buffer *out, struct deviation *deviation, bp_error *error);

#endif
