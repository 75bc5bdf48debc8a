/*
 * From a lattice to a record and back. `test_record_encode --write FOLDER` writes the archives of these
 * lattices, their values and what is evaluated at some angles for tests/python_reader.sh.
 */
#include "values.h"

#include "model/fidelity.h"
#include "trilinear.h"

/* Every test runs for both profiles. */
static enum profile tested = PROFILE_PAPER;

/* A glossy lobe over a diffuse part with a Fresnel-like edge, coloured; invalid where the formula says below the horizon. */
static void lattice_make(struct lattice_dims dims, double size, struct lattice *out)
{
	assert_int_equal(lattice_alloc(dims, out, NULL), BP_OK);
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++)
			for (uint32_t k = 0; k < dims.phi_d; k++) {
				double h = (i + 0.5) / dims.theta_h, d = (j + 0.5) / dims.theta_d * M_PI / 2, p = (k + 0.5) / dims.phi_d * M_PI;
				double theta = h * h * M_PI / 2, lobe = exp(-tan(theta * 0.99) * tan(theta * 0.99) / 0.09);
				double edge = 0.04 + 0.96 * pow(1 - cos(d), 5), swirl = 1 + 0.2 * cos(2 * p) * sin(d) * sin(theta);
				double below = cos(theta) * cos(d) - sin(theta) * sin(d) * fabs(cos(p));
				size_t cell = lattice_index(dims, i, j, k);
				for (int c = 0; c < 3; c++)
					out->rgb[c][cell] = below < -0.05 ? -1 : size * (0.1 * (c + 1) + (5 - c) * lobe * (1 + edge)) * swirl;
			}
	lattice_validate(out);
}

static const struct lattice_dims DIMS[] = {{12, 10, 14}, {4, 4, 4}, {9, 16, 8}, {16, 5, 6}, {17, 16, 5}};
enum { DIMS_COUNT = sizeof DIMS / sizeof *DIMS };

static bp_status pack(const struct lattice *lattice, uint32_t budget, double max_error, uint8_t **record, size_t *bytes,
                      struct record_head *head, bp_error *error)
{
	struct fit_options options = {.profile = tested, .budget_bytes = budget, .max_error = max_error, .effort = 5};
	struct record_source source = {.bytes = 1234, .sha256 = {1, 2, 3}, .nonfinite_count = 7};
	return record_encode(lattice, "material", &source, &options, record, bytes, head, error);
}

static void the_recorded_error_of_every_layer_is_the_measured_one(void **state)
{
	(void)state;
	for (int i = 0; i < DIMS_COUNT; i++) {
		struct lattice lattice;
		struct record_head head;
		uint8_t *record;
		size_t bytes;
		lattice_make(DIMS[i], 1, &lattice);
		assert_int_equal(pack(&lattice, 60400, 0, &record, &bytes, &head, NULL), BP_OK);
		assert_int_equal(head.record_bytes, bytes);
		assert_int_equal(head.source.nonfinite_count, 7);
		for (uint32_t layers = 1; layers <= head.layer_count; layers++) {
			struct expansion table;
			struct model *model = NULL;
			struct fidelity measured;
			assert_int_equal(expansion_alloc(head.dims, &table, NULL), BP_OK);
			assert_int_equal(record_decode_whole(&head, layers, record, &model, NULL), BP_OK);
			assert_int_equal(model->layer_count, layers);
			assert_int_equal(model_expand(model, 0, &table, NULL), BP_OK);
			assert_int_equal(fidelity_measure(&lattice, &table, 1, &measured, NULL), BP_OK);
			assert_true(measured.log_rmse == head.layers[layers - 1].fidelity.log_rmse);
			assert_true(measured.cube_root_rmse == head.layers[layers - 1].fidelity.cube_root_rmse);
			assert_true(measured.largest_relative == head.layers[layers - 1].fidelity.largest_relative);
			model_free(model);
			expansion_free(&table);
		}
		free(record);
		lattice_free(&lattice);
	}
}

static void packing_twice_gives_the_same_bytes(void **state)
{
	struct lattice lattice;
	uint8_t *a, *b;
	size_t a_bytes, b_bytes;
	(void)state;
	lattice_make(DIMS[0], 1, &lattice);
	assert_int_equal(pack(&lattice, 60400, 0, &a, &a_bytes, NULL, NULL), BP_OK);
	assert_int_equal(pack(&lattice, 60400, 0, &b, &b_bytes, NULL, NULL), BP_OK);
	assert_int_equal(a_bytes, b_bytes);
	assert_memory_equal(a, b, a_bytes);
	free(a);
	free(b);
	lattice_free(&lattice);
}

static void a_budget_is_kept_or_the_least_one_is_named(void **state)
{
	struct lattice lattice;
	struct record_head head;
	uint8_t *record = NULL;
	size_t bytes;
	bp_error error = {0};
	(void)state;
	lattice_make(DIMS[0], 1, &lattice);
	assert_int_equal(pack(&lattice, 60400, 0, &record, &bytes, NULL, NULL), BP_OK);
	free(record);
	for (uint32_t budget = (uint32_t)bytes; budget > 600; budget -= 50) {
		size_t smaller;
		bp_status status = pack(&lattice, budget, 0, &record, &smaller, &head, &error);
		if (status) {
			assert_int_equal(status, BP_ERROR_LIMIT);
			assert_non_null(strstr(error.message, "at least"));
			break;
		}
		assert_true(smaller <= budget);
		free(record);
	}
	lattice_free(&lattice);
}

/* Of the spectral profile, where there is enough to tell (all there is takes 9,657 bytes): at most 1 % is left over. */
static void a_budget_is_used_to_the_last_hundredth(void **state)
{
	struct lattice lattice;
	uint8_t *record = NULL;
	size_t bytes;
	(void)state;
	if (tested != PROFILE_SPECTRAL)
		return;
	lattice_make((struct lattice_dims){32, 32, 32}, 1, &lattice);
	for (uint32_t budget = 1000; budget < 9600; budget = budget * 13 / 10) {
		assert_int_equal(pack(&lattice, budget, 0, &record, &bytes, NULL, NULL), BP_OK);
		assert_true(bytes <= budget && (double)bytes >= 0.99 * (double)budget);
		free(record);
	}
	lattice_free(&lattice);
}

static void an_error_can_be_asked_for_instead(void **state)
{
	struct lattice lattice;
	struct record_head full, head;
	uint8_t *record = NULL;
	size_t full_bytes, bytes;
	bp_error error = {0};
	(void)state;
	lattice_make((struct lattice_dims){32, 32, 32}, 1, &lattice);
	assert_int_equal(pack(&lattice, 60400, 0, &record, &full_bytes, &full, NULL), BP_OK);
	free(record);
	double least = full.layers[full.layer_count - 1].fidelity.log_rmse;
	assert_int_equal(pack(&lattice, 0, least * 1.2, &record, &bytes, &head, NULL), BP_OK);
	assert_true(bytes < full_bytes);
	assert_true(head.layers[head.layer_count - 1].fidelity.log_rmse <= least * 1.2);
	free(record);
	record = NULL;
	/* The paper's profile keeps a fixed share of its coefficients; the spectral one ends where float does. */
	assert_int_equal(pack(&lattice, 0, tested == PROFILE_PAPER ? least * 0.5 : 1e-12, &record, &bytes, &head, &error),
	                 BP_ERROR_LIMIT);
	assert_non_null(strstr(error.message, "the least is"));
	assert_null(record);
	lattice_free(&lattice);
}

static void sizes_of_all_orders_pack_and_come_back_finite(void **state)
{
	static const double sizes[] = {1e-300, 1e-12, 1e12, 1e300, 0};
	(void)state;
	for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
		struct lattice lattice;
		struct record_head head;
		struct expansion table;
		struct model *model = NULL;
		uint8_t *record;
		size_t bytes;
		lattice_make(DIMS[1], sizes[i], &lattice);
		assert_int_equal(pack(&lattice, 60400, 0, &record, &bytes, &head, NULL), BP_OK);
		assert_int_equal(record_decode_whole(&head, 0, record, &model, NULL), BP_OK);
		assert_int_equal(expansion_alloc(head.dims, &table, NULL), BP_OK);
		assert_int_equal(model_expand(model, 0, &table, NULL), BP_OK);
		for (size_t cell = 0; cell < 64; cell++)
			for (int c = 0; c < 3; c++)
				assert_true(isfinite(table.unit * (double)table.rgb[c][cell]) && table.rgb[c][cell] >= 0);
		model_free(model);
		expansion_free(&table);
		free(record);
		lattice_free(&lattice);
	}
}

static void an_illegal_name_is_refused(void **state)
{
	struct fit_options options = {.profile = tested, .budget_bytes = 60400, .effort = 5};
	struct record_source source = {0};
	struct lattice lattice;
	uint8_t *record = NULL;
	size_t bytes;
	(void)state;
	lattice_make(DIMS[1], 1, &lattice);
	assert_int_equal(record_encode(&lattice, "a/b", &source, &options, &record, &bytes, NULL, NULL), BP_ERROR_ARGUMENT);
	options.profile = (enum profile)77;
	assert_int_equal(record_encode(&lattice, "a", &source, &options, &record, &bytes, NULL, NULL), BP_ERROR_ARGUMENT);
	lattice_free(&lattice);
}

/* Any byte of a section changed, its checksum mended: an error or a model, never a crash. */
static void damage_behind_a_right_checksum_never_crashes(void **state)
{
	struct lattice lattice;
	struct record_head head;
	struct expansion table;
	uint8_t *record;
	size_t bytes;
	(void)state;
	lattice_make(DIMS[1], 1, &lattice);
	assert_int_equal(pack(&lattice, 60400, 0, &record, &bytes, &head, NULL), BP_OK);
	assert_int_equal(expansion_alloc(head.dims, &table, NULL), BP_OK);
	for (uint32_t s = 0; s < head.section_count; s++)
		for (uint32_t at = 0; at < head.sections[s].bytes; at++)
			for (int bit = 0; bit < 8; bit++) {
				struct model *model = NULL;
				uint8_t *byte = record + head.sections[s].offset + at;
				*byte ^= (uint8_t)(1 << bit);
				head.sections[s].crc32 = bytes_crc32(record + head.sections[s].offset, head.sections[s].bytes);
				if (record_decode_whole(&head, 0, record, &model, NULL) == BP_OK)
					assert_int_equal(model_expand(model, 0, &table, NULL), BP_OK);
				model_free(model);
				*byte ^= (uint8_t)(1 << bit);
				head.sections[s].crc32 = bytes_crc32(record + head.sections[s].offset, head.sections[s].bytes);
			}
	expansion_free(&table);
	free(record);
	lattice_free(&lattice);
}

/* What the library evaluates at some angles: theta_h, theta_d, phi_d in degrees, R, G, B. The half cells at the ends are among them. */
static void looks_write(const char *archive_path, const char *path)
{
	bp_archive *archive = NULL;
	bp_material *material = NULL;
	bp_material_info info = {.struct_bytes = sizeof info};
	FILE *file = fopen(path, "w");
	assert_non_null(file);
	assert_int_equal(bp_archive_open(archive_path, &archive, NULL), BP_OK);
	assert_int_equal(bp_archive_info(archive, 0, &info, NULL), BP_OK);
	assert_int_equal(bp_material_load(archive, 0, NULL, &material, NULL), BP_OK);
	const struct lattice_dims dims = {info.theta_h, info.theta_d, info.phi_d};
	for (int n = 0; n < 40; n++) {
		const double h = dims.theta_h * fmod(0.02 + n * 0.618034, 1), d = dims.theta_d * fmod(0.01 + n * 0.414214, 1);
		const double p = dims.phi_d * fmod(0.005 + n * 0.259921, 1);
		float wi[3], wo[3], rgb[3];
		if (!directions_at(dims, h, d, p, wi, wo))
			continue;
		bp_material_evaluate(material, wi, wo, rgb);
		fprintf(file, "%.12g %.12g %.12g %.9g %.9g %.9g\n", h * h / (dims.theta_h * dims.theta_h) * 90, d / dims.theta_d * 90,
		        p / dims.phi_d * 180, (double)rgb[0], (double)rgb[1], (double)rgb[2]);
	}
	bp_material_free(material);
	bp_archive_close(archive);
	assert_int_equal(fclose(file), 0);
}

static void write_all(const char *folder)
{
	for (int i = 0; i < DIMS_COUNT; i++) {
		char path[512], values[512], looks[512];
		struct archive_writer *writer = NULL;
		struct lattice lattice;
		uint8_t *record;
		size_t bytes;
		snprintf(path, sizeof path, "%s/fitted-%d-%d.bpk", folder, (int)tested, i);
		snprintf(values, sizeof values, "%s/fitted-%d-%d.values", folder, (int)tested, i);
		snprintf(looks, sizeof looks, "%s/fitted-%d-%d.looks", folder, (int)tested, i);
		lattice_make(DIMS[i], 1, &lattice);
		assert_int_equal(pack(&lattice, 60400, 0, &record, &bytes, NULL, NULL), BP_OK);
		assert_int_equal(archive_writer_open(path, &writer, NULL), BP_OK);
		assert_int_equal(archive_writer_add(writer, record, bytes, NULL), BP_OK);
		assert_int_equal(archive_writer_commit(writer, NULL), BP_OK);
		values_write(path, values);
		looks_write(path, looks);
		free(record);
		lattice_free(&lattice);
	}
}

int main(int argc, char **argv)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_recorded_error_of_every_layer_is_the_measured_one),
		cmocka_unit_test(packing_twice_gives_the_same_bytes),
		cmocka_unit_test(a_budget_is_kept_or_the_least_one_is_named),
		cmocka_unit_test(a_budget_is_used_to_the_last_hundredth),
		cmocka_unit_test(an_error_can_be_asked_for_instead),
		cmocka_unit_test(sizes_of_all_orders_pack_and_come_back_finite),
		cmocka_unit_test(an_illegal_name_is_refused),
		cmocka_unit_test(damage_behind_a_right_checksum_never_crashes),
	};
	if (argc == 3 && strcmp(argv[1], "--write") == 0) {
		write_all(argv[2]);
		tested = PROFILE_SPECTRAL;
		write_all(argv[2]);
		return 0;
	}
	int failed = cmocka_run_group_tests_name("paper", tests, NULL, NULL);
	tested = PROFILE_SPECTRAL;
	return failed + cmocka_run_group_tests_name("spectral", tests, NULL, NULL);
}
