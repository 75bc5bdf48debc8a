"use strict";
// Directions, and the polar plot of what is under the pointer.

const DECADES = 5, RADIUS = 150, DEGREE = Math.PI / 180;
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, s) => a.map((x) => x * s);
const unit = (a) => scaled(a, 1 / Math.hypot(...a));

// theta_h, theta_d, phi_d in degrees of unit directions in the local frame; as brdf_place in brdfpack.glsl.
function halfDifference(wi, wo) {
	const s = wi.map((x, n) => x + wo[n]), d = wi.map((x, n) => x - wo[n]), length = Math.hypot(...s);
	let phi = Math.atan2(s[0] * d[1] - s[1] * d[0], -d[2] * length);
	if (phi < 0) phi += Math.PI;
	return [Math.atan2(Math.hypot(s[0], s[1]), s[2]), Math.atan2(Math.hypot(...d), length), phi].map((angle) => angle / DEGREE);
}

// wi and wo in the frame of the normal n, wi in the plane of x and z on the side of negative x.
function localPair(n, wi, wo) {
	const flat = wi.map((x, k) => x - dot(wi, n) * n[k]), x = Math.hypot(...flat) > 1e-6 ? unit(scaled(flat, -1)) : unit(cross(Math.abs(n[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0], n));
	const y = cross(n, x);
	return [[dot(wi, x), dot(wi, y), dot(wi, n)], [dot(wo, x), dot(wo, y), dot(wo, n)]];
}

// f cos theta_o in the plane of incidence, mean of the channels: [[theta_o in degrees, value]]
function polarCurve(material, wi) {
	const angles = Array.from({ length: 357 }, (_, n) => -89 + n / 2), pairs = new Float32Array(6 * angles.length);
	angles.forEach((angle, n) => pairs.set([...wi, Math.sin(angle * DEGREE), 0, Math.cos(angle * DEGREE)], 6 * n));
	const rgb = material.evaluate(pairs);
	return angles.map((angle, n) => [angle, (rgb[3 * n] + rgb[3 * n + 1] + rgb[3 * n + 2]) / 3 * Math.cos(angle * DEGREE)]);
}

class PolarPlot {
	constructor(find) {
		this.find = find;
		this.top = null;
	}
	grid(top) {
		if (this.top === top) return;
		this.top = top;
		let text = `<path class=axis d="M${-RADIUS} 0H${RADIUS}"/>`;
		for (let n = 1; n <= DECADES; n++) {
			const r = RADIUS * n / DECADES;
			text += `<path class=grid d="M${-r} 0A${r} ${r} 0 0 1 ${r} 0"/><text class=tick x=${r} y=12>1e${top - DECADES + n}</text>`;
		}
		this.find("v-grid").innerHTML = text;
	}
	// curves: by slot, or missing; theta: where wo stands, in degrees
	draw(curves, theta) {
		const most = Math.max(1e-30, ...Object.values(curves).flat().map(([, value]) => value));
		this.grid(Math.ceil(Math.log10(most)));
		for (const slot of ["a", "b"]) {
			const points = (curves[slot] || []).map(([angle, value]) => {
				const r = value > 0 ? RADIUS * Math.max(0, (Math.log10(value) - this.top + DECADES) / DECADES) : 0;
				return `${(r * Math.sin(angle * DEGREE)).toFixed(1)} ${(-r * Math.cos(angle * DEGREE)).toFixed(1)}`;
			});
			this.find("v-curve-" + slot).setAttribute("d", points.length ? "M" + points.join("L") : "");
		}
		this.find("v-at").setAttribute("d", `M0 0L${(RADIUS * Math.sin(theta * DEGREE)).toFixed(1)} ${(-RADIUS * Math.cos(theta * DEGREE)).toFixed(1)}`);
	}
}
