#include "stress_subject.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "archive/writer.h"
#include "codec/record_carried.h"
#include "merl/merl_file.h"
#include "scratch.h"
#include "stress_cases.h"

void packed_make(const struct lattice *lattice, const struct carried *carried, const char *name,
                 const struct fit_options *options, struct packed_table *out)
{
	static const struct record_source source = {.bytes = 1};
	const size_t cells = lattice_cells(lattice->dims);
	struct model *model = NULL;

	memset(out, 0, sizeof *out);
	out->status = carried ? record_carried(lattice, carried, name, options, &out->record, &out->record_bytes, NULL) : BP_OK;
	if (!out->status && !out->record)
		out->status = record_encode(lattice, name, &source, options, &out->record, &out->record_bytes, NULL, NULL);
	if (!out->status)
		out->status = record_head_read(out->record, out->record_bytes, &out->head, NULL);
	if (out->status)
		return;
	out->value = malloc(3 * cells * sizeof *out->value);
	if (record_decode_whole(&out->head, 0, out->record, &model, NULL) != BP_OK ||
	    expansion_alloc(lattice->dims, &out->table, NULL) != BP_OK || model_expand(model, 0, &out->table, NULL) != BP_OK) {
		fprintf(stderr, "%s: a record that was just made does not decode\n", name);
		exit(1);
	}
	model_free(model);
	for (size_t c = 0; c < 3; c++)
		for (size_t i = 0; i < cells; i++)
			out->value[c * cells + i] = out->table.unit * (double)out->table.rgb[c][i];
}

void packed_free(struct packed_table *packed)
{
	free(packed->record);
	free(packed->value);
	expansion_free(&packed->table);
	memset(packed, 0, sizeof *packed);
}

size_t packed_bad_values(const struct packed_table *packed)
{
	size_t bad = 0;
	for (size_t i = 0, n = 3 * lattice_cells(packed->head.dims); i < n; i++)
		bad += !(packed->value[i] >= 0 && isfinite(packed->value[i]));
	return bad;
}

static void through_file(const struct packed_table *packed, bool plain, const uint8_t *below, struct lattice *out,
                         struct carried *carried)
{
	char path[SCRATCH_BYTES];
	if (scratch_file(path) != 0 ||
	    lattice_write_path(path, OUTPUT_REPLACE, &packed->table, below, plain ? NULL : packed->record,
	                       plain ? 0 : packed->record_bytes, NULL) != BP_OK ||
	    lattice_read_path(path, &(struct merl_reading){.any_dims = true, .carried = carried}, out, NULL) != BP_OK ||
	    unlink(path) != 0) {
		fprintf(stderr, "%s: cannot be extracted by way of %s\n", packed->head.name, path);
		exit(1);
	}
}

void packed_to_lattice(const struct packed_table *packed, enum decoded_form form, struct lattice *out, struct carried *carried)
{
	const size_t cells = lattice_cells(packed->head.dims);
	uint8_t *below = calloc(cells, 1);

	if (!below)
		exit(1);
	if (form != DECODED_WHOLE) {
		lattice_below_horizon(packed->head.dims, packed->head.horizon_limit, below);
		through_file(packed, form == DECODED_PLAIN, below, out, carried);
	} else {
		if (lattice_alloc(packed->head.dims, out, NULL) != BP_OK)
			exit(1);
		for (size_t c = 0; c < 3; c++)
			memcpy(out->rgb[c], packed->value + c * cells, cells * sizeof(double));
		lattice_validate(out);
		*carried = (struct carried){0};
	}
	free(below);
}

/* ---- materials at work ---- */

static void direction_draw(uint64_t *random, float out[3])
{
	/* Every fourth grazes, and some coincide with the normal. */
	const double u = stress_uniform(random),
				 z = u < 0.25  ? u * u * u
	                 : u < 0.3 ? 1
	                           : u,
				 phi = 6.283185307179586 * stress_uniform(random);
	out[0] = (float)(sqrt(1 - z * z) * cos(phi));
	out[1] = (float)(sqrt(1 - z * z) * sin(phi));
	out[2] = (float)z;
}

static bool values_fine(const float *value, int count)
{
	for (int c = 0; c < count; c++)
		if (!(value[c] >= 0 && isfinite(value[c])))
			return false;
	return true;
}

static void material_exercise(const bp_material *material, unsigned pairs, uint64_t seed, struct archive_outcome *out)
{
	for (unsigned n = 0; n < pairs; n++) {
		float wi[3], wo[3], a[3], b[3], u[3], drawn[3], density, weight[3];
		direction_draw(&seed, wi);
		direction_draw(&seed, wo);
		bp_material_evaluate(material, wi, wo, a);
		bp_material_evaluate(material, wo, wi, b);
		out->asymmetric += memcmp(a, b, sizeof a) != 0;
		out->bad += !values_fine(a, 3);
		bp_material_nearest(material, wi, wo, b);
		out->bad += !values_fine(b, 3);
		for (int i = 0; i < 3; i++)
			u[i] = (float)stress_uniform(&seed);
		density = bp_material_sample(material, wo, u, drawn);
		bp_material_evaluate(material, drawn, wo, a);
		for (int c = 0; c < 3; c++)
			weight[c] = density > 0 ? a[c] * drawn[2] / density : 0;
		out->bad += !values_fine(&density, 1) || !values_fine(weight, 3);
		density = bp_material_pdf(material, wi, wo);
		out->bad += !values_fine(&density, 1);
		if (n == 0) { /* it integrates: one is as long as thousands of evaluations */
			bp_material_albedo(material, (float)stress_uniform(&seed), a);
			out->bad += !values_fine(a, 3);
		}
	}
}

static const char *archive_write(const struct packed_table *packed, size_t count)
{
	static char path[SCRATCH_BYTES];
	struct archive_writer *writer = NULL;

	if (scratch_file(path) != 0 || archive_writer_open(path, &writer, NULL) != BP_OK)
		return NULL;
	for (size_t i = 0; i < count; i++)
		if (!packed[i].status && archive_writer_add(writer, packed[i].record, packed[i].record_bytes, NULL) != BP_OK) {
			archive_writer_discard(writer);
			return NULL;
		}
	return archive_writer_commit(writer, NULL) == BP_OK ? path : NULL;
}

void archive_exercise(const struct packed_table *packed, size_t count, unsigned pairs, struct archive_outcome *out)
{
	bp_archive *archive = NULL;
	const char *path = archive_write(packed, count);

	*out = (struct archive_outcome){0};
	if (!path || bp_archive_open(path, &archive, NULL) != BP_OK) {
		out->refused = count;
		return;
	}
	out->refused += bp_archive_verify(archive, BP_VERIFY_DEEP, NULL, NULL, NULL) != BP_OK;
	for (uint64_t m = 0; m < bp_archive_count(archive); m++)
		for (int form = 0; form < 2; form++) {
			const bp_load_options options = {.struct_bytes = sizeof options, .form = (bp_form)form, .sampling = 1};
			bp_material *material = NULL;
			if (bp_material_load(archive, m, &options, &material, NULL) != BP_OK) {
				out->refused++;
				continue;
			}
			material_exercise(material, pairs, m + 1, out);
			bp_material_free(material);
		}
	bp_archive_close(archive);
	unlink(path);
}
