/*
 * stage.h: where the time of packing one material goes. Internal.
 *
 * A stage clock belongs to a thread. While none runs there, stage_enter costs one look at a pointer, so the functions
 * that lead through a fit say what they are about to do, always:
 *
 *     stage_enter(STAGE_TRANSFORM);         what comes now, until someone says otherwise
 *
 * Times are processor seconds of the thread: a busy machine disturbs them least, and waiting for a disk is not in them.
 */
#ifndef STAGE_H
#define STAGE_H

enum stage {
	STAGE_REST,       /* everything else */
	STAGE_READ,       /* file -> lattice: values and their validity */
	STAGE_CHECKSUM,   /* the source's SHA-256 */
	STAGE_CLEAN,      /* logarithms or weights, filling of holes, noise */
	STAGE_REGRESSION, /* colours */
	STAGE_TRANSFORM,  /* spectra and their rotation, or marginals and pairs, fitted by their wavelets */
	STAGE_CODE,       /* sections and head */
	STAGE_MEASURE,    /* decoding every layer and measuring its error */
	STAGE_COUNT
};

const char *stage_name(enum stage stage);

struct stage_clock {
	double seconds[STAGE_COUNT];
	enum stage now;
	double since;
};

/* Starts one at 0, in STAGE_REST; it must stay where it is until it is stopped. One at a time in a thread. */
void stage_clock_start(struct stage_clock *clock);
void stage_clock_stop(void);

extern _Thread_local struct stage_clock *stage_clock_running;
enum stage stage_switch(enum stage stage);

/* Returns the stage until now, for those that come back to it. */
static inline enum stage stage_enter(enum stage stage) { return stage_clock_running ? stage_switch(stage) : STAGE_REST; }

#endif
