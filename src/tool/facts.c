#include "facts.h"

#include <string.h>

const char *const ZEROS_NAMES[3] = {"auto", "holes", "measured"};
const char *const CHANNEL_NAMES[3] = {"red", "green", "blue"};
const char *const PAIR_NAMES[3] = {"c_hd", "c_hphi", "c_dphi|h"};

const char *profile_name(enum profile profile)
{
	return profile == PROFILE_PAPER ? "paper" : profile == PROFILE_SPECTRAL ? "spectral" : "unknown";
}

bool profile_parse(const char *text, enum profile *out)
{
	const bool paper = !strcmp(text, "paper");
	if (!paper && strcmp(text, "spectral") != 0 && strcmp(text, "default") != 0) /* "default": the name before version 0.2 */
		return false;
	*out = paper ? PROFILE_PAPER : PROFILE_SPECTRAL;
	return true;
}

bool zeros_parse(const char *text, enum zeros_rule *out)
{
	for (int rule = 0; rule < 3; rule++)
		if (!strcmp(text, ZEROS_NAMES[rule])) {
			*out = (enum zeros_rule)rule;
			return true;
		}
	return false;
}

const struct fidelity *head_fidelity(const struct record_head *head)
{
	return &head->layers[head->layer_count > 0 ? head->layer_count - 1 : 0].fidelity;
}

static void fidelity_members(struct json *json, const struct fidelity *fidelity)
{
	json_number(json, "log_rmse", fidelity->log_rmse);
	json_number(json, "seen_log_rmse", fidelity->seen_log_rmse);
	json_number(json, "cube_root_rmse", fidelity->cube_root_rmse);
	json_number(json, "largest_relative", fidelity->largest_relative);
}

void facts_brief(struct json *json, const struct record_head *head)
{
	json_object(json, "errors");
	fidelity_members(json, head_fidelity(head));
	json_close(json);

	json_object(json, "parameters");
	for (int c = 0; c < 3; c++) {
		const struct colour_fit *fit = &head->colour[c];
		json_object(json, CHANNEL_NAMES[c]);
		json_number(json, "diffuse", fit->diffuse);
		json_number(json, "specular", fit->specular);
		json_integer(json, "iterations", fit->iterations);
		json_bool(json, "converged", fit->converged);
		json_number(json, "rejected", fit->rejected);
		json_close(json);
	}
	json_close(json);

	json_array(json, "left_out");
	for (int pair = 0; pair < 3; pair++)
		if (head->left_out >> pair & 1)
			json_string(json, NULL, PAIR_NAMES[pair]);
	json_close(json);
}

static void layers_member(struct json *json, const struct record_head *head)
{
	json_array(json, "layers");
	for (uint32_t i = 0; i < head->layer_count; i++) {
		json_object(json, NULL);
		json_integer(json, "bytes", head->layers[i].bytes);
		fidelity_members(json, &head->layers[i].fidelity);
		json_close(json);
	}
	json_close(json);

	json_array(json, "sections");
	for (uint32_t i = 0; i < head->section_count; i++) {
		const struct record_section *section = &head->sections[i];
		json_object(json, NULL);
		json_integer(json, "type", section->type);
		json_integer(json, "codec", section->codec);
		json_integer(json, "version", section->version);
		json_integer(json, "layer", section->layer);
		json_integer(json, "offset", section->offset);
		json_integer(json, "bytes", section->bytes);
		json_number(json, "error", section->error);
		json_close(json);
	}
	json_close(json);
}

static const struct {
	const char *word, *text;
} ORIGINS[] = {
	[ORIGIN_RGL_RGB] = {"rgl-rgb", "RGL tensor file, red, green and blue"},
	[ORIGIN_RGL_SPECTRA] = {"rgl-spectra", "RGL tensor file, spectra"},
	[ORIGIN_TWO_HALVES] = {"merl-two-halves", "MERL-like table with phi_d from 0 to 2 pi, the mean of its halves"},
};

const char *origin_text(enum origin_kind kind) { return ORIGINS[kind].text; }

/* What the source's object says beyond a MERL table's. */
static void origin_members(struct json *json, const struct origin *origin)
{
	if (!origin_text(origin->kind))
		return;
	json_string(json, "kind", ORIGINS[origin->kind].word);
	if (origin->kind == ORIGIN_RGL_SPECTRA) {
		json_integer(json, "wavelengths", origin->wavelengths);
		json_number(json, "first_nm", origin->first_nm);
		json_number(json, "last_nm", origin->last_nm);
		json_string(json, "observer", "CIE 1931 2 degrees");
		json_string(json, "illuminant", "D65");
		json_string(json, "primaries", "ITU-R BT.709");
	}
	json_object(json, "non_reciprocity");
	json_integer(json, "cells", origin->compared);
	json_number(json, "median", origin->median);
	json_number(json, "percentile_95", origin->percentile95);
	json_close(json);
}

void facts_print(FILE *out, bool indent, const struct record_head *head, const struct origin *origin)
{
	struct json begun = json_begin(out, indent), *json = &begun;
	json_string(json, "name", head->name);
	json_integer(json, "bytes", head->record_bytes);
	json_string(json, "profile", profile_name(head->profile));
	json_integer(json, "codec_version", head->codec_version);

	json_object(json, "source");
	json_integer(json, "bytes", head->source.bytes);
	json_hex(json, "sha256", head->source.sha256, SHA256_BYTES);
	json_integer(json, "nonfinite_cells", head->source.nonfinite_count);
	json_integer(json, "cells_taken_as_holes", head->source.hole_count);
	origin_members(json, origin);
	json_close(json);

	json_object(json, "lattice");
	json_integer(json, "theta_h", head->dims.theta_h);
	json_integer(json, "theta_d", head->dims.theta_d);
	json_integer(json, "phi_d", head->dims.phi_d);
	json_number(json, "horizon_limit", head->horizon_limit);
	json_close(json);

	json_object(json, "options");
	json_integer(json, "budget_bytes", head->options.budget_bytes);
	json_number(json, "max_error", head->options.max_error);
	json_integer(json, "effort", (uint64_t)head->options.effort);
	json_string(json, "zeros", ZEROS_NAMES[head->options.zeros]);
	json_close(json);

	facts_brief(json, head);
	layers_member(json, head);
	json_finish(json);
}
