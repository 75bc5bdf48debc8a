/* test_image.c: exposure, the sRGB curve, and image files. */
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "render/picture.h"
#include "scratch.h"

static char folder[SCRATCH_BYTES];

static int folder_make(void **state)
{
	(void)state;
	return scratch_folder(folder);
}

/* Nothing that a test left behind may stay: also a check that failed writes leave no file. */
static int folder_remove(void **state)
{
	(void)state;
	return rmdir(folder);
}

static const char *path_of(const char *name) { return scratch_in(folder, name); }

static void image_make(uint32_t size, struct sphere_image *image)
{
	bp_error error;
	assert_int_equal(sphere_image_alloc(size, image, &error), BP_OK);
	memset(image->covered, 1, size * size);
	image->covered_count = size * size;
}

static void srgb_has_the_values_of_the_standard(void **state)
{
	(void)state;
	assert_true(image_srgb(0) == 0 && fabs(image_srgb(1) - 1) < 1e-12);
	assert_true(image_srgb(-3) == 0 && fabs(image_srgb(1e30) - 1) < 1e-12);
	assert_true(fabs(image_srgb(0.001) - 0.01292) < 1e-12); /* the straight part */
	assert_true(fabs(image_srgb(0.5) - 0.735356983) < 1e-9);
	assert_true(fabs(image_srgb(0.18) - 0.461356129) < 1e-8);
}

static void exposure_brings_the_90th_percentile_to_nine_tenths(void **state)
{
	(void)state;
	bp_error error;
	struct sphere_image image;
	double exposure;
	image_make(5, &image);
	/* channel means 0, 1, ... 24 in a scattered order; covered: all but the five largest, so index 18 of 20 */
	for (uint32_t n = 0; n < 25; n++) {
		uint32_t mean = n * 7 % 25;
		image.rgb[3 * n] = (float)(mean * 3);
		image.covered[n] = mean < 20;
	}
	image.covered_count = 20;
	assert_int_equal(image_exposure(&image, &exposure, &error), BP_OK);
	assert_true(fabs(exposure - 0.9 / 18) < 1e-12);
	sphere_image_free(&image);
}

static void exposure_of_a_black_image_is_finite(void **state)
{
	(void)state;
	bp_error error;
	struct sphere_image image;
	double exposure;
	image_make(2, &image);
	assert_int_equal(image_exposure(&image, &exposure, &error), BP_OK);
	assert_true(fabs(exposure - 0.9e12) < 1);
	sphere_image_free(&image);
}

static void a_picture_comes_back_from_its_png_file(void **state)
{
	(void)state;
	bp_error error;
	struct picture picture;
	assert_int_equal(picture_alloc(5, 3, &picture, &error), BP_OK);
	for (int n = 0; n < 45; n++)
		picture.rgb[n] = (uint8_t)(n * 37);
	const char *path = path_of("a.png");
	assert_int_equal(picture_write_png(path, &picture, &error), BP_OK);
	png_image png = {.version = PNG_IMAGE_VERSION};
	assert_true(png_image_begin_read_from_file(&png, path));
	assert_int_equal(png.width * 100 + png.height, 503);
	png.format = PNG_FORMAT_RGB;
	uint8_t back[45];
	assert_true(png_image_finish_read(&png, NULL, back, 0, NULL));
	assert_memory_equal(back, picture.rgb, 45);
	unlink(path);
	picture_free(&picture);
}

/* 2 x 2: head "PF\n2 2\n-1\n", then the bottom row. */
static void a_pfm_file_holds_the_bottom_row_first(void **state)
{
	(void)state;
	static const char HEAD[] = "PF\n2 2\n-1\n";
	bp_error error;
	struct sphere_image image;
	unsigned char bytes[128];
	image_make(2, &image);
	for (int n = 0; n < 12; n++)
		image.rgb[n] = (float)n;
	const char *path = path_of("a.pfm");
	assert_int_equal(image_write_pfm(path, &image, &error), BP_OK);
	FILE *file = fopen(path, "rb");
	assert_int_equal(fread(bytes, 1, sizeof bytes, file), 10 + 48);
	fclose(file);
	assert_memory_equal(bytes, HEAD, 10);
	static const unsigned char SIX[4] = {0, 0, 0xc0, 0x40}; /* 6.0f, little-endian */
	assert_memory_equal(bytes + 10, SIX, 4);
	static const unsigned char ZERO[4] = {0, 0, 0, 0};
	assert_memory_equal(bytes + 10 + 24, ZERO, 4);
	/* In another unit: the same bytes where float can hold the values, else the unit as the scale. */
	image.unit = 0.5;
	for (int n = 0; n < 12; n++)
		image.rgb[n] = (float)(2 * n);
	unsigned char again[128];
	assert_int_equal(image_write_pfm(path, &image, &error), BP_OK);
	file = fopen(path, "rb");
	assert_int_equal(fread(again, 1, sizeof again, file), 10 + 48);
	fclose(file);
	assert_memory_equal(again, bytes, 58);
	image.unit = 1e300;
	assert_int_equal(image_write_pfm(path, &image, &error), BP_OK);
	file = fopen(path, "rb");
	assert_int_equal(fread(again, 1, sizeof again, file), 15 + 48);
	fclose(file);
	assert_memory_equal(again, "PF\n2 2\n-1e+300\n", 15);
	unlink(path);
	sphere_image_free(&image);
}

static void the_three_pictures_stand_side_by_side(void **state)
{
	(void)state;
	bp_error error;
	struct sphere_image reference, estimate;
	struct picture picture;
	image_make(2, &reference);
	image_make(2, &estimate);
	for (int n = 0; n < 12; n++)
		reference.rgb[n] = estimate.rgb[n] = 0.5f;
	estimate.rgb[3 * 3 + 1] = 0.48f; /* green of the lower right pixel */
	estimate.rgb[3 * 2] = NAN;       /* the lower left pixel */
	assert_int_equal(picture_compare(&reference, &estimate, &picture, &error), BP_OK);
	assert_int_equal(picture.width * 100 + picture.height, 602);
	const uint8_t *row = picture.rgb + 3 * 6;
	assert_int_equal(row[0], 243); /* 0.9 in sRGB */
	assert_int_equal(row[3 * 3], 243);
	assert_int_equal(row[3 * 3 + 1], 239); /* 0.864 in sRGB: 0.937658, 239 */
	assert_int_equal(row[3 * 5], 0);
	assert_int_equal(row[3 * 5 + 1], 43);                                           /* 10 (0.954687 - 0.937658) 255 = 43.4 */
	assert_true(row[3 * 2] == 255 && row[3 * 2 + 1] == 0 && row[3 * 2 + 2] == 255); /* magenta: not finite */
	assert_int_equal(row[3 * 4], 255);
	picture_free(&picture);
	sphere_image_free(&reference);
	sphere_image_free(&estimate);
}

static void a_path_that_cannot_be_written_is_named_and_nothing_is_left(void **state)
{
	(void)state;
	bp_error error;
	struct picture picture;
	struct sphere_image image;
	image_make(2, &image);
	assert_int_equal(picture_alloc(2, 2, &picture, &error), BP_OK);
	const char *path = path_of("missing/a.png");
	assert_int_equal(picture_write_png(path, &picture, &error), BP_ERROR_IO);
	assert_non_null(strstr(error.message, path));
	assert_int_equal(image_write_pfm(path_of("missing/a.pfm"), &image, &error), BP_ERROR_IO);
	assert_int_equal(scratch_count(folder), 0);
	picture_free(&picture);
	sphere_image_free(&image);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(srgb_has_the_values_of_the_standard),
		cmocka_unit_test(exposure_brings_the_90th_percentile_to_nine_tenths),
		cmocka_unit_test(exposure_of_a_black_image_is_finite),
		cmocka_unit_test(a_picture_comes_back_from_its_png_file),
		cmocka_unit_test(a_pfm_file_holds_the_bottom_row_first),
		cmocka_unit_test(the_three_pictures_stand_side_by_side),
		cmocka_unit_test(a_path_that_cannot_be_written_is_named_and_nothing_is_left),
	};
	return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
