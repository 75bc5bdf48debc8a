/* What the reading half makes of an archive, as checksums: the same from every way to compile it. */
#include <brdfpack.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint64_t sum; /* FNV-1a */

/* The low bytes of a number first, whatever the machine's order. */
static void sum_add(uint32_t number, size_t bytes)
{
	for (; bytes > 0; bytes--, number >>= 8)
		sum = (sum ^ (number & 255)) * 1099511628211u;
}

static int material_sum(const bp_archive *archive, uint64_t index, bp_error *error)
{
	bp_material_info info = {.struct_bytes = sizeof info};
	bp_table_options tables = {.struct_bytes = sizeof tables, .number = BP_NUMBER_HALF, .layout = BP_LAYOUT_INTERLEAVED};
	if (bp_archive_info(archive, index, &info, error))
		return 1;
	const size_t bytes = bp_table_bytes(info.theta_h, info.theta_d, info.phi_d, &tables);
	uint16_t *table = malloc(bytes);
	if (!table || bp_archive_table(archive, index, &tables, table, bytes, error)) {
		free(table);
		return 1;
	}
	for (size_t n = 0; n < bytes / sizeof *table; n++)
		sum_add(table[n], sizeof *table);
	free(table);
	for (int form = 0; form < 3; form++) {
		const bp_load_options options = {.struct_bytes = sizeof options, .form = (bp_form)form, .sampling = !index && !form};
		bp_material *material = NULL;
		if (bp_material_load(archive, index, &options, &material, error))
			return 1;
		for (int n = 0; n < 500; n++) {
			/* directions by arithmetic alone: another libm would give others */
			const float x = (float)(n % 23) / 23, y = (float)(n % 19) / 19 - 0.5f, wo[3] = {x, y, 1.01f - x};
			const float u[3] = {(float)(n % 17) / 17, (float)(n % 13) / 13, (float)(n % 11) / 11}, wi[3] = {y, x - 0.5f, 0.3f};
			float rgb[3];
			bp_material_evaluate(material, wi, wo, rgb);
			for (int c = 0; c < 3; c++) {
				uint32_t bits;
				memcpy(&bits, &rgb[c], sizeof bits);
				sum_add(bits, sizeof bits);
			}
			if (!options.sampling) /* one is enough: its tables take seconds where every instruction is translated */
				continue;
			const float pdf = bp_material_pdf(material, wi, wo);
			if (!(pdf > 0 && isfinite(pdf) && bp_material_sample(material, wo, u, rgb) > 0)) {
				snprintf(error->message, sizeof error->message, "a density that is none");
				return 1;
			}
		}
		bp_material_free(material);
	}
	return 0;
}

int main(int argc, char **argv)
{
	bp_archive *archive = NULL;
	bp_error error;
	if (argc != 2)
		return 2;
	sum = 14695981039346656037u;
	int bad = bp_archive_open(argv[1], &archive, &error) != BP_OK;
	bad = bad || bp_archive_verify(archive, BP_VERIFY_DEEP, NULL, NULL, &error) != BP_OK;
	for (uint64_t i = 0; !bad && i < bp_archive_count(archive); i++)
		bad = material_sum(archive, i, &error);
	if (bad)
		fprintf(stderr, "%s: %s\n", argv[1], error.message);
	else
		printf("%llu materials, %016llx\n", (unsigned long long)bp_archive_count(archive), (unsigned long long)sum);
	bp_archive_close(archive);
	return bad;
}
