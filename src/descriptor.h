/* descriptor.h: reading and writing all that was asked for, whatever signals come in between. Internal. */
#ifndef DESCRIPTOR_H
#define DESCRIPTOR_H

#include <sys/types.h>

/*
 * From the place `at` of the file, or, at -1, from where the descriptor stands. How many of the bytes it was: fewer at the end of
 * a file or a pipe, where errno is 0, and after an error, which errno tells.
 */
size_t descriptor_read(int fd, void *bytes, size_t count, off_t at);

/* The same; fewer after an error only. */
size_t descriptor_write(int fd, const void *bytes, size_t count, off_t at);

#endif
