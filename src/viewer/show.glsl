// show.glsl: sums of light -> the screen: one material, two split by a line, or their difference times ten.
uniform highp sampler2D a, b;
uniform float exposure, split;   // split: in pixels
uniform int mode;                // 0 a, 1 a | b, 2 difference, 3 b
uniform vec2 origin;             // lower left corner of what is drawn
out vec4 colour;

vec3 srgb(vec3 linear)
{
	vec3 x = clamp(linear, 0.0, 1.0);
	return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, vec3(lessThanEqual(x, vec3(0.0031308))));
}

void main()
{
	ivec2 at = ivec2(gl_FragCoord.xy - origin);
	vec4 x = texelFetch(a, at, 0), y = texelFetch(b, at, 0);
	vec3 left = srgb(x.rgb * exposure), right = srgb(y.rgb * exposure);
	vec3 shown = mode == 0 ? left : mode == 3 ? right : mode == 1 ? (float(at.x) < split ? left : right) : 10.0 * abs(left - right);
	if (mode == 1 && abs(float(at.x) - split) < 0.75)
		shown = vec3(1.0);
	colour = vec4(shown, max(x.a, y.a) > 0.0 ? 1.0 : 0.0);
}
