/*
 * Measured files that are no plain MERL tables, on MERL's lattice: tensor files, tables with 360 cells of phi_d, and what is neither.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "merl/merl_file.h"
#include "merl/origin.h"
#include "merl/rgl_file.h"
#include "merl/two_halves.h"
#include "memory_limit.h"
#include "tensor_maker.h"
#include "words.h"

#define PI 3.14159265358979323846

/* A file in memory, which a stream gives in pieces. */
struct memory {
	const uint8_t *bytes;
	size_t count, at;
};

static bp_status memory_read(void *user, void *bytes, size_t capacity, size_t *read, bp_error *error)
{
	struct memory *memory = user;
	(void)error;
	*read = memory->count - memory->at < capacity ? memory->count - memory->at : capacity;
	*read = *read > 10000 ? 10000 : *read;
	memcpy(bytes, memory->bytes + memory->at, *read);
	memory->at += *read;
	return BP_OK;
}

static bp_status bytes_read(const struct byte_buffer *bytes, struct lattice *lattice, struct origin *origin, bp_error *error)
{
	struct memory memory = {.bytes = bytes->bytes, .count = bytes->count};
	uint64_t file_bytes = 0;
	const bp_status status =
		lattice_read(memory_read, &memory, &(struct merl_reading){.origin = origin, .file_bytes = &file_bytes}, lattice, error);
	assert_true(status != BP_OK || file_bytes == bytes->count);
	return status;
}

/* The usual material as a file; the caller frees it. */
static void usual_make(struct byte_buffer *bytes)
{
	struct made_file made = {0};
	*bytes = (struct byte_buffer){0};
	made_material(&made);
	made_write(&made, bytes);
	made_free(&made);
}

static bp_status made_read(const struct made_file *made, struct lattice *lattice, struct origin *origin, bp_error *error)
{
	struct byte_buffer bytes = {0};
	made_write(made, &bytes);
	const bp_status status = bytes_read(&bytes, lattice, origin, error);
	byte_buffer_free(&bytes);
	return status;
}

static void refused(const struct byte_buffer *bytes, const char *words)
{
	struct lattice lattice;
	struct origin origin;
	bp_error error;
	assert_int_equal(bytes_read(bytes, &lattice, &origin, &error), BP_ERROR_BAD_INPUT);
	expect_words(error.message, words);
}

/* Cosines of both directions at the centre of a cell of MERL's lattice. */
static void cosines_at(uint32_t i, uint32_t j, uint32_t k, double cosine[2])
{
	const double u = (i + 0.5) / 90, h = u * u * PI / 2, d = (j + 0.5) / 90 * PI / 2, p = (k + 0.5) / 180 * PI;
	cosine[0] = cos(h) * cos(d) - sin(h) * sin(d) * cos(p);
	cosine[1] = cos(h) * cos(d) + sin(h) * sin(d) * cos(p);
}

/* f = 0.5 / cos theta_o in one direction, 0.5 / cos theta_i in the other. */
static void mean_check(bool instrument)
{
	struct made_file made = {0};
	struct lattice lattice;
	struct origin origin;
	made_material(&made);
	if (!instrument)
		made_remove(&made, "valid");
	const double angle_most = fmin(instrument ? 85 * PI / 180 : PI / 2, (double)made_find(&made, "theta_i")->values[2]);
	assert_int_equal(made_read(&made, &lattice, &origin, NULL), BP_OK);
	size_t valid = 0;
	for (uint32_t i = 0; i < 90; i += 1)
		for (uint32_t j = 0; j < 90; j += 1)
			for (uint32_t k = 0; k < 180; k += 7) {
				const size_t cell = lattice_index(LATTICE_MERL, i, j, k);
				double cosine[2];
				cosines_at(i, j, k, cosine);
				const bool measured = fmin(cosine[0], cosine[1]) > cos(angle_most);
				assert_int_equal(lattice.valid[cell], measured);
				valid += measured;
				for (int c = 0; c < 3 && measured; c++) {
					const double expected = 0.25 / (1 << c) * (1 / fmax(cosine[0], 1e-3) + 1 / fmax(cosine[1], 1e-3));
					if (fabs(lattice.rgb[c][cell] / expected - 1) > 1e-6)
						fail_msg("cell %u %u %u: %g, expected %g", i, j, k, lattice.rgb[c][cell], expected);
				}
			}
	assert_true(valid > 10000);
	assert_int_equal(origin.kind, ORIGIN_RGL_RGB);
	assert_int_equal(origin.compared, lattice.valid_count);
	assert_true(origin.median > 0.05 && origin.percentile95 > origin.median); /* no reciprocal material */
	lattice_free(&lattice);
	made_free(&made);
}

static void a_cell_has_the_mean_of_both_directions(void **state)
{
	(void)state;
	mean_check(true);
}

/* What does not say which samples were measured was computed: 85 degrees are an instrument's limit. */
static void a_computed_file_has_values_to_the_horizon(void **state)
{
	(void)state;
	mean_check(false);
}

/* f that rises with the azimuth between incidence and half vector: cells k and 179 - k differ by the sign of it, which checks the frame. */
static void azimuths_are_those_of_the_cell(void **state)
{
	(void)state;
	struct made_file made = {0};
	struct lattice lattice;
	struct origin origin;
	made_material(&made);
	made_find(&made, "jacobian")->values[0] = 0;
	struct made_field *rgb = made_find(&made, "rgb");
	for (uint64_t n = 0; n < made_count(rgb); n++)
		rgb->values[n] = (double)(n / MADE_SAMPLES % MADE_SAMPLES) / (MADE_SAMPLES - 1);
	assert_int_equal(made_read(&made, &lattice, &origin, NULL), BP_OK);
	for (uint32_t k = 0; k < 180; k += 13) {
		const uint32_t i = 40, j = 50;
		const double u = (i + 0.5) / 90, h = u * u * PI / 2, d = (j + 0.5) / 90 * PI / 2, p = (k + 0.5) / 180 * PI;
		const double x = sin(d) * cos(p), y = sin(d) * sin(p), z = cos(d);
		double cosine[2], expected = 0;
		cosines_at(i, j, k, cosine);
		for (int n = 0; n < 2; n++) {
			const double s = n ? -1 : 1, phi = atan2(s * y, cos(h) * s * x + sin(h) * z);
			expected += 0.5 * (0.5 - phi / (2 * PI)) / cosine[1 - n];
		}
		assert_true(fabs(lattice.rgb[0][lattice_index(LATTICE_MERL, i, j, k)] / expected - 1) < 1e-6);
	}
	lattice_free(&lattice);
	made_free(&made);
}

/* Visible normals within theta_m of a few degrees, so that all samples lie in some cells of theta_h: their mean, not one of them. */
static void a_lobe_narrower_than_the_cell_is_averaged(void **state)
{
	(void)state;
	enum { SIDE = 400, SAMPLES = 40 };
	struct made_file made = {0};
	struct lattice lattice;
	struct origin origin;
	made_material(&made);
	const uint64_t vndf[4] = {1, MADE_ANGLES, 2, SIDE}, rgb[5] = {1, MADE_ANGLES, 3, 2, SAMPLES};
	struct made_field *density = made_set(&made, "vndf", TENSOR_F32, 4, vndf, 0);
	for (uint64_t n = 0; n < made_count(density); n++)
		density->values[n] = n % SIDE <= 10 ? 1 : 0; /* u_m up to 10/399: two cells of 1/90, and a part */
	struct made_field *samples = made_set(&made, "rgb", TENSOR_F32, 5, rgb, 0);
	for (uint64_t n = 0; n < made_count(samples); n++)
		samples->values[n] = n % SAMPLES < 8 ? 0 : 1; /* a step near the middle of cell 0, which has 16 or 17 samples */
	made_remove(&made, "luminance");
	made_remove(&made, "valid");
	assert_int_equal(made_read(&made, &lattice, &origin, NULL), BP_OK);
	double cosine[2];
	cosines_at(0, 10, 90, cosine);
	const double mean = lattice.rgb[0][lattice_index(LATTICE_MERL, 0, 10, 90)] / (0.5 / cosine[0] + 0.5 / cosine[1]);
	if (!(mean > 0.4 && mean < 0.65)) /* the centre alone has 1 */
		fail_msg("mean %g", mean);
	lattice_free(&lattice);
	made_free(&made);
}

/* Normals with a ridge at the centre of cell 1, straight to the centres around it: as samples of a table are interpolated. */
static void a_lobe_that_the_lattice_resolves_has_its_value_at_the_centre(void **state)
{
	(void)state;
	enum { NODES = 181, SIDE = 400, SAMPLES = 40 };
	struct made_file made = {0};
	struct lattice lattice;
	struct origin origin;
	made_material(&made);
	const uint64_t ndf[2] = {2, NODES}, vndf[4] = {1, MADE_ANGLES, 2, SIDE}, rgb[5] = {1, MADE_ANGLES, 3, 2, SAMPLES};
	const uint64_t sigma[2] = {2, 2};
	struct made_field *normals = made_set(&made, "ndf", TENSOR_F32, 2, ndf, 1);
	for (uint64_t n = 0; n < 2 * NODES; n++)
		normals->values[n] += n % NODES == 3 ? 2 : n % NODES == 2 || n % NODES == 4 ? 1 : 0;
	made_set(&made, "sigma", TENSOR_F32, 2, sigma, 0.25);
	struct made_field *density = made_set(&made, "vndf", TENSOR_F32, 4, vndf, 0);
	for (uint64_t n = 0; n < made_count(density); n++)
		density->values[n] = n % SIDE <= 20 ? 1 : 0;
	made_set(&made, "rgb", TENSOR_F32, 5, rgb, 1);
	made_remove(&made, "luminance");
	made_remove(&made, "valid");
	assert_int_equal(made_read(&made, &lattice, &origin, NULL), BP_OK);
	double cosine[2];
	cosines_at(1, 10, 90, cosine);
	const double value = lattice.rgb[0][lattice_index(LATTICE_MERL, 1, 10, 90)] / (0.5 / cosine[0] + 0.5 / cosine[1]);
	if (!(fabs(value - 3) < 0.02)) /* the mean of the cell is 2.5 */
		fail_msg("value %g", value);
	lattice_free(&lattice);
	made_free(&made);
}

static void cells_without_data_in_a_direction_are_invalid(void **state)
{
	(void)state;
	struct made_file made = {0};
	struct lattice lattice;
	struct origin origin;
	bp_error error;
	made_material(&made);
	struct made_field *rgb = made_find(&made, "rgb"), *valid = made_find(&made, "valid");
	/* of the last angle of incidence nothing was measured: cells with an angle beyond half the way to it */
	for (uint64_t n = made_count(rgb) / 3 * 2; n < made_count(rgb); n++)
		rgb->values[n] = 0;
	valid->values[4] = valid->values[5] = 0;
	assert_int_equal(made_read(&made, &lattice, &origin, &error), BP_OK);
	for (uint32_t i = 0; i < 90; i += 3)
		for (uint32_t j = 0; j < 90; j += 3)
			for (uint32_t k = 0; k < 180; k += 11) {
				double cosine[2];
				cosines_at(i, j, k, cosine);
				const double largest = acos(fmin(cosine[0], cosine[1]));
				if (fabs(largest - PI * 3 / 8) > 1e-4)
					assert_int_equal(lattice.valid[lattice_index(LATTICE_MERL, i, j, k)], largest < PI * 3 / 8);
			}
	lattice_free(&lattice);
	/* beyond the last theta_i there is nothing either */
	made_find(&made, "theta_i")->values[2] = 0.9;
	made_find(&made, "theta_i")->values[1] = 0.85;
	assert_int_equal(made_read(&made, &lattice, &origin, &error), BP_OK);
	for (size_t n = 0; n < lattice_cells(LATTICE_MERL); n += 17) {
		double cosine[2];
		cosines_at((uint32_t)(n / 16200), (uint32_t)(n / 180 % 90), (uint32_t)(n % 180), cosine);
		assert_true(!lattice.valid[n] || acos(fmin(cosine[0], cosine[1])) < 0.9);
	}
	lattice_free(&lattice);
	made_free(&made);
}

static void every_beginning_of_a_tensor_file_is_refused(void **state)
{
	(void)state;
	struct byte_buffer bytes;
	usual_make(&bytes);
	const size_t whole = bytes.count;
	for (bytes.count = 13; bytes.count < whole; bytes.count += 7) {
		struct lattice lattice;
		struct origin origin;
		assert_int_equal(bytes_read(&bytes, &lattice, &origin, NULL), BP_ERROR_BAD_INPUT);
	}
	byte_buffer_free(&bytes);
}

/* Refused by its table alone: the arrays behind it are never asked for. */
static void an_anisotropic_file_is_refused_early(void **state)
{
	(void)state;
	struct made_file made = {0};
	struct byte_buffer bytes = {0};
	const uint64_t many[1] = {8}, large[1] = {1 << 20};
	made_material(&made);
	made_set(&made, "phi_i", TENSOR_F32, 1, many, 0);
	made_set(&made, "something", TENSOR_F64, 1, large, 0);
	made_write(&made, &bytes);
	struct memory memory = {.bytes = bytes.bytes, .count = bytes.count};
	struct lattice lattice;
	bp_error error;
	assert_int_equal(lattice_read(memory_read, &memory, NULL, &lattice, &error), BP_ERROR_BAD_INPUT);
	expect_words(error.message, "an anisotropic material (field phi_i has 8 azimuths): only isotropic ones are packed");
	assert_true(memory.at <= 1 << 16);
	byte_buffer_free(&bytes);
	made_free(&made);
}

/* Numbers of two bytes, which become floats: the most memory for a file's bytes. The limit is the system's own. */
static void reading_takes_no_more_than_16_times_the_file(void **state)
{
	(void)state;
	enum { SIDE = 1024, LATTICE_BYTES = 48 << 20 };
	struct made_file made = {0};
	struct byte_buffer bytes = {0};
	const uint64_t one[1] = {1}, vndf[4] = {1, 1, SIDE, SIDE}, spectra[5] = {1, 1, 3, SIDE, SIDE}, wavelengths[1] = {3};
	made_material(&made);
	made_remove(&made, "rgb");
	made_remove(&made, "luminance");
	made_remove(&made, "valid");
	made_set(&made, "theta_i", TENSOR_F32, 1, one, 1.5);
	made_set(&made, "vndf", TENSOR_F16, 4, vndf, 1);
	made_set(&made, "spectra", TENSOR_F16, 5, spectra, 0.5);
	struct made_field *nm = made_set(&made, "wavelengths", TENSOR_F32, 1, wavelengths, 400);
	nm->values[1] = 500;
	nm->values[2] = 600;
	made_write(&made, &bytes);
	made_free(&made);
	const pid_t child = fork();
	assert_true(child >= 0);
	if (!child) {
		struct lattice lattice;
		struct origin origin;
		bool right = memory_limit(16 * bytes.count + LATTICE_BYTES) && bytes_read(&bytes, &lattice, &origin, NULL) == BP_OK;
		right = right && origin.kind == ORIGIN_RGL_SPECTRA && lattice.valid_count > 900000;
		_exit(right ? 0 : 1);
	}
	int ended;
	assert_int_equal(waitpid(child, &ended, 0), child);
	assert_int_equal(ended, 0);
	byte_buffer_free(&bytes);
}

/* What was known of the size may be wrong: a file grows while it is read, and some file systems tell no size. */
static void a_file_of_another_size_than_was_told_is_read_to_its_end(void **state)
{
	(void)state;
	struct byte_buffer bytes;
	usual_make(&bytes);
	const size_t whole = bytes.count;
	const struct {
		size_t told, more;
	} cases[] = {{whole, 0}, {whole, 1}, {whole, 100000}, {0, 100000}, {5, 0}};
	alarm(20); /* rather than for ever */
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		bytes.count = whole;
		write_zeros(&bytes, cases[n].more);
		struct memory memory = {.bytes = bytes.bytes, .count = bytes.count, .at = TENSOR_MAGIC_BYTES};
		struct input input = {.read = memory_read, .user = &memory, .available = cases[n].told, .done = TENSOR_MAGIC_BYTES};
		struct lattice lattice = {0};
		struct origin origin;
		assert_int_equal(rgl_file_read(&input, bytes.bytes, &lattice, &origin, NULL), BP_OK);
		assert_true(memory.at == bytes.count && lattice.valid_count > 0);
		lattice_free(&lattice);
	}
	alarm(0);
	byte_buffer_free(&bytes);
}

static void foreign_files_are_called_what_they_are(void **state)
{
	(void)state;
	static const struct {
		const char *bytes;
		size_t count;
		const char *words;
	} cases[] = {
		{"# made by OpticStudio\nSource  Measured\nSymmetry  PlaneSymmetrical\nSpectralContent  Monochrome\n", 0,
	     "a BSDF of Zemax OpticStudio (text)"},
		{"SCATFUN\1xxxxxxxxxxxx", 20, "Fourier"},
		{"NVIDIA ARC MBSDF V1\nMBSDF_DATA=\n", 0, "a measured BSDF for MDL"},
		{"<?xml version=\"1.0\"?>\n<WindowElement>", 0, "a window's BSDF"},
		{"just some words\n", 0, "database: text"},
		{"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16, "a picture (PNG)"},
		{"version https://git-lfs.github.com/spec/v1\n", 0, "Git LFS"},
		{"\1\2\3\4\5\6\7\10\11\12\13\14\15", 13, "not a MERL file: expected the header 90 90 180, found"},
	};
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		struct byte_buffer bytes = {0};
		write_bytes(&bytes, cases[n].bytes, cases[n].count ? cases[n].count : strlen(cases[n].bytes));
		refused(&bytes, cases[n].words);
		byte_buffer_free(&bytes);
	}
}

/* 90 x 90 x 360 stored values: `second` times those of the first half in the second one, cell 5 of the latter unmeasured. */
static void halves_make(struct byte_buffer *bytes, double second)
{
	write_u32(bytes, 90);
	write_u32(bytes, 90);
	write_u32(bytes, 360);
	for (uint32_t c = 0; c < 3; c++)
		for (uint32_t row = 0; row < 90 * 90; row++)
			for (uint32_t k = 0; k < 360; k++)
				write_f64(bytes, k == 185 && row == 0 ? -1 : (1 + row % 7 + k % 180) * (k < 180 ? 1 : second) / MERL_SCALE[c]);
}

static void two_halves_are_joined_where_they_agree(void **state)
{
	(void)state;
	struct byte_buffer bytes = {0};
	struct lattice lattice;
	struct origin origin;
	halves_make(&bytes, 1.04);
	assert_int_equal(bytes.count, two_halves_bytes());
	assert_int_equal(bytes_read(&bytes, &lattice, &origin, NULL), BP_OK);
	assert_int_equal(origin.kind, ORIGIN_TWO_HALVES);
	assert_true(fabs(origin.median - 0.04 / 1.02) < 1e-3 && fabs(origin.percentile95 - 0.04 / 1.02) < 1e-3);
	assert_int_equal(lattice.valid_count, lattice_cells(LATTICE_MERL) - 1);
	assert_false(lattice.valid[5]);
	for (size_t n = 6; n < lattice_cells(LATTICE_MERL); n += 101)
		for (int c = 0; c < 3; c++)
			assert_true(fabs(lattice.rgb[c][n] / ((double)(1 + n / 180 % 7 + n % 180) * 1.02) - 1) < 1e-12);
	lattice_free(&lattice);
	bytes.count -= 8;
	refused(&bytes, "truncated: expected 69984012 bytes, found 69984004");
	bytes.count += 8;
	write_u8(&bytes, 0);
	refused(&bytes, "trailing bytes");
	byte_buffer_free(&bytes);
}

/* A cell counts once, whichever of its halves is no number, so that what the counts leave over is what was marked as unmeasured. */
static void cells_of_two_halves_that_are_no_numbers_count_once(void **state)
{
	(void)state;
	static const size_t BOTH = 360 + 10, FIRST = 360 + 20, SECOND = 360 + 180 + 30; /* values of the second row */
	const double nan = NAN;
	struct byte_buffer bytes = {0};
	struct lattice lattice;
	struct origin origin;
	halves_make(&bytes, 1);
	memcpy(bytes.bytes + 12 + 8 * BOTH, &nan, 8);
	memcpy(bytes.bytes + 12 + 8 * (BOTH + 180), &nan, 8);
	memcpy(bytes.bytes + 12 + 8 * FIRST, &nan, 8);
	memcpy(bytes.bytes + 12 + 8 * SECOND, &nan, 8);
	assert_int_equal(bytes_read(&bytes, &lattice, &origin, NULL), BP_OK);
	assert_int_equal(lattice.nonfinite_count, 3);
	assert_int_equal(lattice.valid_count, lattice_cells(LATTICE_MERL) - 4); /* and the one that is marked */
	assert_int_equal(origin.compared, lattice.valid_count);
	assert_false(lattice.valid[180 + 10] || lattice.valid[180 + 20] || lattice.valid[180 + 30] || lattice.valid[5]);
	assert_true(lattice.rgb[1][180 + 20] == 0);
	lattice_free(&lattice);
	byte_buffer_free(&bytes);
}

static void two_halves_that_disagree_are_refused_with_the_number(void **state)
{
	(void)state;
	struct byte_buffer bytes = {0};
	halves_make(&bytes, 1.2);
	refused(&bytes, "the two halves disagree: relative difference 0.18");
	byte_buffer_free(&bytes);
}

static void quantiles_are_those_of_the_differences(void **state)
{
	(void)state;
	struct reciprocity *reciprocity = calloc(1, sizeof *reciprocity);
	struct origin origin = {.kind = ORIGIN_RGL_RGB};
	reciprocity_tell(reciprocity, &origin);
	assert_true(origin.compared == 0 && origin.median == 0 && origin.percentile95 == 0);
	for (int n = 0; n < 50; n++)
		reciprocity_add(reciprocity, 0, 0);
	reciprocity_tell(reciprocity, &origin);
	assert_true(origin.compared == 50 && origin.median == 0 && origin.percentile95 == 0);
	for (int n = 0; n < 50; n++)
		reciprocity_add(reciprocity, n < 25 ? 1 : 0, n < 25 ? 1.1 : 1);
	reciprocity_tell(reciprocity, &origin);
	assert_true(origin.median < 1e-3 && fabs(origin.percentile95 - 2) < 1e-3);
	free(reciprocity);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_cell_has_the_mean_of_both_directions),
		cmocka_unit_test(a_computed_file_has_values_to_the_horizon),
		cmocka_unit_test(azimuths_are_those_of_the_cell),
		cmocka_unit_test(a_lobe_narrower_than_the_cell_is_averaged),
		cmocka_unit_test(a_lobe_that_the_lattice_resolves_has_its_value_at_the_centre),
		cmocka_unit_test(cells_without_data_in_a_direction_are_invalid),
		cmocka_unit_test(every_beginning_of_a_tensor_file_is_refused),
		cmocka_unit_test(an_anisotropic_file_is_refused_early),
		cmocka_unit_test(reading_takes_no_more_than_16_times_the_file),
		cmocka_unit_test(a_file_of_another_size_than_was_told_is_read_to_its_end),
		cmocka_unit_test(foreign_files_are_called_what_they_are),
		cmocka_unit_test(two_halves_are_joined_where_they_agree),
		cmocka_unit_test(cells_of_two_halves_that_are_no_numbers_count_once),
		cmocka_unit_test(two_halves_that_disagree_are_refused_with_the_number),
		cmocka_unit_test(quantiles_are_those_of_the_differences),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
