/* paper_rows.inc.h: the rows of paper_expand.c. */

static void KERNEL(paper_row)(float row, const float *column, const float *dphi, size_t n, float *out)
{
	if (dphi)
		for (size_t k = 0; k < n; k++)
			out[k] = row * column[k] * dphi[k];
	else
		for (size_t k = 0; k < n; k++)
			out[k] = row * column[k];
}

static void KERNEL(paper_colour)(float diffuse, float specular, float limit, size_t n, float *out)
{
	for (size_t k = 0; k < n; k++) {
		float v = diffuse + specular * out[k];
		v = v > 0 ? v : 0;
		out[k] = v < limit ? v : limit;
	}
}
