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

/* PSNR in dB, of spheres under point and key lights, that a file's resolution is chosen for. */
#define EXPORT_PSNR 50.0
enum { EXPORT_BYTES_MAX = 1 << 30 };

/*
 * Appends the file of a material to *out: the smallest that reaches EXPORT_PSNR, else the one of most_bytes that comes nearest. *psnr is what
 * it reaches. After a failure *out holds nothing of use. BP_ERROR_BAD_INPUT: values beyond what a float holds. BP_ERROR_MEMORY.
 */
bp_status export_material(const struct model *model, const char *name, const struct export_options *options,
                          struct byte_buffer *out, double *psnr, bp_error *error);

#endif
