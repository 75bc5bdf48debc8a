/*
 * merl_file.h: the MERL file format: three little-endian int32 (90 90 180), then the planes
 * R, G, B of float64, theta_h slowest and phi_d fastest; stored value * MERL_SCALE[c] is 1/sr.
 */
#ifndef MERL_MERL_FILE_H
#define MERL_MERL_FILE_H

#include "carried.h"
#include "lattice.h"
#include "origin.h"
#include "output_file.h"

/* Bytes of a file with these extents: 12 + 24 * cells. MERL: 34,992,012. */
uint64_t merl_file_bytes(struct lattice_dims dims);

/* Delivers up to `capacity` bytes; *read = 0 at the end. Returns a status. */
typedef bp_status merl_read_fn(void *user, void *bytes, size_t capacity, size_t *read, bp_error *error);
/* Is shown every byte of the file, in order (for a checksum). */
typedef void merl_seen_fn(void *user, const void *bytes, size_t count);

/* How a file is read; a zeroed struct, or NULL in its place, is a plain reading of MERL's own extents. */
struct merl_reading {
	merl_seen_fn *seen; /* NULL: nobody looks on */
	void *seen_user;
	bool any_dims;           /* accept any legal extents */
	struct carried *carried; /* NULL, or for what the file carries (carried.h), unchecked; set on success, the caller frees it */
	struct origin *origin;   /* NULL, or where to say what kind of file it was; set on success */
	uint64_t *file_bytes;    /* NULL, or where to put the file's size; set on success */
};

/*
 * Reads one measured file from a stream to its end. Its first twelve bytes say what it is, whatever it is called:
 *
 * - a MERL file, header `90 90 180` (any legal extents when any_dims, but for the next kind's);
 * - a MERL-like one of `90 90 360`, whose two halves of phi_d have to agree (two_halves.h);
 * - a tensor file of the RGL database, evaluated on MERL's lattice (rgl_file.h, rgl_lattice.h).
 *
 * Refuses (BP_ERROR_BAD_INPUT, with expected and found, or what the file is instead) any other, a short stream, trailing bytes
 * of a table, no valid cell at all. The error's offset is where the file ends or should, or where it is wrong. On success the
 * caller owns *out.
 */
bp_status lattice_read(merl_read_fn *read, void *user, const struct merl_reading *reading, struct lattice *out, bp_error *error);
/*
 * The same for a regular file of the file system; a FIFO, a device or a folder is refused without
 * waiting. Messages do not repeat the path: the caller puts it in front.
 */
bp_status lattice_read_path(const char *path, const struct merl_reading *reading, struct lattice *out, bp_error *error);

/*
 * Writes a decoded table as a MERL file: unit * value / MERL_SCALE (DBL_MAX where that would overflow), but -1 where
 * below[cell]. These cells carry the `carried` bytes (carried.h; NULL: none) where they have the room, and are then
 * from -1.0625 to -1. What happens to a file that is there, the rule says (output_file.h); errors name the path.
 */
bp_status lattice_write_path(const char *path, enum output_rule rule, const struct expansion *table, const uint8_t *below,
                             const uint8_t *carried, size_t carried_bytes, bp_error *error);

/* Is the lattice, of the table's extents, what reading such a file gives: the same cells valid, the same values to the bit? */
bool lattice_is_written(const struct lattice *lattice, const struct expansion *table, const uint8_t *below);

/*
 * Writes a lattice as a MERL file: the planes / MERL_SCALE, but -1 in every channel of a cell that is
 * not valid and negative in none.
 */
bp_status lattice_save_path(const char *path, enum output_rule rule, const struct lattice *lattice, bp_error *error);

#endif
