/*
 * Tensor files from arbitrary bytes: the table of fields, the material, its function at some directions. The lattice is left out, which is
 * the same function 1,458,000 times over. Memory: no more than 16 times the file, beside a fixed part.
 */
#include <stdlib.h>

#include "rgl/rgl_material.h"

enum { MEMORY_FIXED = 1 << 18, MEMORY_TIMES = 16 };

static void value_check(const struct rgl_value *value)
{
	for (int c = 0; c < 3; c++)
		if (!(value->rgb[c] >= 0)) /* infinite may be: the lattice refuses such cells */
			abort();
	if (!(value->data >= -1e-6 && value->data <= 1 + 1e-6))
		abort();
}

/* Of which the fields' arrays are inside the file, and not larger than it together. */
static void table_check(const struct tensor_table *table, size_t count)
{
	uint64_t bytes = 0;
	for (uint32_t n = 0; n < table->count; n++) {
		const uint64_t size = table->field[n].count * tensor_type_bytes(table->field[n].type);
		if (table->field[n].offset > count || size > count - table->field[n].offset)
			abort();
		bytes += size;
	}
	if (bytes > count)
		abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
	struct tensor_table table;
	struct rgl_material material;
	if (tensor_table_parse(data, count, count, &table, NULL) != BP_OK)
		return 0;
	table_check(&table, count);
	if (rgl_material_make(data, &table, &material, NULL) != BP_OK)
		return 0;
	/* what a material keeps: floats for the file's numbers */
	const size_t kept = (material.ndf.height * material.ndf.width + material.sigma.height * material.sigma.width +
	                     4 * material.angles * material.height * material.width +
	                     material.vndf.slices * material.vndf.height * (2 * material.vndf.width + 1)) *
	                        sizeof(float) +
	                    material.angles * sizeof(double);
	if (kept > MEMORY_FIXED + MEMORY_TIMES * count)
		abort();
	for (int n = 0; n < 64; n++) {
		struct rgl_value value;
		rgl_evaluate(&material, n % 8 * 0.2, (n - 32) * 0.098, n / 8 * 0.2, 0.1 + 0.01 * n, &value);
		value_check(&value);
	}
	for (size_t angle = 0; angle < material.angles; angle++)
		if (!(rgl_samples_between(&material, angle, 0.1, 0.3) >= 0))
			abort();
	rgl_material_free(&material);
	return 0;
}
