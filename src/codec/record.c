#include "record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../error.h"
#include "../model/fast_math.h"
#include "../model/fidelity.h"
#include "../stage.h"
#include "name.h"
#include "profile_codec.h"

/* ---- decoding ---- */

static bool kind_known(const struct profile_codec *codec, const struct record_section *entry)
{
	for (uint32_t i = 0; i < codec->kind_count; i++)
		if (codec->kinds[i].type == entry->type && codec->kinds[i].codec == entry->codec && codec->kinds[i].version == entry->version)
			return true;
	return false;
}

static bp_status section_fetch(const struct record_section *entry, record_fetch_fn *fetch, void *user, uint8_t **out,
                               bp_error *error)
{
	uint8_t *bytes = malloc(entry->bytes);
	bp_status status;
	if (!bytes)
		return error_memory(error, entry->bytes);
	status = fetch(user, entry->offset, bytes, entry->bytes, error);
	if (!status && bytes_crc32(bytes, entry->bytes) != entry->crc32)
		status = error_set(error, BP_ERROR_CHECKSUM, entry->offset, "the checksum of a section of type %u differs", entry->type);
	if (status) {
		free(bytes);
		return status;
	}
	*out = bytes;
	return BP_OK;
}

/* Fetches what the layers need: *count sections, whose bytes the caller frees also after a failure. */
static bp_status sections_fetch(const struct record_head *head, const struct profile_codec *codec, uint32_t layers,
                                record_fetch_fn *fetch, void *user, struct section_bytes *sections, uint8_t **held,
                                uint32_t *count, bp_error *error)
{
	for (uint32_t i = 0; i < head->section_count && head->sections[i].layer < layers; i++) {
		const struct record_section *entry = &head->sections[i];
		bp_status status;
		if (!kind_known(codec, entry)) {
			if (entry->flags & SECTION_REQUIRED)
				return error_set(error, BP_ERROR_UNSUPPORTED, entry->offset,
				                 "%s: a section of type %u, codec %u, version %u is required; a newer program is needed", head->name,
				                 entry->type, entry->codec, entry->version);
			continue;
		}
		status = section_fetch(entry, fetch, user, &held[*count], error);
		if (status)
			return status;
		sections[*count] = (struct section_bytes){ .entry = entry, .bytes = held[*count] };
		++*count;
	}
	return BP_OK;
}

bp_status record_decode(const struct record_head *head, uint32_t layers, record_fetch_fn *fetch, void *user,
                        struct model **out, bp_error *error)
{
	const struct profile_codec *codec = profile_codec_find(head->profile);
	struct section_bytes sections[RECORD_SECTIONS_MAX];
	uint8_t *held[RECORD_SECTIONS_MAX];
	uint32_t count = 0, failed = UINT32_MAX;
	struct model *model;
	bp_status status;

	if (!codec)
		return error_set(error, BP_ERROR_UNSUPPORTED, 18, "%s: profile %u is not known; a newer program is needed", head->name,
		                 (unsigned)head->profile);
	if (layers == 0 || layers > head->layer_count)
		layers = head->layer_count;
	model = calloc(1, sizeof *model);
	if (!model)
		return error_memory(error, sizeof *model);
	model->profile = head->profile;
	model->dims = head->dims;
	model->horizon_limit = head->horizon_limit;
	memcpy(model->colour, head->colour, sizeof model->colour);
	model->layer_count = layers;
	status = sections_fetch(head, codec, layers, fetch, user, sections, held, &count, error);
	if (!status) {
		status = codec->decode(head, sections, count, model, &failed, error);
		if (status && failed < count && error && error->offset != BP_NO_OFFSET)
			error->offset += sections[failed].entry->offset;
	}
	while (count > 0)
		free(held[--count]);
	if (status)
		model_free(model);
	else
		*out = model;
	return status;
}

/* ---- packing ---- */

static bp_status memory_fetch(void *user, uint64_t offset, uint8_t *bytes, size_t count, bp_error *error)
{
	const uint8_t *record = user;
	(void)error;
	memcpy(bytes, record + offset, count);
	return BP_OK;
}

/* Layers that are measured in one pass over the measured table: what the previews of a usual budget and the whole are. */
enum { MEASURED_AT_ONCE = 3, MEASURED_CELLS_MAX = 1 << 22 };

/* Expands layer `l` of `decoded`, or, where there is none, decodes it from the record's own bytes. */
static bp_status layer_expand(const struct record_head *head, const uint8_t *record, const struct model *decoded, uint32_t l,
                              struct expansion *table, bp_error *error)
{
	struct model *model = NULL;
	bp_status status = BP_OK;
	if (!decoded)
		status = record_decode(head, l + 1, memory_fetch, (void *)(uintptr_t)record, &model, error);
	if (!status)
		status = model_expand(decoded ? decoded : model, l + 1, table, error);
	model_free(model);
	return status;
}

/* Fills in the figures of every layer. */
static bp_status layers_measure(struct record_head *head, const uint8_t *record, const struct lattice *lattice,
                                const struct model *decoded, bp_error *error)
{
	/* A large lattice's layers one by one: their tables would take more memory than the pass is worth. */
	const uint32_t at_once = lattice_cells(head->dims) <= MEASURED_CELLS_MAX ? MEASURED_AT_ONCE : 1;
	struct expansion tables[MEASURED_AT_ONCE] = { 0 };
	struct fidelity figures[MEASURED_AT_ONCE];
	bp_status status = BP_OK;

	for (uint32_t l = 0; !status && l < head->layer_count; l += at_once) {
		uint32_t count = 0;
		while (!status && count < at_once && l + count < head->layer_count) {
			if (!tables[count].block)
				status = expansion_alloc(head->dims, &tables[count], error);
			if (!status)
				status = layer_expand(head, record, decoded, l + count, &tables[count], error);
			count++;
		}
		if (!status)
			status = fidelity_measure_all(lattice, tables, count, figures, error);
		for (uint32_t k = 0; !status && k < count; k++)
			head->layers[l + k].fidelity = figures[k];
	}
	for (int k = 0; k < MEASURED_AT_ONCE; k++)
		expansion_free(&tables[k]);
	return status;
}

static void head_fill(struct record_head *head, const struct model *model, const char *name, const struct record_source *source,
                      const struct fit_options *options, uint32_t codec_version)
{
	memset(head, 0, sizeof *head);
	memcpy(head->name, name, strlen(name));
	head->profile = model->profile;
	head->codec_version = codec_version;
	head->dims = model->dims;
	head->horizon_limit = model->horizon_limit;
	memcpy(head->colour, model->colour, sizeof head->colour);
	head->options = *options;
	head->source = *source;
}

/* What stays the same while records of several sizes are tried. */
struct packing {
	const struct lattice *lattice;
	const struct profile_codec *codec;
	const struct model *model;
	struct encode_request request;
	struct record_head head; /* the constant parts filled */
};

struct packed {
	struct record_head head;
	uint8_t *record; /* malloc'ed */
	size_t bytes;
};

/* One record of at most record_bytes_max, its layers measured. */
static bp_status record_build(const struct packing *packing, uint32_t record_bytes_max, struct packed *out, bp_error *error)
{
	struct packed packed = { .head = packing->head };
	struct encode_request request = packing->request;
	struct section_list sections = { 0 };
	struct model *decoded = NULL;
	bp_status status;

	request.record_bytes_max = record_bytes_max;
	stage_enter(STAGE_CODE);
	status = packing->codec->encode(packing->model, &request, &sections, &packed.head.layer_count, &packed.head.left_out, &decoded,
	                                error);
	if (status)
		goto out;
	/* Once to have the bytes that are decoded, once more with what was measured on them. */
	status = record_write(&packed.head, &sections, &packed.record, &packed.bytes, error);
	stage_enter(STAGE_MEASURE);
	if (!status)
		status = layers_measure(&packed.head, packed.record, packing->lattice, decoded, error);
	free(packed.record);
	packed.record = NULL;
	stage_enter(STAGE_CODE);
	if (!status)
		status = record_write(&packed.head, &sections, &packed.record, &packed.bytes, error);
	if (!status && packed.bytes > record_bytes_max) {
		free(packed.record);
		status = error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "the record takes %zu bytes, the budget is %u", packed.bytes,
		                   record_bytes_max);
	}
	if (!status)
		*out = packed;
out:
	section_list_free(&sections);
	model_free(decoded);
	stage_enter(STAGE_REST);
	return status;
}

static double last_error(const struct packed *packed)
{
	return packed->head.layers[packed->head.layer_count - 1].fidelity.log_rmse;
}

enum { SEARCH_START = 60400 }; /* bytes */

/* What a search for a size knows: sizes that do not satisfy end at `low`, the smallest that does is `high`, 0 for none. */
struct bracket {
	uint32_t low, high;
	double bytes[2], error[2]; /* the last two that were measured, the latest first; 0 for none */
};

/*
 * Where to try next: errors fall about as bytes^-k, with k from the last two sizes, 0.85 before. A little more is asked than needed.
 * Where that would not shrink the bracket, its middle.
 */
static uint32_t bracket_next(const struct bracket *b, double max_error)
{
	double k = 0.85;
	const double low = b->low, high = b->high ? b->high : RECORD_BUDGET_MAX;

	if (b->error[0] > 0 && b->error[1] > 0 && b->bytes[0] != b->bytes[1])
		k = fmin(fmax(fast_log2(b->error[1] / b->error[0]) / fast_log2(b->bytes[0] / b->bytes[1]), 0.3), 3);
	double next = b->error[0] > 0 ? 1.003 * b->bytes[0] * fast_exp2(fast_log2(b->error[0] / max_error) / k) : sqrt(low * high);
	if (!b->high)
		next = fmax(next, 1.1 * low);
	else if (next <= low * 1.002 || next >= high * 0.998)
		next = next <= low * 1.002 && low > high * 0.9 ? low * 1.005 : sqrt(low * high);
	return (uint32_t)fmin(fmax(next, low + 1), b->high ? high - 1 : high);
}

/*
 * The smallest record whose error is at most max_error, to 1 % of its size: the error does not fall with every byte, so a smaller
 * record may exist that this does not find.
 */
static bp_status record_search(const struct packing *packing, double max_error, struct packed *best, bp_error *error)
{
	struct bracket bracket = { .low = RECORD_BUDGET_MIN - 1 };
	uint32_t size = SEARCH_START;

	best->record = NULL;
	while (!bracket.high || (bracket.high > bracket.low && bracket.high - bracket.low > bracket.high / 100 + 1)) {
		struct packed trial = { .record = NULL };
		bp_status status = record_build(packing, size, &trial, error);
		if (status && (status != BP_ERROR_LIMIT || size == RECORD_BUDGET_MAX)) {
			free(best->record);
			best->record = NULL;
			return status;
		}
		const double reached = status ? INFINITY : last_error(&trial);
		if (reached > max_error && size == RECORD_BUDGET_MAX) {
			status = error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET, "an error of %g cannot be met: the least is %g, in %zu bytes",
			                   max_error, reached, trial.bytes);
			free(trial.record);
			return status;
		}
		if (!status) {
			bracket.bytes[1] = bracket.bytes[0];
			bracket.error[1] = bracket.error[0];
			bracket.bytes[0] = (double)trial.bytes;
			bracket.error[0] = reached;
		}
		if (reached > max_error) {
			free(trial.record);
			bracket.low = size;
		} else {
			free(best->record);
			*best = trial;
			bracket.high = (uint32_t)trial.bytes;
		}
		size = bracket_next(&bracket, max_error);
	}
	return BP_OK;
}

bp_status record_pack(const struct lattice *lattice, const char *name, const struct record_source *source,
                      const struct fit_options *options, uint8_t **record, size_t *record_bytes, struct record_head *head,
                      bp_error *error)
{
	struct packing packing = { .lattice = lattice, .codec = profile_codec_find(options->profile) };
	struct packed packed = { .record = NULL };
	struct model *model = NULL;
	size_t name_bytes = strlen(name);
	const char *fault = name_fault(name, name_bytes);
	bp_status status;

	if (!packing.codec)
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "profile %d is not known", (int)options->profile);
	if (fault)
		return error_set(error, BP_ERROR_ARGUMENT, BP_NO_OFFSET, "\"%.255s\" is not a legal name: %s", name, fault);
	status = model_fit(lattice, options, &model, error);
	if (status)
		return status;
	packing.model = model;
	packing.request = (struct encode_request){ .options = options, .name_bytes = name_bytes };
	head_fill(&packing.head, model, name, source, options, packing.codec->version);
	if (options->max_error > 0 && !packing.codec->meets_max_error)
		status = record_search(&packing, options->max_error, &packed, error);
	else
		status = record_build(&packing, options->max_error > 0 ? RECORD_BUDGET_MAX : options->budget_bytes, &packed, error);
	if (!status && head)
		status = record_head_parse(packed.record, packed.bytes, head, error);
	model_free(model);
	if (status) {
		free(packed.record);
		return status;
	}
	*record = packed.record;
	*record_bytes = packed.bytes;
	return BP_OK;
}
