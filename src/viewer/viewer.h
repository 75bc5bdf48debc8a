/*
 * viewer.h: the archive reader as WebAssembly calls it: handles, numbers and memory, for viewer.js.
 *
 * The page provides viewer_read. It may answer "not here yet": the call that wanted the bytes then fails with BP_ERROR_IO, the
 * page fetches them and calls again. Failures return 0 (a handle) or a bp_status; viewer_error has the text of the last one.
 */
#ifndef VIEWER_VIEWER_H
#define VIEWER_VIEWER_H

#include <stddef.h>
#include <stdint.h>

#define VIEWER_CALL __attribute__((used, visibility("default"))) /* the page calls it */

struct bp_archive;
struct viewer_material;

/* From the page: `count` bytes at `offset` of its source `source` into *to; 0, or anything else where they are not there. */
int viewer_read(uint32_t source, double offset, void *to, uint32_t count);

VIEWER_CALL const char *viewer_error(void);     /* the last failure's text */
VIEWER_CALL uint32_t viewer_error_status(void); /* its bp_status */
VIEWER_CALL double viewer_error_offset(void);   /* the byte in the file, or -1 */

VIEWER_CALL struct bp_archive *viewer_archive_open(uint32_t source, double bytes);
VIEWER_CALL void viewer_archive_close(struct bp_archive *archive);
VIEWER_CALL double viewer_archive_count(const struct bp_archive *archive);
/* Everything `verify --deep` checks; a status. */
VIEWER_CALL uint32_t viewer_archive_verify(const struct bp_archive *archive);
/* The number of a name, or -1. */
VIEWER_CALL double viewer_archive_find(const struct bp_archive *archive, const char *name);
/* Name, bytes and layers as JSON, valid until the next call; NULL on failure. */
VIEWER_CALL const char *viewer_archive_info(const struct bp_archive *archive, double index);

/*
 * Loads the first `layers` layers (0: all) of a material into the compact form; preview: every second value along each axis,
 * where there is such a half. viewer_measured: the same from the bytes of a MERL file.
 */
VIEWER_CALL struct viewer_material *viewer_material_load(const struct bp_archive *archive, double index, uint32_t layers,
                                                         uint32_t preview);
VIEWER_CALL struct viewer_material *viewer_measured(const uint8_t *bytes, uint32_t count);
VIEWER_CALL void viewer_material_free(struct viewer_material *material);

/*
 * Numbers that the shader needs, as floats: extents of theta_h, theta_d, phi_d; block stride of a pair of rows, of a slice;
 * width, half; first; mix[9]. 17 in all. The blocks themselves: viewer_material_blocks, viewer_material_bytes.
 */
VIEWER_CALL const float *viewer_material_numbers(const struct viewer_material *material);
VIEWER_CALL const uint8_t *viewer_material_blocks(const struct viewer_material *material);
VIEWER_CALL uint32_t viewer_material_bytes(const struct viewer_material *material);

/* f(wi, wo) of `count` pairs: pairs[6 count] in, rgb[3 count] out, in 1/sr. */
VIEWER_CALL void viewer_material_evaluate(const struct viewer_material *material, uint32_t count, const float *pairs, float *rgb);

/* The decoded table of `layers` layers (0: all): H D P values of R, of G, of B, in 1/sr as double; freed with viewer_free. */
VIEWER_CALL double *viewer_table(const struct bp_archive *archive, double index, uint32_t layers, uint32_t dims[3]);

/* Lights of `brdfpack render` (0 key, 1 env, 2 point): x, y, z, weight, 1 for a point, 5 floats each, in *lights. How many. */
VIEWER_CALL uint32_t viewer_lights(uint32_t lighting, float *lights);

VIEWER_CALL void *viewer_alloc(uint32_t bytes);
VIEWER_CALL void viewer_free(void *block);

#endif
