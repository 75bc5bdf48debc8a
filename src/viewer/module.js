"use strict";
// The reader as WebAssembly, and the places that archives come from. Works in a browser and in Node.

// A place that gives ranges of bytes when it is asked: `get(from, end)` is a promise of them. What came is kept.
class RangeSource {
	constructor(name, size, get) {
		this.name = name;
		this.size = size;
		this.get = get;
		this.pieces = []; // {from, bytes}, newest first
		this.wanted = null;
		this.fetched = 0;
	}
	find(from, end) {
		return this.pieces.find((piece) => piece.from <= from && end <= piece.from + piece.bytes.length);
	}
	read(offset, to) {
		const piece = this.find(offset, offset + to.length);
		if (!piece) {
			this.wanted = [offset, offset + to.length];
			return false;
		}
		to.set(piece.bytes.subarray(offset - piece.from, offset - piece.from + to.length));
		return true;
	}
	async load(from, end) {
		if (this.find(from, end)) return;
		const bytes = await this.get(from, end);
		if (bytes.length !== end - from) throw new Error(`${this.name}: ${bytes.length} bytes came for ${end - from}`);
		this.fetched += bytes.length;
		this.pieces.unshift({ from, bytes });
	}
}

// A place with all its bytes at hand.
class MemorySource extends RangeSource {
	constructor(name, bytes) {
		super(name, bytes.length);
		this.pieces.push({ from: 0, bytes });
	}
}

// An archive on a web server. `notice` is told when the server has no ranges: then the whole file is read, once.
async function serverSource(name, url, notice) {
	const first = 64 + 4096;
	const get = async (from, end) => {
		const answer = await fetch(url, { headers: { Range: `bytes=${from}-${end - 1}` }, cache: "no-store" });
		if (!answer.ok) throw new Error(`${name}: the server says ${answer.status} ${answer.statusText}`);
		return answer;
	};
	const answer = await get(0, first);
	const total = /\/(\d+)$/.exec(answer.headers.get("Content-Range") || "");
	if (answer.status !== 206 || !total) {
		notice(`The server of ${name} gives no ranges of bytes: the whole file was read.`);
		const source = new MemorySource(name, new Uint8Array(await answer.arrayBuffer()));
		source.fetched = source.size;
		return source;
	}
	const source = new RangeSource(name, Number(total[1]), async (from, end) => new Uint8Array(await (await get(from, end)).arrayBuffer()));
	const bytes = new Uint8Array(await answer.arrayBuffer());
	source.fetched = bytes.length;
	source.pieces.push({ from: 0, bytes });
	return source;
}

// A failure of the reader: status as in brdfpack.h, offset in the file or -1.
class ReaderError extends Error {
	constructor(status, offset, message) {
		super(message);
		this.status = status;
		this.offset = offset;
	}
}

class Reader {
	// `code`: the bytes of viewer.wasm
	static async make(code) {
		const reader = new Reader();
		const module = await WebAssembly.compile(code), imports = {};
		for (const { module: from, name } of WebAssembly.Module.imports(module)) {
			const known = { viewer_read: (...a) => reader.read(...a), emscripten_notify_memory_growth: () => {} }[name];
			(imports[from] = imports[from] || {})[name] = known || (() => { throw new Error(`the reader called ${name}, which a page does not have`); });
		}
		reader.calls = (await WebAssembly.instantiate(module, imports)).exports;
		if (reader.calls._initialize) reader.calls._initialize();
		reader.sources = new Map();
		reader.next = 1;
		return reader;
	}
	read(number, offset, to, count) {
		const source = this.sources.get(number);
		return source && source.read(offset, new Uint8Array(this.calls.memory.buffer, to, count)) ? 0 : 1;
	}
	text(at) {
		const bytes = new Uint8Array(this.calls.memory.buffer, at);
		return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
	}
	failure() {
		return new ReaderError(this.calls.viewer_error_status(), this.calls.viewer_error_offset(), this.text(this.calls.viewer_error()));
	}
	// Calls until all the bytes that it wants are here; `bad` tells a failed result.
	async call(source, bad, run) {
		for (;;) {
			source.wanted = null;
			const result = run();
			if (!bad(result)) return result;
			if (!source.wanted) throw this.failure();
			await source.load(...source.wanted);
		}
	}
	async open(source) {
		const number = this.next++;
		this.sources.set(number, source);
		try {
			const handle = await this.call(source, (h) => h === 0, () => this.calls.viewer_archive_open(number, source.size));
			return new Archive(this, source, number, handle);
		} catch (error) {
			this.sources.delete(number);
			throw error;
		}
	}
	// A MERL file, as a material.
	measured(bytes) {
		const at = this.calls.viewer_alloc(bytes.length);
		if (!at) throw new Error("there is not enough memory for this file");
		new Uint8Array(this.calls.memory.buffer).set(bytes, at);
		const handle = this.calls.viewer_measured(at, bytes.length);
		this.calls.viewer_free(at);
		if (!handle) throw this.failure();
		return new Material(this, handle);
	}
	// Lights of `brdfpack render`: 0 key, 1 env, 2 point; [{at, weight, point}]
	lights(lighting) {
		const at = this.calls.viewer_alloc(4 * 5 * 400), count = this.calls.viewer_lights(lighting, at);
		const numbers = Array.from(new Float32Array(this.calls.memory.buffer, at, 5 * count));
		this.calls.viewer_free(at);
		return Array.from({ length: count }, (_, n) => ({ at: numbers.slice(5 * n, 5 * n + 3), weight: numbers[5 * n + 3], point: numbers[5 * n + 4] }));
	}
}

class Archive {
	constructor(reader, source, number, handle) {
		Object.assign(this, { reader, source, number, handle });
		this.count = reader.calls.viewer_archive_count(handle);
	}
	close() {
		this.reader.calls.viewer_archive_close(this.handle);
		this.reader.sources.delete(this.number);
	}
	async info(index) {
		const { reader, handle } = this;
		return JSON.parse(reader.text(await reader.call(this.source, (at) => at === 0, () => reader.calls.viewer_archive_info(handle, index))));
	}
	async find(name) {
		const { reader, handle } = this, bytes = new TextEncoder().encode(name);
		return reader.call(this.source, (index) => index < 0, () => {
			const at = reader.calls.viewer_alloc(bytes.length + 1), memory = new Uint8Array(reader.calls.memory.buffer);
			memory.set(bytes, at);
			memory[at + bytes.length] = 0;
			const index = reader.calls.viewer_archive_find(handle, at);
			reader.calls.viewer_free(at);
			return index;
		});
	}
	// info: of this material; layers 0: all of them
	async load(index, info, layers, preview) {
		const { reader, source, handle } = this, end = info.layers[(layers || info.layers.length) - 1].bytes;
		await source.load(info.offset, info.offset + end);
		return new Material(reader, await reader.call(source, (m) => m === 0, () => reader.calls.viewer_material_load(handle, index, layers, preview ? 1 : 0)));
	}
	async verify() {
		const { reader, handle } = this;
		await reader.call(this.source, (status) => status !== 0, () => reader.calls.viewer_archive_verify(handle));
	}
	// The decoded table of some layers: {dims, values}, values in the order R, G, B
	async table(index, layers) {
		const { reader, handle } = this, dims = reader.calls.viewer_alloc(12);
		try {
			const at = await reader.call(this.source, (a) => a === 0, () => reader.calls.viewer_table(handle, index, layers, dims));
			const extents = Array.from(new Uint32Array(reader.calls.memory.buffer, dims, 3));
			const values = new Float64Array(reader.calls.memory.buffer, at, 3 * extents[0] * extents[1] * extents[2]).slice();
			reader.calls.viewer_free(at);
			return { dims: extents, values };
		} finally {
			reader.calls.viewer_free(dims);
		}
	}
}

class Material {
	constructor(reader, handle) {
		Object.assign(this, { reader, handle });
		this.numbers = new Float32Array(reader.calls.memory.buffer, reader.calls.viewer_material_numbers(handle), 17).slice();
	}
	// A view that holds until the reader is called again.
	blocks() {
		const { calls } = this.reader;
		return new Uint8Array(calls.memory.buffer, calls.viewer_material_blocks(this.handle), calls.viewer_material_bytes(this.handle));
	}
	// pairs: Float32Array of wi, wo; returns R, G, B of each in 1/sr
	evaluate(pairs) {
		const { calls } = this.reader, count = pairs.length / 6, from = calls.viewer_alloc(36 * count), to = from + 24 * count;
		new Float32Array(calls.memory.buffer, from, pairs.length).set(pairs);
		calls.viewer_material_evaluate(this.handle, count, from, to);
		const rgb = new Float32Array(calls.memory.buffer, to, 3 * count).slice();
		calls.viewer_free(from);
		return rgb;
	}
	free() {
		this.reader.calls.viewer_material_free(this.handle);
		this.handle = 0;
	}
}

if (typeof module !== "undefined") module.exports = { MemorySource, RangeSource, Reader, ReaderError };
