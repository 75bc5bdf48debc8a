/*
 * record_measure.h: the errors of a record's layers, which are measured on what its own bytes decode to.
 */
#ifndef CODEC_RECORD_MEASURE_H
#define CODEC_RECORD_MEASURE_H

#include "section.h"

/*
 * Head and sections -> record (sections_join), with the figures of every layer against the lattice; *record is malloc'ed.
 * `decoded`: the model that they decode to, where the caller has it, or NULL.
 * `watch` is told before every layer.
 */
bp_status record_measure(struct record_head *head, const struct section_list *sections, const struct lattice *lattice,
                         const struct model *decoded, const struct watch *watch, uint8_t **record, size_t *record_bytes,
                         bp_error *error);

#endif
