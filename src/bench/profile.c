/*
 * profile.c: this project's own records, through the same functions as `brdfpack build` and `extract`.
 *
 * fit = record_encode (which also decodes and measures every layer); decode = record_head_read, record_decode,
 * model_expand; evaluation = table_evaluate, interpolated, in the expanded memory form. The bytes are the whole
 * record's.
 */
#include <stdlib.h>

#include "codec/record.h"
#include "error.h"
#include "model/table/table.h"
#include "baseline.h"

struct profile_state {
	uint8_t *record;
	size_t bytes;
	struct table *table; /* after profile_prepare */
};

static void profile_free(void *opaque)
{
	struct profile_state *state = opaque;

	if (state) {
		table_free(state->table);
		free(state->record);
	}
	free(state);
}

static bp_status profile_fit(const struct baseline *self, const struct bench_material *material, struct fitted *out,
                             bp_error *error)
{
	const struct fit_options options = {.profile = *(const enum profile *)self->variant,
	                                    .budget_bytes = (uint32_t)material->budget_bytes,
	                                    .effort = material->effort};
	const struct record_source source = {.bytes = material->raw_bytes};
	struct profile_state *state = calloc(1, sizeof *state);

	if (!state)
		return error_memory(error, sizeof *state);
	bp_status status =
		record_encode(material->lattice, material->name, &source, &options, &state->record, &state->bytes, NULL, error);
	if (status)
		profile_free(state);
	else
		*out = (struct fitted){.state = state, .bytes = state->bytes};
	return status;
}

static bp_status profile_expand(const void *opaque, struct expansion *out, bp_error *error)
{
	const struct profile_state *state = opaque;
	struct record_head head;
	struct model *model = NULL;
	bp_status status;

	if ((status = record_head_read(state->record, state->bytes, &head, error)) ||
	    (status = record_decode_whole(&head, 0, state->record, &model, error)))
		return status;
	status = model_expand(model, 0, out, error);
	model_free(model);
	return status;
}

static bp_status profile_prepare(void *opaque, const struct expansion *table, bp_error *error)
{
	struct profile_state *state = opaque;

	return table_build(table, TABLE_EXPANDED, 3, &state->table, error);
}

static void profile_evaluate(const void *opaque, const double wi[3], const double wo[3], double rgb[3])
{
	const struct profile_state *state = opaque;
	const float in[3] = {(float)wi[0], (float)wi[1], (float)wi[2]}, out[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
	float value[3];

	table_evaluate(state->table, in, out, value);
	for (int c = 0; c < 3; c++)
		rgb[c] = (double)value[c];
}

/* What both profiles have in common. */
#define PROFILE_BASELINE(number) \
	.variant = &(const enum profile){number}, .budgeted = true, .fit = profile_fit, .expand = profile_expand, \
	.prepare = profile_prepare, .evaluate = profile_evaluate, .free_state = profile_free

const struct baseline BASELINE_PAPER = {
	.reference = "this project, --profile paper: Bilgili et al. 2012, pair copulas and wavelets",
	PROFILE_BASELINE(PROFILE_PAPER),
};

const struct baseline BASELINE_SPECTRAL = {
	.reference = "this project, the spectral profile",
	PROFILE_BASELINE(PROFILE_SPECTRAL),
};
