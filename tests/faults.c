/*
 * faults.c: damaged archives, many loads, many threads. `faults [-x EVERY] [-r EVERY] WHAT FILE [N [SEED]]`:
 *
 *     truncate FILE   every length below the file's
 *     flip FILE       every bit
 *     mutate FILE N   N random mutations: bytes overwritten, cleared, moved, cut, appended; half of them with mended checksums
 *     load FILE N     N loads and frees; memory must not grow
 *     threads FILE N  eight threads that load and evaluate N materials each
 *
 * Damage must be detected, and a material that loads all the same must have the values it had; likewise one that is extracted
 * or recovered. (With mended checksums only: no crash, and values that are finite and not negative.) Each is opened, verified, loaded
 * and evaluated; every EVERY-th (1: all, unless told; 0: none) also listed and extracted (-x), and recovered (-r). None may take 20 s.
 */
#include <malloc.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "archive_walk.h"

enum { SEEN_MAX = 64, SECONDS_MAX = 20 };

struct subject {
	uint8_t *bytes;
	size_t count;
	struct walk_values *seen; /* of the intact archive, by name order */
	uint64_t seen_count;
	uint64_t *offset; /* of each material's record */
	int fd;           /* of the damaged copy */
	char path[64];
	size_t extract_every, rescue_every;
};

static void fail(const char *what, size_t where)
{
	fprintf(stderr, "faults: %s (at %zu)\n", what, where);
	exit(1);
}

/* For a walk that never ends: where it was. */
static volatile size_t walk_where;
static void hang_tell(int signal_number)
{
	(void)signal_number;
	dprintf(STDERR_FILENO, "faults: no end after %d s (at %zu)\n", SECONDS_MAX, walk_where);
	_exit(1);
}

static void subject_read(const char *path, struct subject *out)
{
	FILE *file = fopen(path, "rb");
	bp_archive *archive = NULL;
	if (!file || fseek(file, 0, SEEK_END) != 0 || bp_archive_open(path, &archive, NULL) != BP_OK)
		fail("the archive cannot be read", 0);
	out->count = (size_t)ftell(file);
	rewind(file);
	out->bytes = malloc(out->count);
	if (fread(out->bytes, 1, out->count, file) != out->count)
		fail("the archive cannot be read", 0);
	fclose(file);
	out->seen = calloc(bp_archive_count(archive), sizeof *out->seen);
	if (archive_walk(path, 0, bp_archive_count(archive), WALK_EXTRACT, out->seen, &out->seen_count) != BP_OK ||
	    out->seen_count != bp_archive_count(archive))
		fail("the archive is damaged to begin with", 0);
	out->offset = calloc(out->seen_count, sizeof *out->offset);
	for (uint64_t m = 0; m < out->seen_count; m++) {
		bp_material_info info = {.struct_bytes = sizeof info};
		if (bp_archive_info(archive, m, &info, NULL) != BP_OK)
			fail("the archive is damaged to begin with", m);
		out->offset[m] = info.record_offset;
	}
	bp_archive_close(archive);
	out->fd = memfd_create("damaged", 0);
	snprintf(out->path, sizeof out->path, "/proc/self/fd/%d", out->fd);
	if (out->fd < 0 || pwrite(out->fd, out->bytes, out->count, 0) != (ssize_t)out->count)
		fail("no memory file", 0);
}

static int by_name(const void *a, const void *b)
{
	return strcmp(((const struct walk_values *)a)->name, ((const struct walk_values *)b)->name);
}

static void values_compare(const struct subject *s, const struct walk_values *seen, uint64_t count, size_t where)
{
	for (uint64_t i = 0; i < count; i++) {
		const struct walk_values *was = bsearch(&seen[i], s->seen, s->seen_count, sizeof *s->seen, by_name);
		if (!was || memcmp(was->rgb, seen[i].rgb, sizeof was->rgb) != 0)
			fail("another value without an error", where);
		if (seen[i].extracted && seen[i].extracted != was->extracted)
			fail("another extracted file without an error", where);
	}
}

enum damage { DAMAGE_ANY, DAMAGE_BIT, DAMAGE_MENDED };

/* What is recovered from the damaged copy. Of one bit's damage that is all but one material at most, and that one is told. */
static void damaged_rescue(const struct subject *s, uint64_t first, uint64_t most, enum damage damage, size_t where)
{
	static struct walk_values seen[SEEN_MAX];
	struct recovery saved = {0};
	uint64_t count;
	const bp_status status = archive_rescue(s->path, first, most, seen, &count, &saved);
	if (damage == DAMAGE_MENDED)
		return;
	if (saved.saved > 0 && status != BP_OK)
		fail("what was recovered is damaged", where);
	if (damage == DAMAGE_BIT && (saved.saved + saved.lost != s->seen_count || saved.lost > 1))
		fail("recovery lost too much, or did not say so", where);
	values_compare(s, seen, count, where);
}

/* Walks `most` materials of the damaged copy, from `first` on; n: which damage it is. */
static void damaged_walk(const struct subject *s, uint64_t first, uint64_t most, enum damage damage, size_t n, size_t where)
{
	static struct walk_values seen[SEEN_MAX];
	const bool extract = s->extract_every && n % s->extract_every == 0, rescue = s->rescue_every && n % s->rescue_every == 0;
	uint64_t count;
	walk_where = where;
	alarm(SECONDS_MAX);
	const bp_status status = archive_walk(s->path, first, most, extract ? WALK_LIST | WALK_EXTRACT : 0, seen, &count);
	if (damage != DAMAGE_MENDED) {
		if (status == BP_OK)
			fail("damage was not detected", where);
		values_compare(s, seen, count, where);
	}
	if (rescue)
		damaged_rescue(s, first, most, damage, where);
	alarm(0);
}

static void truncate_all(struct subject *s)
{
	for (size_t n = s->count; n-- > 0;) {
		if (ftruncate(s->fd, (off_t)n) != 0)
			fail("ftruncate", n);
		damaged_walk(s, 0, SEEN_MAX, DAMAGE_ANY, n, n);
	}
	printf("truncate: %zu lengths, all detected\n", s->count);
}

static void flip_all(struct subject *s)
{
	for (size_t bit = 0; bit < 8 * s->count; bit++) {
		const uint8_t byte = (uint8_t)(s->bytes[bit / 8] ^ 1 << bit % 8);
		if (pwrite(s->fd, &byte, 1, (off_t)(bit / 8)) != 1)
			fail("pwrite", bit);
		damaged_walk(s, 0, SEEN_MAX, DAMAGE_BIT, bit, bit / 8);
		if (pwrite(s->fd, &s->bytes[bit / 8], 1, (off_t)(bit / 8)) != 1)
			fail("pwrite", bit);
	}
	printf("flip: %zu bits, all detected\n", 8 * s->count);
}

static uint64_t random_state;
static size_t random_below(size_t n)
{
	random_state ^= random_state << 13;
	random_state ^= random_state >> 7;
	random_state ^= random_state << 17;
	return (size_t)(random_state >> 11) % n;
}

/* The material whose record is at this byte; behind the records the last one. */
static uint64_t material_at(const struct subject *s, size_t at)
{
	uint64_t m = s->seen_count - 1;
	while (m > 0 && s->offset[m] > at)
		m--;
	return m;
}

/* One mutation of copy[*count], with room for 64 bytes more a turn. Returns where. */
static size_t mutate(uint8_t *copy, size_t *count)
{
	const size_t at = random_below(*count), rest = *count - at, length = 1 + random_below(rest < 4096 ? rest : 4096);
	switch (random_below(6)) {
	case 0: copy[at] = (uint8_t)random_below(256); break;
	case 1: memset(copy + at, random_below(2) ? 0 : 0xFF, length); break;
	case 2:
		for (size_t i = 0; i < length; i++)
			copy[at + i] = (uint8_t)random_below(256);
		break;
	case 3: memmove(copy + at, copy + random_below(*count - length + 1), length); break;
	case 4: *count = at; break;
	default:
		for (size_t i = 0; i < 4; i++)
			copy[at + (rest > 4 ? i : 0)] = (uint8_t)(random_below(2) ? 0xFF : 0);
		if (random_below(4) == 0) {
			memset(copy + *count, 0, 64);
			*count += 1 + random_below(63);
		}
	}
	return at;
}

static void mutate_many(struct subject *s, size_t n, uint64_t seed)
{
	uint8_t *copy = malloc(s->count + 256);
	size_t same = 0;
	random_state = seed * 0x9e3779b97f4a7c15u + 1;
	for (size_t i = 0; i < n; i++) {
		const bool mended = i % 2;
		size_t count = s->count, at = 0;
		memcpy(copy, s->bytes, count);
		for (size_t turns = 1 + random_below(3); turns > 0 && count > 0; turns--)
			at = mutate(copy, &count);
		if (count == s->count && memcmp(copy, s->bytes, count) == 0) {
			same++;
			continue;
		}
		if (mended)
			archive_mend(copy, count);
		if (ftruncate(s->fd, 0) != 0 || pwrite(s->fd, copy, count, 0) != (ssize_t)count)
			fail("pwrite", i);
		/* the first ones that were hit, and one of four times any */
		damaged_walk(s, random_below(4) ? material_at(s, at) : random_below(s->seen_count), 3,
		             mended ? DAMAGE_MENDED : DAMAGE_ANY, i / 2, i);
	}
	free(copy);
	printf("mutate: %zu mutations of %zu bytes, %zu changed nothing\n", n, s->count, same);
}

static void load_many(const char *path, size_t n)
{
	struct mallinfo2 before = {0}, after;
	bp_archive *archive = NULL;
	for (size_t i = 0; i < n; i++) {
		const bp_load_options options = {.struct_bytes = sizeof options, .form = (bp_form)(i % 2), .sampling = i % 64 == 0};
		bp_material *material = NULL;
		if (i % 16 == 0) {
			bp_archive_close(archive);
			archive = NULL;
			if (bp_archive_open(path, &archive, NULL) != BP_OK)
				fail("open", i);
		}
		if (bp_material_load(archive, i % bp_archive_count(archive), &options, &material, NULL) != BP_OK)
			fail("load", i);
		bp_material_free(material);
		if (i == n / 10)
			before = mallinfo2();
	}
	after = mallinfo2();
	bp_archive_close(archive);
	if (after.uordblks > before.uordblks + 1024 || after.hblkhd > before.hblkhd)
		fail("memory grew", after.uordblks - before.uordblks);
	printf("load: %zu loads and frees, %zd bytes more in use at the end than after a tenth\n", n,
	       (ssize_t)(after.uordblks - before.uordblks));
}

struct thread_job {
	const bp_archive *archive;
	const bp_material *shared;
	size_t n, number;
};

static void *thread_run(void *user)
{
	const struct thread_job *job = user;
	for (size_t i = 0; i < job->n; i++) {
		const float wi[3] = {0, 0.6f, 0.8f}, wo[3] = {0.28f, 0, 0.96f};
		bp_load_options options = {.struct_bytes = sizeof options, .form = (bp_form)(i % 2)};
		bp_material *material = NULL;
		float rgb[3], shared[3], drawn[3];
		char name[BP_NAME_BYTES_MAX + 1];
		const uint64_t m = (i + job->number) % bp_archive_count(job->archive);
		if (bp_archive_name(job->archive, m, name, NULL) != BP_OK ||
		    bp_material_load(job->archive, m, &options, &material, NULL) != BP_OK)
			fail("a thread cannot load", i);
		bp_material_evaluate(material, wi, wo, rgb);
		bp_material_evaluate(job->shared, wi, wo, shared);
		bp_material_sample(job->shared, wo, rgb, drawn);
		bp_material_free(material);
	}
	return NULL;
}

static void threads_run(const char *path, size_t n)
{
	enum { THREADS = 8 };
	const bp_load_options options = {.struct_bytes = sizeof options, .sampling = 1};
	struct thread_job job[THREADS];
	pthread_t thread[THREADS];
	bp_archive *archive = NULL;
	bp_material *shared = NULL;
	if (bp_archive_open(path, &archive, NULL) != BP_OK || bp_material_load(archive, 0, &options, &shared, NULL) != BP_OK)
		fail("open", 0);
	for (size_t t = 0; t < THREADS; t++) {
		job[t] = (struct thread_job){archive, shared, n, t};
		if (pthread_create(&thread[t], NULL, thread_run, &job[t]) != 0)
			fail("pthread_create", t);
	}
	for (size_t t = 0; t < THREADS; t++)
		pthread_join(thread[t], NULL);
	bp_material_free(shared);
	bp_archive_close(archive);
	printf("threads: 8 threads, %zu loads each\n", n);
}

int main(int argc, char **argv)
{
	struct subject s = {.extract_every = 1, .rescue_every = 1};
	for (; argc > 2 && (!strcmp(argv[1], "-x") || !strcmp(argv[1], "-r")); argc -= 2, argv += 2)
		*(argv[1][1] == 'x' ? &s.extract_every : &s.rescue_every) = strtoull(argv[2], NULL, 10);
	const char *what = argc > 2 ? argv[1] : "";
	const size_t n = argc > 3 ? strtoull(argv[3], NULL, 10) : 1000;

	signal(SIGALRM, hang_tell);
	if (!strcmp(what, "load")) {
		load_many(argv[2], n);
	} else if (!strcmp(what, "threads")) {
		threads_run(argv[2], n);
	} else if (argc > 2) {
		subject_read(argv[2], &s);
		if (!strcmp(what, "truncate"))
			truncate_all(&s);
		else if (!strcmp(what, "flip"))
			flip_all(&s);
		else
			mutate_many(&s, n, argc > 4 ? strtoull(argv[4], NULL, 10) : 1);
	} else {
		fprintf(stderr, "usage: faults [-x EVERY] [-r EVERY] truncate|flip|mutate|load|threads ARCHIVE [N [SEED]]\n");
		return 2;
	}
	free(s.bytes);
	free(s.seen);
	free(s.offset);
	return 0;
}
