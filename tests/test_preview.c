/* What a renderer does not load: of the lattice, of the file, of the pair copulas. */
#include "archive_fixture.h"

#include "merl/demo.h"
#include "merl/lattice.h"
#include "model/model.h"
#include "packed_fixture.h"

static void a_preview_holds_every_second_value(void **state)
{
	(void)state;
	const enum profile profiles[] = {PROFILE_PAPER, PROFILE_SPECTRAL};
	for (int p = 0; p < 2; p++) {
		struct lattice lattice;
		struct fit_options options = {.profile = profiles[p], .budget_bytes = 60400, .effort = 5};
		struct model *fitted = NULL;
		struct expansion whole, half;
		struct lattice_dims dims = {24, 20, 48}, small;
		struct record_source source = {.bytes = 1};
		struct record_head head;
		uint8_t *record = NULL;
		size_t bytes;
		bp_error error;
		glossy_lattice_make(dims, 1, &lattice);
		if (record_encode(&lattice, "x", &source, &options, &record, &bytes, &head, &error))
			fail_msg("%s", error.message);
		for (uint32_t layers = 1; layers <= head.layer_count; layers++) {
			if (record_decode_whole(&head, layers, record, &fitted, &error))
				fail_msg("%s", error.message);
			assert_true(model_has_half(dims, &small));
			assert_int_equal(expansion_alloc(dims, &whole, NULL), BP_OK);
			assert_int_equal(expansion_alloc(small, &half, NULL), BP_OK);
			assert_int_equal(model_expand(fitted, 0, &whole, &error), BP_OK);
			assert_int_equal(model_expand_half(fitted, &half, &error), BP_OK);
			for (uint32_t i = 0; i < small.theta_h; i++)
				for (uint32_t j = 0; j < small.theta_d; j++)
					for (uint32_t k = 0; k < small.phi_d; k++)
						for (int c = 0; c < 3; c++) {
							double a = (double)whole.rgb[c][lattice_index(dims, 2 * i, 2 * j, 2 * k)] * whole.unit;
							double b = (double)half.rgb[c][lattice_index(small, i, j, k)] * half.unit;
							assert_true(fabs(a - b) <= 1e-4 * a);
						}
			assert_int_equal(model_expand_half(fitted, &whole, &error), BP_ERROR_ARGUMENT);
			expansion_free(&whole);
			expansion_free(&half);
			model_free(fitted);
		}
		free(record);
		lattice_free(&lattice);
	}
}

/* A hundred materials: one of the spectral profile on MERL's lattice, in the middle of the names, and 99 that nobody loads. */
static bp_status archive_of_a_hundred(const char *path, uint8_t *record, size_t bytes)
{
	struct archive_writer *writer = NULL;
	assert_int_equal(archive_writer_open(path, &writer, NULL), BP_OK);
	for (int n = 0; n < 100; n++) {
		char name[32];
		size_t other_bytes;
		snprintf(name, sizeof name, "material-%03d", n);
		uint8_t *other = fixture_record(name, 2, 15000, &other_bytes);
		assert_int_equal(archive_writer_add(writer, n == 57 ? record : other, n == 57 ? bytes : other_bytes, NULL), BP_OK);
		free(other);
	}
	return archive_writer_commit(writer, NULL);
}

/* Opens, finds and loads; returns the bytes that were read from the file. */
static uint64_t bytes_to_load(const char *path, const bp_load_options *options, bp_loaded *loaded)
{
	bp_archive *archive = NULL;
	bp_material *material = NULL;
	bp_error error;
	uint64_t index;
	assert_int_equal(bp_archive_open(path, &archive, NULL), BP_OK);
	assert_int_equal(bp_archive_find(archive, "material-057", &index, NULL), BP_OK);
	if (bp_material_load(archive, index, options, &material, &error))
		fail_msg("%s", error.message);
	assert_int_equal(bp_material_loaded(material, loaded, NULL), BP_OK);
	uint64_t bytes = bp_archive_bytes_read(archive);
	bp_material_free(material);
	bp_archive_close(archive);
	return bytes;
}

static void a_preview_of_one_in_a_hundred_reads_at_most_24_KiB_and_all_of_it_16_KiB_more_than_its_record(void **state)
{
	(void)state;
	const struct fit_options options = {.profile = PROFILE_SPECTRAL, .budget_bytes = 60400, .effort = 5};
	const struct record_source source = {.bytes = 1};
	struct lattice lattice;
	struct record_head head;
	uint8_t *record = NULL;
	size_t bytes;
	bp_error error;
	char path[512];
	assert_int_equal(demo_generate(0, LATTICE_MERL, false, &lattice, NULL), BP_OK);
	if (record_encode(&lattice, "material-057", &source, &options, &record, &bytes, &head, &error))
		fail_msg("%s", error.message);
	lattice_free(&lattice);
	strcpy(path, fixture_path("hundred.bpk"));
	assert_int_equal(archive_of_a_hundred(path, record, bytes), BP_OK);
	assert_true(bytes > 50000 && head.layer_count > 1); /* or the test below says nothing */

	bp_load_options load = {
		.struct_bytes = sizeof load, .form = BP_FORM_PREVIEW, .max_log_rmse = head.layers[0].fidelity.log_rmse};
	bp_loaded loaded = {.struct_bytes = sizeof loaded};
	uint64_t preview = bytes_to_load(path, &load, &loaded);
	assert_int_equal(loaded.layers, 1);
	assert_true(preview <= 24 * 1024);
	load.colour = BP_COLOUR_MEAN;
	assert_true(bytes_to_load(path, &load, &loaded) <= preview);

	uint64_t whole = bytes_to_load(path, NULL, &loaded);
	assert_int_equal(loaded.read_bytes, bytes);
	assert_true(whole <= bytes + 16 * 1024);
	free(record);
}

/* A product of three functions of one angle each: all pairs are independent. */
static void pairs_that_are_independent_are_neither_stored_nor_read(void **state)
{
	(void)state;
	const struct lattice_dims dims = {12, 10, 24};
	const struct fit_options options = {.profile = PROFILE_PAPER, .budget_bytes = 60400, .effort = 5};
	const struct record_source source = {.bytes = 1};
	size_t bytes[2];
	for (int independent = 0; independent < 2; independent++) {
		struct lattice lattice;
		struct record_head head;
		uint8_t *record = NULL;
		bp_archive *archive = NULL;
		struct archive_writer *writer = NULL;
		bp_material *material = NULL;
		bp_loaded loaded = {.struct_bytes = sizeof loaded};
		bp_error error;
		assert_int_equal(lattice_alloc(dims, &lattice, NULL), BP_OK);
		for (uint32_t i = 0; i < dims.theta_h; i++)
			for (uint32_t j = 0; j < dims.theta_d; j++)
				for (uint32_t k = 0; k < dims.phi_d; k++)
					for (int c = 0; c < 3; c++)
						lattice.rgb[c][lattice_index(dims, i, j, k)] =
							(1 + 9 * exp(-0.2 * i * i)) * (1 + 0.1 * j) * (1 + 0.2 * cos(2 * M_PI * k / dims.phi_d)) +
							(independent ? 0 : 0.3 * ((i * 7 + j * 13 + k * 29) % 5));
		lattice_validate(&lattice);
		if (record_encode(&lattice, "x", &source, &options, &record, &bytes[independent], &head, &error))
			fail_msg("%s", error.message);
		assert_int_equal(head.left_out, independent ? 7 : 0);
		assert_int_equal(archive_writer_open(fixture_path("x.bpk"), &writer, NULL), BP_OK);
		assert_int_equal(archive_writer_add(writer, record, bytes[independent], NULL), BP_OK);
		assert_int_equal(archive_writer_commit(writer, NULL), BP_OK);
		assert_int_equal(bp_archive_open(fixture_path("x.bpk"), &archive, NULL), BP_OK);
		assert_int_equal(bp_material_load(archive, 0, NULL, &material, NULL), BP_OK);
		assert_int_equal(bp_material_loaded(material, &loaded, NULL), BP_OK);
		assert_int_equal(loaded.read_bytes, bytes[independent]);
		bp_material_free(material);
		bp_archive_close(archive);
		free(record);
		lattice_free(&lattice);
	}
	assert_true(bytes[1] < bytes[0]);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_preview_holds_every_second_value),
		cmocka_unit_test(a_preview_of_one_in_a_hundred_reads_at_most_24_KiB_and_all_of_it_16_KiB_more_than_its_record),
		cmocka_unit_test(pairs_that_are_independent_are_neither_stored_nor_read),
	};
	return cmocka_run_group_tests(tests, fixture_folder_make, fixture_folder_remove);
}
