#include "record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "model/fidelity.h"
#include "model/math/fast_math.h"
#include "stage.h"
#include "name.h"
#include "profile_codec.h"
#include "record_origin.h"

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
	head->options.watch = NULL;
	head->source = *source;
}

/* ---- the errors of a record's layers, which are measured on what its own bytes decode to ---- */

/* Layers that are measured in one pass over the measured table: what the previews of a usual budget and the whole are. */
enum { MEASURED_AT_ONCE = 3, MEASURED_CELLS_MAX = 1 << 22 };

/* Expands layer `l` of `decoded`, or, where there is none, decodes it from the record's own bytes. */
static bp_status layer_expand(const struct record_head *head, const uint8_t *record, const struct model *decoded, uint32_t l,
                              struct expansion *table, bp_error *error)
{
	struct model *model = NULL;
	bp_status status = BP_OK;
	if (!decoded)
		status = record_decode_whole(head, l + 1, record, &model, error);
	if (!status)
		status = model_expand(decoded ? decoded : model, l + 1, table, error);
	model_free(model);
	return status;
}

/* Fills in the figures of every layer. */
static bp_status layers_measure(struct record_head *head, const uint8_t *record, const struct lattice *lattice,
                                const struct model *decoded, const struct watch *watch, bp_error *error)
{
	/* A large lattice's layers one by one: their tables would take more memory than the pass is worth. */
	const uint32_t at_once = lattice_cells(head->dims) <= MEASURED_CELLS_MAX ? MEASURED_AT_ONCE : 1;
	struct expansion tables[MEASURED_AT_ONCE] = {0};
	struct fidelity figures[MEASURED_AT_ONCE];
	bp_status status = BP_OK;

	for (uint32_t l = 0; !status && l < head->layer_count; l += at_once) {
		uint32_t count = 0;
		while (!status && count < at_once && l + count < head->layer_count) {
			status = watch_tell(watch, 0.8 + 0.2 * (l + count) / head->layer_count, error);
			if (!status)
				status = layer_expand(head, record, decoded, l + count, &tables[count], error);
			count++;
		}
		if (!status)
			status = fidelity_measure(lattice, tables, count, figures, error);
		for (uint32_t k = 0; !status && k < count; k++)
			head->layers[l + k].fidelity = figures[k];
	}
	for (int k = 0; k < MEASURED_AT_ONCE; k++)
		expansion_free(&tables[k]);
	return status;
}

/*
 * Head and sections -> record (sections_join), with the figures of every layer against the lattice; *record is malloc'ed.
 * `decoded`: the model that they decode to, where it is at hand, or NULL. `watch` is told before every layer.
 */
static bp_status record_measure(struct record_head *head, const struct section_list *sections, const struct lattice *lattice,
                                const struct model *decoded, const struct watch *watch, uint8_t **record, size_t *record_bytes,
                                bp_error *error)
{
	uint8_t *unmeasured = NULL;
	/* Once to have the bytes that are decoded, once more with what was measured on them. */
	bp_status status = sections_join(head, sections, &unmeasured, record_bytes, error);
	const enum stage before = stage_enter(STAGE_MEASURE);
	if (!status)
		status = layers_measure(head, unmeasured, lattice, decoded, watch, error);
	free(unmeasured);
	stage_enter(before);
	return status ? status : sections_join(head, sections, record, record_bytes, error);
}

/* ---- one record ---- */

/* What stays the same while records of several sizes are tried. */
struct packing {
	const struct lattice *lattice;
	profile_encode_fn *encode;
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
	struct packed packed = {.head = packing->head};
	struct encode_request request = packing->request;
	struct section_list sections = {0};
	struct model *decoded = NULL;

	request.record_bytes_max = record_bytes_max;
	stage_enter(STAGE_CODE);
	bp_status status = watch_tell(request.options->watch, 0.6, error);
	if (status)
		goto out;
	status =
		packing->encode(packing->model, &request, &sections, &packed.head.layer_count, &packed.head.left_out, &decoded, error);
	if (status)
		goto out;
	if (!record_origin_add(&sections, &packing->head.source.origin)) {
		status = error_memory(error, ORIGIN_BYTES);
		goto out;
	}
	status = record_measure(&packed.head, &sections, packing->lattice, decoded, request.options->watch, &packed.record,
	                        &packed.bytes, error);
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

/* ---- the smallest record within an error ---- */

/* What a search for a size knows: sizes that do not satisfy end at `low`, the smallest that does is `high`, 0 for none. */
struct bracket {
	uint32_t low, high;
	double bytes[2], error[2]; /* the last two that were measured, the latest first; 0 for none */
};

/*
 * Where to try next: errors fall about as bytes^-k, with k from the last two sizes, 0.85 before. A little more is asked than
 * needed. Where that would not shrink the bracket, its middle.
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
 * record may exist that this does not find. best->record is NULL before, and the caller's to free, also after a failure.
 */
static bp_status record_search(const struct packing *packing, double max_error, struct packed *best, bp_error *error)
{
	struct bracket bracket = {.low = RECORD_BUDGET_MIN - 1};
	uint32_t size = BUDGET_USUAL;

	while (!bracket.high || (bracket.high > bracket.low && bracket.high - bracket.low > bracket.high / 100 + 1)) {
		struct packed trial = {.record = NULL};
		bp_status status = record_build(packing, size, &trial, error);
		if (status && (status != BP_ERROR_LIMIT || size == RECORD_BUDGET_MAX))
			return status;
		const double reached = status ? INFINITY : trial.head.layers[trial.head.layer_count - 1].fidelity.log_rmse;
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

bp_status record_encode(const struct lattice *lattice, const char *name, const struct record_source *source,
                        const struct fit_options *options, uint8_t **record, size_t *record_bytes, struct record_head *head,
                        bp_error *error)
{
	struct packing packing = {.lattice = lattice, .encode = profile_encoder_find(options->profile)};
	struct packed packed = {.record = NULL};
	struct model *model = NULL;
	size_t name_bytes = strlen(name);
	const char *fault = name_fault(name, name_bytes);

	if (!packing.encode)
		return error_argument(error, "profile %d is not known", (int)options->profile);
	if (fault)
		return error_argument(error, "\"%.255s\" is not a legal name: %s", name, fault);
	bp_status status = model_fit(lattice, options, &model, error);
	if (status)
		return status;
	packing.model = model;
	packing.request =
		(struct encode_request){.options = options, .name_bytes = name_bytes + record_origin_bytes(&source->origin)};
	head_fill(&packing.head, model, name, source, options, profile_codec_find(options->profile)->version);
	if (options->max_error > 0)
		status = record_search(&packing, options->max_error, &packed, error);
	else
		status = record_build(&packing, options->budget_bytes, &packed, error);
	if (!status && head)
		status = record_head_read(packed.record, packed.bytes, head, error);
	model_free(model);
	if (status) {
		free(packed.record);
		return status;
	}
	*record = packed.record;
	*record_bytes = packed.bytes;
	return BP_OK;
}
