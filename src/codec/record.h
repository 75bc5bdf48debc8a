/*
 * record.h: model <-> bytes: one material's record (format-spec/FORMAT.md, "Record").
 *
 *     record_encode   = model_fit -> sections -> decode -> fidelity of every layer -> head
 *     record_head_read -> record_decode -> model
 */
#ifndef CODEC_RECORD_H
#define CODEC_RECORD_H

#include "merl/origin.h"
#include "model/fidelity.h"
#include "model/model.h"

enum { RECORD_NAME_BYTES_MAX = 255, RECORD_SECTIONS_MAX = 64, SHA256_BYTES = 32 };

/* Largest record that a reader accepts, largest head, and the smallest of each. */
enum { RECORD_BYTES_MAX = 1 << 24, RECORD_HEAD_BYTES_MAX = 4096, RECORD_HEAD_BYTES_MIN = 208 + 32 + 1 + 4 };

/* What --budget may ask for. */
enum { RECORD_BUDGET_MIN = 1000, RECORD_BUDGET_MAX = 4000000 };

/* Every record begins with these bytes. */
#define RECORD_MAGIC \
	"\x8b" \
	"REC\r\n\x1a\n"
enum { RECORD_MAGIC_BYTES = 8, RECORD_VERSION = 2 };

/* In place of a codec version: no encoder made this record as it is, so no rebuild takes it for what it would make. */
enum { RECORD_LAYERS_DROPPED = 0 };

/* Types of section; 1..15 belong to the paper's profile, 16..31 to the spectral one, from 32 on to none. */
enum section_type {
	SECTION_MARGINALS = 1, /* scale and the three marginals of channel R */
	SECTION_PAIR_HD = 2,   /* c_hd */
	SECTION_PAIR_HPHI = 3, /* c_hphi */
	SECTION_SLICES = 4,    /* c_dphi|h */
	SECTION_CHANNEL = 4,   /* G's types are this much higher, B's twice as much */
	SECTION_FIELDS = 16,   /* what makes fields of levels, and a table of fields */
	SECTION_PLANES = 17,   /* bit planes of the levels, one section to a layer */
	SECTION_ORIGIN = 32    /* what kind of file the source was (record_origin.h); optional, in any profile */
};

enum section_flag {
	SECTION_REQUIRED = 1, /* a reader that does not know the type, codec or version must refuse the layer */
	SECTION_COLOUR = 2,   /* not needed for an achromatic load */
	SECTION_ONLY_R = 4    /* needed for channel R alone; for G and B twice and four times this */
};

/* The word of a head that says what became of a source's zeros: cells taken as holes, and the rule from this bit on. */
enum { HEAD_ZEROS_SHIFT = 28 };

/* The measured file a record was made from. */
struct record_source {
	uint64_t bytes;
	uint8_t sha256[SHA256_BYTES];
	uint64_t nonfinite_count; /* cells refused as NaN or infinite */
	uint32_t hole_count;      /* cells taken as not measured for the value they hold (merl/holes.h) */
	struct origin origin;     /* for the encoder; a head does not tell it (record_origin.h) */
};

struct record_layer {
	uint32_t bytes; /* of the record up to and including this layer, head included */
	struct fidelity fidelity;
};

struct record_section {
	uint16_t type, codec, version;
	uint16_t layer;  /* the first layer that needs it; 0: every load does */
	uint16_t flags;  /* section_flag; a reader ignores other bits */
	uint32_t offset; /* from the record's start */
	uint32_t bytes;
	uint32_t crc32;
	double error; /* what `list NAME` shows beside the section, or NaN where it has none */
};

/* All that is known of a record without reading its sections. */
struct record_head {
	char name[RECORD_NAME_BYTES_MAX + 1];
	enum profile profile;
	uint32_t codec_version; /* of the encoder, or RECORD_LAYERS_DROPPED */
	uint32_t head_bytes, record_bytes;
	struct lattice_dims dims;
	double horizon_limit;
	struct colour_fit colour[3];
	struct fit_options options;
	struct record_source source;
	uint32_t layer_count;
	struct record_layer layers[LAYERS_MAX];
	uint32_t section_count;
	struct record_section sections[RECORD_SECTIONS_MAX];
	uint32_t left_out; /* bit 0: c_hd, 1: c_hphi, 2: every c_dphi|h; these pairs are 1 in all channels and are not stored */
	uint32_t channels; /* bit c: channel c is wanted. All three when parsed; who loads one alone clears the others */
};

/* Bytes of a head, CRC included; a profile subtracts this from its budget before it spends the rest. */
uint32_t record_head_size(size_t name_bytes, uint32_t layer_count, uint32_t section_count);

/*
 * Fits and encodes one material: *record is malloc'ed (the caller frees it). The head, parsed
 * from the very bytes, is stored in *head when that is not NULL. A record never exceeds
 * options->budget_bytes; BP_ERROR_LIMIT names the least possible budget otherwise. With
 * options->max_error > 0 the budget does not count: the record is the smallest found whose log RMSE is at
 * most max_error; BP_ERROR_LIMIT says what was reached when 4,000,000 bytes do not suffice.
 */
bp_status record_encode(const struct lattice *lattice, const char *name, const struct record_source *source,
                        const struct fit_options *options, uint8_t **record, size_t *record_bytes, struct record_head *head,
                        bp_error *error);

/* Bytes from the record's start that tell head_bytes and record_bytes. */
enum { RECORD_PROBE_BYTES = 16 };

/* Checks the magic and the two sizes against their limits; nothing else is known yet. For finding records by scanning. */
bp_status record_probe(const uint8_t bytes[RECORD_PROBE_BYTES], uint32_t *head_bytes, uint32_t *record_bytes, bp_error *error);

/*
 * Checks and parses the first `count` bytes of a record (at least its head). Offsets in errors count
 * from the record's start. Profiles, sections and codecs that this reader does not know are no error here.
 */
bp_status record_head_read(const uint8_t *bytes, size_t count, struct record_head *head, bp_error *error);

struct byte_buffer;
/* Appends the head, all of which is filled, to an empty buffer. Of the options it takes budget, bound and effort. */
void record_head_write(const struct record_head *head, struct byte_buffer *out);

/* Delivers `count` bytes at `offset` from the record's start; offsets in its errors are the caller's to understand. */
typedef bp_status record_fetch_fn(void *user, uint64_t offset, uint8_t *bytes, size_t count, bp_error *error);

/* The fewest layers whose log RMSE of what can be seen is at most this; all where none satisfies it or 0 is asked for. */
uint32_t record_layers_for(const struct record_head *head, double max_log_rmse);

/* Checks the head and every section's checksum of a record that is in memory, `count` bytes. */
bp_status record_verify(const uint8_t *record, size_t count, struct record_head *head, bp_error *error);

/* The head, and what record_decode of these layers (1 or more) fetches: not what is optional and unknown to this program. */
uint32_t record_bytes_needed(const struct record_head *head, uint32_t layers);

/* Fetches and checks the sections of layers 0..layers-1 (0: all) and builds the model; the caller frees it with model_free. */
bp_status record_decode(const struct record_head *head, uint32_t layers, record_fetch_fn *fetch, void *user, struct model **out,
                        bp_error *error);
/* The same from a record that is in memory, all head->record_bytes of it. */
bp_status record_decode_whole(const struct record_head *head, uint32_t layers, const uint8_t *record, struct model **out,
                              bp_error *error);

/* Whether a build of this source with these options would make the record that has this head: codec version included. */
bool record_answers(const struct record_head *head, const struct record_source *source, const struct fit_options *options);

/*
 * Copies a record with layers 0..layers-1 only (0: all), its sections byte for byte: *out is malloc'ed. Where layers are
 * dropped its head says so in place of the codec version.
 * `count` must be the record's bytes; head and section checksums are checked.
 */
bp_status record_keep_layers(const uint8_t *record, size_t count, uint32_t layers, uint8_t **out, size_t *out_bytes,
                             bp_error *error);
/* Copies a record, all of it, under another name. A name that is not legal is BP_ERROR_ARGUMENT. */
bp_status record_rename(const uint8_t *record, size_t count, const char *name, uint8_t **out, size_t *out_bytes, bp_error *error);

#endif
