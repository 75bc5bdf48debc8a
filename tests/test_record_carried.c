/*
 * A table that was decoded from a record comes with it, by way of a MERL file, and keeps it: packed, extracted, packed again, the
 * record is the same to the byte, in both profiles. Where its values are not the file's, or it would not serve, nothing is kept.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "codec/record_carried.h"
#include "codec/section.h"
#include "merl/merl_file.h"
#include "packed_fixture.h"
#include "scratch.h"

static const struct lattice_dims DIMS = {20, 16, 24};
static const struct fit_options USUAL[2] = {{.profile = PROFILE_PAPER, .budget_bytes = 9000, .effort = 5},
                                            {.profile = PROFILE_SPECTRAL, .budget_bytes = 9000, .effort = 5}};
static const struct record_source MEASURED = {.bytes = 1, .sha256 = {1}, .nonfinite_count = 3};

/* A record and the table that it decodes to. */
struct packed {
	uint8_t *record;
	size_t bytes;
	struct record_head head;
	struct expansion table;
	uint8_t *below;
};

static void decode(struct packed *packed)
{
	struct model *model;
	assert_int_equal(record_head_read(packed->record, packed->bytes, &packed->head, NULL), BP_OK);
	assert_int_equal(record_decode_whole(&packed->head, 0, packed->record, &model, NULL), BP_OK);
	assert_int_equal(expansion_alloc(packed->head.dims, &packed->table, NULL), BP_OK);
	assert_int_equal(model_expand(model, 0, &packed->table, NULL), BP_OK);
	packed->below = malloc(lattice_cells(packed->head.dims));
	assert_non_null(packed->below);
	lattice_below_horizon(packed->head.dims, packed->head.horizon_limit, packed->below);
	model_free(model);
}

static void packed_make(const struct fit_options *options, struct packed *packed)
{
	struct lattice lattice;
	uint8_t below[20 * 16 * 24];
	glossy_lattice_make(DIMS, 1, &lattice);
	lattice_below_horizon(DIMS, LATTICE_MERL_HORIZON, below);
	for (size_t n = 0; n < sizeof below; n++)
		for (int c = 0; c < 3; c++)
			lattice.rgb[c][n] =
				below[n] ? -1 : lattice.rgb[c][n] * (1 + 0.3 * sin((double)(n * (size_t)(c + 3)))); /* rough: the budget binds */
	lattice_validate(&lattice);
	assert_int_equal(record_encode(&lattice, "first", &MEASURED, options, &packed->record, &packed->bytes, NULL, NULL), BP_OK);
	decode(packed);
	lattice_free(&lattice);
}

static void packed_free(struct packed *packed)
{
	free(packed->record);
	free(packed->below);
	expansion_free(&packed->table);
}

/* What is read from a file. */
struct file {
	struct lattice lattice;
	struct carried carried;
};

static void file_free(struct file *file)
{
	lattice_free(&file->lattice);
	free(file->carried.bytes);
}

/* Through a file, which carries these bytes. */
static void extracted(const struct packed *packed, const uint8_t *carried, size_t bytes, struct file *out)
{
	char path[SCRATCH_BYTES];
	assert_int_equal(scratch_file(path), 0);
	assert_int_equal(lattice_write_path(path, OUTPUT_REPLACE, &packed->table, packed->below, carried, bytes, NULL), BP_OK);
	assert_int_equal(
		lattice_read_path(path, &(struct merl_reading){.any_dims = true, .carried = &out->carried}, &out->lattice, NULL), BP_OK);
	unlink(path);
}

static bool kept(const struct file *file, const char *name, struct fit_options options)
{
	uint8_t *record = NULL;
	size_t bytes;
	assert_int_equal(record_carried(&file->lattice, &file->carried, name, &options, &record, &bytes, NULL), BP_OK);
	free(record);
	return record != NULL;
}

static void the_record_stays_the_same_byte_for_byte(void **state)
{
	(void)state;
	for (int p = 0; p < 2; p++) {
		struct packed first;
		struct file file;
		uint8_t *record;
		size_t bytes;
		packed_make(&USUAL[p], &first);
		extracted(&first, first.record, first.bytes, &file);
		assert_int_equal(record_carried(&file.lattice, &file.carried, "first", &USUAL[p], &record, &bytes, NULL), BP_OK);
		assert_non_null(record);
		assert_int_equal(bytes, first.bytes);
		assert_memory_equal(record, first.record, bytes);
		free(record);
		file_free(&file);
		packed_free(&first);
	}
}

static void another_name_is_all_that_changes(void **state)
{
	(void)state;
	for (int p = 0; p < 2; p++) {
		struct packed first, again = {0};
		struct file file;
		packed_make(&USUAL[p], &first);
		extracted(&first, first.record, first.bytes, &file);
		assert_int_equal(record_carried(&file.lattice, &file.carried, "second", &USUAL[p], &again.record, &again.bytes, NULL),
		                 BP_OK);
		assert_non_null(again.record);
		decode(&again);
		for (int c = 0; c < 3; c++)
			assert_memory_equal(first.table.rgb[c], again.table.rgb[c], lattice_cells(DIMS) * sizeof(float));
		assert_memory_equal(first.below, again.below, lattice_cells(DIMS));
		assert_string_equal(again.head.name, "second");
		/* Where the record comes from and how near to that it is are facts of the measured file. */
		assert_memory_equal(&again.head.source, &MEASURED, sizeof MEASURED);
		assert_int_equal(again.head.layer_count, first.head.layer_count);
		for (uint32_t l = 0; l < first.head.layer_count; l++)
			assert_memory_equal(&again.head.layers[l].fidelity, &first.head.layers[l].fidelity, sizeof(struct fidelity));
		assert_int_equal(again.head.codec_version, first.head.codec_version);
		file_free(&file);
		packed_free(&first);
		packed_free(&again);
	}
}

static void a_changed_value_makes_it_a_measurement_again(void **state)
{
	(void)state;
	struct packed first;
	struct file file;
	packed_make(&USUAL[1], &first);
	for (int what = 0; what < 4; what++) {
		extracted(&first, first.record, first.bytes, &file);
		assert_true(kept(&file, "m", USUAL[1]));
		const size_t cells = lattice_cells(DIMS);
		size_t cell = what == 3 ? 0 : cells / 2;
		while (file.lattice.valid[cell] != (what != 2))
			cell = (cell + 1) % cells;
		if (what < 2)
			file.lattice.rgb[2 * what][cell] *= 1 + 0x1p-50;
		file.lattice.valid[cell] ^= what >= 2; /* 2: one more is measured; 3: one less */
		assert_false(kept(&file, "m", USUAL[1]));
		file_free(&file);
	}
	packed_free(&first);
}

static void another_request_is_packed_anew(void **state)
{
	(void)state;
	struct packed first, bounded;
	struct file file;
	struct fit_options options = USUAL[1];
	packed_make(&options, &first);
	extracted(&first, first.record, first.bytes, &file);
	options.effort = 9; /* what is exact cannot be better */
	assert_true(kept(&file, "m", options));
	options.budget_bytes = 100000;
	assert_true(kept(&file, "m", options));
	options.budget_bytes = (uint32_t)first.bytes;
	assert_true(kept(&file, "fives", options)); /* as long as its name is no longer */
	assert_false(kept(&file, "longer", options));
	options.budget_bytes = (uint32_t)first.bytes - 1;
	assert_false(kept(&file, "fives", options));
	assert_true(kept(&file, "four", options));
	assert_false(kept(&file, "m", USUAL[0]));
	options = (struct fit_options){.profile = PROFILE_SPECTRAL, .budget_bytes = 100000, .max_error = 0.01, .effort = 5};
	assert_false(kept(&file, "m", options));        /* a smaller record might do */
	assert_false(kept(&file, "no/name", USUAL[1])); /* record_encode says why */
	file_free(&file);
	packed_free(&first);

	packed_make(&options, &bounded);
	extracted(&bounded, bounded.record, bounded.bytes, &file);
	assert_true(kept(&file, "m", options));
	options.max_error = 0.02;
	assert_false(kept(&file, "m", options));
	file_free(&file);
	packed_free(&bounded);
}

static void a_damaged_or_foreign_record_is_not_kept(void **state)
{
	(void)state;
	struct packed first;
	struct file file;
	packed_make(&USUAL[1], &first);
	uint8_t *bytes = malloc(first.bytes);
	assert_non_null(bytes);
	for (size_t at = 0; at < first.bytes; at += at < 300 ? 1 : 97) {
		memcpy(bytes, first.record, first.bytes);
		bytes[at] ^= 0x10;
		extracted(&first, bytes, first.bytes, &file);
		assert_false(kept(&file, "m", USUAL[1]));
		file_free(&file);
	}
	extracted(&first, first.record, first.bytes - 1, &file);
	assert_false(kept(&file, "m", USUAL[1]));
	file_free(&file);
	extracted(&first, NULL, 0, &file);
	assert_null(file.carried.bytes);
	assert_false(kept(&file, "m", USUAL[1]));
	file_free(&file);
	free(bytes);
	packed_free(&first);
}

/* The record with its sections and head as `change` leaves them; it has all its checksums. */
static void foreign_make(const struct packed *first, void (*change)(struct record_head *, struct section_list *),
                         uint8_t **record, size_t *bytes)
{
	struct section_list sections = {0};
	struct record_head head = first->head;
	for (uint32_t i = 0; i < head.section_count; i++) {
		const struct record_section *entry = &head.sections[i];
		write_bytes(section_add(&sections, (enum section_type)entry->type, entry->codec, entry->version, entry->layer,
		                        entry->flags, entry->error),
		            first->record + entry->offset, entry->bytes);
	}
	change(&head, &sections);
	assert_int_equal(sections_join(&head, &sections, record, bytes, NULL), BP_OK);
	section_list_free(&sections);
}

static void all_in_the_last_layer(struct record_head *head, struct section_list *sections)
{
	for (uint32_t i = 0; i < sections->count; i++)
		sections->entry[i].layer = (uint16_t)(head->layer_count - 1);
}

static void of_other_extents(struct record_head *head, struct section_list *sections)
{
	(void)sections;
	head->dims.theta_h--;
}

static void unknown_add(struct record_head *head, struct section_list *sections, uint32_t flags)
{
	write_u32(section_add(sections, (enum section_type)999, 0, 1, head->layer_count - 1, flags, NAN), 7);
}

static void with_a_section_that_is_required(struct record_head *head, struct section_list *sections)
{
	unknown_add(head, sections, SECTION_REQUIRED);
}

static void with_a_section_that_is_not(struct record_head *head, struct section_list *sections)
{
	unknown_add(head, sections, 0);
}

/* Every checksum holds, and the whole record has the file's values; but whoever loads a part of it would find nothing, or not understand it. */
static void a_record_that_does_not_decode_layer_by_layer_is_not_kept(void **state)
{
	(void)state;
	static void (*const changes[])(struct record_head *, struct section_list *) = {
		all_in_the_last_layer, of_other_extents, with_a_section_that_is_required, with_a_section_that_is_not};
	for (int p = 0; p < 2; p++) {
		struct packed first;
		packed_make(&USUAL[p], &first);
		assert_true(first.head.layer_count > 1);
		for (int n = 0; n < 4; n++) {
			const struct fit_options options = {.profile = USUAL[p].profile, .budget_bytes = 20000, .effort = 5};
			struct file file;
			uint8_t *record;
			size_t bytes;
			foreign_make(&first, changes[n], &record, &bytes);
			extracted(&first, record, bytes, &file);
			assert_int_equal(file.carried.count, bytes);
			assert_int_equal(kept(&file, "m", options), n == 3); /* what is optional does no harm */
			file_free(&file);
			free(record);
		}
		packed_free(&first);
	}
}

/* Four extents have two cells below the horizon: no record fits there. */
static void without_room_nothing_is_carried(void **state)
{
	(void)state;
	struct packed packed = {0};
	struct file file = {0};
	glossy_lattice_make((struct lattice_dims){4, 4, 4}, 1, &file.lattice);
	assert_int_equal(record_encode(&file.lattice, "m", &MEASURED, &USUAL[1], &packed.record, &packed.bytes, NULL, NULL), BP_OK);
	file_free(&file);
	decode(&packed);
	extracted(&packed, packed.record, packed.bytes, &file);
	assert_null(file.carried.bytes);
	for (size_t n = 0; n < 64; n++)
		assert_int_equal(file.lattice.valid[n], !packed.below[n]);
	file_free(&file);
	packed_free(&packed);
}

/* A record that lost layers stays marked as such. */
static void a_shortened_record_is_kept_as_it_is(void **state)
{
	(void)state;
	struct packed first, shorter = {0};
	struct file file;
	struct record_head head;
	uint8_t *record;
	size_t bytes;
	packed_make(&USUAL[1], &first);
	assert_true(first.head.layer_count > 1);
	assert_int_equal(record_keep_layers(first.record, first.bytes, 1, &shorter.record, &shorter.bytes, NULL), BP_OK);
	decode(&shorter);
	extracted(&shorter, shorter.record, shorter.bytes, &file);
	assert_int_equal(record_carried(&file.lattice, &file.carried, "m", &USUAL[1], &record, &bytes, NULL), BP_OK);
	assert_non_null(record);
	assert_int_equal(record_head_read(record, bytes, &head, NULL), BP_OK);
	assert_int_equal(head.codec_version, RECORD_LAYERS_DROPPED);
	free(record);
	file_free(&file);
	packed_free(&first);
	packed_free(&shorter);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_record_stays_the_same_byte_for_byte),
		cmocka_unit_test(another_name_is_all_that_changes),
		cmocka_unit_test(a_changed_value_makes_it_a_measurement_again),
		cmocka_unit_test(another_request_is_packed_anew),
		cmocka_unit_test(a_damaged_or_foreign_record_is_not_kept),
		cmocka_unit_test(a_record_that_does_not_decode_layer_by_layer_is_not_kept),
		cmocka_unit_test(without_room_nothing_is_carried),
		cmocka_unit_test(a_shortened_record_is_kept_as_it_is),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
