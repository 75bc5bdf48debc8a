/*
 * origin.h: what kind of file a lattice was read from, and what was done to make a reciprocal table of it.
 */
#ifndef MERL_ORIGIN_H
#define MERL_ORIGIN_H

#include <stdint.h>

enum origin_kind {
	ORIGIN_MERL = 0,        /* a table as it is; the fields below are 0 */
	ORIGIN_RGL_RGB = 1,     /* a tensor file of the RGL database, red, green and blue as they are there */
	ORIGIN_RGL_SPECTRA = 2, /* the same by wavelength: made linear RGB for CIE 1931 2 degrees, D65, ITU-R BT.709 (rgl/colour.h) */
	ORIGIN_TWO_HALVES = 3   /* a MERL-like table with phi_d from 0 to 2 pi: the mean of its halves */
};

struct origin {
	enum origin_kind kind;
	uint32_t wavelengths;        /* of spectra */
	double first_nm, last_nm;    /* of spectra */
	uint64_t compared;           /* cells of which both directions were there */
	double median, percentile95; /* over these, of |a - b| / ((a + b) / 2), a and b the channels' mean in the two directions */
};

enum { RECIPROCITY_BINS = 2000 };

/* How often that, 0 to 2, fell into each step of 1/1000. Start from a zeroed struct. */
struct reciprocity {
	uint64_t bins[RECIPROCITY_BINS + 1];
	uint64_t count;
};

/* One pair of values, not negative. */
void reciprocity_add(struct reciprocity *reciprocity, double a, double b);

/* Sets compared, median and percentile95, each to the middle of its step; 0 where nothing was compared. */
void reciprocity_tell(const struct reciprocity *reciprocity, struct origin *origin);

#endif
