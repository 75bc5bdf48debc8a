"use strict";
// WebGL 2: two materials, A and B, lit by any number of lights. Light adds up over frames, LIGHTS_A_PASS at a time.

const LIGHTS_A_PASS = 32, TEXTURE_WIDTH = 1024;

class Drawing {
	// canvas; text(name): a shader's text. Throws with a reason where the browser cannot.
	constructor(canvas, text) {
		const gl = canvas.getContext("webgl2", { antialias: false, premultipliedAlpha: true, preserveDrawingBuffer: true });
		if (!gl) throw new Error("This browser has no WebGL 2.");
		if (!gl.getExtension("EXT_color_buffer_float")) throw new Error("This browser's WebGL 2 cannot draw into float textures.");
		Object.assign(this, { canvas, gl, size: 0, materials: { a: null, b: null }, sums: {}, done: 0, lights: [] });
		this.scene = 0;
		this.tilt = 0.16;
		const head = "#version 300 es\nprecision highp float;\nprecision highp int;\n";
		const corner = head + "void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }";
		this.shade = this.program(corner, head + text("brdfpack.glsl") + text("sphere.glsl"));
		this.show = this.program(corner, head + text("show.glsl"));
		this.array = gl.createVertexArray();
		this.frame = gl.createFramebuffer();
	}
	program(vertex, fragment) {
		const { gl } = this, program = gl.createProgram();
		for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
			const shader = gl.createShader(kind);
			gl.shaderSource(shader, text);
			gl.compileShader(shader);
			if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error("shader: " + gl.getShaderInfoLog(shader));
			gl.attachShader(program, shader);
		}
		gl.linkProgram(program);
		if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error("shader: " + gl.getProgramInfoLog(program));
		const at = {};
		for (let n = 0; n < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); n++) {
			const name = gl.getActiveUniform(program, n).name;
			at[name] = gl.getUniformLocation(program, name);
		}
		return { program, at };
	}
	// A texture without filtering; rows of `width` texels.
	texture(width, height, format, kind, type, bytes) {
		const { gl } = this, texture = gl.createTexture();
		gl.bindTexture(gl.TEXTURE_2D, texture);
		gl.texImage2D(gl.TEXTURE_2D, 0, format, width, height, 0, kind, type, bytes);
		for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, gl.NEAREST], [gl.TEXTURE_MAG_FILTER, gl.NEAREST], [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
			gl.texParameteri(gl.TEXTURE_2D, name, value);
		return texture;
	}
	resize(size) {
		if (size === this.size) return;
		const { gl } = this;
		for (const slot of ["a", "b"]) {
			for (const texture of this.sums[slot] || []) gl.deleteTexture(texture);
			this.sums[slot] = [0, 1].map(() => this.texture(size, size, gl.RGBA32F, gl.RGBA, gl.FLOAT, null));
		}
		this.size = size;
		this.restart();
	}
	// slot "a" or "b"; material null: nothing there
	put(slot, material) {
		const { gl } = this, old = this.materials[slot];
		if (old) gl.deleteTexture(old.blocks);
		this.materials[slot] = null;
		if (material) {
			const bytes = material.blocks(), height = Math.ceil(bytes.length / (16 * TEXTURE_WIDTH)), padded = new Uint8Array(16 * TEXTURE_WIDTH * height);
			padded.set(bytes);
			const blocks = this.texture(TEXTURE_WIDTH, height, gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT, new Uint32Array(padded.buffer));
			this.materials[slot] = { blocks, numbers: material.numbers };
		}
		this.restart();
	}
	light(lights) {
		this.lights = lights;
		this.restart();
	}
	restart() {
		this.done = 0;
	}
	// The next lights' part of the sum. True when all of it is there.
	add() {
		const { gl, shade: { program, at } } = this, some = this.lights.slice(this.done, this.done + LIGHTS_A_PASS);
		gl.useProgram(program);
		gl.bindVertexArray(this.array);
		gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
		gl.viewport(0, 0, this.size, this.size);
		gl.uniform1i(at.blocks, 0);
		gl.uniform1i(at.before, 1);
		gl.uniform1i(at.scene, this.scene);
		gl.uniform1f(at.size, this.size);
		gl.uniform1f(at.tilt, this.tilt);
		gl.uniform1i(at.count, some.length);
		gl.uniform4fv(at["light[0]"], Float32Array.from({ length: 4 * LIGHTS_A_PASS }, (_, n) => {
			const light = some[n >> 2];
			return light ? (n & 3) < 3 ? light.at[n & 3] : light.weight : 0;
		}));
		gl.uniform1fv(at["is_point[0]"], Float32Array.from({ length: LIGHTS_A_PASS }, (_, n) => some[n] ? some[n].point : 0));
		for (const slot of ["a", "b"]) {
			const material = this.materials[slot], sums = this.sums[slot];
			if (this.done === 0) gl.bindTexture(gl.TEXTURE_2D, null);
			for (const sum of sums) { // the last one is drawn into
				gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, sum, 0);
				if (this.done === 0) gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]); // nothing before the first lights
			}
			if (!material) continue;
			const m = material.numbers;
			gl.uniform3f(at["brdf.extents"], m[0], m[1], m[2]);
			gl.uniform2f(at["brdf.stride"], m[3], m[4]);
			gl.uniform2f(at["brdf.block"], m[5], m[6]);
			gl.uniform1f(at["brdf.first"], m[7]);
			for (let n = 0; n < 3; n++) gl.uniform3fv(at[`brdf.mix${n}`], m.subarray(8 + 3 * n, 11 + 3 * n));
			gl.activeTexture(gl.TEXTURE1);
			gl.bindTexture(gl.TEXTURE_2D, sums[0]);
			gl.activeTexture(gl.TEXTURE0);
			gl.bindTexture(gl.TEXTURE_2D, material.blocks);
			gl.drawArrays(gl.TRIANGLES, 0, 3);
			sums.reverse(); // what was drawn is now what was before
		}
		this.done += some.length;
		return this.done >= this.lights.length;
	}
	// Linear light of slot a or b: Float32Array of RGBA, bottom row first.
	pixels(slot) {
		const { gl, size } = this, out = new Float32Array(4 * size * size);
		gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
		gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.sums[slot][0], 0);
		gl.readPixels(0, 0, size, size, gl.RGBA, gl.FLOAT, out);
		return out;
	}
	// As `brdfpack render` exposes: the 90th percentile of the covered pixels' means becomes 0.9.
	exposure(slot) {
		const pixels = this.pixels(slot), means = [];
		for (let n = 0; n < pixels.length; n += 4) if (pixels[n + 3] > 0) means.push((pixels[n] + pixels[n + 1] + pixels[n + 2]) / 3);
		means.sort((x, y) => x - y);
		return 0.9 / Math.max(1e-12, means.length ? means[Math.floor(0.9 * means.length)] : 0);
	}
	// mode: "a", "b", "split", "side" or "difference"; share: where the split is, 0 to 1
	present(mode, exposure, share) {
		const { gl, size, show: { program, at } } = this, wide = mode === "side" ? 2 : 1;
		if (this.canvas.width !== wide * size || this.canvas.height !== size) Object.assign(this.canvas, { width: wide * size, height: size });
		gl.bindFramebuffer(gl.FRAMEBUFFER, null);
		gl.useProgram(program);
		gl.bindVertexArray(this.array);
		for (const [unit, slot] of [[0, "a"], [1, "b"]]) {
			gl.activeTexture(gl.TEXTURE0 + unit);
			gl.bindTexture(gl.TEXTURE_2D, this.sums[slot][0]);
			gl.uniform1i(at[slot], unit);
		}
		gl.uniform1f(at.exposure, exposure);
		gl.uniform1f(at.split, share * size);
		for (let n = 0; n < wide; n++) {
			gl.viewport(n * size, 0, size, size);
			gl.uniform2f(at.origin, n * size, 0);
			gl.uniform1i(at.mode, mode === "side" ? (n ? 3 : 0) : { a: 0, split: 1, difference: 2, b: 3 }[mode]);
			gl.drawArrays(gl.TRIANGLES, 0, 3);
		}
		for (const unit of [0, 1]) {
			gl.activeTexture(gl.TEXTURE0 + unit);
			gl.bindTexture(gl.TEXTURE_2D, null); // nothing is read while it is drawn into
		}
	}
}
