/*
 * memory_stream.h: text printed into memory. Unlike with open_memstream nothing is lost without a word when memory runs out.
 */
#ifndef MEMORY_STREAM_H
#define MEMORY_STREAM_H

#include <stdio.h>

#include "bytes.h"

/*
 * What is written to the stream is added to *out, once it is flushed or closed; out->failed tells that memory ran out. *out stays
 * where it is as long as the stream is open, and is the caller's to free. NULL without memory.
 */
FILE *memory_stream_open(struct byte_buffer *out);

#endif
