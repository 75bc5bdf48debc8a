/*
 * archimedean_copula.h: two Archimedean copulas of three variables: C = psi(psi^-1(u) + psi^-1(v) + psi^-1(w)).
 *
 *     Frank     C = -log(1 - s) / alpha,  s = p q_u q_v q_w,  p = 1 - e^-alpha,  q_u = (1 - e^-alpha u) / p
 *               c = alpha^2 s (1 + s) / (1 - s)^3 e^-alpha(u + v + w) / ((1 - e^-alpha u)(1 - e^-alpha v)(1 - e^-alpha w))
 *     Clayton   C = (u^-alpha + v^-alpha + w^-alpha - 2)^(-1 / alpha)
 *               c = (1 + alpha)(1 + 2 alpha) (u v w)^-(alpha + 1) (u^-alpha + v^-alpha + w^-alpha - 2)^-(1 / alpha + 3)
 *
 * (Nelsen, An Introduction to Copulas, 2006, chapter 4.) alpha > 0; alpha -> 0 is independence.
 */
#ifndef BENCH_ARCHIMEDEAN_COPULA_H
#define BENCH_ARCHIMEDEAN_COPULA_H

enum archimedean_family { ARCHIMEDEAN_FRANK, ARCHIMEDEAN_CLAYTON, ARCHIMEDEAN_FAMILIES };

/* The density c; u, v, w in (0, 1). */
double archimedean_density(enum archimedean_family family, double alpha, double u, double v, double w);

/* What C needs of one coordinate u in [0, 1]: Frank 1 - e^-alpha u and e^-alpha u; Clayton u^-alpha. */
struct copula_edge {
	double a, b;
};
struct copula_edge copula_edge(enum archimedean_family family, double alpha, double u);

/* What does not depend on the cell. */
struct copula {
	enum archimedean_family family;
	double alpha, power; /* -1 / alpha */
	double p2, below;    /* Frank: p^2; e^-2 alpha - 2 e^-alpha */
};
struct copula copula_make(enum archimedean_family family, double alpha);

/* C itself. */
double copula_value(const struct copula *copula, struct copula_edge u, struct copula_edge v, struct copula_edge w);

/*
 * The integral of c over a cell, from the edges of it along each axis: the eight-corner difference of C. Its error is a few
 * 1e-15, absolute, so it is right also where the density is singular, and where there is next to none it may be below 0 by that
 * much. An axis whose edges descend turns its sign.
 */
double copula_cell_mass(const struct copula *copula, const struct copula_edge u[2], const struct copula_edge v[2],
                        const struct copula_edge w[2]);

#endif
