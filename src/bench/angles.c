#include "angles.h"

static double below(double x, uint32_t extent)
{
	double last = nextafter((double)extent, 0);

	return x < 0 ? 0 : x > last ? last : x;
}

void lattice_coordinates(struct lattice_dims dims, const double wi[3], const double wo[3], double out[3])
{
	double x = wi[0] + wo[0], y = wi[1] + wo[1], z = wi[2] + wo[2];
	double inverse = 1 / sqrt(x * x + y * y + z * z), across = sqrt(x * x + y * y);
	double cos_h = z * inverse, sin_h = across * inverse;
	double cos_d = (wi[0] * x + wi[1] * y + wi[2] * z) * inverse;
	double c = across > 0 ? x / across : 1, s = across > 0 ? y / across : 0;
	/* wi turned by -phi_h about z, then by -theta_h about y: h becomes the pole */
	double ax = c * wi[0] + s * wi[1], ay = c * wi[1] - s * wi[0];
	double phi = atan2(ay, cos_h * ax - sin_h * wi[2]);

	if (phi < 0)
		phi += M_PI;
	out[0] = below(sqrt(acos(fmin(1, cos_h)) / M_PI_2) * dims.theta_h, dims.theta_h);
	out[1] = below(acos(fmin(1, cos_d)) / M_PI_2 * dims.theta_d, dims.theta_d);
	out[2] = phi / M_PI * dims.phi_d;
	if (!(out[2] < dims.phi_d))
		out[2] -= dims.phi_d;
	out[2] = below(out[2], dims.phi_d);
}
