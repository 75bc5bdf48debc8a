/* Text and bytes of the page of `report`. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "memory_stream.h"
#include "render/base64.h"
#include "tool/report_page/page_html.h"

static struct byte_buffer printed;

static FILE *out_open(void)
{
	printed = (struct byte_buffer){0};
	FILE *out = memory_stream_open(&printed);
	assert_non_null(out);
	return out;
}

static void assert_printed(FILE *out, const char *expected)
{
	fclose(out);
	assert_int_equal(printed.count, strlen(expected));
	if (printed.count)
		assert_memory_equal(printed.bytes, expected, printed.count);
	byte_buffer_free(&printed);
}

static void text_cannot_leave_its_place(void **user)
{
	(void)user;
	static const struct {
		const char *text, *html;
	} cases[] = {
		{"", ""},
		{"plain name-1", "plain name-1"},
		{"<b>&\"'</b>", "&lt;b&gt;&amp;&quot;&#39;&lt;/b&gt;"},
		{"\xd9\x85\xf0\x9f\x8e\xa8", "\xd9\x85\xf0\x9f\x8e\xa8"}, /* two and four bytes */
		{"a\xff"
	     "b\xc0\x80",
	     "a\xef\xbf\xbd"
	     "b\xef\xbf\xbd\xef\xbf\xbd"},                                              /* no UTF-8 */
		{"\xed\xa0\x80", "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"},                   /* a surrogate */
		{"cut \xe2\x82", "cut \xef\xbf\xbd\xef\xbf\xbd"},                           /* an end within a sequence */
		{"\n\x1b\x7f\xc2\x85", "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"}, /* control characters */
	};
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		FILE *out = out_open();
		html_text(out, cases[n].text);
		assert_printed(out, cases[n].html);
	}
	FILE *out = out_open();
	html_name(out, "a<b");
	assert_printed(out, "<bdi>a&lt;b</bdi>");
}

/* The vectors of RFC 4648, section 10, and every digit. */
static void base64_is_that_of_the_standard(void **user)
{
	(void)user;
	static const char *const cases[][2] = {{"", ""},
	                                       {"f", "Zg=="},
	                                       {"fo", "Zm8="},
	                                       {"foo", "Zm9v"},
	                                       {"foob", "Zm9vYg=="},
	                                       {"fooba", "Zm9vYmE="},
	                                       {"foobar", "Zm9vYmFy"},
	                                       {"\xff\xef\xbe", "/+++"}};
	for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
		FILE *out = out_open();
		base64_write(out, (const uint8_t *)cases[n][0], strlen(cases[n][0]));
		assert_printed(out, cases[n][1]);
	}
}

static void a_picture_has_its_text_and_extents(void **user)
{
	(void)user;
	struct picture picture;
	assert_int_equal(picture_alloc(3, 2, &picture, NULL), BP_OK);
	FILE *out = out_open();
	assert_int_equal(html_picture(out, &picture, "ball", "a \"b\"", NULL), BP_OK);
	fclose(out);
	write_u8(&printed, 0);
	static const char head[] =
		"<img class=\"ball\" loading=lazy width=3 height=2 alt=\"a &quot;b&quot;\" src=\"data:image/png;base64,iVBORw0KGgo";
	assert_memory_equal(printed.bytes, head, sizeof head - 1);
	assert_string_equal((const char *)printed.bytes + printed.count - 3, "\">");
	byte_buffer_free(&printed);
	picture_free(&picture);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(text_cannot_leave_its_place),
		cmocka_unit_test(base64_is_that_of_the_standard),
		cmocka_unit_test(a_picture_has_its_text_and_extents),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
