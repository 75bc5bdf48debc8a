/*
 * pinned.c: what the demo materials take and lose, against what was pinned.
 *
 *     pinned [--write] TSV         for make: `make pinned`, and `make pinned PINNED_FLAGS=--write` after a change on purpose
 *
 * A row is a material, a profile and a budget: bytes, log RMSE over measured cells, and CRC32 of the decoded values in single
 * precision. A run fails where a row differs: worse is an error, better or other values ask to be pinned on purpose.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <zlib.h>

#include "codec/record.h"
#include "merl/demo.h"

enum { BUDGET_COUNT = 3, PROFILE_COUNT = 2, LINE = 200 };
static const uint32_t BUDGETS[BUDGET_COUNT] = {4096, 16384, 60400};
static const struct {
	enum profile profile;
	const char *name;
} PROFILES[PROFILE_COUNT] = {{PROFILE_PAPER, "paper"}, {PROFILE_SPECTRAL, "spectral"}};

/* In the order of the axes, of the values themselves: independent of the unit that a model chose. */
static uint32_t values_crc32(const struct expansion *table)
{
	const size_t cells = lattice_cells(table->dims);
	uLong crc = crc32(0, NULL, 0);
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < cells; i++) {
			const float value = (float)(table->unit * (double)table->rgb[c][i]);
			crc = crc32(crc, (const Bytef *)&value, sizeof value);
		}
	return (uint32_t)crc;
}

static void row_print(FILE *out, const struct lattice *lattice, const char *name, int p, uint32_t budget)
{
	static const struct record_source source = {.bytes = 1};
	const struct fit_options options = {.profile = PROFILES[p].profile, .budget_bytes = budget, .effort = 5};
	struct record_head head;
	struct expansion table;
	struct model *model = NULL;
	uint8_t *record = NULL;
	size_t bytes;
	bp_error error;

	if (record_encode(lattice, name, &source, &options, &record, &bytes, &head, &error) ||
	    record_decode_whole(&head, 0, record, &model, &error) || expansion_alloc(lattice->dims, &table, &error) ||
	    model_expand(model, 0, &table, &error)) {
		fprintf(stderr, "%s: %s\n", name, error.message);
		exit(1);
	}
	fprintf(out, "%s\t%s\t%u\t%zu\t%.5f\t%08x\n", name, PROFILES[p].name, budget, bytes,
	        head.layers[head.layer_count - 1].fidelity.log_rmse, values_crc32(&table));
	expansion_free(&table);
	model_free(model);
	free(record);
}

/* All rows of every `step`-th material from `first` on. */
static void rows_print(FILE *out, size_t first, size_t step)
{
	for (size_t n = first; n < demo_count(); n += step) {
		struct lattice lattice;
		bp_error error;
		if (demo_generate(n, LATTICE_MERL, false, &lattice, &error)) {
			fprintf(stderr, "%s: %s\n", demo_name(n), error.message);
			exit(1);
		}
		for (int p = 0; p < PROFILE_COUNT; p++)
			for (int b = 0; b < BUDGET_COUNT; b++)
				row_print(out, &lattice, demo_name(n), p, BUDGETS[b]);
		lattice_free(&lattice);
	}
}

/* The rows of all materials, by `jobs` processes, one after the other in lines. */
static char (*rows_make(size_t jobs, size_t *count))[LINE]
{
	const size_t most = demo_count() * PROFILE_COUNT * BUDGET_COUNT;
	char(*line)[LINE] = calloc(most + 1, sizeof *line);
	FILE *part[16];
	pid_t pid[16];
	int status = 0;

	for (size_t j = 0; j < jobs; j++) {
		part[j] = tmpfile();
		pid[j] = part[j] ? fork() : -1;
		if (!line || pid[j] < 0) {
			perror("pinned");
			exit(1);
		}
		if (pid[j] == 0) {
			rows_print(part[j], j, jobs);
			_exit(fflush(part[j]) != 0);
		}
	}
	*count = 0;
	for (size_t j = 0; j < jobs; j++) {
		if (waitpid(pid[j], &status, 0) < 0 || status != 0)
			exit(1);
		rewind(part[j]);
		while (*count < most && fgets(line[*count], LINE, part[j]))
			++*count;
		fclose(part[j]);
	}
	qsort(line, *count, sizeof *line, (int (*)(const void *, const void *))strcmp);
	return line;
}

struct row {
	char key[LINE];
	unsigned long bytes;
	double error;
	unsigned crc;
};

static int row_parse(const char *line, struct row *row)
{
	char name[64], profile[16];
	unsigned budget;
	if (sscanf(line, "%63[^\t]\t%15[^\t]\t%u\t%lu\t%lf\t%x", name, profile, &budget, &row->bytes, &row->error, &row->crc) != 6)
		return 0;
	snprintf(row->key, sizeof row->key, "%s, %s, %u", name, profile, budget);
	return 1;
}

static int rows_compare(FILE *pinned, char (*line)[LINE], size_t count)
{
	char text[LINE];
	size_t at = 0;
	int worse = 0, other = 0;

	while (fgets(text, sizeof text, pinned)) {
		struct row was, now;
		if (text[0] == '#' || !strncmp(text, "material\t", 9))
			continue;
		if (!row_parse(text, &was) || at == count || !row_parse(line[at], &now) || strcmp(was.key, now.key) != 0) {
			printf("%s: pinned, but not among the demo materials at this place\n", row_parse(text, &was) ? was.key : text);
			return 1;
		}
		at++;
		if (now.bytes > was.bytes || now.error > was.error) {
			printf("%s: worse: %lu bytes, log RMSE %.5f; pinned: %lu, %.5f\n", now.key, now.bytes, now.error, was.bytes,
			       was.error);
			worse++;
		} else if (now.bytes != was.bytes || now.error != was.error || now.crc != was.crc) {
			printf("%s: other: %lu bytes, log RMSE %.5f, values %08x; pinned: %lu, %.5f, %08x\n", now.key, now.bytes, now.error,
			       now.crc, was.bytes, was.error, was.crc);
			other++;
		}
	}
	if (at != count) {
		printf("%zu rows are not pinned, the first: %s", count - at, line[at]);
		return 1;
	}
	printf("%zu rows: %d worse, %d other; where that is meant: make pinned PINNED_FLAGS=--write\n", count, worse, other);
	return worse || other;
}

int main(int argc, char **argv)
{
	const int writing = argc == 3 && !strcmp(argv[1], "--write");
	const long cores = sysconf(_SC_NPROCESSORS_ONLN);
	size_t count;

	if (argc != 2 + writing) {
		fprintf(stderr, "pinned [--write] TSV\n");
		return 2;
	}
	FILE *file = fopen(argv[argc - 1], writing ? "w" : "r");
	if (!file) {
		perror(argv[argc - 1]);
		return 1;
	}
	char(*line)[LINE] = rows_make(cores < 1 ? 1 : cores > 16 ? 16 : (size_t)cores, &count);
	int code = 0;
	if (writing) {
		fprintf(file, "# demo set, MERL's lattice; made by `make pinned "
		              "PINNED_FLAGS=--write`\nmaterial\tprofile\tbudget\tbytes\tlog RMSE\tvalues\n");
		for (size_t n = 0; n < count; n++)
			fputs(line[n], file);
	} else {
		code = rows_compare(file, line, count);
	}
	free(line);
	return fclose(file) != 0 || code;
}
