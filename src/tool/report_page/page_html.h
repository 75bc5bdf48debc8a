/* page_html.h: text, pictures and lengths as HTML. */
#ifndef TOOL_REPORT_PAGE_PAGE_HTML_H
#define TOOL_REPORT_PAGE_PAGE_HTML_H

#include <stdint.h>
#include <stdio.h>

#include "render/picture.h"

/* A text for element content or a quoted attribute: & < > " ' escaped; what is no UTF-8 and control characters become U+FFFD. */
void html_text(FILE *out, const char *text);

/* The same within <bdi>, so that a right-to-left name turns nothing around it. */
void html_name(FILE *out, const char *name);

/* <table> with a caption and the head's row, which is left open: columns up to NULL, "" for an empty cell. All of it is HTML. */
void html_table(FILE *out, const char *caption, ...) __attribute__((sentinel));

/* <img> with the picture as PNG; `alt` is escaped here. `style`: its class. */
bp_status html_picture(FILE *out, const struct picture *picture, const char *style, const char *alt, bp_error *error);

#endif
