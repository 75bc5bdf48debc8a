/*
 * A material of the RGL database as a function: values known in closed form, and what a file may not hold.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

#include "rgl/colour.h"
#include "rgl/rgl_material.h"
#include "tensor_maker.h"
#include "words.h"

#define PI 3.14159265358979323846

/* The file that a test changes, and the material that is made of it. */
static struct made_file made;
static struct rgl_material material;
static struct rgl_value value;

static int begin(void **state)
{
	(void)state;
	made = (struct made_file){0};
	made_material(&made);
	return 0;
}

static int end(void **state)
{
	(void)state;
	rgl_material_free(&material);
	made_free(&made);
	return 0;
}

static void begin_anew(void)
{
	end(NULL);
	begin(NULL);
}

static bp_status material_of(bp_error *error)
{
	struct byte_buffer bytes = {0};
	struct tensor_table table;
	rgl_material_free(&material);
	made_write(&made, &bytes);
	bp_status status = tensor_table_parse(bytes.bytes, bytes.count, bytes.count, &table, error);
	if (!status)
		status = rgl_material_make(bytes.bytes, &table, &material, error);
	byte_buffer_free(&bytes);
	return status;
}

static void made_is_good(void) { assert_int_equal(material_of(NULL), BP_OK); }

static void refused(const char *words)
{
	bp_error error = {0};
	assert_int_equal(material_of(&error), BP_ERROR_BAD_INPUT);
	expect_words(error.message, words);
}

static void near(double got, double expected)
{
	if (!(fabs(got - expected) <= 1e-6 * fabs(expected) + 1e-12))
		fail_msg("%.12g, expected %.12g", got, expected);
}

static void samples_over_the_cosine_where_all_is_even(void **state)
{
	(void)state;
	made_find(&made, "sigma")->values[0] = 0.25;
	made_is_good();
	for (int n = 0; n < 20; n++) {
		rgl_evaluate(&material, n * 0.07, n * 0.3 - 3, 0.05 * n, 0.9 - 0.04 * n, &value);
		for (int c = 0; c < 3; c++)
			near(value.rgb[c], 0.5 / (1 << c) / (0.9 - 0.04 * n));
		near(value.data, 1);
	}
	made_find(&made, "jacobian")->values[0] = 0; /* the same, as ndf / (4 sigma) is 1 */
	made_find(&made, "ndf")->values[0] = 5;
	made_is_good();
	rgl_evaluate(&material, 0.3, 0, 0, 0.5, &value);
	near(value.rgb[0], 1);
}

/* A density x along theta_m makes s_x = x^2; samples that rise with s_x then tell x^2, and ndf(x) the rest. */
static void samples_follow_the_visible_normals(void **state)
{
	(void)state;
	struct made_field *vndf = made_find(&made, "vndf"), *rgb = made_find(&made, "rgb"), *ndf = made_find(&made, "ndf");
	for (uint64_t n = 0; n < made_count(vndf); n++)
		vndf->values[n] = (double)(n % MADE_SIDE);
	for (uint64_t n = 0; n < made_count(rgb); n++)
		rgb->values[n] = 3 + (double)(n % MADE_SAMPLES);
	for (uint64_t n = 0; n < made_count(ndf); n++)
		ndf->values[n] = 2 + (double)(n % MADE_SIDE);
	made_is_good();
	for (int n = 0; n <= 10; n++) {
		const double x = n / 10.0;
		rgl_evaluate(&material, 0.4, 1, x * x * PI / 2, 1, &value);
		near(value.rgb[1], (3 + (MADE_SAMPLES - 1) * x * x) * (2 + (MADE_SIDE - 1) * x));
	}
	/* all samples lie between x = 0 and 1, as x^2 rises by 1; from 0.5 to 1 there are 3/4 of their steps */
	near(rgl_samples_between(&material, 1, PI / 8, PI / 2), 0.75 * (MADE_SAMPLES - 1));
}

/* Samples that rise with s_y: the azimuth of the half vector as seen from the incident direction. */
static void azimuths_count_from_the_incident_direction(void **state)
{
	(void)state;
	struct made_field *rgb = made_find(&made, "rgb");
	for (uint64_t n = 0; n < made_count(rgb); n++)
		rgb->values[n] = (double)(n / MADE_SAMPLES % MADE_SAMPLES);
	made_is_good();
	for (int n = -4; n <= 4; n++) {
		const double phi = n * 0.7;
		rgl_evaluate(&material, 0.4, phi, 0.3, 1, &value);
		near(value.rgb[0], (MADE_SAMPLES - 1) * (0.5 - phi / (2 * PI)));
	}
}

static void angles_of_incidence_are_interpolated(void **state)
{
	(void)state;
	struct made_field *rgb = made_find(&made, "rgb");
	const uint64_t slice = made_count(rgb) / MADE_ANGLES;
	for (uint64_t n = 0; n < made_count(rgb); n++)
		rgb->values[n] = (double)(1 + n / slice);
	made_is_good();
	for (int n = 0; n <= 8; n++) {
		rgl_evaluate(&material, n * PI / 16, 0, 0, 1, &value);
		near(value.rgb[2], 1 + n / 4.0);
	}
}

static void negative_channels_are_0(void **state)
{
	(void)state;
	struct made_field *rgb = made_find(&made, "rgb");
	for (uint64_t n = 0; n < made_count(rgb); n++)
		rgb->values[n] = n / (MADE_SAMPLES * MADE_SAMPLES) % 3 == 1 ? -0.5 : 0.5;
	made_is_good();
	rgl_evaluate(&material, 0.2, 0, 0.1, 1, &value);
	near(value.rgb[0], 0.5);
	assert_true(value.rgb[1] == 0);
}

/* What `valid` calls unmeasured and is 0, whichever way round its bits are. */
static void zeros_that_were_not_measured_are_no_data(void **state)
{
	(void)state;
	for (int inverted = 0; inverted < 2; inverted++) {
		begin_anew();
		struct made_field *rgb = made_find(&made, "rgb"), *valid = made_find(&made, "valid");
		const size_t plane = MADE_SAMPLES * MADE_SAMPLES, sample[3] = {1, plane + 5, 2 * plane + 8};
		for (int k = 0; k < 3; k++) {
			valid->values[sample[k] / 8] = (double)((unsigned)valid->values[sample[k] / 8] & ~(0x80u >> sample[k] % 8));
			for (size_t c = 0; c < 3 && k != 1; c++) /* the second one holds a value */
				rgb->values[(sample[k] / plane * 3 + c) * plane + sample[k] % plane] = 0;
		}
		for (size_t c = 0; c < 3; c++)
			rgb->values[c * plane + 10] = 0; /* measured, and 0 */
		for (uint64_t n = 0; inverted && n < made_count(valid); n++)
			valid->values[n] = 255 - valid->values[n];
		made_is_good();
		for (size_t n = 0; n < MADE_ANGLES * plane; n++)
			assert_true(material.samples[4 * n + 3] == (n == sample[0] || n == sample[2] ? 0 : 1));
		made_remove(&made, "valid");
		made_is_good();
		assert_true(material.samples[4 * sample[0] + 3] == 1);
	}
}

static void spectra_become_linear_rgb(void **state)
{
	(void)state;
	enum { COUNT = 61 };
	double wavelengths[COUNT], weights[3 * COUNT], sum[3] = {0}, red[3] = {0};
	for (int n = 0; n < COUNT; n++)
		wavelengths[n] = 360 + 8 * n;
	colour_weights(wavelengths, COUNT, weights);
	for (int n = 0; n < COUNT; n++)
		for (int c = 0; c < 3; c++) {
			sum[c] += weights[3 * n + c];
			red[c] += wavelengths[n] > 600 ? weights[3 * n + c] : 0;
		}
	for (int c = 0; c < 3; c++)
		near(sum[c], 1); /* what reflects all light is white */
	assert_true(red[0] > 0.7 && red[1] < 0.1 && red[2] < 0.01 && red[1] > -0.1);

	made_remove(&made, "rgb");
	const uint64_t shape[5] = {1, MADE_ANGLES, COUNT, MADE_SAMPLES, MADE_SAMPLES}, count[1] = {COUNT};
	struct made_field *spectra = made_set(&made, "spectra", TENSOR_F32, 5, shape, 0);
	struct made_field *nm = made_set(&made, "wavelengths", TENSOR_F32, 1, count, 0);
	memcpy(nm->values, wavelengths, sizeof wavelengths);
	for (uint64_t n = 0; n < made_count(spectra); n++)
		spectra->values[n] = wavelengths[n / (MADE_SAMPLES * MADE_SAMPLES) % COUNT] > 600 ? 0.5 : 0.25;
	made_is_good();
	rgl_evaluate(&material, 0.2, 0, 0.1, 1, &value);
	for (int c = 0; c < 3; c++)
		near(value.rgb[c], fmax(0.25 + 0.25 * red[c], 0));
	assert_int_equal(material.wavelengths, COUNT);
	assert_true(material.first == 360 && material.last == 840);
	nm->values[7] = nm->values[6];
	refused("field wavelengths: element 7 is 408; they must ascend");
	made_remove(&made, "wavelengths");
	refused("no field wavelengths");
}

/* CIE 15: what emits at one wavelength alone has the chromaticity of the spectral locus; BT.709's white is D65's. */
static void the_observer_is_the_standard_one(void **state)
{
	(void)state;
	const double wavelengths[3] = {545, 550, 555}; /* 550 nm alone */
	double weights[9];
	colour_weights(wavelengths, 3, weights);
	/* chromaticity of 550 nm: x 0.3016, y 0.6923; in BT.709 that is a negative red, a positive green and a negative blue */
	const double r = weights[3], g = weights[4], b = weights[5];
	const double x = 0.4124 * r + 0.3576 * g + 0.1805 * b, y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
	const double z = 0.0193 * r + 0.1192 * g + 0.9505 * b;
	assert_true(fabs(x / (x + y + z) - 0.3016) < 0.002 && fabs(y / (x + y + z) - 0.6923) < 0.002);
}

/* One value of one field after the other is made wrong. */
static void wrong_values_are_refused_by_their_field(void **state)
{
	(void)state;
	static const struct {
		const char *field;
		uint64_t element;
		double value;
		const char *words;
	} cases[] = {
		{"vndf", 5, NAN, "field vndf: element 5 is negative, NaN or infinite"},
		{"vndf", 20, INFINITY, "field vndf: element 20 is"},
		{"vndf", 0, -1, "field vndf: element 0 is"},
		{"ndf", 3, NAN, "field ndf: element 3 is negative, NaN or infinite"},
		{"ndf", 0, -0.1, "field ndf: element 0 is"},
		{"sigma", 7, -INFINITY, "field sigma: element 7 is"},
		{"rgb", 9, NAN, "field rgb: element 9 is NaN or infinite"},
		{"theta_i", 1, 0, "field theta_i: element 1 is 0; they must ascend"},
		{"theta_i", 2, 0.5, "field theta_i: element 2 is 0.5; they must ascend"},
		{"theta_i", 2, 3, "field theta_i: element 2 is 3"},
		{"theta_i", 0, NAN, "field theta_i: element 0 is nan"},
		{"theta_i", 0, -0.1, "field theta_i: element 0 is -0.1"},
	};
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		begin_anew();
		made_find(&made, cases[n].field)->values[cases[n].element] = cases[n].value;
		refused(cases[n].words);
	}
}

static void zero_distributions_are_refused(void **state)
{
	(void)state;
	static const char *const fields[] = {"ndf", "sigma", "vndf"};
	for (int n = 0; n < 3; n++) {
		begin_anew();
		struct made_field *field = made_find(&made, fields[n]);
		for (uint64_t k = 0; k < made_count(field); k++)
			field->values[k] = n == 2 && k < MADE_SIDE * MADE_SIDE ? 1 : 0; /* of vndf the second angle's */
		refused(n == 2 ? "field vndf: the density at theta_i number 1 is 0 everywhere" : "0 everywhere");
	}
}

static void shapes_that_disagree_are_refused(void **state)
{
	(void)state;
	static const struct {
		const char *field;
		enum tensor_type type;
		uint32_t rank;
		uint64_t shape[5];
		const char *words;
	} cases[] = {
		{"vndf", TENSOR_F32, 4, {1, 2, 4, 4}, "field vndf: 1 x 2 directions of incidence, phi_i and theta_i have 1 x 3"},
		{"rgb", TENSOR_F32, 5, {1, 4, 3, 4, 4}, "field rgb: 1 x 4 directions"},
		{"rgb", TENSOR_F32, 5, {1, 3, 4, 4, 4}, "field rgb: 4 channels, expected 3"},
		{"rgb", TENSOR_F32, 4, {1, 3, 4, 4}, "field rgb: rank 4, expected 5"},
		{"rgb", TENSOR_F32, 5, {1, 3, 3, 4, 1}, "field rgb: dimension 4 is 1; 2 to 2048"},
		{"rgb", TENSOR_U8, 5, {1, 3, 3, 4, 4}, "field rgb: type uint8, where floats are expected"},
		{"luminance", TENSOR_F32, 4, {1, 3, 4, 5}, "field luminance: its shape is not that of the samples"},
		{"ndf", TENSOR_F32, 1, {8}, "field ndf: rank 1, expected 2"},
		{"ndf", TENSOR_F32, 2, {1, 4}, "field ndf: dimension 0 is 1"},
		{"valid", TENSOR_U8, 1, {7}, "field valid: 7 elements of type uint8, expected 6"},
		{"valid", TENSOR_F32, 1, {6}, "field valid: 6 elements of type float32"},
		{"jacobian", TENSOR_F32, 1, {1}, "field jacobian: one uint8"},
		{"theta_i", TENSOR_F32, 1, {300}, "field theta_i: 300 angles"},
		{"phi_i", TENSOR_F32, 1, {3}, "an anisotropic material (field phi_i has 3 azimuths)"},
	};
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		begin_anew();
		made_set(&made, cases[n].field, cases[n].type, cases[n].rank, cases[n].shape, 1);
		refused(cases[n].words);
	}
	static const char *const needed[] = {"phi_i", "theta_i", "ndf", "sigma", "vndf", "jacobian"};
	for (int n = 0; n < 6; n++) {
		char words[64];
		begin_anew();
		made_remove(&made, needed[n]);
		snprintf(words, sizeof words, "no field %s", needed[n]);
		refused(words);
	}
	begin_anew();
	made_remove(&made, "rgb");
	refused("neither field rgb nor spectra");
}

/* Two azimuths are isotropic still: the first one counts. */
static void of_two_azimuths_the_first_is_taken(void **state)
{
	(void)state;
	const uint64_t two[1] = {2}, vndf[4] = {2, MADE_ANGLES, 4, 4}, rgb[5] = {2, MADE_ANGLES, 3, 4, 4}, valid[1] = {12},
				   luminance[4] = {2, MADE_ANGLES, 4, 4};
	made_set(&made, "phi_i", TENSOR_F32, 1, two, 0)->values[1] = 3;
	made_set(&made, "vndf", TENSOR_F64, 4, vndf, 1);
	made_set(&made, "luminance", TENSOR_F16, 4, luminance, 1);
	made_set(&made, "valid", TENSOR_U8, 1, valid, 255);
	struct made_field *samples = made_set(&made, "rgb", TENSOR_F16, 5, rgb, 0.5);
	for (uint64_t n = made_count(samples) / 2; n < made_count(samples); n++)
		samples->values[n] = 4;
	made_is_good();
	rgl_evaluate(&material, 0.7, 2, 0.4, 0.5, &value);
	near(value.rgb[0], 1);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test_setup_teardown(samples_over_the_cosine_where_all_is_even, begin, end),
		cmocka_unit_test_setup_teardown(samples_follow_the_visible_normals, begin, end),
		cmocka_unit_test_setup_teardown(azimuths_count_from_the_incident_direction, begin, end),
		cmocka_unit_test_setup_teardown(angles_of_incidence_are_interpolated, begin, end),
		cmocka_unit_test_setup_teardown(negative_channels_are_0, begin, end),
		cmocka_unit_test_setup_teardown(zeros_that_were_not_measured_are_no_data, begin, end),
		cmocka_unit_test_setup_teardown(spectra_become_linear_rgb, begin, end),
		cmocka_unit_test_setup_teardown(the_observer_is_the_standard_one, begin, end),
		cmocka_unit_test_setup_teardown(wrong_values_are_refused_by_their_field, begin, end),
		cmocka_unit_test_setup_teardown(zero_distributions_are_refused, begin, end),
		cmocka_unit_test_setup_teardown(shapes_that_disagree_are_refused, begin, end),
		cmocka_unit_test_setup_teardown(of_two_azimuths_the_first_is_taken, begin, end),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
