/*
 * head.h: the `#` lines on top of a benchmark's table: machine, compiler, commit and command.
 */
#ifndef BENCH_HEAD_H
#define BENCH_HEAD_H

#include <stdio.h>

/* The commit is taken from the environment (BENCH_COMMIT): the program does not know it. */
void head_print(FILE *out, int argc, char **argv);

#endif
