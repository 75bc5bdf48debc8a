#include "upsampling.h"

const float UPSAMPLING_WAVELENGTHS[UPSAMPLING_COUNT] = {380, 405, 430, 455, 480, 505, 530, 555,
                                                        580, 605, 630, 655, 680, 705, 730, 755};

/*
 * r(l) and g(l) at these; b(l) is what is missing from 1. Found by minimising under those conditions; the sums behind them run
 * from 380 to 780 nm by 1 nm. tests/mitsuba_files.py looks them up in Mitsuba's own observer and illuminant.
 */
static const double RED[UPSAMPLING_COUNT] = {0.200854, 0.122827, 0.045984, 0, 0, 0, 0, 0, 0.117390, 0.928373, 1, 1, 1, 1, 1, 1};
static const double GREEN[UPSAMPLING_COUNT] = {0, 0, 0, 0, 0.204397, 0.898204, 1, 1, 0.826811, 0.067391, 0, 0, 0, 0, 0, 0};

void upsample(const float *rgb, size_t slices, size_t points, float *spectra)
{
	for (size_t slice = 0; slice < slices; slice++) {
		const float *red = rgb + 3 * slice * points, *green = red + points, *blue = green + points;
		for (size_t l = 0; l < UPSAMPLING_COUNT; l++)
			for (size_t n = 0; n < points; n++) {
				const double mixed = RED[l] * red[n] + GREEN[l] * green[n] + (1 - RED[l] - GREEN[l]) * blue[n];
				*spectra++ = (float)mixed;
			}
	}
}
