#include "viewer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "archive/reader.h"
#include "error.h"
#include "merl/merl_file.h"
#include "model/table/table.h"
#include "render/lights.h"

struct viewer_material {
	struct table *table;
	struct table_layout layout;
	float numbers[17];
};

static bp_error last;

const char *viewer_error(void) { return last.message[0] ? last.message : bp_status_text(last.status); }

uint32_t viewer_error_status(void) { return (uint32_t)last.status; }

double viewer_error_offset(void) { return last.offset == BP_NO_OFFSET ? -1 : (double)last.offset; }

static int source_read(void *user, uint64_t offset, void *bytes, size_t count)
{
	return viewer_read((uint32_t)(uintptr_t)user, (double)offset, bytes, (uint32_t)count);
}

struct bp_archive *viewer_archive_open(uint32_t source, double bytes)
{
	const bp_source from = {
		.struct_bytes = sizeof from, .read = source_read, .user = (void *)(uintptr_t)source, .bytes = (uint64_t)bytes};
	bp_archive *archive;
	return bp_archive_open_source(&from, &archive, &last) == BP_OK ? archive : NULL;
}

void viewer_archive_close(struct bp_archive *archive) { bp_archive_close(archive); }

double viewer_archive_count(const struct bp_archive *archive) { return (double)bp_archive_count(archive); }

static int first_only(void *user, const bp_problem *problem)
{
	(void)user, (void)problem;
	return 1;
}

uint32_t viewer_archive_verify(const struct bp_archive *archive)
{
	return (uint32_t)bp_archive_verify(archive, BP_VERIFY_DEEP, first_only, NULL, &last);
}

double viewer_archive_find(const struct bp_archive *archive, const char *name)
{
	uint64_t index;
	return bp_archive_find(archive, name, &index, &last) == BP_OK ? (double)index : -1;
}

/* A name in JSON: names are UTF-8 without control characters (name.h). */
static size_t name_quote(char *out, const char *name)
{
	size_t used = 0;
	for (; *name; name++) {
		if (*name == '"' || *name == '\\')
			out[used++] = '\\';
		out[used++] = *name;
	}
	return used;
}

const char *viewer_archive_info(const struct bp_archive *archive, double index)
{
	static char text[2 * BP_NAME_BYTES_MAX + 128 + 64 * LAYERS_MAX];
	struct index_entry entry;
	struct record_head head;
	if (archive_record_head(archive, (uint64_t)index, &entry, &head, &last) != BP_OK)
		return NULL;
	size_t used = (size_t)snprintf(text, sizeof text, "{\"name\":\"");
	used += name_quote(text + used, head.name);
	used += (size_t)snprintf(text + used, sizeof text - used, "\",\"offset\":%llu,\"bytes\":%u,\"layers\":[",
	                         (unsigned long long)entry.offset, head.record_bytes);
	for (uint32_t l = 0; l < head.layer_count; l++)
		used += (size_t)snprintf(text + used, sizeof text - used, "%s{\"bytes\":%u,\"error\":%.6g}", l ? "," : "",
		                         head.layers[l].bytes, head.layers[l].fidelity.seen_log_rmse);
	snprintf(text + used, sizeof text - used, "]}");
	return text;
}

/* Takes over the table. */
static struct viewer_material *material_of(struct table *table)
{
	struct viewer_material *material = calloc(1, sizeof *material);
	if (!material || !table_layout(table, &material->layout)) {
		error_memory(&last, sizeof *material);
		table_free(table);
		free(material);
		return NULL;
	}
	material->table = table;
	const struct table_layout *l = &material->layout;
	const float numbers[8] = {(float)l->dims.theta_h, (float)l->dims.theta_d, (float)l->dims.phi_d, (float)(l->row / 32),
	                          (float)(l->slice / 32), (float)l->width,        (float)l->half,       l->first};
	memcpy(material->numbers, numbers, sizeof numbers);
	memcpy(material->numbers + 8, l->mix, sizeof l->mix);
	return material;
}

struct viewer_material *viewer_material_load(const struct bp_archive *archive, double index, uint32_t layers, uint32_t preview)
{
	struct model *model;
	struct table *table;
	struct lattice_dims half;
	if (archive_model_load(archive, (uint64_t)index, layers, &model, &last) != BP_OK)
		return NULL;
	const bool halved = preview && model_has_half(model->dims, &half);
	const bp_status status = table_build_model(model, halved, TABLE_COMPACT, 3, &table, &last);
	model_free(model);
	return status == BP_OK ? material_of(table) : NULL;
}

/* Bytes in memory, as lattice_read reads them. */
struct memory {
	const uint8_t *bytes;
	size_t left;
};

static bp_status memory_read(void *user, void *to, size_t capacity, size_t *read, bp_error *error)
{
	struct memory *memory = user;
	(void)error;
	*read = capacity < memory->left ? capacity : memory->left;
	memcpy(to, memory->bytes, *read);
	memory->bytes += *read;
	memory->left -= *read;
	return BP_OK;
}

struct viewer_material *viewer_measured(const uint8_t *bytes, uint32_t count)
{
	struct lattice lattice = {0};
	struct expansion expansion = {0};
	struct table *table = NULL;
	struct memory memory = {bytes, count};
	bp_status status = lattice_read(memory_read, &memory, &(struct merl_reading){.any_dims = true}, &lattice, &last);
	if (status == BP_OK)
		status = expansion_alloc(lattice.dims, &expansion, &last);
	if (status == BP_OK) {
		const size_t cells = lattice_cells(lattice.dims);
		expansion.unit = 1;
		for (int c = 0; c < 3; c++)
			for (size_t n = 0; n < cells; n++) {
				const double value = lattice.valid[n] ? lattice.rgb[c][n] : 0;
				expansion.rgb[c][n] = (float)(value < TABLE_LARGEST ? value : TABLE_LARGEST);
			}
		status = table_build(&expansion, TABLE_COMPACT, 3, &table, &last);
	}
	lattice_free(&lattice);
	expansion_free(&expansion);
	return status == BP_OK ? material_of(table) : NULL;
}

void viewer_material_free(struct viewer_material *material)
{
	if (material) {
		table_free(material->table);
		free(material);
	}
}

const float *viewer_material_numbers(const struct viewer_material *material) { return material->numbers; }

const uint8_t *viewer_material_blocks(const struct viewer_material *material) { return material->layout.blocks; }

uint32_t viewer_material_bytes(const struct viewer_material *material) { return (uint32_t)material->layout.bytes; }

void viewer_material_evaluate(const struct viewer_material *material, uint32_t count, const float *pairs, float *rgb)
{
	for (uint32_t n = 0; n < count; n++)
		table_evaluate(material->table, pairs + (size_t)6 * n, pairs + (size_t)6 * n + 3, rgb + (size_t)3 * n);
}

double *viewer_table(const struct bp_archive *archive, double index, uint32_t layers, uint32_t dims[3])
{
	struct index_entry entry;
	struct record_head head;
	struct expansion table = {0};
	double *values = NULL;
	if (archive_record_head(archive, (uint64_t)index, &entry, &head, &last) == BP_OK &&
	    archive_entry_expand(archive, &entry, &head, layers, &table, &last) == BP_OK) {
		const size_t cells = lattice_cells(head.dims);
		values = malloc(3 * cells * sizeof *values);
		if (!values)
			error_memory(&last, 3 * cells * sizeof *values);
		for (size_t n = 0; values && n < 3 * cells; n++)
			values[n] = table.unit * (double)table.rgb[n / cells][n % cells];
		dims[0] = head.dims.theta_h;
		dims[1] = head.dims.theta_d;
		dims[2] = head.dims.phi_d;
	}
	expansion_free(&table);
	return values;
}

uint32_t viewer_lights(uint32_t lighting, float *lights)
{
	static struct light made[LIGHTS_MAX];
	const int count = lights_make((enum lighting)lighting, made);
	for (int n = 0; n < count; n++) {
		for (int q = 0; q < 3; q++)
			lights[5 * n + q] = (float)made[n].at[q];
		lights[5 * n + 3] = (float)made[n].weight;
		lights[5 * n + 4] = made[n].is_point ? 1 : 0;
	}
	return (uint32_t)count;
}

void *viewer_alloc(uint32_t bytes) { return malloc(bytes); }

void viewer_free(void *block) { free(block); }
