#include "picture.h"

#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

#include "bytes.h"
#include "error.h"
#include "output_file.h"

bp_status picture_alloc(uint32_t width, uint32_t height, struct picture *out, bp_error *error)
{
	size_t bytes = (size_t)3 * width * height;
	uint8_t *rgb = calloc(bytes ? bytes : 1, 1);
	if (!rgb)
		return error_memory(error, bytes);
	*out = (struct picture){.width = width, .height = height, .rgb = rgb};
	return BP_OK;
}

void picture_free(struct picture *picture)
{
	free(picture->rgb);
	*picture = (struct picture){0};
}

static uint8_t to_byte(double x) { return (uint8_t)(fmin(1, fmax(0, x)) * 255 + 0.5); }

void picture_place(struct picture *picture, uint32_t x, const struct sphere_image *image, double exposure)
{
	for (uint32_t row = 0; row < image->size; row++) {
		const float *from = image->rgb + (size_t)3 * row * image->size;
		uint8_t *to = picture->rgb + 3 * (x + (size_t)row * picture->width);
		for (uint32_t n = 0; n < image->size; n++, from += 3, to += 3) {
			bool finite = isfinite(from[0]) && isfinite(from[1]) && isfinite(from[2]);
			for (int c = 0; c < 3; c++)
				to[c] = finite ? to_byte(image_srgb(from[c] * exposure)) : c == 1 ? 0 : 255;
		}
	}
}

bp_status picture_compare(const struct sphere_image *reference, const struct sphere_image *estimate, struct picture *out,
                          bp_error *error)
{
	const uint32_t size = reference->size;
	double exposure;
	struct picture picture;
	bp_status status = image_exposure(reference, &exposure, error);
	if (status == BP_OK)
		status = picture_alloc(3 * size, size, &picture, error);
	if (status != BP_OK)
		return status;
	picture_place(&picture, 0, reference, exposure);
	picture_place(&picture, size, estimate, exposure);
	for (uint32_t y = 0; y < size; y++)
		for (uint32_t x = 0; x < 3 * size; x++) {
			size_t n = x + (size_t)3 * size * y;
			double a = image_srgb(reference->rgb[n] * exposure), b = estimate->rgb[n];
			b = isfinite(b) ? image_srgb(b * exposure) : 1 - a;
			picture.rgb[(size_t)3 * 3 * size * y + 6 * size + x] = to_byte(10 * fabs(a - b));
		}
	*out = picture;
	return BP_OK;
}

/* Behind signature and header of a PNG file: who made it, as a text chunk (length, type, text, CRC32). */
#define PNG_MARK \
	"\0\0\0\x11" \
	"tEXt" \
	"Software\0" \
	"brdfpack" \
	"\xf2\x0c\xf4\x0d"
enum { PNG_HEAD_BYTES = 33, PNG_MARK_BYTES = sizeof PNG_MARK - 1 };

bool picture_is_ours(const uint8_t *head, size_t count)
{
	if (count >= PNG_HEAD_BYTES + PNG_MARK_BYTES && !memcmp(head, "\x89PNG\r\n\x1a\n", 8))
		return !memcmp(head + PNG_HEAD_BYTES, PNG_MARK, PNG_MARK_BYTES);
	return count >= 4 && !memcmp(head, "<svg", 4) && memmem(head, count, PICTURE_SVG_MARK, sizeof PICTURE_SVG_MARK - 1);
}

bp_status picture_encode_png(const struct picture *picture, uint8_t **out, size_t *count, bp_error *error)
{
	png_image png = {.version = PNG_IMAGE_VERSION, .width = picture->width, .height = picture->height, .format = PNG_FORMAT_RGB};
	png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(png);
	uint8_t *memory = malloc(bytes + PNG_MARK_BYTES);
	if (!memory)
		return error_memory(error, bytes);
	if (!png_image_write_to_memory(&png, memory, &bytes, 0, picture->rgb, 0, NULL)) {
		free(memory);
		return error_set(error, BP_ERROR_MEMORY, BP_NO_OFFSET, "cannot encode as PNG: %s", png.message);
	}
	memmove(memory + PNG_HEAD_BYTES + PNG_MARK_BYTES, memory + PNG_HEAD_BYTES, bytes - PNG_HEAD_BYTES);
	memcpy(memory + PNG_HEAD_BYTES, PNG_MARK, PNG_MARK_BYTES);
	*out = memory;
	*count = bytes + PNG_MARK_BYTES;
	return BP_OK;
}

bp_status picture_write_png(const char *path, const struct picture *picture, bp_error *error)
{
	uint8_t *bytes = NULL;
	size_t count = 0;
	bp_status status = picture_encode_png(picture, &bytes, &count, error);
	if (status != BP_OK)
		return status;
	status = output_file_write_whole(path, OUTPUT_REPLACE, bytes, count, error);
	free(bytes);
	return status;
}

bp_status image_write_pfm(const char *path, const struct sphere_image *image, bp_error *error)
{
	const size_t row = 3 * (size_t)image->size;
	double largest = 0, factor = 1, scale = image->unit;
	struct byte_buffer file = {0};
	char head[96];
	for (size_t n = 0; n < row * image->size; n++)
		largest = fmax(largest, fabs((double)image->rgb[n]));
	/* Few programs look at the scale: it is 1 wherever a float can hold the values. */
	if (largest * image->unit < 1e38 && image->unit > 1e-30) {
		factor = image->unit;
		scale = 1;
	}
	/* a negative scale means little-endian; its magnitude is the unit */
	write_bytes(&file, head, (size_t)snprintf(head, sizeof head, "PF\n%u %u\n%.9g\n", image->size, image->size, -scale));
	for (uint32_t y = image->size; y-- > 0;)
		for (size_t n = 0; n < row; n++)
			write_f32(&file, (float)(factor * (double)image->rgb[row * y + n]));
	const bp_status status = file.failed ? error_memory(error, file.count)
	                                     : output_file_write_whole(path, OUTPUT_REPLACE, file.bytes, file.count, error);
	byte_buffer_free(&file);
	return status;
}
