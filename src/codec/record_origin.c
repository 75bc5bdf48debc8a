#include "record_origin.h"

#include <math.h>
#include <string.h>

#include "error.h"

enum { NONE = 0, OBSERVER_CIE_1931 = 1, ILLUMINANT_D65 = 1, PRIMARIES_BT709 = 1, TABLE_LINE_BYTES = 32 };

uint32_t record_origin_bytes(const struct origin *origin)
{
	return origin->kind == ORIGIN_MERL ? 0 : TABLE_LINE_BYTES + ORIGIN_BYTES;
}

bool record_origin_add(struct section_list *list, const struct origin *origin)
{
	if (origin->kind == ORIGIN_MERL)
		return true;
	struct byte_buffer *last = section_add(list, SECTION_ORIGIN, ORIGIN_CODEC, ORIGIN_VERSION, 0, 0, (double)NAN);
	if (!last)
		return false;
	/* from the end to the front: sections stand in the order of their layers */
	const size_t before = list->count - 1;
	const struct record_section entry = list->entry[before];
	const struct byte_buffer empty = *last;
	memmove(list->entry + 1, list->entry, before * sizeof *list->entry);
	memmove(list->bytes + 1, list->bytes, before * sizeof *list->bytes);
	list->entry[0] = entry;
	list->bytes[0] = empty;
	struct byte_buffer *out = &list->bytes[0];
	const bool spectra = origin->kind == ORIGIN_RGL_SPECTRA;
	write_u8(out, (uint8_t)origin->kind);
	write_u8(out, spectra ? OBSERVER_CIE_1931 : NONE);
	write_u8(out, spectra ? ILLUMINANT_D65 : NONE);
	write_u8(out, spectra ? PRIMARIES_BT709 : NONE);
	write_u32(out, origin->wavelengths);
	write_f32(out, (float)origin->first_nm);
	write_f32(out, (float)origin->last_nm);
	write_u32(out, (uint32_t)origin->compared);
	write_f32(out, (float)origin->median);
	write_f32(out, (float)origin->percentile95);
	return !out->failed;
}

const struct record_section *record_origin_find(const struct record_head *head)
{
	for (uint32_t i = 0; i < head->section_count; i++) {
		const struct record_section *entry = &head->sections[i];
		if (entry->type == SECTION_ORIGIN && entry->codec == ORIGIN_CODEC && entry->version == ORIGIN_VERSION &&
		    entry->bytes == ORIGIN_BYTES)
			return entry;
	}
	return NULL;
}

bool record_origin_is_current(const struct record_head *head)
{
	for (uint32_t i = 0; i < head->section_count; i++)
		if (head->sections[i].type == SECTION_ORIGIN &&
		    (head->sections[i].codec != ORIGIN_CODEC || head->sections[i].version != ORIGIN_VERSION))
			return false;
	return true;
}

bp_status record_origin_parse(const uint8_t bytes[ORIGIN_BYTES], struct origin *out, bp_error *error)
{
	struct byte_reader in = byte_reader_over(bytes, ORIGIN_BYTES);
	struct origin origin = {0};
	const unsigned kind = read_u8(&in);
	read_span(&in, 3); /* follow from the kind */
	origin.wavelengths = read_u32(&in);
	origin.first_nm = (double)read_f32(&in);
	origin.last_nm = (double)read_f32(&in);
	origin.compared = read_u32(&in);
	origin.median = (double)read_f32(&in);
	origin.percentile95 = (double)read_f32(&in);
	if (kind < ORIGIN_RGL_RGB || kind > ORIGIN_TWO_HALVES)
		return error_set(error, BP_ERROR_CORRUPT, 0, "origin: kind %u is not known", kind);
	if (!(origin.first_nm >= 0 && origin.last_nm >= origin.first_nm && origin.last_nm < 1e6) ||
	    !(origin.median >= 0 && origin.median <= 2 && origin.percentile95 >= 0 && origin.percentile95 <= 2))
		return error_set(error, BP_ERROR_CORRUPT, 0, "origin: a figure is out of range");
	origin.kind = (enum origin_kind)kind;
	*out = origin;
	return BP_OK;
}
