#include "usage.h"

#include <stdbool.h>
#include <string.h>

struct block {
	size_t column; /* where the next word goes; 0: at the beginning of a line */
	size_t hang;   /* indent of the lines that follow */
	bool open;     /* the next line may go on with it */
};

static void words_put(FILE *out, struct block *block, const char *text, size_t bytes)
{
	for (size_t at = 0; at < bytes;) {
		const size_t blanks = strspn(text + at, " "), length = strcspn(text + at + blanks, " \n");
		const size_t gap = blanks > 0 ? blanks : block->column > block->hang;
		if (block->column > block->hang && block->column + gap + length > USAGE_COLUMNS) {
			fprintf(out, "\n%*s", (int)block->hang, "");
			block->column = block->hang;
		} else {
			fprintf(out, "%*s", (int)gap, "");
			block->column += gap;
		}
		fwrite(text + at + blanks, 1, length, out);
		block->column += length;
		at += blanks + length;
	}
}

/* Where an entry's second part begins; 0: the line is none. */
static size_t part_second(const char *line, size_t bytes, size_t indent)
{
	for (size_t at = indent; at + 2 < bytes; at++)
		if (line[at] == ' ' && line[at + 1] == ' ')
			return at + strspn(line + at, " ");
	return 0;
}

void usage_print(FILE *out, const char *usage)
{
	struct block block = {0};
	bool heading = true; /* "Usage:" and the lines under it stay as they are, but for their length */

	for (const char *line = usage; *line; line += strcspn(line, "\n"), line += *line == '\n') {
		const size_t bytes = strcspn(line, "\n"), indent = strspn(line, " ");
		const size_t second = part_second(line, bytes, indent);
		heading = heading && (line == usage || indent > 0);
		if (block.open && bytes > 0 && indent == block.hang) {
			words_put(out, &block, line + indent, bytes - indent);
			continue;
		}
		if (line != usage)
			fputc('\n', out);
		block = (struct block){.hang = second ? second : indent, .open = !heading && bytes > 0 && (second || indent == 0)};
		if (heading)
			block.hang = indent > 0 ? indent : strlen("Usage: ");
		words_put(out, &block, line, bytes);
	}
	fputc('\n', out);
}
