/*
 * rgl_file.h: tensor files of the RGL database as measured files (rgl/tensor_file.h has the layout).
 */
#ifndef MERL_RGL_FILE_H
#define MERL_RGL_FILE_H

#include "input.h"
#include "rgl/tensor_file.h"

/* A larger file is refused. The published isotropic ones have 0.7 (RGB) to some 10 MB (spectra). */
enum { RGL_FILE_BYTES_MAX = 64 << 20 };

/*
 * The rest of a stream that began with `head`, the magic: the whole file is read into memory, and its material evaluated on
 * MERL's lattice (rgl_lattice.h). Takes at most 14 times the file's bytes beside the lattice. An anisotropic material is refused
 * as soon as its table of fields is there. BP_ERROR_BAD_INPUT names the field.
 */
bp_status rgl_file_read(struct input *in, const uint8_t head[TENSOR_MAGIC_BYTES], struct lattice *out, struct origin *origin,
                        bp_error *error);

#endif
