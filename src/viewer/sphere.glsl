// sphere.glsl: adds the light of some sources to what was there before: a sphere as `brdfpack render` draws it, or a floor at grazing angle.
// Follows brdfpack.glsl.
#define LIGHTS 32
uniform highp usampler2D blocks;
uniform highp sampler2D before;  // the sum so far
uniform Brdf brdf;
uniform int scene;               // 0 sphere, 1 floor
uniform float size;              // pixels
uniform float tilt;              // of the camera over the floor
uniform int count;
uniform vec4 light[LIGHTS];      // xyz: towards it, or where it is; w: its weight
uniform float is_point[LIGHTS];
out vec4 sum;

// A frame with z along n.
mat3 frame(vec3 n)
{
	vec3 t = normalize(abs(n.y) < 0.9 ? cross(vec3(0.0, 1.0, 0.0), n) : cross(vec3(1.0, 0.0, 0.0), n));
	return mat3(t, cross(n, t), n);
}

void main()
{
	vec2 uv = gl_FragCoord.xy / size * 2.0 - 1.0;
	vec3 n, v, p;
	if (scene == 0) {
		float square = dot(uv, uv);
		if (square >= 0.99) {
			sum = vec4(0.0);
			return;
		}
		n = p = vec3(uv, sqrt(1.0 - square));
		v = vec3(0.0, 0.0, 1.0);
	} else { // a floor below an eye that looks along it
		vec3 eye = vec3(0.0, 0.35, 2.4), ray = normalize(vec3(0.55 * uv.x, 0.4 * uv.y - tilt, -1.0));
		if (ray.y >= -1e-3) {
			sum = vec4(0.0);
			return;
		}
		n = vec3(0.0, 1.0, 0.0);
		p = eye - ray * (eye.y / ray.y);
		v = -ray;
	}
	mat3 world = frame(n);
	vec3 wo = v * world, radiance = texelFetch(before, ivec2(gl_FragCoord.xy), 0).rgb;
	for (int l = 0; l < LIGHTS; l++) {
		if (l >= count)
			break;
		vec3 to = light[l].xyz - is_point[l] * p;
		float square = dot(to, to);
		vec3 wi = to * inversesqrt(square) * world;
		if (wi.z > 1e-3)
			radiance += brdf_evaluate(blocks, brdf, wi, wo) * wi.z * (light[l].w / mix(1.0, square, is_point[l]));
	}
	sum = vec4(radiance, 1.0);
}
