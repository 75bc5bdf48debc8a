/*
 * record_carried.h: a table that was decoded from a record, and comes with it, keeps it.
 *
 *     archive -> extract -> MERL file that carries its record (../merl/carried.h) -> build -> archive
 *
 * Packed like a measurement a decoded table would lose a little with every turn. Its record says exactly what is in it,
 * provided that nobody has changed a value since; that is checked cell by cell.
 */
#ifndef CODEC_RECORD_CARRIED_H
#define CODEC_RECORD_CARRIED_H

#include "merl/carried.h"
#include "record.h"

/*
 * The record that came with the lattice, byte for byte but for the name: source, options and errors stay those of the measured
 * file that it was made from. *record is malloc'ed, or NULL where the lattice has to be fitted, because
 *
 * - nothing is carried, or the record is damaged, or one of its layers does not decode;
 * - it does not decode to this lattice: the same cells valid, the same values to the bit as they are read;
 * - it is of another profile than options->profile, or larger than options->budget_bytes;
 * - with options->max_error > 0, which lets the budget not count: it was not made for that very bound. A smaller record might do.
 *
 * Fails only where memory runs out.
 */
bp_status record_carried(const struct lattice *lattice, const struct carried *carried, const char *name,
                         const struct fit_options *options, uint8_t **record, size_t *record_bytes, bp_error *error);

#endif
