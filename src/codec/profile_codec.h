/*
 * profile_codec.h: what a profile has to offer to put its models into records; record.c does what all have in common.
 */
#ifndef CODEC_PROFILE_CODEC_H
#define CODEC_PROFILE_CODEC_H

#include "section.h"

/* What an encoder may spend. */
struct encode_request {
	const struct fit_options *options;
	size_t name_bytes; /* for record_head_size: of the name, and of what stands in the record beside the profile's own sections */
	uint32_t record_bytes_max; /* head included */
};

/* A section that has been fetched and whose checksum holds. */
struct section_bytes {
	const struct record_section *entry;
	uint8_t *bytes; /* entry->bytes of them */
};

struct profile_codec {
	uint32_t version; /* goes into the record's head; changes when the same input and options would give other bytes */
	/* Of a section's type, codec and version: does this reader understand them? Did only earlier ones? */
	bool (*reads)(const struct record_section *entry);
	bool (*retired)(const struct record_section *entry); /* NULL: there are none */
	/*
	 * Builds the profile's part of *model from the sections of the layers that are wanted, in file order; on failure
	 * record_decode frees what has been attached with model_free. Offsets in errors count from the section's start
	 * when *failed names its place in the list, which is UINT32_MAX before.
	 */
	bp_status (*decode)(const struct record_head *head, const struct section_bytes *sections, uint32_t count, struct model *model,
	                    uint32_t *failed, bp_error *error);
};

/*
 * Adds the model's sections to an empty list, sets *layer_count and *left_out. BP_ERROR_LIMIT, naming the least possible, when
 * head and sections cannot be as small as request->record_bytes_max. An encoder that knows what decoding would give may store it
 * in *decoded (NULL before), which saves measuring it the time; the caller frees it.
 */
typedef bp_status profile_encode_fn(const struct model *model, const struct encode_request *request,
                                    struct section_list *sections, uint32_t *layer_count, uint32_t *left_out,
                                    struct model **decoded, bp_error *error);

/* NULL for a profile that this program does not know. Two functions, so that a program that only reads links no encoder. */
const struct profile_codec *profile_codec_find(enum profile profile);
profile_encode_fn *profile_encoder_find(enum profile profile);

/* paper_sections.c */
extern const struct profile_codec PAPER_CODEC;
profile_encode_fn paper_encode;
/* spectral_sections.c */
extern const struct profile_codec SPECTRAL_CODEC;
profile_encode_fn spectral_encode;

#endif
