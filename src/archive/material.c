/* Loading a material to render from: record -> model -> expansion -> table, and the sampler beside it. */
#include <math.h>

#include "environment.h"
#include "error.h"
#include "memory.h"
#include "model/table/table.h"
#include "model/sample/sample.h"
#include "reader.h"

enum { ALBEDO_TABLE_MAX = 65536 };

struct bp_material {
	struct table *table;
	struct sampler *sampler;     /* NULL: loaded without */
	struct albedo_cache *albedo; /* the same */
	bp_loaded loaded;
	bp_allocator allocator; /* where all of this lies; alloc NULL: malloc */
};

/* For the calls that make or free a material. Returns what memory_allocator_set wants afterwards. */
static const bp_allocator *allocator_enter(const bp_allocator *allocator)
{
	return memory_allocator_set(allocator && allocator->alloc ? allocator : NULL);
}

static bp_status options_check(const bp_load_options *options, bp_error *error)
{
	if (options->struct_bytes != sizeof *options)
		return error_argument(error, "struct_bytes is %zu, not sizeof(bp_load_options) = %zu", options->struct_bytes,
		                      sizeof *options);
	if (!(options->max_log_rmse >= 0))
		return error_argument(error, "max_log_rmse is %g, it must be 0 or more", options->max_log_rmse);
	if (options->form != BP_FORM_EXPANDED && options->form != BP_FORM_COMPACT && options->form != BP_FORM_PREVIEW)
		return error_argument(error, "there is no memory form %d", (int)options->form);
	if ((int)options->colour < BP_COLOUR_RGB || (int)options->colour > BP_COLOUR_B)
		return error_argument(error, "there is no colour option %d", (int)options->colour);
	if (options->allocator && (!options->allocator->alloc || !options->allocator->release))
		return error_argument(error, "an allocator needs both of its functions");
	if (options->sampling != 0 && options->sampling != 1)
		return error_argument(error, "sampling is %d, it must be 0 or 1", options->sampling);
	return BP_OK;
}

/* Leaves out what has one of the flags `some`, but for what has one of `wanted`. */
static void sections_drop(struct record_head *head, uint32_t some, uint32_t wanted)
{
	uint32_t kept = 0;
	for (uint32_t n = 0; n < head->section_count; n++)
		if (!(head->sections[n].flags & some) || head->sections[n].flags & wanted)
			head->sections[kept++] = head->sections[n];
	head->section_count = kept;
}

/* An achromatic load does without the sections that only colour needs, one channel alone without those of the others. */
static bp_status colour_choose(struct record_head *head, bp_colour colour, bp_error *error)
{
	if (colour == BP_COLOUR_RGB)
		return BP_OK;
	if (colour == BP_COLOUR_MEAN) {
		sections_drop(head, SECTION_COLOUR, 0);
		return BP_OK;
	}
	if (head->profile != PROFILE_PAPER)
		return error_set(error, BP_ERROR_UNSUPPORTED, BP_NO_OFFSET, "%s: records of this profile do not keep the channels apart",
		                 head->name);
	sections_drop(head, (uint32_t)SECTION_ONLY_R * 7, (uint32_t)SECTION_ONLY_R << (colour - BP_COLOUR_R));
	head->channels = 1u << (colour - BP_COLOUR_R);
	return BP_OK;
}

static bp_status material_build(const struct model *model, const bp_load_options *options, bp_material *material, bp_error *error)
{
	struct lattice_dims half;
	const bool preview = options->form == BP_FORM_PREVIEW && model_has_half(model->dims, &half);
	bp_status status = table_build_model(model, preview, options->form == BP_FORM_COMPACT ? TABLE_COMPACT : TABLE_EXPANDED,
	                                     options->colour == BP_COLOUR_RGB ? 3 : 1, &material->table, error);
	if (!status && options->sampling)
		status = sampler_build(material->table, &material->sampler, error);
	if (!status && options->sampling)
		status = albedo_cache_make(&material->albedo, error);
	const struct lattice_dims dims = preview ? half : model->dims;
	material->loaded = (bp_loaded){
		.struct_bytes = sizeof material->loaded,
		.form = options->form == BP_FORM_PREVIEW && !preview ? BP_FORM_EXPANDED : options->form,
		.colour = options->colour,
		.sampling = options->sampling,
		.theta_h = dims.theta_h,
		.theta_d = dims.theta_d,
		.phi_d = dims.phi_d,
	};
	return status;
}

/* Decodes and builds; *material is the caller's to free in any case. The arithmetic and the allocator are as they should be. */
static bp_status material_fill(const bp_archive *archive, const struct index_entry *entry, struct record_head *head,
                               uint32_t layers, const bp_load_options *options, bp_material **out, bp_error *error)
{
	struct model *model = NULL;
	bp_material *material = memory_alloc_kept(sizeof *material);
	if (!material)
		return error_memory(error, sizeof *material);
	*material = (bp_material){.allocator = options->allocator ? *options->allocator : (bp_allocator){0}};
	*out = material;
	bp_status status = archive_entry_load(archive, entry, head, layers, &model, error);
	if (!status)
		status = material_build(model, options, material, error);
	model_free(model);
	return status;
}

/*
 * What loading may need: 17 bytes per cell while the model is expanded, 12 of them in the three fields, 6 of the result, and a
 * few tables. Fields lie in blocks of lanes (spectrum_rows.c), which are more than the cells where phi_d has few; and the cosines
 * of a row's span of n cells take 2 n^2 bytes (spans.c), those of all spans P^3/3, which counts where it has hundreds.
 */
static double need_of(struct lattice_dims dims)
{
	const double rows = (double)dims.theta_h * dims.theta_d, p = dims.phi_d;
	const uint32_t even = ((dims.phi_d + 1) / 2 + 7) / 8, odd = (dims.phi_d / 2 + 7) / 8, lanes = (even + odd + 1) / 2 * 16;
	const double cosines = p * p * fmin(p / 3, 2 * rows);
	return fmax(24 * rows * p, rows * (12 * lanes + 9 * p + 24) + cosines) + 1e6;
}

static bp_status need_check(const struct record_head *head, size_t most, bp_error *error)
{
	const double limit = most > 0 ? (double)most : 2 * need_of(LATTICE_MERL), need = need_of(head->dims);
	if (need <= limit)
		return BP_OK;
	return error_set(error, BP_ERROR_LIMIT, BP_NO_OFFSET,
	                 "%s: a table of %u x %u x %u cells may need %.0f MB, the limit is %.3g MB; max_memory_bytes sets it",
	                 head->name, head->dims.theta_h, head->dims.theta_d, head->dims.phi_d, need / 1e6, limit / 1e6);
}

bp_status bp_material_load(const bp_archive *archive, uint64_t index, const bp_load_options *options, bp_material **out,
                           bp_error *error)
{
	const bp_load_options whole = {.struct_bytes = sizeof whole};
	struct index_entry entry;
	struct record_head head;
	bp_material *material = NULL;
	fenv_t before;

	options = options ? options : &whole;
	bp_status status = options_check(options, error);
	if (!status)
		status = archive_record_head(archive, index, &entry, &head, error);
	if (!status)
		status = need_check(&head, options->max_memory_bytes, error);
	if (!status)
		status = colour_choose(&head, options->colour, error);
	if (status)
		return status;
	const uint32_t layers = record_layers_for(&head, options->max_log_rmse);
	environment_enter(&before);
	const bp_allocator *allocator_before = allocator_enter(options->allocator);
	status = material_fill(archive, &entry, &head, layers, options, &material, error);
	memory_allocator_set(allocator_before);
	environment_leave(&before);
	if (status) {
		bp_material_free(material);
		return status;
	}
	bp_loaded *loaded = &material->loaded;
	loaded->layers = layers;
	loaded->log_rmse = head.layers[layers - 1].fidelity.log_rmse;
	loaded->read_bytes = record_bytes_needed(&head, layers);
	loaded->memory_bytes = sizeof *material + table_bytes(material->table) +
	                       (material->sampler ? sampler_bytes(material->sampler) + albedo_cache_bytes() : 0);
	*out = material;
	return BP_OK;
}

void bp_material_free(bp_material *material)
{
	if (!material)
		return;
	const bp_allocator allocator = material->allocator; /* it outlives what it lies in */
	const bp_allocator *before = allocator_enter(&allocator);
	table_free(material->table);
	sampler_free(material->sampler);
	albedo_cache_free(material->albedo);
	memory_free_kept(material);
	memory_allocator_set(before);
}

bp_status bp_material_loaded(const bp_material *material, bp_loaded *loaded, bp_error *error)
{
	if (loaded->struct_bytes != sizeof *loaded)
		return error_argument(error, "struct_bytes is %zu, not sizeof(bp_loaded) = %zu", loaded->struct_bytes, sizeof *loaded);
	*loaded = material->loaded;
	return BP_OK;
}

void bp_material_evaluate(const bp_material *material, const float wi[3], const float wo[3], float rgb[3])
{
	table_evaluate(material->table, wi, wo, rgb);
}

void bp_material_nearest(const bp_material *material, const float wi[3], const float wo[3], float rgb[3])
{
	table_nearest(material->table, wi, wo, rgb);
}

void bp_material_evaluate_batch(const bp_material *material, size_t count, const float *const wi[3], const float *const wo[3],
                                float *const rgb[3])
{
	if (count > 0)
		table_evaluate_batch(material->table, count, wi, wo, rgb);
}

float bp_material_sample(const bp_material *material, const float wo[3], const float u[3], float wi[3])
{
	if (material->sampler)
		return sampler_draw(material->sampler, wo, u, wi);
	wi[0] = wi[1] = wi[2] = 0;
	return 0;
}

float bp_material_pdf(const bp_material *material, const float wi[3], const float wo[3])
{
	return material->sampler ? sampler_pdf(material->sampler, wi, wo) : 0;
}

void bp_material_albedo(const bp_material *material, float theta_o, float rgb[3])
{
	if (material->albedo)
		albedo_cached(material->albedo, material->table, theta_o, rgb);
	else
		rgb[0] = rgb[1] = rgb[2] = 0;
}

void bp_material_sample_batch(const bp_material *material, size_t count, const float *const wo[3], const float *const u[3],
                              float *const wi[3], float *pdf)
{
	for (size_t n = 0; n < count; n++) {
		float in[3];
		pdf[n] = bp_material_sample(material, (const float[]){wo[0][n], wo[1][n], wo[2][n]},
		                            (const float[]){u[0][n], u[1][n], u[2][n]}, in);
		for (int c = 0; c < 3; c++)
			wi[c][n] = in[c];
	}
}

void bp_material_pdf_batch(const bp_material *material, size_t count, const float *const wi[3], const float *const wo[3],
                           float *pdf)
{
	for (size_t n = 0; n < count; n++)
		pdf[n] = bp_material_pdf(material, (const float[]){wi[0][n], wi[1][n], wi[2][n]},
		                         (const float[]){wo[0][n], wo[1][n], wo[2][n]});
}

bp_status bp_material_albedo_table(const bp_material *material, size_t count, float *rgb, bp_error *error)
{
	if (count < 1 || count > ALBEDO_TABLE_MAX || !rgb)
		return error_argument(error, "an albedo table has 1 to %d entries, not %zu", ALBEDO_TABLE_MAX, count);
	if (!material->albedo)
		return error_argument(error, "the material was loaded without sampling, so it has no albedo");
	for (size_t n = 0; n < count; n++)
		bp_material_albedo(material, (float)acos(((double)n + 0.5) / (double)count), rgb + 3 * n);
	return BP_OK;
}
