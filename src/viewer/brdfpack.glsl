// brdfpack.glsl: a material in the shading language of OpenGL ES 3.00 (WebGL 2). Take it into your own engine: nothing here
// depends on the rest of the viewer. format-spec/SHADING.md says how the texture and the uniforms are filled.
//
// A material is the compact table of the C library (src/model/table/compact.h), block for block: blocks of 32 bytes are two texels
// of RGBA32UI, BRDF_TEXTURE_WIDTH texels to a row. A look-up reads 8 texels.

#define BRDF_TEXTURE_WIDTH 1024

struct Brdf {
	vec3 extents;       // cells along theta_h, theta_d, phi_d
	vec2 stride;        // blocks from a pair of theta_d to the next, from a theta_h to the next
	vec2 block;         // cells of a block; cells between two share codes
	float first;        // where a stored value stands in its cell: at the centre, 1/2; in a preview at 1/4
	vec3 mix0, mix1, mix2; // what brings sums of red codes, of blue codes and of means to R, G, B in 1/sr
};

// Coordinates in cells of a pair of unit directions in the local frame, z along the normal (Rusinkiewicz 1998). By the half and the
// difference vector, without arc cosines, so that nothing is lost near the highlight.
vec3 brdf_place(Brdf b, vec3 wi, vec3 wo)
{
	vec3 s = wi + wo, d = wi - wo;
	float half_length = length(s);
	float theta_h = atan(length(s.xy), s.z), theta_d = atan(length(d), half_length);
	float y = s.x * d.y - s.y * d.x, x = -d.z * half_length;
	float phi_d = x == 0.0 && y == 0.0 ? 0.0 : atan(y, x);
	phi_d += phi_d < 0.0 ? 3.14159265 : 0.0; // reciprocity: the same material seen from the other side
	return b.extents * vec3(sqrt(theta_h * 0.636619772), theta_d * 0.636619772, phi_d * 0.318309886);
}

// One row of phi_d. Returns the weighted sums of red codes, of blue codes and of means.
vec3 brdf_row(highp usampler2D blocks, int at, int cell, float later, float place, vec2 weight)
{
	ivec2 texel = ivec2(2 * at % BRDF_TEXTURE_WIDTH, 2 * at / BRDF_TEXTURE_WIDTH);
	uvec4 a = texelFetch(blocks, texel, 0), c = texelFetch(blocks, texel + ivec2(1, 0), 0);
	// bytes 0 to 3: two 16-bit floats, the base and the step of the block's fourth roots
	float base = uintBitsToFloat((a.x & 0xffffu) << 14), step_ = uintBitsToFloat(a.x >> 16 << 14);
	// bytes 4 to 22: residuals of the block's cells, and of the next block's first
	int byte_ = 4 + cell, next = byte_ + 1;
	uint w0 = byte_ < 16 ? a[byte_ >> 2] : c[(byte_ >> 2) - 4], w1 = next < 16 ? a[next >> 2] : c[(next >> 2) - 4];
	vec2 root = base + step_ * vec2(float(w0 >> (8 * (byte_ & 3)) & 255u), float(w1 >> (8 * (next & 3)) & 255u));
	vec2 mean = root * root;
	mean *= mean * weight;
	// bytes 23 to 31: three times 12 bits of R/(R + G + B) and of B/(R + G + B)
	uint code0 = c.y >> 24 | (c.z & 0xffffu) << 8, code1 = c.z >> 16 | (c.w & 0xffu) << 16, code2 = c.w >> 8;
	uint from = later > 0.0 ? code1 : code0, to = later > 0.0 ? code2 : code1;
	float sum = mean.x + mean.y;
	return vec3(sum * mix(float(from & 4095u), float(to & 4095u), place), sum * mix(float(from >> 12), float(to >> 12), place), sum);
}

// f(wi, wo) in 1/sr; 0 where a direction is on or below the horizon.
vec3 brdf_evaluate(highp usampler2D blocks, Brdf b, vec3 wi, vec3 wo)
{
	if (wi.z <= 0.0 || wo.z <= 0.0)
		return vec3(0.0);
	vec3 at = brdf_place(b, wi, wo) - b.first, low = floor(at), part = at - low, last = b.extents - 1.0;
	// before the first and beyond the last centre of theta_h and theta_d the value stays; phi_d goes round
	vec2 h = clamp(vec2(low.x, low.x + 1.0), 0.0, last.x), d = clamp(vec2(low.y, low.y + 1.0), 0.0, last.y);
	float k = low.z < 0.0 ? last.z : min(low.z, last.z);
	float number = floor((k + 0.5) / b.block.x), cell = k - number * b.block.x, later = cell >= b.block.y ? 1.0 : 0.0;
	float place = (cell - later * b.block.y + part.z) / b.block.y;
	vec2 along = vec2(1.0 - part.z, part.z);
	vec3 sum = vec3(0.0);
	for (int n = 0; n < 4; n++) { // theta_h, theta_d and their next
		float i = n < 2 ? h.x : h.y, j = (n & 1) == 0 ? d.x : d.y, pair = floor(0.5 * j), odd = j - 2.0 * pair;
		float weight = (n < 2 ? 1.0 - part.x : part.x) * ((n & 1) == 0 ? 1.0 - part.y : part.y);
		int block = int(i * b.stride.y + pair * b.stride.x + 2.0 * number + odd);
		sum += brdf_row(blocks, block, int(cell), later, place, weight * along);
	}
	return max(vec3(0.0), sum.x * b.mix0 + sum.y * b.mix1 + sum.z * b.mix2);
}
