#include "journal.h"

#include "bytes.h"
#include "descriptor.h"
#include "error.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What an entry's head says of its record. */
static uint32_t entry_crc(const uint8_t head[JOURNAL_ENTRY_BYTES], const uint8_t *record, size_t record_bytes)
{
	return bytes_crc32_more(bytes_crc32(head + 4, 4), record, record_bytes);
}

bp_status journal_add(struct journal *journal, const uint8_t *record, size_t record_bytes, uint64_t *offset, bp_error *error)
{
	uint8_t head[JOURNAL_ENTRY_BYTES] = JOURNAL_MARK;
	store_u32(head + 4, (uint32_t)record_bytes);
	store_u32(head + 8, entry_crc(head, record, record_bytes));
	/* The head last: an entry without it is torn, whatever stands behind. */
	if (descriptor_write(journal->fd, record, record_bytes, (off_t)(journal->bytes + sizeof head)) < record_bytes ||
	    descriptor_write(journal->fd, head, sizeof head, (off_t)journal->bytes) < sizeof head)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot write beside it: %s", strerror(errno));
	*offset = journal->bytes + sizeof head;
	journal->bytes += sizeof head + record_bytes;
	journal->added++;
	return BP_OK;
}

bp_status journal_read(const struct journal *journal, uint64_t offset, uint8_t *record, uint32_t record_bytes, bp_error *error)
{
	uint8_t head[JOURNAL_ENTRY_BYTES];
	if (descriptor_read(journal->fd, head, sizeof head, (off_t)(offset - sizeof head)) < sizeof head ||
	    descriptor_read(journal->fd, record, record_bytes, (off_t)offset) < record_bytes)
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot read the finished records beside it: %s",
		                 strerror(errno ? errno : EIO));
	if (load_u32(head + 4) != record_bytes || load_u32(head + 8) != entry_crc(head, record, record_bytes))
		return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, /* no archive is damaged, and `recover` is no remedy */
		                 "the finished records beside it have changed while it ran; has another build the same output?");
	return BP_OK;
}

const struct journal_entry *journal_find(const struct journal *journal, const char *name)
{
	size_t low = 0, high = journal->found_count; /* the first whose name is behind: the one before it is the latest of the name */
	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (strcmp(journal->found[middle].name, name) <= 0)
			low = middle + 1;
		else
			high = middle;
	}
	return low > 0 && !strcmp(journal->found[low - 1].name, name) ? &journal->found[low - 1] : NULL;
}

bp_status journal_take(const struct journal *journal, const char *name, const struct record_source *source,
                       const struct fit_options *options, uint8_t **record, size_t *record_bytes, bp_error *error)
{
	const struct journal_entry *entry = journal_find(journal, name);
	struct record_head head;

	*record = NULL;
	if (!entry)
		return BP_OK;
	uint8_t *bytes = malloc(entry->bytes);
	if (!bytes)
		return error_memory(error, entry->bytes);
	bp_status status = journal_read(journal, entry->offset, bytes, entry->bytes, error);
	if (!status)
		status = record_verify(bytes, entry->bytes, &head, error);
	if (status || !record_answers(&head, source, options)) {
		free(bytes);
		return BP_OK;
	}
	*record = bytes;
	*record_bytes = entry->bytes;
	return BP_OK;
}

size_t journal_count(const struct journal *journal) { return journal->path ? journal->found_count + journal->added : 0; }

bool journal_has_name(int fd, const char *path)
{
	struct stat own, there;
	return fstat(fd, &own) == 0 && lstat(path, &there) == 0 && own.st_dev == there.st_dev && own.st_ino == there.st_ino;
}

void journal_close(struct journal *journal, bool keep)
{
	if (journal->fd >= 0 && journal->path) {
		if (keep && journal_count(journal) > 0)
			(void)!ftruncate(journal->fd, (off_t)journal->bytes); /* of what was begun there is no use */
		else if (journal_has_name(journal->fd, journal->path))    /* not what somebody else has put there meanwhile */
			unlink(journal->path);
	}
	if (journal->fd >= 0)
		close(journal->fd);
	for (size_t n = 0; n < journal->found_count; n++)
		free(journal->found[n].name);
	free(journal->found);
	free(journal->path);
	*journal = (struct journal){.fd = -1};
}
