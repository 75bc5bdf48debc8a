// The WebAssembly reader against the test vectors: node tests/viewer_vectors.js BUILD
// Every archive of format-spec/vectors is judged as the README's table says, and every decoded value agrees with the library's
// (NAME.values, nine digits). Then, where BUILD has the demo archive, how long decoding takes beside the native tool.
"use strict";
const fs = require("fs"), path = require("path");
const { MemorySource, RangeSource, Reader } = require("../src/viewer/module.js");
const top = path.join(__dirname, ".."), vectors = path.join(top, "format-spec/vectors"), build = process.argv[2];
const STATUS = { ok: 0, "not an archive": 4, "unsupported version": 5, corrupt: 6, "checksum differs": 7 };
let count = 0, bad = 0;
const fail = (text) => { console.error("viewer_vectors: " + text); bad++; };

// As a page reads from a server: bytes come only when they were asked for.
const ranged = (name, bytes) => new RangeSource(name, bytes.length, async (from, end) => bytes.subarray(from, end));

async function judge(reader, file, verdict) {
	const bytes = new Uint8Array(fs.readFileSync(path.join(vectors, file)));
	for (const source of [new MemorySource(file, bytes), ranged(file, bytes)]) {
		count++;
		let status = 0;
		try {
			const archive = await reader.open(source);
			try { await archive.verify(); } finally { archive.close(); }
		} catch (error) {
			if (error.status === undefined) throw error;
			status = error.status;
		}
		if (status !== STATUS[verdict]) fail(`${file}: status ${status}, expected ${STATUS[verdict]} (${verdict})`);
	}
}

async function compare(reader, file) {
	const lines = fs.readFileSync(path.join(vectors, file), "utf8").split("\n"), name = file.replace(".values", ".bpk");
	const archive = await reader.open(new MemorySource(name, new Uint8Array(fs.readFileSync(path.join(vectors, name)))));
	for (let n = 0; n + 3 < lines.length; n += 4) {
		count++;
		const words = lines[n].split(" "), dims = words.slice(-3).map(Number), layers = Number(words.at(-4)), material = words.slice(0, -4).join(" ");
		const { dims: found, values } = await archive.table(await archive.find(material), layers);
		if (String(dims) !== String(found)) fail(`${file}: ${material}: extents ${found}, expected ${dims}`);
		const expected = lines.slice(n + 1, n + 4).join(" ").split(" ").map(Number);
		if (expected.length !== values.length) fail(`${file}: ${material}: ${values.length} values, expected ${expected.length}`);
		const far = expected.findIndex((value, cell) => !(Math.abs(values[cell] - value) <= 1e-6 * Math.abs(value)));
		if (far >= 0) fail(`${file}: ${material}, ${layers} layers, value ${far}: ${values[far]}, expected ${expected[far]}`);
	}
	archive.close();
}

async function time(reader, file) {
	const archive = await reader.open(new MemorySource(file, new Uint8Array(fs.readFileSync(file)))), info = await archive.info(0), seconds = [[], []];
	for (let run = 0; run < 9; run++)
		for (const preview of [0, 1]) {
			const start = process.hrtime.bigint();
			(await archive.load(0, info, preview, preview)).free();
			seconds[preview].push(Number(process.hrtime.bigint() - start) / 1e6);
		}
	const median = (list) => list.sort((a, b) => a - b)[list.length >> 1].toFixed(1);
	console.log(`loading in WebAssembly, compact: ${median(seconds[0])} ms all layers, ${median(seconds[1])} ms preview`);
	archive.close();
}

(async () => {
	const reader = await Reader.make(fs.readFileSync(path.join(build, "viewer/viewer.wasm")));
	for (const line of fs.readFileSync(path.join(vectors, "README.md"), "utf8").split("\n")) {
		const row = /^\| ([a-z-]*\.bpk) \| ([^|]*) \|/.exec(line);
		if (row) await judge(reader, row[1], row[2]);
	}
	for (const file of fs.readdirSync(vectors)) if (file.endsWith(".values")) await compare(reader, file);
	if (process.argv[3]) await time(reader, process.argv[3]);
	console.log(`viewer_vectors: ${count} comparisons, ${bad} failed`);
	process.exitCode = bad || count < 100 ? 1 : 0;
})();
