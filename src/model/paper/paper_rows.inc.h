/* paper_rows.inc.h: the rows of paper_expand.c. See paper_kernels.h. */

static void KERNEL(paper_row)(float row, const float *column, const float *dphi, size_t n, float *out)
{
	if (dphi)
		for (size_t k = 0; k < n; k++)
			out[k] = row * column[k] * dphi[k];
	else
		for (size_t k = 0; k < n; k++)
			out[k] = row * column[k];
}

static void KERNEL(paper_colour)(const float *achromatic, size_t n, const float diffuse[3], const float specular[3], float limit,
                                 float *const rgb[3])
{
	for (int c = 0; c < 3; c++) {
		const float a = diffuse[c], b = specular[c];
		float *restrict out = rgb[c];

		for (size_t k = 0; k < n; k++) {
			float v = a + b * achromatic[k];
			v = v > 0 ? v : 0;
			out[k] = v < limit ? v : limit;
		}
	}
}
