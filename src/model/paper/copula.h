/*
 * copula.h: pair-copula densities on the measuring lattice, as exact ratios of the means of marginal.h:
 *
 *     c_hd    = hd_ij/(h_i d_j)
 *     c_hphi  = hphi_ik/(h_i phi_k)
 *     c_dphi|h = v_ijk h_i/(hd_ij hphi_ik)         of slice i
 *
 * so that K h_i d_j phi_k c_hd c_hphi c_dphi|h = K v_ijk for every valid cell (the paper's eq. 7). All are 1
 * where the angles are independent.
 *
 * A ratio is undefined where a mean in it is undefined, and where its denominator is 0: then the density is 0
 * for every value of it, so nothing is lost by treating it as missing.
 */
#ifndef MODEL_PAPER_COPULA_H
#define MODEL_PAPER_COPULA_H

#include "marginal.h"

/* theta_h x theta_d values, row-major; defined = 0 where undefined (the value is then 0). */
void copula_hd(const struct density *density, double *value, uint8_t *defined);
/* theta_h x phi_d. */
void copula_hphi(const struct density *density, double *value, uint8_t *defined);
/* theta_d x phi_d, of slice i. */
void copula_slice(const struct density *density, uint32_t i, double *value, uint8_t *defined);
/*
 * One copula for the slices from..theta_h-1: the ratio of the sums of numerators and denominators over the slices in
 * which the cell is valid, that is, the mean of their copulas weighted by what independence predicts there.
 */
void copula_shared(const struct density *density, uint32_t from, double *value, uint8_t *defined);

#endif
