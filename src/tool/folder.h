/*
 * folder.h: output folders.
 */
#ifndef TOOL_FOLDER_H
#define TOOL_FOLDER_H

#include <stdbool.h>

/* Creates the folder and those above it; true when it is there afterwards. Says why not. */
bool folder_create(const char *path);

/* "FOLDER/NAME.SUFFIX", malloc'ed; NULL when memory ran out. */
char *folder_path(const char *folder, const char *name, const char *suffix);

#endif
