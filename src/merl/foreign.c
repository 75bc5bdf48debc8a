#include "foreign.h"

#include <stdbool.h>
#include <string.h>

/* By their first bytes. */
static const struct {
	const char *bytes;
	size_t count;
	const char *kind;
} BEGINNINGS[] = {
	{"SCATFUN", 7, "a BSDF table of Fourier coefficients (pbrt-v3, Mitsuba 0.6)"},
	{"NVIDIA ARC MBSDF", 16, "a measured BSDF for MDL (NVIDIA, .mbsdf)"},
	{"\x8b"
     "BPK\r\n",
     6, "an archive of brdfpack; `brdfpack merge` joins archives"},
	{"\x89PNG", 4, "a picture (PNG)"},
	{"\xff\xd8\xff", 3, "a picture (JPEG)"},
	{"\x76\x2f\x31\x01", 4, "a picture (OpenEXR)"},
	{"\x89HDF", 4, "an HDF5 file"},
	{"\x93NUMPY", 6, "a NumPy array"},
	{"%PDF", 4, "a PDF document"},
	{"version https://git-lfs", 23, "a pointer to a file in Git LFS, not the file; fetch it by `git lfs pull`"},
};

/* Words that tell a text's kind, anywhere in its beginning. */
static const struct {
	const char *word, *kind;
} WORDS[] = {
	{"SpectralContent", "a BSDF of Zemax OpticStudio (text)"},
	{"ScatterType", "a BSDF of Zemax OpticStudio (text)"},
	{"SampleRotation", "a BSDF of Zemax OpticStudio (text)"},
	{"WindowElement", "a window's BSDF as XML (LBNL, Radiance)"},
	{"<html", "a web page"},
	{"<!DOCTYPE html", "a web page"},
	{"<?xml", "XML"},
};

static bool is_text(const uint8_t *head, size_t count)
{
	for (size_t n = 0; n < count; n++)
		if (head[n] < 0x20 && !(head[n] >= '\t' && head[n] <= '\r'))
			return false;
	return count > 0;
}

const char *foreign_kind(const uint8_t *head, size_t count)
{
	char text[FOREIGN_HEAD_BYTES + 1];
	for (size_t n = 0; n < sizeof BEGINNINGS / sizeof *BEGINNINGS; n++)
		if (count >= BEGINNINGS[n].count && memcmp(head, BEGINNINGS[n].bytes, BEGINNINGS[n].count) == 0)
			return BEGINNINGS[n].kind;
	if (count > FOREIGN_HEAD_BYTES)
		count = FOREIGN_HEAD_BYTES;
	if (!is_text(head, count))
		return NULL;
	memcpy(text, head, count);
	text[count] = '\0';
	for (size_t n = 0; n < sizeof WORDS / sizeof *WORDS; n++)
		if (strstr(text, WORDS[n].word))
			return WORDS[n].kind;
	return "text";
}
