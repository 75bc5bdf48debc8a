/* journal_open.c: whose file it is, and what of it still counts. */
#include "journal.h"

#include "bytes.h"
#include "codec/profile_codec.h"
#include "error.h"
#include "memory.h"
#include "output_file.h"
#include "output_path.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char *journal_path(const char *target)
{
	char name[2 * OUTPUT_STEM_BYTES];
	output_path_stem(target, name);
	strcat(name, "journal");
	return output_path_beside(target, name);
}

static void header_make(const char *target, const struct fit_options *options, uint8_t out[JOURNAL_HEADER_BYTES])
{
	const struct profile_codec *codec = profile_codec_find(options->profile);
	const char *slash = strrchr(target, '/'), *name = slash ? slash + 1 : target;
	const size_t name_bytes = strlen(name);
	uint64_t bound;
	memcpy(&bound, &options->max_error, sizeof bound);
	const uint32_t words[] = {JOURNAL_VERSION,         (uint32_t)options->profile, codec ? codec->version : 0,
	                          options->budget_bytes,   (uint32_t)options->effort,  (uint32_t)bound,
	                          (uint32_t)(bound >> 32), (uint32_t)name_bytes};
	uint8_t *at = out + JOURNAL_MAGIC_BYTES;
	memset(out, 0, JOURNAL_HEADER_BYTES);
	memcpy(out, JOURNAL_MAGIC, JOURNAL_MAGIC_BYTES);
	for (size_t n = 0; n < sizeof words / sizeof *words; n++, at += 4)
		store_u32(at, words[n]);
	memcpy(at, name, name_bytes < 256 ? name_bytes : 256);
	store_u32(out + JOURNAL_HEADER_BYTES - 4, bytes_crc32(out, JOURNAL_HEADER_BYTES - 4));
}

/* Sizes up what follows the header: entries up to the first that is not whole. */
static bp_status entries_scan(struct journal *journal, uint64_t file_bytes, bp_error *error)
{
	uint8_t head[JOURNAL_ENTRY_BYTES], *record = NULL;
	size_t room = 0;
	bp_status status = BP_OK;

	while (!status && journal->bytes + sizeof head <= file_bytes) {
		struct record_head about;
		if (pread(journal->fd, head, sizeof head, (off_t)journal->bytes) != (ssize_t)sizeof head ||
		    memcmp(head, JOURNAL_MARK, 4) != 0)
			break;
		const uint32_t bytes = load_u32(head + 4);
		if (bytes > RECORD_BYTES_MAX || bytes > file_bytes - journal->bytes - sizeof head)
			break;
		if (!(record = memory_roomy(record, &room, bytes))) {
			status = error_memory(error, bytes);
			break;
		}
		const uint64_t offset = journal->bytes + sizeof head;
		if (journal_read(journal, offset, record, bytes, NULL) || record_head_read(record, bytes, &about, NULL) ||
		    about.record_bytes != bytes)
			break;
		struct journal_entry *more = memory_grown(journal->found, journal->found_count, sizeof *more);
		char *name = more ? strdup(about.name) : NULL;
		journal->found = more ? more : journal->found;
		if (!name) {
			status = error_memory(error, sizeof *more);
			break;
		}
		journal->found[journal->found_count++] = (struct journal_entry){.name = name, .offset = offset, .bytes = bytes};
		journal->bytes = offset + bytes;
	}
	free(record);
	return status;
}

static int entry_compare(const void *a, const void *b)
{
	const struct journal_entry *x = a, *y = b;
	const int names = strcmp(x->name, y->name);
	return names ? names : (x->offset > y->offset) - (x->offset < y->offset);
}

/* Empties the file but for the header. */
static bp_status begin(struct journal *journal, const uint8_t header[JOURNAL_HEADER_BYTES], bp_error *error)
{
	journal->bytes = JOURNAL_HEADER_BYTES;
	if (ftruncate(journal->fd, 0) == 0 && pwrite(journal->fd, header, JOURNAL_HEADER_BYTES, 0) == JOURNAL_HEADER_BYTES)
		return BP_OK;
	return error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "cannot write beside it: %s", strerror(errno ? errno : ENOSPC));
}

/* A journal that is ours by now, and what stands in it. */
static bp_status take_over(struct journal *journal, const uint8_t header[JOURNAL_HEADER_BYTES], const uint8_t *there,
                           uint64_t file_bytes, bool resume, char remark[JOURNAL_REMARK_BYTES], bp_error *error)
{
	const bool alike = !memcmp(there, header, JOURNAL_HEADER_BYTES), filled = file_bytes > JOURNAL_HEADER_BYTES;
	if (!resume || !alike) {
		if (filled)
			snprintf(remark, JOURNAL_REMARK_BYTES, "%s",
			         alike ? "records that an interrupted build had finished are dropped; --update would have gone on from them"
			               : "an interrupted build's finished records are dropped: other options, or another version, made them");
		return begin(journal, header, error);
	}
	journal->bytes = JOURNAL_HEADER_BYTES;
	bp_status status = entries_scan(journal, file_bytes, error);
	if (status)
		return status;
	if (journal->found_count > 0)
		qsort(journal->found, journal->found_count, sizeof *journal->found, entry_compare);
	if (journal->bytes < file_bytes) {
		snprintf(remark, JOURNAL_REMARK_BYTES,
		         "of an interrupted build's finished records %zu are whole; %llu bytes behind them are dropped",
		         journal->found_count, (unsigned long long)(file_bytes - journal->bytes));
		(void)!ftruncate(journal->fd, (off_t)journal->bytes);
	}
	return BP_OK;
}

enum claim { CLAIM_NEW, CLAIM_OLD, CLAIM_BUSY, CLAIM_FOREIGN, CLAIM_FAILED };

/* Creates the file, or opens the one that is there if it is a journal of this user's that nobody works with. */
static enum claim claim(const char *path, int *fd, uint64_t *file_bytes, uint8_t there[JOURNAL_HEADER_BYTES])
{
	struct stat about;
	enum { TRIES = 10 };

	for (int turn = 0; turn < TRIES; turn++) { /* between two calls another build may create or remove it */
		*fd = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
		const bool created = *fd >= 0;
		if (!created && errno != EEXIST)
			return CLAIM_FAILED;
		if (!created)
			*fd = open(path, O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
		if (*fd < 0 && errno == ENOENT)
			continue;
		if (*fd < 0 || fstat(*fd, &about) != 0 || !S_ISREG(about.st_mode) || about.st_uid != geteuid())
			return CLAIM_FOREIGN;
		const bool locked = output_path_lock(*fd) == 0; /* a folder without locks is legal: then the name alone has to do */
		if (!locked && (errno == EAGAIN || errno == EACCES))
			return CLAIM_BUSY;
		if (journal_has_name(*fd, path)) {
			memset(there, 0, JOURNAL_HEADER_BYTES);
			const ssize_t got = created ? 0 : pread(*fd, there, JOURNAL_HEADER_BYTES, 0);
			if (got < 0 || memcmp(there, JOURNAL_MAGIC, (size_t)(got < JOURNAL_MAGIC_BYTES ? got : JOURNAL_MAGIC_BYTES)) != 0)
				return CLAIM_FOREIGN;
			*file_bytes = fstat(*fd, &about) == 0 ? (uint64_t)about.st_size : 0;
			return created ? CLAIM_NEW : CLAIM_OLD;
		}
		close(*fd);
	}
	*fd = -1;
	return CLAIM_BUSY;
}

bp_status journal_open(const char *output, const struct fit_options *options, bool resume, struct journal *out,
                       char remark[JOURNAL_REMARK_BYTES], bp_error *error)
{
	uint8_t header[JOURNAL_HEADER_BYTES], there[JOURNAL_HEADER_BYTES];
	struct journal journal = {.fd = -1};
	uint64_t file_bytes = 0;
	struct stat about;
	char *target = NULL;
	enum claim claimed = CLAIM_FAILED;
	bool found;

	*remark = '\0';
	bp_status status = output_path_resolve(output, &target, &found, &about, error);
	if (status)
		goto out;
	header_make(target, options, header);
	if (!(journal.path = journal_path(target)))
		status = error_memory(error, strlen(target));
	free(target);
	if (status)
		goto out;
	claimed = claim(journal.path, &journal.fd, &file_bytes, there);
	if (claimed == CLAIM_NEW || claimed == CLAIM_OLD) {
		status = claimed == CLAIM_NEW ? begin(&journal, header, error)
		                              : take_over(&journal, header, there, file_bytes, resume, remark, error);
		goto out;
	}
	if (claimed == CLAIM_FAILED) {
		status = error_set(error, BP_ERROR_IO, BP_NO_OFFSET, "%s: cannot create: %s", journal.path, strerror(errno));
		goto out;
	}
	snprintf(remark, JOURNAL_REMARK_BYTES,
	         claimed == CLAIM_BUSY ? "another build to it is running; what this one has finished would not survive a kill"
	                               : "%s is in the way and is not removed; what is finished would not survive a kill",
	         journal.path);
	if (journal.fd >= 0)
		close(journal.fd);
	free(journal.path);
	journal = (struct journal){.fd = -1};
	status = output_scratch_open(output, &journal.fd, error);
out:
	if (!status) {
		*out = journal;
		return BP_OK;
	}
	if (claimed == CLAIM_OLD) { /* stays as it is: an older build's records may stand in what was not read */
		free(journal.path);
		journal.path = NULL;
	}
	journal_close(&journal, false);
	return status;
}
