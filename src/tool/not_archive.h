/*
 * not_archive.h: what lies at a path where an archive was wanted, for people who gave the wrong one of their files.
 */
#ifndef TOOL_NOT_ARCHIVE_H
#define TOOL_NOT_ARCHIVE_H

#include <stddef.h>

/*
 * What it is and what takes it, in text[bytes], to stand behind "not an archive: it does not begin as one" or "not a regular
 * file"; empty where nothing is known of it.
 */
void not_archive_tell(const char *path, char *text, size_t bytes);

#endif
