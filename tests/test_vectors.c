/*
 * The archives of format-spec/vectors: written by `test_vectors --write FOLDER`, otherwise made again in a
 * temporary folder, compared byte for byte with the committed ones, and read.
 */
#include "values.h"
#include "vectors.h"

#include "vectors_damaged.h"
#include "vectors_spectral.h"

/* ---- good ---- */

static void make_marginals(const char *path) { vector_one(path, SHAPE_MARGINALS); }
static void make_pairs(const char *path) { vector_one(path, SHAPE_PAIRS); }
static void make_slices(const char *path) { vector_one(path, SHAPE_FULL); }
static void make_no_hd(const char *path) { vector_one(path, (struct vector_shape){{4, 4, 4}, 0, 5, 6, 1}); }
static void make_odd(const char *path) { vector_one(path, (struct vector_shape){{7, 5, 11}, 9, 9, 8, 0.75}); }
static void make_larger(const char *path) { vector_one(path, (struct vector_shape){{9, 16, 8}, 20, 18, 14, 3}); }
static void make_bright(const char *path) { vector_one(path, (struct vector_shape){{6, 5, 8}, 8, 9, 5, 1e300}); }
static void make_dark(const char *path) { vector_one(path, (struct vector_shape){{6, 5, 8}, 8, 9, 5, 1e-300}); }
static void make_zero(const char *path) { vector_one(path, (struct vector_shape){{6, 5, 8}, 8, 9, 5, 0}); }

/* Holes by the rule that takes every zero; the count is the head's word alone. */
static void make_holes(const char *path) { head_with(path, 52, 0x10000000 + 6 * 5 * 8, 4, "material"); }

static void make_empty(const char *path) { vector_archive(path, NULL, NULL, 0); }

static void make_names(const char *path)
{
	static const char *const names[] = {" ", "!", "A", "a", "caf\xC3\xA9", "\xE9\x8A\x80", "\xF0\x9F\x8E\xA8"};
	char longest[256];
	uint8_t *records[8];
	size_t bytes[8];
	memset(longest, 'n', 255);
	longest[255] = 0;
	for (int i = 0; i < 8; i++)
		records[i] = vector_record(i < 5 ? names[i] : i == 5 ? longest : names[i - 1], SHAPE_MARGINALS, &bytes[i]);
	vector_archive(path, records, bytes, 8);
}

static void make_with_section(const char *path, uint32_t flags)
{
	struct record_head head;
	struct section_list sections;
	uint8_t *record;
	size_t bytes;
	vector_encode("material", SHAPE_FULL, &head, &sections);
	write_bytes(section_add(&sections, (enum section_type)900, 1, 1, 2, flags, 0.5), "of a later version", 18);
	assert_int_equal(sections_join(&head, &sections, &record, &bytes, NULL), BP_OK);
	section_list_free(&sections);
	vector_archive(path, &record, &bytes, 1);
}

static void make_optional_section(const char *path) { make_with_section(path, 0xFF00); }
static void make_required_section(const char *path) { make_with_section(path, SECTION_REQUIRED); }

static void make_dropped_layer(const char *path)
{
	size_t bytes, kept_bytes;
	uint8_t *record = vector_record("material", SHAPE_FULL, &bytes), *kept;
	assert_int_equal(record_keep_layers(record, bytes, 2, &kept, &kept_bytes, NULL), BP_OK);
	free(record);
	vector_archive(path, &kept, &kept_bytes, 1);
}

static const struct vector VECTORS[] = {
	{"good-marginals", BP_OK, "One material, 4x4x4, all pairs left out.", make_marginals},
	{"good-pairs", BP_OK, "4x5x6 with both unconditional pairs, two layers.", make_pairs},
	{"good-slices", BP_OK, "6x5x8 with everything, three layers; the last of five slices is shared, one is empty.", make_slices},
	{"good-no-hd", BP_OK, "4x4x4 with c_hd left out.", make_no_hd},
	{"good-one-layer", BP_OK, "6x5x8 with everything in one layer: the sections say what is there, not the layers.",
     make_one_layer},
	{"good-odd-extents", BP_OK, "7x5x11: transform planes larger than the fields.", make_odd},
	{"good-larger", BP_OK, "9x16x8: one to three wavelet levels.", make_larger},
	{"good-bright", BP_OK, "Values around 1e300.", make_bright},
	{"good-dark", BP_OK, "Values around 1e-300.", make_dark},
	{"good-zero", BP_OK, "Every value is 0.", make_zero},
	{"good-limits", BP_OK, "Legal but hostile: parameters at the end of their range; values are 0 or meet their limit.",
     make_limits},
	{"good-empty", BP_OK, "No material and no index page.", make_empty},
	{"good-names", BP_OK, "Eight names: a blank, two-, three- and four-byte characters, and 255 bytes.", make_names},
	{"good-two-levels", BP_OK, "An index of two leaves and a root.", vector_two_levels},
	{"good-optional-section", BP_OK, "A section of an unknown type with unknown flags, not required: skipped.",
     make_optional_section},
	{"good-dropped-layer", BP_OK, "A record whose last layer was dropped: two layers, bit 2 of left out is clear.",
     make_dropped_layer},
	{"good-minor", BP_OK, "Minor version 1, ignorable flags, and reserved bytes in use.", make_minor},
	{"good-holes", BP_OK, "All 6x5x8 cells of the source were taken as holes, by rule 1.", make_holes},
	{"good-spectral", BP_OK, "The spectral profile, 16x15x6, cut off in its lowest plane by a budget of 1500 bytes.",
     make_spectral},
	{"good-spectral-layers", BP_OK, "The spectral profile, 17x15x7, two layers.", make_spectral_layers},
	{"good-spectral-weights", BP_OK, "The spectral profile, 21x20x4: coded more coarsely where errors are worth less.",
     make_spectral_weights},
	{"good-spectral-plain", BP_OK, "The spectral profile, 21x20x4, weights as codec version 5 wrote them.", make_spectral_plain},
	{"good-spectral-single", BP_OK, "The spectral profile, 21x20x4, one quantiser, as codec version 6 wrote it.",
     make_spectral_single},
	{"good-spectral-whole-single", BP_OK,
     "The spectral profile, 16x15x6, whole rows and one quantiser, as codec version 4 wrote them.", make_spectral_whole_single},
	{"good-spectral-whole", BP_OK, "The spectral profile, 16x15x6, rows of phi_d that are not cut at the horizon.",
     make_spectral_whole},
	{"good-spectral-least", BP_OK, "The spectral profile, 4x4x4, complete.", make_spectral_least},
	{"good-spectral-bright", BP_OK, "The spectral profile, values around 1e300.", make_spectral_bright},
	{"good-spectral-dark", BP_OK, "The spectral profile, values around 1e-300.", make_spectral_dark},
	{"good-spectral-zero", BP_OK, "The spectral profile, every value 0: no plane at all.", make_spectral_zero},
	{"good-origin", BP_OK, "The spectral profile, 4x4x4, and a section that tells of its source: spectra of an RGL tensor file.",
     make_origin},
	{"unsupported-major", BP_ERROR_UNSUPPORTED, "Major version 2.", make_major},
	{"unsupported-flags", BP_ERROR_UNSUPPORTED, "A required flag in the archive's header.", make_flags},
	{"unsupported-record-version", BP_ERROR_UNSUPPORTED, "A record of version 1.", make_record_version},
	{"unsupported-profile", BP_ERROR_UNSUPPORTED, "Profile 77.", make_profile},
	{"unsupported-section", BP_ERROR_UNSUPPORTED, "A required section of an unknown type.", make_required_section},
	{"unsupported-retired", BP_ERROR_UNSUPPORTED,
     "A record of the paper's profile as codec versions up to 3 wrote it: to be packed again.", make_retired},
	{"unsupported-codec", BP_ERROR_UNSUPPORTED, "A known type of section with an unknown codec, required.", make_codec},
	{"bad-empty-file", BP_ERROR_NOT_OURS, "No byte at all.", make_empty_file},
	{"bad-text-mode", BP_ERROR_NOT_OURS, "CR LF became LF on the way, everywhere.", make_text_mode},
	{"bad-short-header", BP_ERROR_CORRUPT, "The magic, and an end within the header.", make_short_header},
	{"bad-truncated", BP_ERROR_CORRUPT, "The last byte is missing.", make_truncated},
	{"bad-trailing", BP_ERROR_CORRUPT, "A byte behind the end.", make_trailing},
	{"bad-header-checksum", BP_ERROR_CHECKSUM, "A bit of the header differs.", make_header_checksum},
	{"bad-page-checksum", BP_ERROR_CHECKSUM, "A bit of the index differs.", make_page_checksum},
	{"bad-head-checksum", BP_ERROR_CHECKSUM, "A bit of a record's head differs.", make_head_checksum},
	{"bad-section-checksum", BP_ERROR_CHECKSUM, "A bit of a section differs.", make_section_checksum},
	{"bad-count", BP_ERROR_CORRUPT, "The header counts four materials, the index has three.", make_count},
	{"bad-count-pages", BP_ERROR_CORRUPT, "The header counts 10^8 materials in one page.", make_count_pages},
	{"bad-depth", BP_ERROR_CORRUPT, "The header says two levels, there is one page.", make_depth},
	{"bad-index-offset", BP_ERROR_CORRUPT, "An index offset near 2^64.", make_index_offset},
	{"bad-page-padding", BP_ERROR_CORRUPT, "A byte of an index page's padding is not zero.", make_page_padding},
	{"bad-page-order", BP_ERROR_CORRUPT, "Two names in the index have changed places.", make_page_order},
	{"bad-duplicate", BP_ERROR_CORRUPT, "The same name twice.", make_duplicate},
	{"bad-cycle", BP_ERROR_CORRUPT, "The root names itself as its child.", make_cycle},
	{"bad-leaf-twice", BP_ERROR_CORRUPT, "Both entries of the root lead to the first leaf.", make_leaf_twice},
	{"bad-record-offset", BP_ERROR_CORRUPT, "The index places a record behind the file.", make_record_offset},
	{"bad-record-swapped", BP_ERROR_CORRUPT, "Two entries lead to each other's records.", make_record_swapped},
	{"bad-gap", BP_ERROR_CORRUPT, "A byte that belongs to nothing between two records.", make_gap},
	{"bad-head-bytes", BP_ERROR_CORRUPT, "A head that claims 4 GB.", make_head_bytes},
	{"bad-name", BP_ERROR_CORRUPT, "A name with a slash, in the index and in the record.", make_name},
	{"bad-holes", BP_ERROR_CORRUPT, "More cells taken as holes than there are.", make_too_many_holes},
	{"bad-zeros-rule", BP_ERROR_CORRUPT, "Rule 3 for zeros.", make_zeros_rule},
	{"bad-extents", BP_ERROR_CORRUPT, "A lattice of 1024x1024x1024 cells.", make_extents},
	{"bad-section-order", BP_ERROR_CORRUPT, "The sections' layers descend.", make_section_order},
	{"bad-section-bytes", BP_ERROR_CORRUPT, "A section that claims 4 GB.", make_section_bytes},
	{"bad-nan", BP_ERROR_CORRUPT, "A scale that is not a number, under a checksum that holds.", make_nan},
	{"bad-overflow", BP_ERROR_CORRUPT, "Scale and specular parameter whose product overflows.", make_overflow},
	{"bad-marginal-bytes", BP_ERROR_CORRUPT, "A section of marginals with a byte too many.", make_marginal_bytes},
	{"bad-coefficients", BP_ERROR_CORRUPT, "A pair that claims more coefficients than its bytes can hold.", make_coefficients},
	{"bad-stream-short", BP_ERROR_CORRUPT, "A range coder stream without its last byte.", make_stream_short},
	{"bad-stream-long", BP_ERROR_CORRUPT, "A range coder stream with a byte too many.", make_stream_long},
	{"bad-step", BP_ERROR_CORRUPT, "A step beyond the largest.", make_step},
	{"bad-section-missing", BP_ERROR_CORRUPT, "No marginals.", make_section_missing},
	{"bad-section-twice", BP_ERROR_CORRUPT, "The marginals twice.", make_section_twice},
	{"bad-spectral-planes", BP_ERROR_CORRUPT, "25 bit planes.", make_spectral_planes},
	{"bad-spectral-unit", BP_ERROR_CORRUPT, "A unit above 2^999.", make_spectral_unit},
	{"bad-spectral-unit-least", BP_ERROR_CORRUPT, "A unit below 2^-1022.", make_spectral_unit_least},
	{"bad-spectral-limit", BP_ERROR_CORRUPT, "Rows cut at the zenith.", make_spectral_limit},
	{"bad-spectral-weight", BP_ERROR_CORRUPT, "A weight above 63.", make_spectral_weight},
	{"bad-spectral-weights-long", BP_ERROR_CORRUPT, "A stream that is longer than its weights.", make_spectral_weights_long},
	{"bad-spectral-end", BP_ERROR_CORRUPT, "More units than there are planes, fields and harmonics.", make_spectral_end},
	{"bad-spectral-early", BP_ERROR_CORRUPT, "A stream of planes that is longer than its units.", make_spectral_early},
	{"bad-origin", BP_ERROR_CORRUPT, "A source of a kind that is not known.", make_origin_kind},
};
enum { VECTOR_COUNT = sizeof VECTORS / sizeof *VECTORS };

/* ---- their decoded values ---- */

static bool has_values(const struct vector *vector)
{
	return vector->verified == BP_OK && strcmp(vector->name, "good-two-levels") != 0 && strcmp(vector->name, "good-names") != 0;
}

/* ---- tests ---- */

static const char *committed(const struct vector *vector, const char *ending)
{
	static char path[512];
	snprintf(path, sizeof path, "format-spec/vectors/%s.%s", vector->name, ending);
	return path;
}

static void the_committed_archives_are_those_that_the_writer_makes(void **state)
{
	(void)state;
	for (int i = 0; i < VECTOR_COUNT; i++) {
		size_t made_bytes, committed_bytes;
		uint8_t *made, *kept;
		VECTORS[i].make(fixture_path("v.bpk"));
		made = fixture_file_read(fixture_path("v.bpk"), &made_bytes);
		kept = fixture_file_read(committed(&VECTORS[i], "bpk"), &committed_bytes);
		if (made_bytes != committed_bytes || memcmp(made, kept, made_bytes) != 0)
			fail_msg("%s differs; if the format was meant to change: test_vectors --write format-spec/vectors", VECTORS[i].name);
		free(made);
		free(kept);
	}
}

static void every_archive_is_judged_as_its_name_says(void **state)
{
	(void)state;
	for (int i = 0; i < VECTOR_COUNT; i++) {
		bp_archive *archive = NULL;
		bp_error error = {0};
		bp_status status = bp_archive_open(committed(&VECTORS[i], "bpk"), &archive, &error);
		if (!status)
			status = bp_archive_verify(archive, BP_VERIFY_DEEP, NULL, NULL, &error);
		bp_archive_close(archive);
		if (status != VECTORS[i].verified)
			fail_msg("%s: %s (%s), expected: %s", VECTORS[i].name, bp_status_text(status), error.message,
			         bp_status_text(VECTORS[i].verified));
	}
}

/* Decoded values are the contract: within 1e-6 of the committed ones, relative, or 1e-6 of the table's largest. */
static void decoded_values_are_the_committed_ones(void **state)
{
	(void)state;
	for (int i = 0; i < VECTOR_COUNT; i++) {
		FILE *made, *kept;
		char made_word[300], kept_word[300];
		if (!has_values(&VECTORS[i]))
			continue;
		values_write(committed(&VECTORS[i], "bpk"), fixture_path("v.values"));
		made = fopen(fixture_path("v.values"), "r");
		kept = fopen(committed(&VECTORS[i], "values"), "r");
		assert_non_null(made);
		assert_non_null(kept);
		while (fscanf(kept, "%299s", kept_word) == 1) {
			char *made_end, *kept_end;
			double a, b;
			assert_int_equal(fscanf(made, "%299s", made_word), 1);
			a = strtod(made_word, &made_end);
			b = strtod(kept_word, &kept_end);
			if (*made_end || *kept_end ? strcmp(made_word, kept_word) != 0
			                           : fabs(a - b) > 1e-6 * fabs(b) + 1e-12 * (fabs(b) < 1e-200 ? 0 : 1))
				fail_msg("%s: %s decoded, %s committed", VECTORS[i].name, made_word, kept_word);
		}
		assert_int_equal(fscanf(made, "%299s", made_word), EOF);
		fclose(made);
		fclose(kept);
	}
}

static void write_all(const char *folder)
{
	char path[512], values[512];
	snprintf(path, sizeof path, "%s/README.md", folder);
	FILE *readme = fopen(path, "w");
	assert_non_null(readme);
	fputs("# Test vectors\n\n"
	      "Small archives for readers of the format: good ones load and verify, unsupported ones are intact but need a newer\n"
	      "reader, bad ones must be refused. `NAME.values` holds what the good ones decode to: for each material and number of\n"
	      "layers a line `NAME LAYERS H D P`, then one line of H × D × P values for each of R, G and B, in 1/sr. Their error\n"
	      "figures are invented, since nothing was measured. `tests/test_vectors.c` makes the files\n"
	      "(`build/tests/test_vectors --write format-spec/vectors`) and compares them.\n\n"
	      "| file | what a deep verification says | |\n|---|---|---|\n",
	      readme);
	for (int i = 0; i < VECTOR_COUNT; i++) {
		snprintf(path, sizeof path, "%s/%s.bpk", folder, VECTORS[i].name);
		VECTORS[i].make(path);
		fprintf(readme, "| %s.bpk | %s | %s |\n", VECTORS[i].name, bp_status_text(VECTORS[i].verified), VECTORS[i].sentence);
		snprintf(values, sizeof values, "%s/%s.values", folder, VECTORS[i].name);
		if (has_values(&VECTORS[i]))
			values_write(path, values);
	}
	assert_int_equal(fclose(readme), 0);
}

int main(int argc, char **argv)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_committed_archives_are_those_that_the_writer_makes),
		cmocka_unit_test(every_archive_is_judged_as_its_name_says),
		cmocka_unit_test(decoded_values_are_the_committed_ones),
	};
	if (argc == 3 && strcmp(argv[1], "--write") == 0) {
		write_all(argv[2]);
		return 0;
	}
	return cmocka_run_group_tests(tests, fixture_folder_make, fixture_folder_remove);
}
