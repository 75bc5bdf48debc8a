/*
 * export.h: a material in the file formats of renderers: what `extract --format bsdf` and `--format mbsdf` write.
 *
 * format-spec/RENDERERS.md has the layouts, their sources, and how the resolution is chosen.
 */
#ifndef TOOL_EXPORT_EXPORT_H
#define TOOL_EXPORT_EXPORT_H

#include <stdbool.h>

#include "brdfpack.h"
#include "bytes.h"
#include "deviation.h"
#include "model/model.h"

enum export_format { EXPORT_BSDF, EXPORT_MBSDF };

struct export_options {
	enum export_format format;
	bool spectral;       /* EXPORT_BSDF: `spectra` and `wavelengths` instead of `rgb` */
	uint64_t most_bytes; /* of a file, at least export_bytes_least */
};

/* The largest file that is written unless told otherwise, and one that the smallest file of any material fits in. */
uint64_t export_bytes_usual(enum export_format format, bool spectral);
uint64_t export_bytes_least(enum export_format format, bool spectral);

enum { EXPORT_BYTES_MAX = 1 << 30 };

/*
 * Appends the file of a material to *out: the smallest that deviation_suffices of, else that of at most most_bytes with the
 * highest PSNR; *deviation is the one it has. After a failure *out holds nothing of use. BP_ERROR_BAD_INPUT: values beyond what a
 * float holds.
 */
bp_status export_material(const struct model *model, const char *name, const struct export_options *options,
                          struct byte_buffer *out, struct deviation *deviation, bp_error *error);

/* Of one format, the same and the bytes of any material's smallest file: tensor files of the RGL database. */
uint64_t export_bsdf_least(bool spectral);
bp_status export_bsdf(const struct reflectance *reflectance, const char *name, const struct export_options *options,
                      struct byte_buffer *out, struct deviation *deviation, bp_error *error);
/* Measured BSDFs of NVIDIA's Material Definition Language. */
uint64_t export_mbsdf_least(void);
bp_status export_mbsdf(const struct reflectance *reflectance, const char *name, const struct export_options *options,
                       struct byte_buffer *out, struct deviation *deviation, bp_error *error);

#endif
