/* base64.h: bytes as text (RFC 4648, section 4), for pictures and archives inside SVG and HTML. */
#ifndef RENDER_BASE64_H
#define RENDER_BASE64_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

void base64_write(FILE *out, const uint8_t *bytes, size_t count);

#endif
