/*
 * The section that tells what kind of file a material was read from: written, found, carried along, and what is not believed.
 */
#include "archive_fixture.h"
#include "codec/record_origin.h"

static const struct origin SPECTRA = {.kind = ORIGIN_RGL_SPECTRA,
                                      .wavelengths = 195,
                                      .first_nm = 360,
                                      .last_nm = 1000,
                                      .compared = 986456,
                                      .median = 0.0165,
                                      .percentile95 = 0.1195};

static void packed(enum profile profile, uint32_t budget, const struct origin *origin, uint8_t **record, size_t *bytes,
                   struct record_head *head)
{
	const struct fit_options options = {.profile = profile, .budget_bytes = budget, .effort = 5};
	struct record_source source = {.bytes = 658936, .sha256 = {1, 2, 3}};
	struct lattice lattice = {0};
	source.origin = *origin;
	assert_int_equal(lattice_alloc((struct lattice_dims){20, 20, 24}, &lattice, NULL), BP_OK);
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < lattice_cells(lattice.dims); n++)
			lattice.rgb[c][n] = 0.1 + 0.05 * c + exp(-(double)(n / 480) / 3) * (1 + 0.3 * sin((double)n));
	lattice_validate(&lattice);
	assert_int_equal(record_encode(&lattice, "material", &source, &options, record, bytes, head, NULL), BP_OK);
	lattice_free(&lattice);
}

static void the_section_comes_back(void **state)
{
	(void)state;
	for (int p = PROFILE_PAPER; p <= PROFILE_SPECTRAL; p++) {
		uint8_t *record;
		size_t bytes;
		struct record_head head;
		struct origin origin;
		packed((enum profile)p, 8000, &SPECTRA, &record, &bytes, &head);
		assert_true(bytes <= 8000);
		const struct record_section *section = record_origin_find(&head);
		assert_non_null(section);
		assert_int_equal(section->layer, 0);
		assert_int_equal(section->flags, 0); /* optional */
		assert_true(record_origin_is_current(&head));
		assert_int_equal(record_origin_parse(record + section->offset, &origin, NULL), BP_OK);
		assert_int_equal(origin.kind, SPECTRA.kind);
		assert_int_equal(origin.wavelengths, 195);
		assert_true(origin.first_nm == 360 && origin.last_nm == 1000 && origin.compared == 986456);
		assert_true(fabs(origin.median - 0.0165) < 1e-8 && fabs(origin.percentile95 - 0.1195) < 1e-8);
		struct model *model;
		for (uint32_t layers = 1; layers <= head.layer_count; layers++) {
			assert_int_equal(record_decode_whole(&head, layers, record, &model, NULL), BP_OK);
			model_free(model);
		}
		free(record);
	}
}

static void a_merl_table_has_none(void **state)
{
	(void)state;
	static const struct origin merl = {.kind = ORIGIN_MERL};
	uint8_t *record;
	size_t bytes;
	struct record_head head;
	packed(PROFILE_SPECTRAL, 8000, &merl, &record, &bytes, &head);
	assert_null(record_origin_find(&head));
	assert_int_equal(record_origin_bytes(&merl), 0);
	assert_true(record_origin_is_current(&head));
	free(record);
}

static void it_goes_along_with_fewer_layers_and_other_names(void **state)
{
	(void)state;
	uint8_t *record, *copy;
	size_t bytes, copy_bytes;
	struct record_head head;
	packed(PROFILE_SPECTRAL, 60400, &SPECTRA, &record, &bytes, &head);
	assert_int_equal(record_keep_layers(record, bytes, 1, &copy, &copy_bytes, NULL), BP_OK);
	assert_int_equal(record_head_read(copy, copy_bytes, &head, NULL), BP_OK);
	assert_non_null(record_origin_find(&head));
	free(copy);
	assert_int_equal(record_rename(record, bytes, "other", &copy, &copy_bytes, NULL), BP_OK);
	assert_int_equal(record_head_read(copy, copy_bytes, &head, NULL), BP_OK);
	assert_non_null(record_origin_find(&head));
	free(copy);
	free(record);
}

static void bytes_that_no_writer_writes_are_corrupt(void **state)
{
	(void)state;
	struct section_list list = {0};
	struct origin origin;
	bp_error error;
	assert_true(record_origin_add(&list, &SPECTRA));
	assert_int_equal(list.count, 1);
	assert_int_equal(list.bytes[0].count, ORIGIN_BYTES);
	static const struct {
		size_t at;
		uint8_t value;
	} cases[] = {{0, 0}, {0, 4}, {0, 255}, {11, 0xff}, {15, 0x80}, {23, 0xff}, {27, 0x7f}};
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		uint8_t bytes[ORIGIN_BYTES];
		memcpy(bytes, list.bytes[0].bytes, sizeof bytes);
		bytes[cases[n].at] = cases[n].value;
		assert_int_equal(record_origin_parse(bytes, &origin, &error), BP_ERROR_CORRUPT);
	}
	section_list_free(&list);
}

/* Another version may say other things: it is neither read nor taken for what this program would write. */
static void other_versions_are_left_alone(void **state)
{
	(void)state;
	struct record_head head = {.section_count = 1};
	head.sections[0] = (struct record_section){.type = SECTION_ORIGIN, .version = ORIGIN_VERSION + 1, .bytes = ORIGIN_BYTES};
	assert_null(record_origin_find(&head));
	assert_false(record_origin_is_current(&head));
	head.sections[0].version = ORIGIN_VERSION;
	assert_non_null(record_origin_find(&head));
	head.sections[0].bytes++;
	assert_null(record_origin_find(&head));
}

/* Who loads a material does not read this section. */
static void what_is_told_as_read_was_read(const bp_archive *archive)
{
	const bp_load_options options = {.struct_bytes = sizeof options};
	bp_loaded loaded = {.struct_bytes = sizeof loaded};
	bp_material *material = NULL;
	const uint64_t before = bp_archive_bytes_read(archive);
	assert_int_equal(bp_material_load(archive, 0, &options, &material, NULL), BP_OK);
	const uint64_t after = bp_archive_bytes_read(archive);
	assert_int_equal(bp_material_loaded(material, &loaded, NULL), BP_OK);
	assert_int_equal(loaded.read_bytes, after - before);
	bp_material_free(material);
}

/* Through an archive, with a damaged byte and without. */
static void an_archive_tells_it(void **state)
{
	(void)state;
	uint8_t *record;
	size_t bytes;
	struct record_head head;
	struct archive_writer *writer;
	struct index_page leaf;
	struct index_entry entry;
	struct origin origin;
	bp_archive *archive;
	bp_error error;
	packed(PROFILE_SPECTRAL, 8000, &SPECTRA, &record, &bytes, &head);
	const char *path = fixture_path("origin.bpk");
	for (int damaged = 0; damaged < 2; damaged++) {
		assert_int_equal(archive_writer_open(path, &writer, NULL), BP_OK);
		assert_int_equal(archive_writer_add(writer, record, bytes, NULL), BP_OK);
		assert_int_equal(archive_writer_commit(writer, NULL), BP_OK);
		FILE *file = fopen(path, "r+b");
		assert_non_null(file);
		fseek(file, (long)(64 + record_origin_find(&head)->offset + 20), SEEK_SET);
		if (damaged)
			fputc(0x55, file);
		fclose(file);
		assert_int_equal(bp_archive_open(path, &archive, NULL), BP_OK);
		leaf.count = 0;
		assert_int_equal(archive_entry(archive, 0, &leaf, &entry, NULL), BP_OK);
		assert_int_equal(archive_entry_origin(archive, &entry, &head, &origin, &error), damaged ? BP_ERROR_CHECKSUM : BP_OK);
		assert_true(damaged || origin.wavelengths == 195);
		what_is_told_as_read_was_read(archive);
		bp_archive_close(archive);
	}
	free(record);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_section_comes_back),
		cmocka_unit_test(a_merl_table_has_none),
		cmocka_unit_test(it_goes_along_with_fewer_layers_and_other_names),
		cmocka_unit_test(bytes_that_no_writer_writes_are_corrupt),
		cmocka_unit_test(other_versions_are_left_alone),
		cmocka_unit_test(an_archive_tells_it),
	};
	return cmocka_run_group_tests(tests, fixture_folder_make, fixture_folder_remove);
}
