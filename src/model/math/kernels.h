/*
 * kernels.h: hot loops that are compiled twice or three times and chosen once.
 *
 * The loops of a wing are static functions KERNEL(name), in WING_kernels.inc.h or in files NAME.inc.h that it includes. It ends
 * in one table of function pointers, whose type is in WING_kernels.h; WING_kernels.c compiles that text for any processor,
 * WING_kernels_avx2.c for AVX2, and WING_kernels_avx512.c, where that gains something, for AVX-512.
 * To add a loop: write KERNEL(loop) in an .inc.h, add a member to WING_kernels.h and an initialiser to WING_kernels.inc.h.
 *
 * All tables give the same bits: no fused multiply-add, no reassociation by the compiler, and sums run over
 * a fixed number of lanes (vector.h) whatever the machine's vectors are.
 */
#ifndef MODEL_MATH_KERNELS_H
#define MODEL_MATH_KERNELS_H

/* Whether this processor runs the tables compiled for AVX2, for AVX-512 (F, BW, DQ, VL). Cheap; thread-safe. */
int kernels_avx2_usable(void);
int kernels_avx512_usable(void);

/* The tables of a wing, and WING_kernels_get(): the one for this processor. */
#define KERNELS_OF(wing) \
	extern const struct wing##_kernels wing##_kernels_plain, wing##_kernels_avx2; \
	static inline const struct wing##_kernels *wing##_kernels_get(void) \
	{ \
		return kernels_avx2_usable() ? &wing##_kernels_avx2 : &wing##_kernels_plain; \
	}
/* The same for a wing that has one for AVX-512 too. */
#define KERNELS_OF_THREE(wing) \
	extern const struct wing##_kernels wing##_kernels_plain, wing##_kernels_avx2, wing##_kernels_avx512; \
	static inline const struct wing##_kernels *wing##_kernels_get(void) \
	{ \
		return kernels_avx512_usable() ? &wing##_kernels_avx512 \
		       : kernels_avx2_usable() ? &wing##_kernels_avx2 \
		                               : &wing##_kernels_plain; \
	}

#endif
