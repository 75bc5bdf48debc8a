/*
 * vectors_spectral.h: archives of format-spec/vectors with records of the spectral profile, fitted to small tables of
 * rational functions and arbitrary noise, so that no library function's last bit matters.
 */
#ifndef TESTS_VECTORS_DEFAULT_H
#define TESTS_VECTORS_DEFAULT_H

#include "codec/record_origin.h"
#include "vectors.h"

FIXTURE void vector_lattice(struct lattice_dims d, double scale, struct lattice *out)
{
	assert_int_equal(lattice_alloc(d, out, NULL), BP_OK);
	vector_state = d.theta_h * 31 + d.phi_d;
	for (uint32_t i = 0; i < d.theta_h; i++)
		for (uint32_t j = 0; j < d.theta_d; j++)
			for (uint32_t k = 0; k < d.phi_d; k++) {
				const double h = (i + 0.5) / d.theta_h, t = (j + 0.5) / d.theta_d, p = 2 * (k + 0.5) / d.phi_d - 1;
				const double lobe = 4 / (1 + 80 * h * h * h * h), edge = 1 / (1.125 - t * t), swirl = 1 + 0.25 * p * p * h * t;
				for (int c = 0; c < 3; c++) {
					const double noise = 1 + (vector_random(1001) - 500.0) / 10000;
					out->rgb[c][lattice_index(d, i, j, k)] =
						h + t + p * p > 2.25 ? -1 : scale * (0.125 * (c + 1) + lobe * edge) * swirl * noise;
				}
			}
	lattice_validate(out);
}

/* Fitted, with whole rows where there is an error bound, and encoded; the caller may change the sections before sections_join. Error
 * figures are invented, as for the others. */
FIXTURE void vector_spectral_encode(const char *name, struct lattice_dims dims, double scale, uint32_t budget, double max_error,
                                    struct record_head *head, struct section_list *sections)
{
	const struct fit_options options = {.profile = PROFILE_SPECTRAL, .budget_bytes = budget, .max_error = max_error, .effort = 5};
	const struct encode_request request = {.options = &options, .name_bytes = strlen(name), .record_bytes_max = budget};
	struct model *model = NULL, *decoded = NULL;
	struct lattice lattice;
	vector_lattice(dims, scale, &lattice);
	assert_int_equal(model_fit(&lattice, &options, &model, NULL), BP_OK);
	fixture_head(head, name);
	head->profile = PROFILE_SPECTRAL;
	head->dims = dims;
	head->options = options;
	head->horizon_limit = -0.0625;
	memset(sections, 0, sizeof *sections);
	assert_int_equal(spectral_encode(model, &request, sections, &head->layer_count, &head->left_out, &decoded, NULL), BP_OK);
	for (uint32_t l = 0; l < head->layer_count; l++)
		head->layers[l].fidelity = (struct fidelity){0.25 / (l + 1), 0.1875 / (l + 1), 0.125 / (l + 1), 2.0 / (l + 1)};
	model_free(model);
	model_free(decoded);
	lattice_free(&lattice);
}

FIXTURE void vector_spectral_write(const char *path, struct record_head *head, struct section_list *sections)
{
	uint8_t *record;
	size_t bytes;
	assert_int_equal(sections_join(head, sections, &record, &bytes, NULL), BP_OK);
	section_list_free(sections);
	vector_archive(path, &record, &bytes, 1);
}

FIXTURE void vector_spectral(const char *path, struct lattice_dims dims, double scale, uint32_t budget)
{
	struct record_head head;
	struct section_list sections;
	vector_spectral_encode("material", dims, scale, budget, 0, &head, &sections);
	vector_spectral_write(path, &head, &sections);
}

static void make_spectral(const char *path) { vector_spectral(path, (struct lattice_dims){16, 15, 6}, 1, 1500); }
/* Enough cells along theta_h and theta_d for weights; what the caller does to their section comes under a checksum that holds. */
FIXTURE void vector_weights_begin(struct record_head *head, struct section_list *sections)
{
	vector_spectral_encode("material", (struct lattice_dims){21, 20, 4}, 1, 2000, 0, head, sections);
	assert_int_equal(sections->entry[0].version, 8);
}

static void make_spectral_weights(const char *path)
{
	struct record_head head;
	struct section_list sections;
	vector_weights_begin(&head, &sections);
	vector_spectral_write(path, &head, &sections);
}

enum { VECTOR_LIMIT_AT = 80, VECTOR_WEIGHTS_AT = 84 };

/* As versions before codec version 7 wrote it: one quantiser, and no centre of the second. */
FIXTURE void vector_undependent(struct section_list *sections)
{
	enum { CENTRE_SECOND_AT = 64 };
	struct byte_buffer *fields = &sections->bytes[0];
	memmove(fields->bytes + CENTRE_SECOND_AT, fields->bytes + CENTRE_SECOND_AT + 4, fields->count - CENTRE_SECOND_AT - 4);
	fields->count -= 4;
	sections->entry[0].version -= 3;
}

static void make_spectral_single(const char *path)
{
	struct record_head head;
	struct section_list sections;
	vector_weights_begin(&head, &sections);
	vector_undependent(&sections);
	vector_spectral_write(path, &head, &sections);
}

/* As codec version 5 wrote it: 100 weights as they are, and no factors by frequency. */
static void make_spectral_plain(const char *path)
{
	struct record_head head;
	struct section_list sections;
	vector_weights_begin(&head, &sections);
	vector_undependent(&sections);
	sections.entry[0].version = 4;
	sections.bytes[0].count = VECTOR_LIMIT_AT - 4;
	for (uint32_t n = 0; n < 100; n++)
		write_u8(&sections.bytes[0], (uint8_t)(n * 3 % 64));
	vector_spectral_write(path, &head, &sections);
}

static void make_spectral_limit(const char *path)
{
	struct record_head head;
	struct section_list sections;
	vector_weights_begin(&head, &sections);
	store_u32(sections.bytes[0].bytes + VECTOR_LIMIT_AT, 0x3f800000); /* 1 */
	vector_spectral_write(path, &head, &sections);
}

static void make_spectral_weight(const char *path)
{
	struct record_head head;
	struct section_list sections;
	vector_weights_begin(&head, &sections);
	memset(sections.bytes[0].bytes + VECTOR_WEIGHTS_AT, 0xff, sections.bytes[0].count - VECTOR_WEIGHTS_AT);
	vector_spectral_write(path, &head, &sections);
}

static void make_spectral_weights_long(const char *path)
{
	struct record_head head;
	struct section_list sections;
	vector_weights_begin(&head, &sections);
	write_u8(&sections.bytes[0], 0);
	vector_spectral_write(path, &head, &sections);
}
static void make_spectral_least(const char *path) { vector_spectral(path, (struct lattice_dims){4, 4, 4}, 1, 60400); }
static void make_spectral_bright(const char *path) { vector_spectral(path, (struct lattice_dims){4, 5, 6}, 1e300, 60400); }
static void make_spectral_dark(const char *path) { vector_spectral(path, (struct lattice_dims){4, 5, 6}, 1e-300, 60400); }
static void make_spectral_zero(const char *path) { vector_spectral(path, (struct lattice_dims){4, 4, 4}, 0, 60400); }

/* Just enough content for a preview and what follows it: where a coder that does better leaves one layer, take more cells. */
static void make_spectral_layers(const char *path)
{
	struct record_head head;
	struct section_list sections;
	vector_spectral_encode("material", (struct lattice_dims){17, 15, 7}, 1, 6000, 0, &head, &sections);
	assert_int_equal(head.layer_count, 2);
	vector_spectral_write(path, &head, &sections);
}

/* A record that tells of a source by wavelength; `kind`: what its section says of it. */
FIXTURE void vector_origin(const char *path, uint8_t kind)
{
	const struct origin origin = {.kind = ORIGIN_RGL_SPECTRA,
	                              .wavelengths = 195,
	                              .first_nm = 360,
	                              .last_nm = 1000,
	                              .compared = 1000000,
	                              .median = 0.015625,
	                              .percentile95 = 0.125};
	struct record_head head;
	struct section_list sections;
	vector_spectral_encode("material", (struct lattice_dims){4, 4, 4}, 1, 60400, 0, &head, &sections);
	assert_true(record_origin_add(&sections, &origin));
	sections.bytes[0].bytes[0] = kind;
	vector_spectral_write(path, &head, &sections);
}

static void make_origin(const char *path) { vector_origin(path, ORIGIN_RGL_SPECTRA); }
static void make_origin_kind(const char *path) { vector_origin(path, 4); }

/* Rows of phi_d are not cut: an error bound is a promise about all measured values. */
static void make_spectral_whole(const char *path)
{
	struct record_head head;
	struct section_list sections;
	vector_spectral_encode("material", (struct lattice_dims){16, 15, 6}, 1, 1500, 0.0625, &head, &sections);
	vector_spectral_write(path, &head, &sections);
}

/* The same as codec version 4 wrote it. */
static void make_spectral_whole_single(const char *path)
{
	struct record_head head;
	struct section_list sections;
	vector_spectral_encode("material", (struct lattice_dims){16, 15, 6}, 1, 1500, 0.0625, &head, &sections);
	vector_undependent(&sections);
	vector_spectral_write(path, &head, &sections);
}

/* One number of a section changed, under a checksum that holds. */
FIXTURE void vector_spectral_changed(const char *path, int section, size_t at, uint32_t value)
{
	struct record_head head;
	struct section_list sections;
	vector_spectral_encode("material", (struct lattice_dims){4, 4, 4}, 1, 60400, 0, &head, &sections);
	store_u32(sections.bytes[section].bytes + at, value);
	vector_spectral_write(path, &head, &sections);
}

static void make_spectral_planes(const char *path) { vector_spectral_changed(path, 0, 76, 25); }
static void make_spectral_unit(const char *path) { vector_spectral_changed(path, 0, 4, 0x7e700000); }
static void make_spectral_unit_least(const char *path) { vector_spectral_changed(path, 0, 4, 0); }
static void make_spectral_end(const char *path) { vector_spectral_changed(path, 1, 0, 3 * 4 * 24 + 1); }
static void make_spectral_early(const char *path) { vector_spectral_changed(path, 1, 0, 5); }

#endif
