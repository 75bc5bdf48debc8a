/* paper_sections.c: the paper's model as sections (FORMAT.md, "Profile 1"): four of every channel. */
#include <math.h>
#include <stdlib.h>

#include "error.h"
#include "model/paper/paper.h"
#include "codec/profile_codec.h"
#include "paper_fields.h"

enum { CODEC_RAW = 0, CODEC_SPARSE_OLD = 1, CODEC_SPARSE = 2 };
enum { LEFT_OUT_HD = 1, LEFT_OUT_HPHI = 2, LEFT_OUT_SLICES = 4, LEFT_OUT_ALL = 7 };

/* The sections of a channel, in the order of their types. */
static const struct {
	uint16_t type, codec, version, layer;
	enum paper_field field;
	uint32_t left_out;
} PARTS[] = {
	{SECTION_MARGINALS, CODEC_RAW, 2, PAPER_LAYER_MARGINALS, 0, 0},
	{SECTION_PAIR_HD, CODEC_SPARSE, 1, PAPER_LAYER_PAIRS, PAPER_HD, LEFT_OUT_HD},
	{SECTION_PAIR_HPHI, CODEC_SPARSE, 1, PAPER_LAYER_PAIRS, PAPER_HPHI, LEFT_OUT_HPHI},
	{SECTION_SLICES, CODEC_SPARSE, 1, PAPER_LAYER_SLICES, PAPER_SLICE, LEFT_OUT_SLICES},
};
enum { PART_COUNT = sizeof PARTS / sizeof *PARTS };

static bool paper_reads(const struct record_section *entry)
{
	const uint32_t part = (entry->type - 1u) % SECTION_CHANNEL;
	return entry->type >= 1 && entry->type <= 3 * SECTION_CHANNEL && entry->codec == PARTS[part].codec &&
	       entry->version == PARTS[part].version;
}

/* Codec versions up to 3 had one achromatic density. */
static bool paper_retired(const struct record_section *entry)
{
	return entry->type >= 1 && entry->type <= SECTION_CHANNEL && entry->version == 1 &&
	       entry->codec == (entry->type == SECTION_MARGINALS ? CODEC_RAW : CODEC_SPARSE_OLD);
}

static const struct sparse_field *fields_of(const struct paper_channel *channel, enum paper_field kind, uint32_t *count)
{
	*count = kind == PAPER_SLICE ? channel->slice_count : 1;
	return kind == PAPER_SLICE ? channel->slice : kind == PAPER_HD ? &channel->hd : &channel->hphi;
}

/* ---- encoding ---- */

static bool any_there(const struct sparse_field *fields, uint32_t count)
{
	for (uint32_t i = 0; i < count; i++)
		if (fields[i].count)
			return true;
	return false;
}

static struct byte_buffer *part_add(struct section_list *sections, int part, int c)
{
	return section_add(sections, (enum section_type)(PARTS[part].type + c * SECTION_CHANNEL), PARTS[part].codec,
	                   PARTS[part].version, PARTS[part].layer, SECTION_REQUIRED | (uint32_t)SECTION_ONLY_R << c, NAN);
}

/* All sections of the model, coarser by `shift` (fields_coarsen); sections come in the order of their layers. */
static bp_status model_write(const struct paper_model *paper, uint32_t shift, struct section_list *sections,
                             uint32_t *layer_count, uint32_t *left_out, bp_error *error)
{
	bp_status status = BP_OK;

	*layer_count = 1;
	*left_out = LEFT_OUT_ALL;
	for (int part = 0; !status && part < PART_COUNT; part++)
		for (int c = 0; !status && c < 3; c++) {
			const struct paper_channel *channel = &paper->channel[c];
			struct sparse_field *coarse = NULL;
			uint32_t count;

			if (part == 0) {
				marginals_write(paper->dims, channel, part_add(sections, part, c));
				continue;
			}
			const struct sparse_field *fields = fields_of(channel, PARTS[part].field, &count);
			status = fields_coarsen(PARTS[part].field, fields, count, shift, &coarse, error);
			if (!status && any_there(coarse, count)) {
				status = fields_write(paper->dims, PARTS[part].field, coarse, count, part_add(sections, part, c), error);
				*layer_count = PARTS[part].layer + 1u;
				*left_out &= ~PARTS[part].left_out;
			}
			sparse_fields_free(coarse, count);
		}
	return status;
}

static uint64_t record_bytes(const struct section_list *sections, uint32_t layer_count, size_t name_bytes)
{
	uint64_t bytes = record_head_size(name_bytes, layer_count, sections->count);
	for (uint32_t i = 0; i < sections->count; i++)
		bytes += sections->bytes[i].count;
	return bytes;
}

/* What was tried: the coarsest that did not fit, and the finest that did. */
struct bracket {
	uint32_t above, below; /* shifts, in units of SHIFT_GRAIN */
	uint64_t above_bytes, below_bytes;
};

enum { SHIFT_GRAIN = 16, SHIFT_MOST = SPARSE_SHIFT_MAX / SHIFT_GRAIN };

/* Where bytes would meet the budget if they fell evenly between; a little coarser, so that the bracket closes from both sides. */
static uint32_t bracket_next(const struct bracket *b, uint64_t budget)
{
	const double share = (double)(b->above_bytes - budget) / (double)(b->above_bytes - b->below_bytes);
	const uint32_t next = b->above + (uint32_t)((b->below - b->above) * share) + 1;
	return next > b->above && next < b->below ? next : (b->above + b->below) / 2;
}

bp_status paper_encode(const struct model *model, const struct encode_request *request, struct section_list *sections,
                       uint32_t *layer_count, uint32_t *left_out, struct model **decoded, bp_error *error)
{
	const uint64_t budget = request->record_bytes_max;
	struct bracket bracket = {.above = 0, .below = SHIFT_MOST};
	(void)decoded;

	for (uint32_t shift = 0, next;; shift = next) { /* the finest, the coarsest, and what lies between */
		section_list_free(sections);
		const bp_status status = model_write(model->paper, shift * SHIFT_GRAIN, sections, layer_count, left_out, error);
		if (status)
			return status;
		const uint64_t bytes = record_bytes(sections, *layer_count, request->name_bytes);
		if (bytes > budget && shift == SHIFT_MOST)
			return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET,
			                 "the budget of %u bytes is too small: this record takes at least %llu", request->record_bytes_max,
			                 (unsigned long long)bytes);
		if (bytes > budget) {
			bracket.above = shift;
			bracket.above_bytes = bytes;
		} else {
			bracket.below = shift;
			bracket.below_bytes = bytes;
			if (shift == 0 || (shift < SHIFT_MOST && bytes >= budget - budget / 500))
				return BP_OK; /* what is left would not buy another grain worth its time */
		}
		next = shift == 0 ? SHIFT_MOST : bracket.below - bracket.above > 1 ? bracket_next(&bracket, budget) : bracket.below;
		if (next == shift)
			return BP_OK;
	}
}

/* ---- decoding ---- */

static bp_status section_read(const struct section_bytes *section, struct model *model, bp_error *error)
{
	const uint32_t type = section->entry->type - 1u, c = type / SECTION_CHANNEL, part = type % SECTION_CHANNEL;
	struct paper_channel *channel = &model->paper->channel[c];
	struct byte_reader in = byte_reader_over(section->bytes, section->entry->bytes);

	if (part == 0)
		return marginals_read(&in, model->dims, model->colour[c].specular, channel, error);
	const enum paper_field kind = PARTS[part].field;
	if (kind != PAPER_SLICE)
		return fields_read(&in, model->dims, kind, kind == PAPER_HD ? &channel->hd : &channel->hphi, 1, error);
	channel->slice_count = paper_shared_from(model->dims.theta_h) + 1;
	channel->slice = calloc(channel->slice_count, sizeof *channel->slice);
	if (!channel->slice)
		return error_memory(error, channel->slice_count * sizeof *channel->slice);
	return fields_read(&in, model->dims, kind, channel->slice, channel->slice_count, error);
}

static bp_status paper_decode(const struct record_head *head, const struct section_bytes *sections, uint32_t count,
                              struct model *model, uint32_t *failed, bp_error *error)
{
	uint32_t seen = 0;
	bp_status status = BP_OK;

	model->paper = calloc(1, sizeof *model->paper);
	if (!model->paper)
		return error_memory(error, sizeof *model->paper);
	model->paper->dims = model->dims;
	for (uint32_t i = 0; !status && i < count; i++) {
		uint32_t bit = 1u << sections[i].entry->type;
		*failed = i;
		if (seen & bit)
			return error_set(error, BP_ERROR_CORRUPT, 0, "a second section of type %u", sections[i].entry->type);
		seen |= bit;
		status = section_read(&sections[i], model, error);
	}
	if (status)
		return status;
	*failed = UINT32_MAX;
	for (int c = 0; c < 3; c++)
		if (head->channels >> c & 1 && !(seen >> (SECTION_MARGINALS + c * SECTION_CHANNEL) & 1))
			return error_set(error, BP_ERROR_CORRUPT, 0, "the section of the marginals of channel %d is missing", c);
	return BP_OK;
}

const struct profile_codec PAPER_CODEC = {.version = 4, .reads = paper_reads, .retired = paper_retired, .decode = paper_decode};
