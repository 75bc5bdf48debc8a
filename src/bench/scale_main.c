/*
 * scale_main.c: archives of many small records, for bench_scale.py.
 *
 *     brdfpack-bench-scale OUT COUNT [FIRST [STEP]]
 *
 * Writes an archive of COUNT materials, names m0000000, m0000001, ... from FIRST (0) on, every STEP-th (1). All have the same
 * record of a table of 4 x 4 x 4 cells but for the name: what is timed is the archive, not the fit.
 */
#include <stdio.h>
#include <stdlib.h>

#include "archive/writer.h"
#include "codec/record.h"

static bp_status record_make(uint8_t **record, size_t *bytes, bp_error *error)
{
	static const struct record_source source = {.bytes = 1};
	const struct fit_options options = {.profile = PROFILE_SPECTRAL, .budget_bytes = 1000, .effort = 5};
	struct lattice lattice;
	bp_status status = lattice_alloc((struct lattice_dims){4, 4, 4}, &lattice, error);

	if (status)
		return status;
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < lattice_cells(lattice.dims); i++)
			lattice.rgb[c][i] = 0.1 * (c + 1) + 0.01 * (double)(i % 7);
	lattice_validate(&lattice);
	status = record_encode(&lattice, "m", &source, &options, record, bytes, NULL, error);
	lattice_free(&lattice);
	return status;
}

int main(int argc, char **argv)
{
	struct archive_writer *writer = NULL;
	uint8_t *record = NULL;
	size_t bytes;
	bp_error error;

	if (argc < 3) {
		fprintf(stderr, "usage: brdfpack-bench-scale OUT COUNT [FIRST [STEP]]\n");
		return 2;
	}
	const unsigned long count = strtoul(argv[2], NULL, 10), first = argc > 3 ? strtoul(argv[3], NULL, 10) : 0;
	const unsigned long step = argc > 4 ? strtoul(argv[4], NULL, 10) : 1;
	bp_status status = record_make(&record, &bytes, &error);
	if (!status)
		status = archive_writer_open(argv[1], &writer, &error);
	for (unsigned long n = 0; n < count && !status; n++) {
		char name[32];
		uint8_t *named = NULL;
		size_t named_bytes;
		snprintf(name, sizeof name, "m%07lu", first + n * step);
		status = record_rename(record, bytes, name, &named, &named_bytes, &error);
		if (!status)
			status = archive_writer_add(writer, named, named_bytes, &error);
		free(named);
	}
	free(record);
	if (!status)
		status = archive_writer_commit(writer, &error);
	else
		archive_writer_discard(writer);
	if (status)
		fprintf(stderr, "%s: %s\n", argv[1], error.message);
	return status != BP_OK;
}
