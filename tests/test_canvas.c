/* test_canvas.c: drawing into PNG and SVG. */
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "render/canvas.h"
#include "render/font.h"
#include "scratch.h"

static char folder[SCRATCH_BYTES];
static const char *path;

static int folder_make(void **state)
{
	(void)state;
	path = scratch_folder(folder) ? NULL : scratch_in(folder, "picture");
	return path ? 0 : -1;
}

static int folder_remove(void **state)
{
	(void)state;
	return rmdir(folder);
}

static const struct colour BLACK = {0, 0, 0}, RED = {255, 0, 0};

static void draw(struct canvas *canvas)
{
	const double bent[4][2] = {{2, 10}, {8, 10}, {NAN, NAN}, {12, 10}};
	const uint8_t cells[6] = {0, 0, 255, 0, 255, 0};
	const struct picture picture = {.width = 2, .height = 1, .rgb = (uint8_t *)(uintptr_t)cells};
	canvas_rectangle(canvas, 1, 1, 3, 2, RED);
	canvas_line(canvas, bent, 4, 2, BLACK);
	canvas_picture(canvas, 20, 1, 4, 4, &picture);
	canvas_text(canvas, 2, 30, 7, ANCHOR_LEFT, false, BLACK, "L<&\xc3\xa9");
}

/* Draws on 40 x 40 pixels and reads the file back; malloc'ed. */
static uint8_t *png_of(void (*paint)(struct canvas *))
{
	bp_error error;
	struct canvas *canvas;
	png_image png = {.version = PNG_IMAGE_VERSION};
	uint8_t *rgb = malloc(40 * 40 * 3);
	assert_int_equal(canvas_make(40, 40, false, &canvas, &error), BP_OK);
	paint(canvas);
	assert_int_equal(canvas_write(canvas, path, &error), BP_OK);
	canvas_free(canvas);
	assert_true(png_image_begin_read_from_file(&png, path) && png.width == 40 && png.height == 40);
	png.format = PNG_FORMAT_RGB;
	assert_true(png_image_finish_read(&png, NULL, rgb, 0, NULL));
	unlink(path);
	return rgb;
}

static unsigned pixel(const uint8_t *rgb, int x, int y)
{
	const uint8_t *p = rgb + 3 * (x + 40 * y);
	return (unsigned)p[0] << 16 | (unsigned)p[1] << 8 | p[2];
}

static void a_png_canvas_has_ink_where_it_was_drawn(void **state)
{
	(void)state;
	uint8_t *rgb = png_of(draw);
	assert_int_equal(pixel(rgb, 0, 0), 0xffffff);
	assert_int_equal(pixel(rgb, 1, 1), 0xff0000);
	assert_int_equal(pixel(rgb, 3, 2), 0xff0000);
	assert_int_equal(pixel(rgb, 4, 1), 0xffffff);
	/* a line of width 2 about y = 10 covers the rows 9 and 10; the NaN leaves a gap */
	assert_int_equal(pixel(rgb, 5, 9), 0);
	assert_int_equal(pixel(rgb, 5, 10), 0);
	assert_int_equal(pixel(rgb, 5, 12), 0xffffff);
	assert_int_equal(pixel(rgb, 11, 10), 0xffffff);
	/* two cells over four columns */
	assert_int_equal(pixel(rgb, 21, 4), 0x0000ff);
	assert_int_equal(pixel(rgb, 22, 1), 0x00ff00);
	assert_int_equal(pixel(rgb, 24, 1), 0xffffff);
	/* L: a stem of 7 rows that ends on the baseline, and a foot of 5 columns */
	for (int y = 23; y < 30; y++)
		assert_int_equal(pixel(rgb, 2, y), 0);
	assert_int_equal(pixel(rgb, 6, 29), 0);
	assert_int_equal(pixel(rgb, 6, 28), 0xffffff);
	assert_int_equal(pixel(rgb, 2, 30), 0xffffff);
	free(rgb);
}

static void draw_outside(struct canvas *canvas)
{
	const double far[2][2] = {{-500, -300}, {700, 900}};
	canvas_rectangle(canvas, -10, -10, 12, 12, RED);
	canvas_line(canvas, far, 2, 3, BLACK);
	canvas_text(canvas, 39, 3, 14, ANCHOR_LEFT, false, BLACK, "outside");
	canvas_text(canvas, 39, 39, 14, ANCHOR_RIGHT, true, BLACK, "g");
}

static void drawing_outside_is_clipped(void **state)
{
	(void)state;
	uint8_t *rgb = png_of(draw_outside);
	assert_int_equal(pixel(rgb, 1, 1), 0xff0000);
	assert_int_equal(pixel(rgb, 2, 2), 0xffffff);
	free(rgb);
}

static void an_svg_canvas_is_text_with_markup_escaped(void **state)
{
	(void)state;
	bp_error error;
	struct canvas *canvas;
	char text[4096];
	assert_int_equal(canvas_make(40, 40, true, &canvas, &error), BP_OK);
	draw(canvas);
	assert_int_equal(canvas_write(canvas, path, &error), BP_OK);
	canvas_free(canvas);
	FILE *file = fopen(path, "rb");
	text[fread(text, 1, sizeof text - 1, file)] = '\0';
	fclose(file);
	unlink(path);
	assert_memory_equal(text, "<svg ", 5);
	assert_non_null(strstr(text, "<rect x=\"1\" y=\"1\" width=\"3\" height=\"2\" fill=\"#ff0000\"/>"));
	assert_non_null(strstr(text, "d=\"M2.00 10.00L8.00 10.00M12.00 10.00\""));
	assert_non_null(strstr(text, ">L&#60;&#38;\xc3\xa9</text>"));
	assert_non_null(strstr(text, "href=\"data:image/png;base64,iVBORw0KGgo")); /* the PNG magic */
	assert_string_equal(text + strlen(text) - 7, "</svg>\n");
}

static void every_printable_character_has_a_glyph_of_its_own(void **state)
{
	(void)state;
	assert_true(font_glyph(' ') == 0);
	for (unsigned a = 33; a < 127; a++) {
		assert_true(font_glyph((unsigned char)a) != 0 && font_glyph((unsigned char)a) >> (FONT_WIDTH * FONT_ROWS) == 0);
		for (unsigned b = 33; b < a; b++)
			assert_true(font_glyph((unsigned char)a) != font_glyph((unsigned char)b));
	}
	assert_true(font_glyph(200) == font_glyph('?') && font_glyph('\n') == font_glyph('?'));
}

static void a_path_that_cannot_be_written_is_named(void **state)
{
	(void)state;
	bp_error error;
	for (int svg = 0; svg < 2; svg++) {
		struct canvas *canvas;
		assert_int_equal(canvas_make(8, 8, svg, &canvas, &error), BP_OK);
		assert_int_equal(canvas_write(canvas, "/nowhere/at/all", &error), BP_ERROR_IO);
		assert_non_null(strstr(error.message, "/nowhere/at/all"));
		canvas_free(canvas);
	}
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_png_canvas_has_ink_where_it_was_drawn),
		cmocka_unit_test(drawing_outside_is_clipped),
		cmocka_unit_test(an_svg_canvas_is_text_with_markup_escaped),
		cmocka_unit_test(every_printable_character_has_a_glyph_of_its_own),
		cmocka_unit_test(a_path_that_cannot_be_written_is_named),
	};
	return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
