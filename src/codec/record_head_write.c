#include <float.h>
#include <math.h>
#include <string.h>

#include "bytes.h"
#include "record.h"

static void layers_write(struct byte_buffer *out, const struct record_head *head)
{
	for (uint32_t l = 0; l < head->layer_count; l++) {
		const struct record_layer *layer = &head->layers[l];
		write_u32(out, layer->bytes);
		write_f32(out, (float)fmin(layer->fidelity.seen_log_rmse, (double)FLT_MAX));
		write_f64(out, layer->fidelity.log_rmse);
		write_f64(out, layer->fidelity.cube_root_rmse);
		write_f64(out, layer->fidelity.largest_relative);
	}
}

static void sections_write(struct byte_buffer *out, const struct record_head *head)
{
	for (uint32_t i = 0; i < head->section_count; i++) {
		const struct record_section *entry = &head->sections[i];
		write_u16(out, entry->type);
		write_u16(out, entry->codec);
		write_u16(out, entry->version);
		write_u16(out, entry->layer);
		write_u16(out, entry->flags);
		write_u16(out, 0);
		write_u32(out, entry->offset);
		write_u32(out, entry->bytes);
		write_u32(out, entry->crc32);
		/* One bit pattern for "none", whatever NaN the processor made. */
		if (isnan(entry->error))
			write_u64(out, UINT64_C(0x7FF8000000000000));
		else
			write_f64(out, entry->error);
	}
}

static void colour_write(struct byte_buffer *out, const struct record_head *head)
{
	for (int c = 0; c < 3; c++) {
		write_f64(out, head->colour[c].diffuse);
		write_f64(out, head->colour[c].specular);
		write_f64(out, head->colour[c].rejected);
		write_u32(out, head->colour[c].iterations);
		write_u32(out, head->colour[c].converged);
	}
}

static void fixed_write(struct byte_buffer *out, const struct record_head *head)
{
	write_bytes(out, RECORD_MAGIC, RECORD_MAGIC_BYTES);
	write_u32(out, head->head_bytes);
	write_u32(out, head->record_bytes);
	write_u16(out, RECORD_VERSION);
	write_u16(out, (uint16_t)head->profile);
	write_u32(out, head->codec_version);
	write_u16(out, (uint16_t)head->dims.theta_h);
	write_u16(out, (uint16_t)head->dims.theta_d);
	write_u16(out, (uint16_t)head->dims.phi_d);
	write_u8(out, (uint8_t)strlen(head->name));
	write_u8(out, (uint8_t)head->layer_count);
	write_u16(out, (uint16_t)head->section_count);
	write_u16(out, (uint16_t)head->left_out);
	write_u32(out, head->options.budget_bytes);
	write_f64(out, head->options.max_error);
	write_u32(out, (uint32_t)head->options.effort);
	write_u32(out, head->source.hole_count | (uint32_t)head->options.zeros << HEAD_ZEROS_SHIFT);
	write_f64(out, head->horizon_limit);
	write_u64(out, head->source.bytes);
	write_bytes(out, head->source.sha256, SHA256_BYTES);
	write_u64(out, head->source.nonfinite_count);
}

void record_head_write(const struct record_head *head, struct byte_buffer *out)
{
	fixed_write(out, head);
	colour_write(out, head);
	layers_write(out, head);
	sections_write(out, head);
	write_bytes(out, head->name, strlen(head->name));
	if (!out->failed)
		write_u32(out, bytes_crc32(out->bytes, out->count));
}
