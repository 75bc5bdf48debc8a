/*
 * output_check.h: what a command may write over, looked at before any work.
 *
 * A file that is there is replaced only when this program made it, as its first bytes tell, and when it is none of the inputs;
 * with --force also otherwise. It must be possible to make: the folder is there and lets a file be created, a link leads to a
 * file. Links are followed, here and by what writes (output_file.h).
 */
#ifndef TOOL_OUTPUT_CHECK_H
#define TOOL_OUTPUT_CHECK_H

#include <stdbool.h>
#include <stddef.h>

#include "brdfpack.h"

enum output_kind { OUTPUT_KIND_ARCHIVE, OUTPUT_KIND_PICTURE, OUTPUT_KIND_PAGE };

/* What a page of `report` begins with. */
#define PAGE_MARK "<!doctype html>\n<!-- made by brdfpack -->\n"

/* True when the path may be written; says why not. inputs[count] are the paths that are read; NULL among them stands for none. */
bool output_check(const char *path, enum output_kind kind, bool force, const char *const *inputs, size_t count);

/* The same, with the reason in *error instead of a message. */
bp_status output_check_path(const char *path, enum output_kind kind, bool force, const char *const *inputs, size_t count,
                            bp_error *error);

/* For commands that learn later what they read: BP_ERROR_ARGUMENT when `input` is the same file as `path` (device and inode). */
bp_status output_check_input(const char *path, const char *input, bp_error *error);

/* Reports that something stands at `path` that this command must not replace, with the way out. */
void output_taken_report(const char *path);

#endif
