/* zlib.h: of zlib the library uses the CRC-32 alone; WebAssembly has no zlib, so zlib.c stands in for it. */
#ifndef VIEWER_ZLIB_H
#define VIEWER_ZLIB_H

#include <stddef.h>

typedef unsigned char Bytef;
typedef unsigned int uInt;
typedef unsigned long uLong;

uLong crc32(uLong crc, const Bytef *bytes, uInt count);
uLong crc32_z(uLong crc, const Bytef *bytes, size_t count);

#endif
