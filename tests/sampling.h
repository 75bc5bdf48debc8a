/*
 * sampling.h: oracles for tests of sampling, written in double, in the half-angle's own coordinates; they know nothing of the
 * sampler's tables.
 */
#ifndef TESTS_SAMPLING_H
#define TESTS_SAMPLING_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <gsl/gsl_cdf.h>

#include "model/sample/albedo.h"
#include "model/sample/sample.h"
#define RANDOM_SEED 13
#include "random.h"

#define ORACLE __attribute__((unused)) static

struct material {
	struct table *table;
	struct sampler *sampler;
};

ORACLE void release(struct material *m)
{
	table_free(m->table);
	sampler_free(m->sampler);
}

ORACLE const double DEGREES[] = {0, 2, 20, 45, 70, 84, 89, 89.8};
enum { ANGLES = sizeof DEGREES / sizeof *DEGREES };
ORACLE const struct lattice_dims SMALL = {90, 30, 36};

/* wo at this polar angle, at some azimuth */
ORACLE void outgoing(double degrees, float wo[3])
{
	double theta = degrees * M_PI / 180;
	wo[0] = (float)(sin(theta) * cos(0.7));
	wo[1] = (float)(sin(theta) * sin(0.7));
	wo[2] = (float)cos(theta);
}

/* The largest theta_h with wi above the horizon. */
ORACLE double horizon(double theta_o, double phi) { return M_PI_4 + 0.5 * atan2(sin(theta_o) * cos(phi), cos(theta_o)); }

/* wi of the half-angle (theta_h, phi) in the frame of wo; returns dw_i/dw_h = 4 (wo.h) */
ORACLE double reflect(double theta_o, double theta_h, double phi, float wi[3])
{
	double h[3] = {sin(theta_h) * cos(phi), sin(theta_h) * sin(phi), cos(theta_h)}, o[3] = {sin(theta_o), 0, cos(theta_o)};
	double dot = h[0] * o[0] + h[2] * o[2], x = 2 * dot * h[0] - o[0], y = 2 * dot * h[1], z = 2 * dot * h[2] - o[2];
	wi[0] = (float)(x * cos(0.7) - y * sin(0.7));
	wi[1] = (float)(x * sin(0.7) + y * cos(0.7));
	wi[2] = (float)z;
	return 4 * dot;
}

/* Integral of the density over theta_h from a to b (as shares of its range, squared) and phi from c to d. */
ORACLE double integrate(const struct sampler *s, double degrees, double a, double b, double c, double d, int steps_h,
                        int steps_phi)
{
	double theta_o = degrees * M_PI / 180, sum = 0;
	float wo[3], wi[3];
	outgoing(degrees, wo);
	for (int p = 0; p < steps_phi; p++) {
		double phi = c + (p + 0.5) / steps_phi * (d - c), top = horizon(theta_o, phi);
		for (int n = 0; n < steps_h; n++) {
			double q0 = a + (b - a) * n / steps_h, q1 = a + (b - a) * (n + 1) / steps_h, q = 0.5 * (q0 + q1);
			double area = 2 * (pow(sin(0.5 * top * q1 * q1), 2) - pow(sin(0.5 * top * q0 * q0), 2)) * (d - c) / steps_phi;
			double jacobian = reflect(theta_o, top * q * q, phi, wi);
			if (wi[2] > 0)
				sum += (double)sampler_pdf(s, wi, wo) * jacobian * area;
		}
	}
	return sum;
}

/* Integral over all half-angles whose wi is above the horizon; the steps share the edges that sample.h states, where the density jumps. */
ORACLE double integrate_all(const struct sampler *s, double degrees)
{
	enum { STEPS = 64 * 6, PHIS = 16 * 12 };
	double theta_o = degrees * M_PI / 180, sum = 0;
	float wo[3], wi[3];
	outgoing(degrees, wo);
	for (int p = 0; p < PHIS; p++) {
		double phi = 2 * M_PI * (p + 0.5) / PHIS, top = pow(sin(0.5 * horizon(theta_o, phi)), 2);
		for (int n = 0; n < STEPS; n++) {
			double from = 0.5 * pow((double)n / STEPS, 4), to = fmin(top, 0.5 * pow((n + 1.0) / STEPS, 4));
			if (from >= top)
				break;
			double jacobian = reflect(theta_o, 2 * asin(sqrt(0.5 * (from + to))), phi, wi);
			if (wi[2] > 0)
				sum += (double)sampler_pdf(s, wi, wo) * jacobian * 2 * (to - from) * 2 * M_PI / PHIS;
		}
	}
	return sum;
}

/*
 * Bins of phi and of sqrt(theta_h / its largest), a prime number of each so that they share no edge with the tables;
 * 32 quadrature steps in each bin of phi do, because a retroreflector's density jumps there; 60 in each of the others for a
 * mirror's, near the horizon: with 20 the probabilities of what is right come out too small.
 */
enum { CHI_PHI = 13, CHI_H = 19, CHI_BINS = CHI_PHI * CHI_H, SAMPLES = 40000 };

/* Samples of one sampler against the density of another: the same one, but for the test of this test. */
ORACLE double chi_square_probability(const struct sampler *drawn, const struct sampler *s, double degrees)
{
	double theta_o = degrees * M_PI / 180, count[CHI_BINS] = {0}, expected[CHI_BINS], rest_count = 0, rest = 0, chi = 0;
	float wo[3], wi[3];
	int bins = 0;
	outgoing(degrees, wo);
	for (int n = 0; n < SAMPLES; n++) {
		const float u[3] = {(float)uniform(), (float)uniform(), (float)uniform()};
		assert_true(sampler_draw(drawn, wo, u, wi) > 0);
		double h[3], length = 0;
		for (int c = 0; c < 3; c++) {
			h[c] = (double)wi[c] + (double)wo[c];
			length += h[c] * h[c];
		}
		double theta_h = asin(fmin(1, hypot(h[0], h[1]) / sqrt(length))), phi = atan2(h[1], h[0]) - 0.7;
		phi -= 2 * M_PI * floor(phi / (2 * M_PI));
		double q = sqrt(theta_h / horizon(theta_o, phi));
		int a = (int)(phi / (2 * M_PI) * CHI_PHI), b = (int)(q * CHI_H);
		count[(a < CHI_PHI ? a : CHI_PHI - 1) * CHI_H + (b < CHI_H ? b : CHI_H - 1)]++;
	}
	for (int a = 0; a < CHI_PHI; a++)
		for (int b = 0; b < CHI_H; b++)
			expected[a * CHI_H + b] = SAMPLES * integrate(s, degrees, (double)b / CHI_H, (double)(b + 1) / CHI_H,
			                                              2 * M_PI * a / CHI_PHI, 2 * M_PI * (a + 1) / CHI_PHI, 60, 32);
	for (int n = 0; n < CHI_BINS; n++)
		if (expected[n] < 8) {
			rest += expected[n];
			rest_count += count[n];
		} else {
			chi += pow(count[n] - expected[n], 2) / expected[n];
			bins++;
		}
	if (rest > 8) {
		chi += pow(rest_count - rest, 2) / rest;
		bins++;
	}
	return gsl_cdf_chisq_Q(chi, bins - 1);
}

/* The albedo by quadrature over the half-angle: mean(R, G, B) cos theta_i. */
ORACLE double quadrature(const struct material *m, double degrees)
{
	enum { STEPS = 500, TURNS = 180 };
	double theta_o = degrees * M_PI / 180, sum = 0;
	float wo[3], wi[3], rgb[3];
	outgoing(degrees, wo);
	for (int p = 0; p < TURNS; p++) {
		double phi = 2 * M_PI * (p + 0.5) / TURNS, top = horizon(theta_o, phi);
		for (int n = 0; n < STEPS; n++) {
			double q0 = (double)n / STEPS, q1 = (n + 1.0) / STEPS, q = 0.5 * (q0 + q1);
			double area = 2 * (pow(sin(0.5 * top * q1 * q1), 2) - pow(sin(0.5 * top * q0 * q0), 2)) * 2 * M_PI / TURNS;
			double jacobian = reflect(theta_o, top * q * q, phi, wi);
			if (!(wi[2] > 0))
				continue;
			table_evaluate(m->table, wi, wo, rgb);
			sum += ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3 * (double)wi[2] * jacobian * area;
		}
	}
	return sum;
}

/* Mean and relative standard deviation of mean(R, G, B) cos / pdf */
ORACLE void weights(const struct material *m, const float wo[3], int count, int cosine_only, double *mean, double *deviation)
{
	double sum = 0, squares = 0;
	for (int n = 0; n < count; n++) {
		float wi[3], rgb[3];
		const float u[3] = {(float)uniform(), (float)uniform(), (float)uniform()};
		double pdf;
		if (cosine_only) {
			float r = sqrtf(u[0]), phi = 6.2831853f * u[1];
			wi[0] = r * cosf(phi);
			wi[1] = r * sinf(phi);
			wi[2] = sqrtf(1 - u[0]);
			pdf = (double)wi[2] / M_PI;
		} else {
			float p = sampler_draw(m->sampler, wo, u, wi);
			assert_true(p > 0 && p < INFINITY);
			assert_true(wi[2] > 0);
			assert_true(fabsf(wi[0] * wi[0] + wi[1] * wi[1] + wi[2] * wi[2] - 1) < 3e-6f);
			assert_true(p == sampler_pdf(m->sampler, wi, wo));
			pdf = (double)p;
		}
		table_evaluate(m->table, wi, wo, rgb);
		double weight = ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3 * (double)wi[2] / pdf;
		assert_true(isfinite(weight) && weight >= 0);
		sum += weight;
		squares += weight * weight;
	}
	*mean = sum / count;
	*deviation = sqrt(fmax(0, squares / count - *mean * *mean)) / *mean;
}

#endif
