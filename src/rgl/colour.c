#include "colour.h"

#include <string.h>

enum { FIRST = 380, STEP = 5 };
static const double CIE[][4] = {
#include "cie_1931.inc.h"
};
enum { SAMPLES = sizeof CIE / sizeof *CIE };

/* ITU-R BT.709-6: chromaticities x, y of red, green and blue */
static const double PRIMARIES[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};

/* Inverse by cofactors; the primaries' matrix is far from singular. */
static void invert(double m[3][3], double out[3][3])
{
	const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
	                           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
	                           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++) {
			const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
			out[i][j] = (m[a][c] * m[b][d] - m[a][d] * m[b][c]) / determinant;
		}
}

/* XYZ -> RGB, so that `white` becomes (1, 1, 1). */
static void matrix_make(const double white[3], double out[3][3])
{
	double primaries[3][3], inverse[3][3];
	for (int c = 0; c < 3; c++) {
		primaries[0][c] = PRIMARIES[c][0] / PRIMARIES[c][1];
		primaries[1][c] = 1;
		primaries[2][c] = (1 - PRIMARIES[c][0] - PRIMARIES[c][1]) / PRIMARIES[c][1];
	}
	invert(primaries, inverse);
	for (int c = 0; c < 3; c++) {
		double power = 0; /* of the primary in the white */
		for (int k = 0; k < 3; k++)
			power += inverse[c][k] * white[k];
		for (int k = 0; k < 3; k++)
			out[c][k] = inverse[c][k] / power;
	}
}

/* Adds what the observer sees at a wavelength to the one or two given wavelengths that it lies between. */
static void spread(const double *wavelengths, size_t count, double at, const double seen[3], double *weights)
{
	size_t upper = 0;
	while (upper < count && wavelengths[upper] < at)
		upper++;
	if (upper == count)
		upper = count - 1;
	const size_t lower = upper && wavelengths[upper] > at ? upper - 1 : upper;
	const double width = wavelengths[upper] - wavelengths[lower];
	const double share = width > 0 ? (at - wavelengths[lower]) / width : 1;
	for (int c = 0; c < 3; c++) {
		weights[3 * upper + (size_t)c] += share * seen[c];
		weights[3 * lower + (size_t)c] += (1 - share) * seen[c];
	}
}

void colour_weights(const double *wavelengths, size_t count, double *weights)
{
	double white[3] = {0}, matrix[3][3];
	for (int n = 0; n < SAMPLES; n++)
		for (int c = 0; c < 3; c++)
			white[c] += CIE[n][c] * CIE[n][3];
	matrix_make(white, matrix);
	memset(weights, 0, 3 * count * sizeof *weights);
	for (int n = 0; n < SAMPLES; n++) {
		double seen[3] = {0};
		for (int c = 0; c < 3; c++)
			for (int k = 0; k < 3; k++)
				seen[c] += matrix[c][k] * CIE[n][k] * CIE[n][3];
		spread(wavelengths, count, FIRST + STEP * n, seen, weights);
	}
}
