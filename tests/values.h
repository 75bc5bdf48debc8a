/*
 * values.h: writes what an archive decodes to as text: the .values files of format-spec/vectors.
 */
#ifndef TESTS_VALUES_H
#define TESTS_VALUES_H

#include "archive_fixture.h"

/* One line per material and layer, then a line of values per channel, nine digits: what every reader must decode. */
FIXTURE void values_write(const char *archive_path, const char *path)
{
	bp_archive *archive = NULL;
	FILE *file = fopen(path, "w");
	assert_non_null(file);
	assert_int_equal(bp_archive_open(archive_path, &archive, NULL), BP_OK);
	for (uint64_t m = 0; m < bp_archive_count(archive); m++) {
		struct index_entry entry;
		struct record_head head;
		assert_int_equal(archive_record_head(archive, m, &entry, &head, NULL), BP_OK);
		for (uint32_t layers = 1; layers <= head.layer_count; layers++) {
			struct expansion table = {0};
			struct model *model = NULL;
			assert_int_equal(expansion_alloc(head.dims, &table, NULL), BP_OK);
			assert_int_equal(archive_model_load(archive, m, layers, &model, NULL), BP_OK);
			assert_int_equal(model_expand(model, 0, &table, NULL), BP_OK);
			fprintf(file, "%s %u %u %u %u\n", head.name, layers, head.dims.theta_h, head.dims.theta_d, head.dims.phi_d);
			for (int c = 0; c < 3; c++)
				for (size_t i = 0, cells = lattice_cells(head.dims); i < cells; i++)
					fprintf(file, "%.9g%c", table.unit * (double)table.rgb[c][i], i + 1 < cells ? ' ' : '\n');
			model_free(model);
			expansion_free(&table);
		}
	}
	bp_archive_close(archive);
	assert_int_equal(fclose(file), 0);
}

#endif
