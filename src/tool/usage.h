/* usage.h: what a command says of itself, fitted to a terminal of 80 columns. */
#ifndef TOOL_USAGE_H
#define TOOL_USAGE_H

#include <stdio.h>

enum { USAGE_COLUMNS = 80 };

/*
 * Prints a command's usage text (ASCII), its lines broken anew. A line with two blanks between words, as "  -q, --quiet   no
 * progress", begins an entry, which lines indented as far as its second part go on with; lines without indent that follow each
 * other are one paragraph, but for the first ones, up to "Usage:" and what is indented under it. Long words stay whole.
 */
void usage_print(FILE *out, const char *usage);

#endif
