#include "archive_walk.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "archive/reader.h"
#include "merl/merl_file.h"
#include "scratch.h"
#include "tool/facts.h"

static void values_check(const float *value, int count)
{
	for (int i = 0; i < count; i++)
		if (!(value[i] >= 0 && isfinite(value[i])))
			abort();
}

static void material_walk(const bp_material *material, struct walk_values *out)
{
	static const float directions[5][3] = {
		{0, 0, 1}, {0.6f, 0, 0.8f}, {0, 0.8f, 0.6f}, {-0.48f, 0.64f, 0.6f}, {0.9999f, 0, 0.0141f}};
	for (int i = 0; i < 4; i++) {
		float rgb[3];
		bp_material_evaluate(material, directions[i], directions[i + 1], out->rgb[i]);
		values_check(out->rgb[i], 3);
		bp_material_nearest(material, directions[i + 1], directions[i], rgb);
		values_check(rgb, 3);
	}
}

/* Head of material m: its name and whether its lattice is small. */
static bool material_small(const bp_archive *archive, uint64_t m, char name[BP_NAME_BYTES_MAX + 1])
{
	bp_material_info info = {.struct_bytes = sizeof info};
	uint64_t found;
	if (bp_archive_name(archive, m, name, NULL) != BP_OK)
		return false;
	if (bp_archive_find(archive, name, &found, NULL) == BP_OK && found != m)
		abort();
	return bp_archive_info(archive, m, &info, NULL) == BP_OK &&
	       (uint64_t)info.theta_h * info.theta_d * info.phi_d <= WALK_CELLS_MAX;
}

/* A path of this process's own, in memory where possible: recovery syncs what it writes. */
static const char *scratch_path(char which)
{
	char name[64];
	snprintf(name, sizeof name, "brdfpack-walk-%ld-%c", (long)getpid(), which);
	return scratch_in(access("/dev/shm", W_OK) == 0 ? "/dev/shm" : scratch_parent(), name);
}

/* Every head, as `list` reads them; those of materials first.. are printed, in its longest form. */
static void heads_list(const bp_archive *archive, uint64_t first, uint64_t most)
{
	static FILE *nowhere;
	const uint64_t count = bp_archive_count(archive);
	struct index_page leaf;
	struct index_entry entry;
	struct record_head head;
	leaf.count = 0;
	if (!nowhere && !(nowhere = fopen("/dev/null", "w")))
		abort();
	for (uint64_t m = 0; m < count; m++) {
		if (archive_entry(archive, m, &leaf, &entry, NULL) != BP_OK || archive_entry_head(archive, &entry, &head, NULL) != BP_OK)
			continue;
		if ((m + count - first % count) % count >= most)
			continue;
		struct origin origin;
		if (archive_entry_origin(archive, &entry, &head, &origin, NULL) != BP_OK)
			continue;
		facts_print(nowhere, true, &head, &origin);
	}
}

static uint32_t file_crc32(const char *path)
{
	static uint8_t bytes[12 + 24 * WALK_CELLS_MAX + 1];
	FILE *file = fopen(path, "rb");
	if (!file)
		abort();
	const size_t count = fread(bytes, 1, sizeof bytes, file);
	fclose(file);
	return bytes_crc32(bytes, count);
}

/* The file that `extract` writes of material m: its CRC32, 0 where there is none. */
static uint32_t material_extract(const bp_archive *archive, uint64_t m)
{
	const char *path = scratch_path('m');
	struct index_page leaf;
	struct index_entry entry;
	struct record_head head, same;
	struct expansion table = {0};
	struct model *model = NULL;
	uint8_t *record = NULL, *below = NULL;
	uint32_t crc = 0;

	leaf.count = 0;
	if (archive_entry(archive, m, &leaf, &entry, NULL) != BP_OK || archive_entry_head(archive, &entry, &head, NULL) != BP_OK ||
	    archive_entry_load(archive, &entry, &head, 0, &model, NULL) != BP_OK ||
	    archive_entry_record(archive, &entry, &same, &record, NULL) != BP_OK ||
	    expansion_alloc(model->dims, &table, NULL) != BP_OK)
		goto out;
	below = malloc(lattice_cells(model->dims));
	if (!below || model_expand(model, 0, &table, NULL) != BP_OK)
		goto out;
	lattice_below_horizon(model->dims, model->horizon_limit, below);
	if (lattice_write_path(path, OUTPUT_REPLACE, &table, below, record, head.record_bytes, NULL) == BP_OK) {
		crc = file_crc32(path);
		unlink(path);
	}
out:
	expansion_free(&table);
	model_free(model);
	free(record);
	free(below);
	return crc;
}

/* Material m through the public calls that copy: its table, and its record into an archive in memory, where it must be the same. */
static void material_copy(const bp_archive *archive, uint64_t m, const char *name)
{
	static uint16_t table[3 * WALK_CELLS_MAX];
	const bp_table_options options = {.struct_bytes = sizeof options, .number = BP_NUMBER_HALF, .layout = BP_LAYOUT_INTERLEAVED};
	bp_material_info info = {.struct_bytes = sizeof info};
	bp_layer layers[BP_LAYERS_MAX];
	bp_section sections[BP_SECTIONS_MAX];
	bp_writer *writer = NULL;
	bp_archive *copy = NULL;
	uint8_t *record = NULL, *again = NULL, *bytes = NULL;
	size_t record_bytes, again_bytes, count;
	uint64_t index;

	if (bp_archive_info(archive, m, &info, NULL) != BP_OK ||
	    bp_archive_layers(archive, m, sizeof *layers, layers, BP_LAYERS_MAX, NULL, NULL) != BP_OK ||
	    bp_archive_sections(archive, m, sizeof *sections, sections, BP_SECTIONS_MAX, NULL, NULL) != BP_OK)
		return;
	bp_archive_table(archive, m, &options, table, bp_table_bytes(info.theta_h, info.theta_d, info.phi_d, &options), NULL);
	if (bp_archive_record(archive, m, &record, &record_bytes, NULL) != BP_OK)
		return;
	if (bp_writer_create(&writer, NULL) != BP_OK || bp_writer_add(writer, record, record_bytes, NULL) != BP_OK ||
	    bp_writer_save_memory(writer, &bytes, &count, NULL) != BP_OK ||
	    bp_archive_open_memory(bytes, count, &copy, NULL) != BP_OK || bp_archive_find(copy, name, &index, NULL) != BP_OK ||
	    bp_archive_record(copy, index, &again, &again_bytes, NULL) != BP_OK || again_bytes != record_bytes ||
	    memcmp(again, record, record_bytes) != 0)
		abort();
	bp_archive_close(copy);
	bp_writer_free(writer);
	bp_free(bytes);
	bp_free(again);
	bp_free(record);
}

bp_status archive_walk(const char *path, uint64_t first, uint64_t most, unsigned also, struct walk_values *seen,
                       uint64_t *seen_count)
{
	bp_archive *archive = NULL;
	bool small = true;
	uint64_t count = 0;
	bp_status status = bp_archive_open(path, &archive, NULL);

	if (seen_count)
		*seen_count = 0;
	if (status)
		return status;
	if (also & WALK_LIST)
		heads_list(archive, first, most);
	for (uint64_t n = 0; n < most && n < bp_archive_count(archive); n++) {
		const uint64_t m = (first + n) % bp_archive_count(archive);
		struct walk_values values = {.name = ""};
		bp_material *material = NULL;
		if (!material_small(archive, m, values.name)) {
			small = false;
			continue;
		}
		/* by name: its number is another one when others are lost */
		const uint32_t way = bytes_crc32(values.name, strlen(values.name));
		const bp_load_options options = {.struct_bytes = sizeof options,
		                                 .form = (bp_form)(way % 2),
		                                 .colour = (bp_colour)(way / 2 % 2),
		                                 .max_log_rmse = way % 3 == 0 ? 0.1 : 0};
		if (bp_material_load(archive, m, &options, &material, NULL) != BP_OK)
			continue;
		material_walk(material, &values);
		bp_material_free(material);
		if (also & WALK_EXTRACT) {
			values.extracted = material_extract(archive, m);
			material_copy(archive, m, values.name);
		}
		if (seen)
			seen[count] = values;
		count++;
	}
	if (seen_count)
		*seen_count = count;
	status = bp_archive_verify(archive, small && most >= bp_archive_count(archive) ? BP_VERIFY_DEEP : 0, NULL, NULL, NULL);
	bp_archive_close(archive);
	return status;
}

bp_status archive_rescue(const char *path, uint64_t first, uint64_t most, struct walk_values *seen, uint64_t *seen_count,
                         struct recovery *saved)
{
	const char *rescued = scratch_path('r');
	bp_archive *archive = NULL;
	bp_status status = archive_recover(path, rescued, NULL, NULL, saved, NULL);

	if (seen_count)
		*seen_count = 0;
	if (status)
		return status;
	if (bp_archive_open(rescued, &archive, NULL) != BP_OK || bp_archive_count(archive) != saved->saved ||
	    bp_archive_verify(archive, 0, NULL, NULL, NULL) != BP_OK)
		abort();
	bp_archive_close(archive);
	status = archive_walk(rescued, first, most, 0, seen, seen_count);
	unlink(rescued);
	return status;
}

/* ---- mending ---- */

void record_mend(uint8_t *bytes, size_t count)
{
	enum { AT_HEAD = 8, AT_LAYERS = 31, AT_SECTIONS = 32, AT_TABLES = 208, ROW = 32 };
	uint32_t head, layers, sections;

	if (count < AT_TABLES)
		return;
	head = load_u32(bytes + AT_HEAD);
	layers = bytes[AT_LAYERS];
	sections = load_u16(bytes + AT_SECTIONS);
	if (head > count || head < AT_TABLES + 4)
		return;
	for (uint32_t s = 0; s < sections && AT_TABLES + ROW * (layers + s + 1) + 4 <= head; s++) {
		uint8_t *row = bytes + AT_TABLES + ROW * (layers + s);
		const uint32_t offset = load_u32(row + 12), length = load_u32(row + 16);
		if (offset <= count && length <= count - offset)
			store_u32(row + 20, bytes_crc32(bytes + offset, length));
	}
	store_u32(bytes + head - 4, bytes_crc32(bytes, head - 4));
}

void archive_mend(uint8_t *bytes, size_t count)
{
	uint64_t index, pages;

	if (count < ARCHIVE_HEADER_BYTES)
		return;
	store_u32(bytes + 16, (uint32_t)count);
	store_u32(bytes + 20, (uint32_t)((uint64_t)count >> 32));
	store_u32(bytes + 60, bytes_crc32(bytes, 60));
	index = load_u64(bytes + 32);
	pages = load_u32(bytes + 40);
	for (uint64_t p = 0; p < pages && index <= count && PAGE_BYTES * (p + 1) <= count - index; p++) {
		uint8_t *page = bytes + index + PAGE_BYTES * p;
		store_u32(page + PAGE_BYTES - 4, bytes_crc32(page, PAGE_BYTES - 4));
	}
	for (size_t at = ARCHIVE_HEADER_BYTES; at + RECORD_MAGIC_BYTES <= count; at++)
		if (bytes[at] == 0x8B && memcmp(bytes + at, RECORD_MAGIC, RECORD_MAGIC_BYTES) == 0)
			record_mend(bytes + at, count - at);
}
