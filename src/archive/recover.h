/*
 * recover.h: a new archive from the records of a damaged one, found by scanning.
 *
 * Header and index are not needed: a record begins with its magic and carries its length, its name and its
 * checksums. Where index pages have survived, their names tell what else there was.
 */
#ifndef ARCHIVE_RECOVER_H
#define ARCHIVE_RECOVER_H

#include "brdfpack.h"

struct recovery {
	uint64_t saved; /* records, each once */
	uint64_t lost;  /* materials that are known to have been there, by a record's head, the index, or the header's count */
};

/*
 * Is told of each material that is lost (with the offset of the damage where known) and of each second copy that is not saved;
 * once, without a name, of those that the header alone tells of. NULL: nobody is told.
 */
typedef void recover_report_fn(void *user, const char *material, const bp_error *why);

/*
 * Saves every record of the file at `damaged` whose checksums all hold into a new archive at `path`, which is
 * put in its place at the end, even of the damaged one. Of two records of one name the first in the file is saved. The bytes of
 * the records are not changed. BP_ERROR_NOT_FOUND when there is no intact record at all; then nothing is written. BP_OK may come
 * with a warning in *error, as from archive_writer_commit.
 */
bp_status archive_recover(const char *damaged, const char *path, recover_report_fn *report, void *user, struct recovery *out,
                          bp_error *error);

#endif
