/*
 * stress_subject.h: packing one lattice and having its decoded values, in one call; and materials at work.
 */
#ifndef TESTS_STRESS_SUBJECT_H
#define TESTS_STRESS_SUBJECT_H

#include "codec/record.h"
#include "merl/carried.h"

/* A lattice packed and decoded again; free with packed_free. */
struct packed_table {
	bp_status status; /* of record_encode */
	struct record_head head;
	uint8_t *record;
	size_t record_bytes;
	struct expansion table; /* decoded from the record's bytes */
	double *value;          /* 3 * cells, in 1/sr */
};

/* As a build does: a record that comes with the lattice (carried; NULL: none) is kept where it serves, else the lattice is fitted. */
void packed_make(const struct lattice *lattice, const struct carried *carried, const char *name,
                 const struct fit_options *options, struct packed_table *out);
void packed_free(struct packed_table *packed);

/* Values that are negative, NaN or infinite. */
size_t packed_bad_values(const struct packed_table *packed);

/* What of a decoded table is packed again. */
enum decoded_form {
	DECODED_FILE,  /* as it is extracted, and read again: cells below the horizon invalid, and in them the record where it fits */
	DECODED_PLAIN, /* the same without the record */
	DECODED_WHOLE  /* the whole table, which no file holds */
};
/* What the file carries goes to *carried; the caller frees its bytes. */
void packed_to_lattice(const struct packed_table *packed, enum decoded_form form, struct lattice *out, struct carried *carried);

/*
 * Writes the records (ascending names) as an archive, verifies it deeply, loads every material in both forms with
 * sampling and evaluates `pairs` pairs of random directions. *bad counts values, weights and densities that are not
 * finite or negative; *asymmetric those that change when the directions change places; *refused what would not load.
 */
struct archive_outcome {
	size_t bad, asymmetric, refused;
};
void archive_exercise(const struct packed_table *packed, size_t count, unsigned pairs, struct archive_outcome *out);

#endif
