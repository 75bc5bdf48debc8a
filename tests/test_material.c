/* Loading a material from an archive: options, bytes read, lifetimes, threads, and damage. */
#include "archive_fixture.h"

#include <pthread.h>

#include "merl/lattice.h"
#include "model/table/table.h"

static const struct lattice_dims DIMS = {12, 10, 24};
enum { MATERIALS = 100 };

/* A glossy material over the whole lattice; n changes its colour. */
static uint8_t *packed_as(enum profile profile, struct lattice_dims dims, int n, size_t *bytes)
{
	struct lattice lattice;
	struct record_source source = {.bytes = 1};
	struct fit_options options = {.profile = profile, .budget_bytes = 60400, .effort = 5};
	char name[32];
	uint8_t *record = NULL;
	bp_error error;
	snprintf(name, sizeof name, "material-%03d", n);
	assert_int_equal(lattice_alloc(dims, &lattice, &error), BP_OK);
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++)
			for (uint32_t k = 0; k < dims.phi_d; k++)
				for (int c = 0; c < 3; c++) {
					double h = (double)i / dims.theta_h, d = (double)j / dims.theta_d, p = (double)k / dims.phi_d;
					lattice.rgb[c][lattice_index(dims, i, j, k)] =
						0.1 * (c + 1) + (2 + n % 7 + d * d) * exp(-8 * h * h) * (1 + 0.2 * d * h * cos(2 * M_PI * p));
				}
	lattice_validate(&lattice);
	if (record_encode(&lattice, name, &source, &options, &record, bytes, NULL, &error))
		fail_msg("%s", error.message);
	lattice_free(&lattice);
	return record;
}

static uint8_t *packed(int n, size_t *bytes) { return packed_as(PROFILE_PAPER, DIMS, n, bytes); }

static int archive_make(void **state)
{
	struct archive_writer *writer = NULL;
	if (fixture_folder_make(state))
		return -1;
	assert_int_equal(archive_writer_open(fixture_path("hundred.bpk"), &writer, NULL), BP_OK);
	for (int n = 0; n < MATERIALS; n++) {
		size_t bytes;
		uint8_t *record = packed(n, &bytes);
		assert_int_equal(archive_writer_add(writer, record, bytes, NULL), BP_OK);
		free(record);
	}
	assert_int_equal(archive_writer_commit(writer, NULL), BP_OK);
	return 0;
}

static bp_archive *opened(void)
{
	bp_archive *archive = NULL;
	bp_error error;
	if (bp_archive_open(fixture_path("hundred.bpk"), &archive, &error))
		fail_msg("%s", error.message);
	return archive;
}

static void directions(int n, float wi[3], float wo[3])
{
	double a = 0.1 + n * 0.37, b = n * 1.71, c = fmod(n * 0.61, 1.5), d = fmod(n * 0.83, 1.5);
	wi[0] = (float)(sin(c) * cos(a)), wi[1] = (float)(sin(c) * sin(a)), wi[2] = (float)cos(c);
	wo[0] = (float)(sin(d) * cos(b)), wo[1] = (float)(sin(d) * sin(b)), wo[2] = (float)cos(d);
}

static void a_loaded_material_gives_what_its_decoded_table_gives(void **state)
{
	(void)state;
	bp_archive *archive = opened();
	for (int form = 0; form < 2; form++)
		for (int colour = 0; colour < 2; colour++) {
			bp_load_options options = {.struct_bytes = sizeof options, .form = (bp_form)form, .colour = (bp_colour)colour};
			bp_material *material = NULL;
			struct model *model = NULL;
			struct expansion expansion;
			struct table *table = NULL;
			bp_error error;
			if (bp_material_load(archive, 42, &options, &material, &error))
				fail_msg("%s", error.message);
			assert_int_equal(archive_model_load(archive, 42, 0, &model, &error), BP_OK);
			assert_int_equal(expansion_alloc(DIMS, &expansion, &error), BP_OK);
			assert_int_equal(model_expand(model, 0, &expansion, &error), BP_OK);
			assert_int_equal(table_build(&expansion, (enum table_form)form, colour ? 1 : 3, &table, &error), BP_OK);
			for (int n = 0; n < 500; n++) {
				float wi[3], wo[3], got[3], want[3];
				directions(n, wi, wo);
				bp_material_evaluate(material, wi, wo, got);
				table_evaluate(table, wi, wo, want);
				assert_memory_equal(got, want, sizeof got);
				assert_true(got[0] >= 0);
				assert_true(!colour || (got[0] == got[1] && got[1] == got[2]));
				bp_material_nearest(material, wi, wo, got);
				table_nearest(table, wi, wo, want);
				assert_memory_equal(got, want, sizeof got);
				bp_material_evaluate_batch(material, 1, (const float *const[]){&wi[0], &wi[1], &wi[2]},
				                           (const float *const[]){&wo[0], &wo[1], &wo[2]},
				                           (float *const[]){&got[0], &got[1], &got[2]});
				table_evaluate(table, wi, wo, want);
				assert_memory_equal(got, want, sizeof got);
			}
			bp_material_evaluate_batch(material, 0, NULL, NULL, NULL); /* nothing is looked at */
			bp_material_free(material);
			model_free(model);
			expansion_free(&expansion);
			table_free(table);
		}
	bp_archive_close(archive);
}

/* Each channel's sections are a third of the record; what is loaded gives that channel in all three places. */
static void a_channel_is_loaded_alone(void **state)
{
	(void)state;
	bp_archive *archive = opened();
	bp_material *whole = NULL;
	bp_material_info info = {.struct_bytes = sizeof info};
	assert_int_equal(bp_material_load(archive, 7, NULL, &whole, NULL), BP_OK);
	assert_int_equal(bp_archive_info(archive, 7, &info, NULL), BP_OK);
	uint32_t read = 0;
	for (int c = 0; c < 3; c++) {
		const bp_load_options options = {.struct_bytes = sizeof options, .colour = (bp_colour)(BP_COLOUR_R + c)};
		bp_loaded loaded = {.struct_bytes = sizeof loaded};
		bp_material *alone = NULL;
		assert_int_equal(bp_material_load(archive, 7, &options, &alone, NULL), BP_OK);
		assert_int_equal(bp_material_loaded(alone, &loaded, NULL), BP_OK);
		assert_true(loaded.colour == options.colour);
		assert_true(loaded.read_bytes - info.head_bytes < 2 * (info.record_bytes - info.head_bytes) / 5);
		read += loaded.read_bytes - info.head_bytes;
		for (int n = 0; n < 300; n++) {
			float wi[3], wo[3], a[3], b[3];
			directions(n, wi, wo);
			bp_material_evaluate(alone, wi, wo, a);
			bp_material_evaluate(whole, wi, wo, b);
			assert_true(a[0] == a[1] && a[1] == a[2]);
			assert_true(fabsf(a[0] - b[c]) <= 2e-3f * b[c] + 1e-5f);
		}
		bp_material_free(alone);
	}
	assert_int_equal(read, info.record_bytes - info.head_bytes);
	bp_material_free(whole);
	bp_archive_close(archive);
}

static void a_preview_is_the_same_material_of_fewer_values(void **state)
{
	(void)state;
	bp_archive *archive = opened(); /* 12 x 10 x 24 */
	bp_load_options options = {.struct_bytes = sizeof options, .form = BP_FORM_PREVIEW};
	bp_loaded loaded = {.struct_bytes = sizeof loaded};
	bp_material *preview = NULL, *whole = NULL;
	assert_int_equal(bp_material_load(archive, 5, &options, &preview, NULL), BP_OK);
	assert_int_equal(bp_material_load(archive, 5, NULL, &whole, NULL), BP_OK);
	assert_int_equal(bp_material_loaded(preview, &loaded, NULL), BP_OK);
	assert_true(loaded.form == BP_FORM_PREVIEW && loaded.memory_bytes < 6 * 5 * 13 * 6 + 2000);
	double gap = 0, sum = 0;
	for (int n = 0; n < 500; n++) {
		float wi[3], wo[3], a[3], b[3];
		directions(n, wi, wo);
		bp_material_evaluate(preview, wi, wo, a);
		bp_material_evaluate(whole, wi, wo, b);
		gap += fabs((double)a[1] - (double)b[1]);
		sum += (double)b[1];
	}
	assert_true(gap < 0.2 * sum); /* very coarse here, but the same material */
	bp_material_free(preview);
	bp_material_free(whole);
	bp_archive_close(archive);
}

static void options_decide_what_is_there_and_it_says_so(void **state)
{
	(void)state;
	bp_archive *archive = opened();
	bp_load_options options = {.struct_bytes = sizeof options, .form = BP_FORM_COMPACT, .colour = BP_COLOUR_MEAN, .sampling = 1};
	bp_loaded loaded = {.struct_bytes = sizeof loaded};
	bp_material_info info = {.struct_bytes = sizeof info};
	bp_material *whole = NULL, *small = NULL;
	const float wo[3] = {0.6f, 0, 0.8f}, u[3] = {0.5f, 0.3f, 0.4f};
	float wi[3] = {7, 7, 7}, rgb[3];
	assert_int_equal(bp_material_load(archive, 0, NULL, &whole, NULL), BP_OK);
	assert_int_equal(bp_material_load(archive, 0, &options, &small, NULL), BP_OK);
	assert_int_equal(bp_archive_info(archive, 0, &info, NULL), BP_OK);

	assert_int_equal(bp_material_loaded(whole, &loaded, NULL), BP_OK);
	assert_true(loaded.form == BP_FORM_EXPANDED && loaded.colour == BP_COLOUR_RGB && loaded.sampling == 0);
	bp_layer layers[BP_LAYERS_MAX];
	assert_int_equal(bp_archive_layers(archive, 0, sizeof *layers, layers, BP_LAYERS_MAX, NULL, NULL), BP_OK);
	assert_true(loaded.layers == info.layer_count && loaded.log_rmse == layers[info.layer_count - 1].log_rmse);
	assert_true(loaded.theta_h == 12 && loaded.theta_d == 10 && loaded.phi_d == 24);
	assert_true(loaded.read_bytes == info.record_bytes);
	size_t bytes = loaded.memory_bytes;
	assert_true(bytes > 12 * 10 * 24 * 6 && bytes < 12 * 10 * 25 * 6 + 2000);
	assert_int_equal(bp_material_loaded(small, &loaded, NULL), BP_OK);
	assert_true(loaded.form == BP_FORM_COMPACT && loaded.colour == BP_COLOUR_MEAN && loaded.sampling == 1);

	assert_true(bp_material_sample(whole, wo, u, wi) == 0 && wi[0] == 0 && wi[1] == 0 && wi[2] == 0);
	assert_true(bp_material_pdf(whole, wo, wo) == 0);
	bp_material_albedo(whole, 0.5f, rgb);
	assert_true(rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0);
	float pdf = bp_material_sample(small, wo, u, wi);
	assert_true(pdf > 0 && wi[2] > 0 && pdf == bp_material_pdf(small, wi, wo));
	bp_material_albedo(small, 0.5f, rgb);
	assert_true(rgb[0] > 0 && rgb[0] == rgb[2]);
	loaded.struct_bytes--;
	assert_int_equal(bp_material_loaded(small, &loaded, NULL), BP_ERROR_ARGUMENT);
	bp_material_free(whole);
	bp_material_free(small);
	bp_material_free(NULL);
	bp_archive_close(archive);
}

static void options_out_of_range_are_refused(void **state)
{
	(void)state;
	bp_archive *archive = opened();
	bp_material *material = NULL;
	bp_error error;
	const bp_load_options good = {.struct_bytes = sizeof good};
	bp_load_options bad[8];
	for (int n = 0; n < 8; n++)
		bad[n] = good;
	bad[0].struct_bytes = 0;
	bad[1].max_log_rmse = -1e-9;
	bad[2].max_log_rmse = NAN;
	bad[3].form = (bp_form)3;
	bad[4].colour = (bp_colour)7;
	bad[5].sampling = 2;
	bad[6].struct_bytes = sizeof good + 8;
	bad[7].form = (bp_form)-1;
	for (int n = 0; n < 8; n++) {
		assert_int_equal(bp_material_load(archive, 0, &bad[n], &material, &error), BP_ERROR_ARGUMENT);
		assert_int_equal(error.status, BP_ERROR_ARGUMENT);
		assert_null(material);
	}
	assert_int_equal(bp_material_load(archive, MATERIALS, &good, &material, &error), BP_ERROR_NOT_FOUND);
	assert_null(material);
	bp_archive_close(archive);
}

/* The first material is loaded with a limit of `need` bytes and 1 MB, and no byte less. */
static void expect_need(const bp_archive *archive, size_t need)
{
	bp_load_options options = {.struct_bytes = sizeof options};
	bp_material *material = NULL;
	bp_error error;
	need += 1000000;
	options.max_memory_bytes = need - 1;
	assert_int_equal(bp_material_load(archive, 0, &options, &material, &error), BP_ERROR_LIMIT);
	assert_null(material);
	assert_non_null(strstr(error.message, "max_memory_bytes"));
	options.max_memory_bytes = 1000;
	assert_int_equal(bp_material_load(archive, 0, &options, &material, &error), BP_ERROR_LIMIT);
	assert_non_null(strstr(error.message, "limit is 0.001 MB"));
	options.max_memory_bytes = need;
	assert_int_equal(bp_material_load(archive, 0, &options, &material, &error), BP_OK);
	bp_material_free(material);
}

/* The limit is what brdfpack.h says: where phi_d has few cells, lanes of whole blocks; where it has hundreds, every span's cosines. */
static void what_may_need_more_memory_than_allowed_is_refused(void **state)
{
	(void)state;
	bp_archive *archive = opened();
	expect_need(archive, 120 * (12 * 32 + 9 * 24 + 24) + 24 * 24 * 24 / 3);
	bp_archive_close(archive);

	const struct {
		struct lattice_dims dims;
		size_t need;
	} cases[] = {
		{{32, 32, 60}, 24 * 32 * 32 * 60},
		{{12, 10, 4}, 120 * (12 * 16 + 9 * 4 + 24) + 4 * 4 * 4 / 3 + 1},
		{{4, 4, 1024}, 16 * (12 * 1024 + 9 * 1024 + 24) + 1024 * 1024 * 2 * 16},
	};
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		size_t bytes;
		uint8_t *record = packed_as(PROFILE_SPECTRAL, cases[n].dims, 0, &bytes);
		struct archive_writer *writer = NULL;
		assert_int_equal(archive_writer_open(fixture_path("need.bpk"), &writer, NULL), BP_OK);
		assert_int_equal(archive_writer_add(writer, record, bytes, NULL), BP_OK);
		assert_int_equal(archive_writer_commit(writer, NULL), BP_OK);
		free(record);
		assert_int_equal(bp_archive_open(fixture_path("need.bpk"), &archive, NULL), BP_OK);
		expect_need(archive, cases[n].need);
		bp_archive_close(archive);
	}
}

static void opening_and_loading_read_little_more_than_the_record(void **state)
{
	(void)state;
	for (int form = 0; form < 2; form++) {
		bp_archive *archive = opened();
		bp_load_options options = {.struct_bytes = sizeof options, .form = (bp_form)form};
		bp_loaded loaded = {.struct_bytes = sizeof loaded};
		bp_material *material = NULL;
		uint64_t index;
		assert_int_equal(bp_archive_find(archive, "material-073", &index, NULL), BP_OK);
		assert_int_equal(bp_material_load(archive, index, &options, &material, NULL), BP_OK);
		assert_int_equal(bp_material_loaded(material, &loaded, NULL), BP_OK);
		assert_true(bp_archive_bytes_read(archive) <= loaded.read_bytes + 16384);
		bp_material_free(material);
		bp_archive_close(archive);
	}
}

static void a_material_outlives_its_archive(void **state)
{
	(void)state;
	bp_archive *archive = opened();
	bp_material *material = NULL;
	float wi[3], wo[3], before[3], after[3];
	directions(3, wi, wo);
	assert_int_equal(bp_material_load(archive, 7, NULL, &material, NULL), BP_OK);
	bp_material_evaluate(material, wi, wo, before);
	bp_archive_close(archive);
	bp_material_evaluate(material, wi, wo, after);
	assert_memory_equal(before, after, sizeof before);
	bp_material_free(material);
}

struct loader {
	const bp_archive *archive;
	double sum;
	bp_status status;
};

static void *load_all(void *user)
{
	struct loader *loader = user;
	for (uint64_t n = 0; n < MATERIALS && !loader->status; n++) {
		bp_material *material = NULL;
		float wi[3], wo[3], rgb[3];
		loader->status = bp_material_load(loader->archive, n, NULL, &material, NULL);
		if (loader->status)
			break;
		directions((int)n, wi, wo);
		bp_material_evaluate(material, wi, wo, rgb);
		loader->sum += (double)rgb[1];
		bp_material_free(material);
	}
	return NULL;
}

static void several_threads_load_from_one_archive(void **state)
{
	(void)state;
	enum { THREADS = 4 };
	bp_archive *archive = opened();
	struct loader loaders[THREADS];
	pthread_t threads[THREADS];
	for (int n = 0; n < THREADS; n++) {
		loaders[n] = (struct loader){archive, 0, BP_OK};
		assert_int_equal(pthread_create(&threads[n], NULL, load_all, &loaders[n]), 0);
	}
	for (int n = 0; n < THREADS; n++)
		pthread_join(threads[n], NULL);
	for (int n = 0; n < THREADS; n++) {
		assert_int_equal(loaders[n].status, BP_OK);
		assert_true(loaders[n].sum == loaders[0].sum);
	}
	bp_archive_close(archive);
}

static void a_file_replaced_while_open_stays_the_old_one(void **state)
{
	(void)state;
	size_t count;
	uint8_t *bytes = fixture_file_read(fixture_path("hundred.bpk"), &count);
	char path[512], other[512];
	bp_archive *archive = NULL;
	bp_material *material = NULL;
	float wi[3], wo[3], before[3], after[3];
	directions(3, wi, wo);
	strcpy(path, fixture_path("open.bpk"));
	strcpy(other, fixture_path("other.bpk"));
	fixture_file_write(path, bytes, count);
	fixture_file_write(other, "something else", 14);
	assert_int_equal(bp_archive_open(path, &archive, NULL), BP_OK);
	assert_int_equal(bp_material_load(archive, 9, NULL, &material, NULL), BP_OK);
	bp_material_evaluate(material, wi, wo, before);
	bp_material_free(material);
	assert_int_equal(rename(other, path), 0);
	assert_int_equal(bp_material_load(archive, 9, NULL, &material, NULL), BP_OK);
	bp_material_evaluate(material, wi, wo, after);
	assert_memory_equal(before, after, sizeof before);
	bp_material_free(material);
	bp_archive_close(archive);
	assert_int_equal(bp_archive_open(path, &archive, NULL), BP_ERROR_NOT_OURS);
	free(bytes);
}

static void a_file_damaged_while_open_gives_errors(void **state)
{
	(void)state;
	size_t count;
	uint8_t *bytes = fixture_file_read(fixture_path("hundred.bpk"), &count);
	const char *path = fixture_path("damaged.bpk");
	bp_archive *archive = NULL;
	bp_material_info info = {.struct_bytes = sizeof info};
	bp_material *material = NULL;
	bp_error error;
	fixture_file_write(path, bytes, count);
	assert_int_equal(bp_archive_open(path, &archive, NULL), BP_OK);
	assert_int_equal(bp_archive_info(archive, 50, &info, NULL), BP_OK);
	/* overwritten in the last section of material 50 */
	FILE *file = fopen(path, "r+b");
	assert_non_null(file);
	fseek(file, (long)(info.record_offset + info.record_bytes - 1), SEEK_SET);
	fputc(bytes[info.record_offset + info.record_bytes - 1] ^ 1, file);
	fclose(file);
	assert_int_equal(bp_material_load(archive, 50, NULL, &material, &error), BP_ERROR_CHECKSUM);
	assert_true(error.offset >= info.record_offset && error.offset < info.record_offset + info.record_bytes);
	assert_int_equal(bp_material_load(archive, 49, NULL, &material, &error), BP_OK);
	bp_material_free(material);
	/* cut */
	material = NULL;
	assert_int_equal(truncate(path, (off_t)(info.record_offset + 20)), 0);
	assert_int_equal(bp_material_load(archive, 51, NULL, &material, &error), BP_ERROR_CORRUPT);
	assert_null(material);
	bp_archive_close(archive);
	free(bytes);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_loaded_material_gives_what_its_decoded_table_gives),
		cmocka_unit_test(a_channel_is_loaded_alone),
		cmocka_unit_test(a_preview_is_the_same_material_of_fewer_values),
		cmocka_unit_test(options_decide_what_is_there_and_it_says_so),
		cmocka_unit_test(options_out_of_range_are_refused),
		cmocka_unit_test(what_may_need_more_memory_than_allowed_is_refused),
		cmocka_unit_test(opening_and_loading_read_little_more_than_the_record),
		cmocka_unit_test(a_material_outlives_its_archive),
		cmocka_unit_test(several_threads_load_from_one_archive),
		cmocka_unit_test(a_file_replaced_while_open_stays_the_old_one),
		cmocka_unit_test(a_file_damaged_while_open_gives_errors),
	};
	return cmocka_run_group_tests(tests, archive_make, fixture_folder_remove);
}
