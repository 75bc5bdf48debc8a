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

#include "record.h"

/*
 * The record that the lattice carries, with this name and source, these options, and the errors against this very table, which are
 * rounding errors: *record is malloc'ed. It is NULL where there is none to keep: nothing is carried or it is damaged, it does not
 * decode to exactly this lattice, it is of another profile, it does not fit options->budget_bytes, or another max_error is asked for
 * (a smaller record might do then).
 */
bp_status record_carried(const struct lattice *lattice, const char *name, const struct record_source *source,
                         const struct fit_options *options, uint8_t **record, size_t *record_bytes, bp_error *error);

#endif
