#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <math.h>
#include <string.h>

#include <cmocka.h>

#include "tool/export/export.h"
#include "tool/export/tensor_writer.h"
#include "tool/export/upsampling.h"
#include "tool/export/warped.h"

/* A plastic of our own making: diffuse, and a lobe around the half vector that brightens towards grazing angles. */
struct plastic {
	double diffuse[3], lobe, width;
};

static void plastic_value(const struct plastic *plastic, const float wi[3], const float wo[3], double f[3])
{
	double h[3], length = 0, d = 0;
	for (int axis = 0; axis < 3; axis++) {
		h[axis] = (double)wi[axis] + wo[axis];
		length += h[axis] * h[axis];
	}
	for (int axis = 0; axis < 3; axis++)
		d += wi[axis] * h[axis] / sqrt(length);
	const double tangent = hypot(h[0], h[1]) / h[2] / plastic->width;
	const double lobe = plastic->lobe * exp(-tangent * tangent) * (1 + 4 * pow(1 - fmin(d, 1), 5));
	for (int c = 0; c < 3; c++)
		f[c] = wi[2] > 0 && wo[2] > 0 ? plastic->diffuse[c] + lobe : 0;
}

static void plastic_evaluate(const void *user, size_t count, const float *const wi[3], const float *const wo[3],
                             float *const rgb[3])
{
	for (size_t n = 0; n < count; n++) {
		double f[3];
		plastic_value(user, (const float[]){wi[0][n], wi[1][n], wi[2][n]}, (const float[]){wo[0][n], wo[1][n], wo[2][n]}, f);
		for (int c = 0; c < 3; c++)
			rgb[c][n] = (float)f[c];
	}
}

static const struct plastic PLASTIC = {{0.2, 0.1, 0.05}, 2, 0.2}, BLACK = {{0}, 0, 1};

static void direction(double theta, double phi, float w[3])
{
	w[0] = (float)(sin(theta) * cos(phi));
	w[1] = (float)(sin(theta) * sin(phi));
	w[2] = (float)cos(theta);
}

/* The n-th of pairs of directions up to `most` radians from the normal: what the fields say, and what they should: plastic's, by the cosine. */
static void pair_values(const struct warped *warped, int n, double most, double wanted[3], double got[3])
{
	float wi[3], wo[3];
	direction(most * fmod(n * 0.618034, 1), n, wi);
	direction(most * fmod(n * 0.754878, 1), n * 1.7, wo);
	plastic_value(&PLASTIC, wi, wo, wanted);
	for (int c = 0; c < 3; c++)
		wanted[c] *= wo[2];
	warped_evaluate(warped, wi, wo, got);
}

static void warped_fields_give_the_material_back(void **state)
{
	(void)state;
	const struct reflectance reflectance = {plastic_evaluate, &PLASTIC};
	const struct warped_shape shape = {22, 56, 39, 80, {0.5, 0.1}};
	struct warped warped;
	int off = 0;
	assert_int_equal(warped_make(&reflectance, &shape, &warped, NULL), BP_OK);
	for (int n = 0; n < 2000; n++) {
		double wanted[3], got[3];
		pair_values(&warped, n, 1.4, wanted, got);
		for (int c = 0; c < 3; c++)
			off += fabs(got[c] - wanted[c]) > 0.03 * wanted[c] + 3e-4;
	}
	assert_true(off < 60); /* of 6000 values */
	float wi[3], below[3];
	double got[3];
	direction(0.3, 0, wi);
	direction(1.8, 2, below);
	warped_evaluate(&warped, wi, below, got);
	assert_true(got[0] == 0 && got[1] == 0 && got[2] == 0);
	warped_free(&warped);
}

/* Readers divide by what they interpolate of it, in floats: a 0 there may come out below 0. */
static void luminance_is_0_nowhere(void **state)
{
	(void)state;
	const struct reflectance reflectance = {plastic_evaluate, &PLASTIC};
	const struct warped_shape shape = {11, 24, 19, 18, {0.5, 0.1}};
	const size_t points = (size_t)shape.size * shape.size;
	struct warped warped;
	size_t dark = 0;
	assert_int_equal(warped_make(&reflectance, &shape, &warped, NULL), BP_OK);
	for (size_t angle = 0; angle < shape.angles; angle++) {
		const float *luminance = warped.luminance + angle * points, *rgb = warped.rgb + angle * 3 * points;
		double sum = 0;
		for (size_t n = 0; n < points; n++)
			sum += (double)luminance[n];
		for (size_t n = 0; n < points; n++) {
			const double mean = ((double)rgb[n] + rgb[points + n] + rgb[2 * points + n]) / 3,
						 share = (double)luminance[n] * (double)points / sum;
			assert_true(share > 0.9e-4);
			assert_true(share < 1.1e-4 || fabs((double)luminance[n] - mean) <= 1e-6 * mean);
			dark += mean <= 0;
		}
	}
	assert_true(dark > 0);
	warped_free(&warped);
}

/* A lobe is hollow at its sides, where straight lines between samples lie above it; the mean of the differences is small nevertheless. */
static void between_samples_the_mean_is_right(void **state)
{
	(void)state;
	const struct reflectance reflectance = {plastic_evaluate, &PLASTIC};
	const struct warped_shape shape = {11, 24, 19, 18, {0.5, 0.1}};
	struct warped warped;
	double sum = 0, sum_absolute = 0;
	assert_int_equal(warped_make(&reflectance, &shape, &warped, NULL), BP_OK);
	for (int n = 0; n < 20000; n++) {
		double wanted[3], got[3];
		pair_values(&warped, n, 1.2, wanted, got);
		sum += got[0] - wanted[0];
		sum_absolute += fabs(got[0] - wanted[0]);
	}
	if (!(fabs(sum) < 0.1 * sum_absolute))
		fail_msg("%g of %g", sum, sum_absolute);
	warped_free(&warped);
}

/* Beside a narrow lobe the samples that are right in the mean were below 0, and so was the light that readers saw there. */
static void no_light_is_below_0(void **state)
{
	(void)state;
	static const struct plastic mirror = {{0}, 200, 0.05};
	const struct reflectance reflectance = {plastic_evaluate, &mirror};
	const struct warped_shape shape = {11, 24, 19, 18, {0.5, 0.1}};
	struct warped warped;
	assert_int_equal(warped_make(&reflectance, &shape, &warped, NULL), BP_OK);
	double least = 0;
	for (int n = 0; n < 20000; n++) {
		double wanted[3], got[3];
		pair_values(&warped, n, 1, wanted, got);
		least = fmin(least, got[0]);
	}
	if (!(least > -5e-7)) /* cells across the horizon go below 0 a little */
		fail_msg("%g", least);
	warped_free(&warped);
}

/* Readers divide by the sum of each slice of luminance. */
static void a_black_material_has_luminance_all_the_same(void **state)
{
	(void)state;
	const struct reflectance reflectance = {plastic_evaluate, &BLACK};
	const struct warped_shape shape = {3, 8, 8, 5, {0.5, 0.1}};
	struct warped warped;
	assert_int_equal(warped_make(&reflectance, &shape, &warped, NULL), BP_OK);
	for (int n = 0; n < 3 * 25; n++)
		assert_true(warped.luminance[n] == 1 && fabsf(warped.rgb[3 * n]) < 1e-29F);
	warped_free(&warped);
}

static void what_no_float_holds_is_refused(void **state)
{
	(void)state;
	const struct plastic blinding = {{3e38, 3e38, 3e38}, 0, 1};
	const struct reflectance reflectance = {plastic_evaluate, &blinding};
	const struct warped_shape shape = {3, 8, 8, 5, {0.5, 0.1}};
	struct warped warped;
	bp_error error;
	assert_int_equal(warped_make(&reflectance, &shape, &warped, &error), BP_ERROR_BAD_INPUT);
	assert_non_null(strstr(error.message, "float"));
	warped_free(&warped);
}

static void plastic_exactly(const void *exported, const float wi[3], const float wo[3], double rgb[3])
{
	plastic_value(exported, wi, wo, rgb);
	for (int c = 0; c < 3; c++)
		rgb[c] *= wo[2];
}

static void plastic_brighter(const void *exported, const float wi[3], const float wo[3], double rgb[3])
{
	plastic_exactly(exported, wi, wo, rgb);
	rgb[1] *= 1.02;
}

static void deviation_is_that_of_spheres_and_albedos(void **state)
{
	(void)state;
	const struct reflectance reflectance = {plastic_evaluate, &PLASTIC};
	struct deviation_reference *reference;
	struct deviation deviation;
	assert_int_equal(deviation_reference_make(&reflectance, &reference, NULL), BP_OK);
	assert_int_equal(deviation_measure(reference, plastic_exactly, &PLASTIC, &deviation, NULL), BP_OK);
	assert_true(deviation.psnr > 100 && deviation.albedo < 1e-5 && deviation_suffices(&deviation));
	assert_int_equal(deviation_measure(reference, plastic_brighter, &PLASTIC, &deviation, NULL), BP_OK);
	assert_true(deviation.psnr > 40 && deviation.psnr < 60 && fabs(deviation.albedo - 0.02) < 1e-4);
	assert_false(deviation_suffices(&deviation));
	deviation_reference_free(reference);
}

static uint64_t number_at(const struct byte_buffer *file, size_t at, size_t bytes)
{
	uint64_t value = 0;
	assert_true(at + bytes <= file->count);
	for (size_t n = bytes; n-- > 0;)
		value = value << 8 | file->bytes[at + n];
	return value;
}

static void a_tensor_file_is_laid_out_as_specified(void **state)
{
	(void)state;
	const uint8_t letters[3] = {'a', 'b', 'c'};
	const float numbers[6] = {0, 1, 2, 3, 4, -0.5f};
	const struct tensor fields[] = {{"text", TENSOR_U8, 1, {3}, letters}, {"n", TENSOR_F32, 2, {2, 3}, numbers}};
	struct byte_buffer file = {0};
	tensor_file_write(fields, 2, &file);
	assert_false(file.failed);
	assert_int_equal(file.count, tensor_file_bytes(fields, 2));
	assert_memory_equal(file.bytes, "tensor_file\0\1\0\2\0\0\0", 18);
	assert_int_equal(number_at(&file, 18, 2), 4);
	assert_memory_equal(file.bytes + 20, "text", 4);
	assert_int_equal(number_at(&file, 24, 2), 1);
	assert_int_equal(number_at(&file, 26, 1), 1);
	const uint64_t text = number_at(&file, 27, 8);
	assert_int_equal(number_at(&file, 35, 8), 3);
	assert_memory_equal(file.bytes + 45, "n", 1);
	assert_int_equal(number_at(&file, 48, 1), 10);
	const uint64_t n = number_at(&file, 49, 8);
	assert_int_equal(number_at(&file, 57, 8), 2);
	assert_int_equal(number_at(&file, 65, 8), 3);
	assert_true(text == 80 && n == 88 && file.count == 88 + 24);
	assert_memory_equal(file.bytes + text, "abc\0\0\0\0\0", 8);
	assert_int_equal(number_at(&file, n + 20, 4), 0xbf000000);
	byte_buffer_free(&file);
}

static void files_are_as_large_as_needed_and_no_larger_than_told(void **state)
{
	(void)state;
	const struct reflectance reflectance = {plastic_evaluate, &PLASTIC};
	const uint64_t most[] = {export_bsdf_least(false), 80000, 100000000};
	double before = 0;
	for (int n = 0; n < 3; n++) {
		const struct export_options options = {EXPORT_BSDF, false, most[n]};
		struct byte_buffer file = {0};
		struct deviation deviation;
		assert_int_equal(export_bsdf(&reflectance, "plastic", &options, &file, &deviation, NULL), BP_OK);
		if (!(file.count <= most[n] && deviation.psnr > before))
			fail_msg("%zu bytes, %g dB", file.count, deviation.psnr);
		assert_memory_equal(file.bytes, "tensor_file", 12);
		before = deviation.psnr;
		if (n == 2)
			assert_true(deviation_suffices(&deviation) && file.count < 5000000);
		byte_buffer_free(&file);
	}
}

static void an_mbsdf_holds_f_at_the_centres_of_its_cells(void **state)
{
	(void)state;
	static const char HEAD[] = "NVIDIA ARC MBSDF V1\nname=\"a \\\"good\\\" one??\"\nMBSDF_DATA=\n";
	const struct reflectance reflectance = {plastic_evaluate, &PLASTIC};
	const struct export_options options = {EXPORT_MBSDF, false, export_mbsdf_least()};
	struct byte_buffer file = {0};
	struct deviation deviation;
	assert_int_equal(export_mbsdf(&reflectance, "a \"good\" one\xc3\xa9", &options, &file, &deviation, NULL), BP_OK);
	assert_true(file.count <= options.most_bytes);
	assert_memory_equal(file.bytes, HEAD, sizeof HEAD - 1);
	size_t at = sizeof HEAD - 1;
	assert_int_equal(number_at(&file, at, 4), 1);
	const size_t theta = number_at(&file, at + 4, 4), phi = number_at(&file, at + 8, 4);
	assert_int_equal(file.count, at + 12 + 12 * theta * theta * phi);
	const size_t in = 5, out = 11, turn = 7;
	float wi[3], wo[3];
	double f[3];
	direction(((double)in + 0.5) / (double)theta * M_PI_2, 0, wi);
	direction(((double)out + 0.5) / (double)theta * M_PI_2, ((double)turn + 0.5) / (double)phi * M_PI, wo);
	plastic_value(&PLASTIC, wi, wo, f);
	for (size_t c = 0; c < 3; c++) {
		const uint32_t bits = (uint32_t)number_at(&file, at + 12 + 4 * (3 * ((in * theta + out) * phi + turn) + c), 4);
		float value;
		memcpy(&value, &bits, sizeof value);
		assert_true(fabs(value / f[c] - 1) < 1e-4);
	}
	byte_buffer_free(&file);
}

static void grey_stays_flat_when_it_becomes_a_spectrum(void **state)
{
	(void)state;
	const float rgb[6] = {0.5f, 1, 0.5f, 0, 0.5f, 0}; /* grey, red */
	float spectra[2 * UPSAMPLING_COUNT];
	upsample(rgb, 1, 2, spectra);
	for (int l = 0; l < UPSAMPLING_COUNT; l++) {
		assert_true(fabsf(spectra[2 * l] - 0.5f) < 1e-6f);
		assert_true(spectra[2 * l + 1] >= 0 && spectra[2 * l + 1] <= 1);
	}
	assert_true(spectra[2 * UPSAMPLING_COUNT - 5] == 1 && spectra[2 * 6 + 1] == 0);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(warped_fields_give_the_material_back),
		cmocka_unit_test(between_samples_the_mean_is_right),
		cmocka_unit_test(no_light_is_below_0),
		cmocka_unit_test(luminance_is_0_nowhere),
		cmocka_unit_test(a_black_material_has_luminance_all_the_same),
		cmocka_unit_test(what_no_float_holds_is_refused),
		cmocka_unit_test(deviation_is_that_of_spheres_and_albedos),
		cmocka_unit_test(a_tensor_file_is_laid_out_as_specified),
		cmocka_unit_test(files_are_as_large_as_needed_and_no_larger_than_told),
		cmocka_unit_test(an_mbsdf_holds_f_at_the_centres_of_its_cells),
		cmocka_unit_test(grey_stays_flat_when_it_becomes_a_spectrum),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
