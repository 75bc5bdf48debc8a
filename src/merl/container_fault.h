/*
 * container_fault.h: what a file is that was taken for a tar or zip and is none, or not a whole one. Part of the tool.
 */
#ifndef MERL_CONTAINER_FAULT_H
#define MERL_CONTAINER_FAULT_H

#include <stdint.h>

/* What is wrong with the file as a whole, as far as its bytes tell, with the remedy; NULL: nothing that is known. */
const char *container_fault(int fd);

/* The same for a container that ends at this byte of the file: what stands behind it is not read; zeros there are no loss. */
const char *container_rest(int fd, int64_t end);

#endif
