/*
 * vectors.h: the small archives of format-spec/vectors, made by hand from the writing functions, byte by
 * byte the same on every machine. tests/test_vectors.c writes them and compares them.
 */
#ifndef TESTS_VECTORS_H
#define TESTS_VECTORS_H

#include "archive_fixture.h"

#include "archive/index.h"
#include "codec/profile_codec.h"
#include "model/paper/paper.h"

/* What a reader makes of it: loads (every layer of every material) and verifies. */
struct vector {
	const char *name;
	bp_status verified; /* by a deep verification */
	const char *sentence;
	void (*make)(const char *path);
};

/* A little generator with fixed parameters (Numerical Recipes' ranqd1), so that contents are arbitrary but known. */
static uint32_t vector_state;
FIXTURE uint32_t vector_random(uint32_t n)
{
	vector_state = vector_state * 1664525u + 1013904223u;
	return (uint32_t)((uint64_t)vector_state * n >> 32);
}

FIXTURE void vector_field(struct lattice_dims dims, enum paper_field kind, uint32_t count, uint16_t step,
                          struct sparse_field *field)
{
	uint32_t next = 0, room = paper_plane_cells(dims, kind);
	*field = (struct sparse_field){.count = count, .step = count ? step : 0};
	if (!count)
		return;
	field->index = malloc(count * sizeof *field->index);
	field->level = malloc(count * sizeof *field->level);
	for (uint32_t i = 0; i < count; i++) {
		next += i ? 1 + vector_random((room - next) / (count - i) * 2 / 3 + 1) : 0;
		field->index[i] = next;
		field->level[i] = (int32_t)vector_random(101) - 50;
		if (field->level[i] == 0)
			field->level[i] = 1;
	}
	field->level[0] = (int32_t)(600 + vector_random(100)); /* the coarse cells hold the mean */
}

struct vector_shape {
	struct lattice_dims dims;
	uint32_t hd, hphi, per_slice; /* coefficients of the pairs and of each slice */
	double scale;
};

/* A model of the paper's profile, every channel another; free with vector_model_free. */
FIXTURE struct model *vector_model(struct vector_shape shape, uint32_t seed)
{
	struct model *model = calloc(1, sizeof *model);
	struct paper_model *paper = calloc(1, sizeof *paper);
	const uint16_t step = PAPER_STEP_ONE - 7 * 256;
	vector_state = seed;
	model->profile = PROFILE_PAPER;
	model->dims = shape.dims;
	model->horizon_limit = -0.0625;
	model->paper = paper;
	paper->dims = shape.dims;
	for (int c = 0; c < 3; c++) {
		struct paper_channel *channel = &paper->channel[c];
		model->colour[c] =
			(struct colour_fit){shape.scale * (0.125 - 0.0625 * c), 1.25 - 0.25 * c, 9u + (uint32_t)c, c != 1, 0.03125 * c};
		channel->scale = shape.scale;
		if (paper_marginals_alloc(shape.dims, channel, NULL) != BP_OK)
			abort();
		for (size_t i = 0; i < paper_marginal_values(shape.dims); i++)
			channel->marginal[0][i] = paper_coded((uint16_t)(PAPER_STEP_ONE - 1000 + vector_random(2000)));
		vector_field(shape.dims, PAPER_HD, shape.hd, step, &channel->hd);
		vector_field(shape.dims, PAPER_HPHI, shape.hphi, step, &channel->hphi);
		channel->slice_count = paper_shared_from(shape.dims.theta_h) + 1;
		channel->slice = calloc(channel->slice_count, sizeof *channel->slice);
		for (uint32_t i = 0; i < channel->slice_count; i++)
			vector_field(shape.dims, PAPER_SLICE, i % 3 == 2 ? 0 : shape.per_slice, step, &channel->slice[i]);
	}
	return model;
}

FIXTURE void vector_model_free(struct model *model) { model_free(model); }

/* The model as sections, and a head that fits them; the caller may change either before sections_join. */
FIXTURE void vector_encode(const char *name, struct vector_shape shape, struct record_head *head, struct section_list *sections)
{
	struct encode_request request = {.name_bytes = strlen(name), .record_bytes_max = 60400};
	struct model *decoded = NULL, *model = vector_model(shape, (uint32_t)strlen(name) * 7 + (unsigned char)name[0]);
	fixture_head(head, name);
	head->dims = model->dims;
	memcpy(head->colour, model->colour, sizeof head->colour);
	memset(sections, 0, sizeof *sections);
	assert_int_equal(paper_encode(model, &request, sections, &head->layer_count, &head->left_out, &decoded, NULL), BP_OK);
	for (uint32_t l = 0; l < head->layer_count; l++)
		head->layers[l].fidelity = (struct fidelity){0.25 / (l + 1), 0.1875 / (l + 1), 0.125 / (l + 1),
		                                             2.0 / (l + 1)}; /* invented: there is no source */
	vector_model_free(model);
}

FIXTURE uint8_t *vector_record(const char *name, struct vector_shape shape, size_t *bytes)
{
	struct record_head head;
	struct section_list sections;
	uint8_t *record = NULL;
	vector_encode(name, shape, &head, &sections);
	assert_int_equal(sections_join(&head, &sections, &record, bytes, NULL), BP_OK);
	section_list_free(&sections);
	return record;
}

static const struct vector_shape SHAPE_MARGINALS = {{4, 4, 4}, 0, 0, 0, 0.5};
static const struct vector_shape SHAPE_PAIRS = {{4, 5, 6}, 6, 7, 0, 0.25};
static const struct vector_shape SHAPE_FULL = {{6, 5, 8}, 8, 9, 5, 2.0};

/* An archive of records given as bytes; frees them. */
FIXTURE void vector_archive(const char *path, uint8_t *const *records, const size_t *bytes, size_t count)
{
	struct archive_writer *writer = NULL;
	assert_int_equal(archive_writer_open(path, &writer, NULL), BP_OK);
	for (size_t i = 0; i < count; i++) {
		assert_int_equal(archive_writer_add(writer, records[i], bytes[i], NULL), BP_OK);
		free(records[i]);
	}
	assert_int_equal(archive_writer_commit(writer, NULL), BP_OK);
}

/* Names of 255 bytes: 15 to a page, so 16 materials take two leaves and a root. */
FIXTURE void vector_two_levels(const char *path)
{
	uint8_t *records[16];
	size_t bytes[16];
	for (int i = 0; i < 16; i++) {
		char name[256];
		memset(name, 'n', 253);
		name[253] = (char)('0' + i / 10), name[254] = (char)('0' + i % 10), name[255] = 0;
		records[i] = vector_record(name, SHAPE_MARGINALS, &bytes[i]);
	}
	vector_archive(path, records, bytes, 16);
}

FIXTURE void vector_three(const char *path)
{
	size_t bytes[3];
	uint8_t *records[3];
	records[0] = vector_record("blue", SHAPE_FULL, &bytes[0]);
	records[1] = vector_record("green", SHAPE_PAIRS, &bytes[1]);
	records[2] = vector_record("red", SHAPE_MARGINALS, &bytes[2]);
	vector_archive(path, records, bytes, 3);
}

FIXTURE void vector_one(const char *path, struct vector_shape shape)
{
	size_t bytes;
	uint8_t *record = vector_record("material", shape, &bytes);
	vector_archive(path, &record, &bytes, 1);
}

#endif
