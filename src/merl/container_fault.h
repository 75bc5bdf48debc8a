/*
 * container_fault.h: what a file is that was taken for a tar or zip and is none, or not a whole one. Part of the tool.
 */
#ifndef MERL_CONTAINER_FAULT_H
#define MERL_CONTAINER_FAULT_H

/* What is wrong with the file as a whole, as far as its bytes tell, with the remedy; NULL: nothing that is known. */
const char *container_fault(int fd);

/* The same for a container that opened and has no entry: empty, or zeros to its end. */
const char *container_emptiness(int fd);

#endif
