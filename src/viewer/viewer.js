"use strict";
// The viewer's part of the page: which material is shown, how it is lit, and what the pointer does.

const NAMES_MAX = 1000, LAMP = unit([0.5, 0.6, 0.8]);

class Viewer {
	constructor() {
		this.find = (id) => document.getElementById(id);
		this.slots = { a: null, b: null }; // {archive, index, info, layers, material}
		this.turn = 0;
		this.lamp = LAMP;
		this.base = 1; // exposure before the slider
		this.turns = { a: 0, b: 0 }; // of show: the last one counts
		this.busy = 0;
	}
	say(text, warning) {
		const status = this.find("v-status");
		status.textContent = text;
		status.classList.toggle("warning", Boolean(warning));
	}
	async start() {
		const text = (name) => this.find("v-" + name).textContent;
		if (typeof WebAssembly !== "object" || typeof DecompressionStream !== "function")
			throw new Error("This browser has no WebAssembly, or cannot unpack it.");
		this.drawing = new Drawing(this.find("v-canvas"), text);
		this.reader = await Reader.make(await unpacked(text("wasm")));
		this.polar = new PolarPlot(this.find);
		this.listen();
		this.relight();
		this.find("v-open").hidden = false;
		this.say("Click a sphere below, or drop an archive or a MERL file here; nothing is uploaded.");
		await this.openOwn();
	}
	// The archive that the page is about: in the page, or beside it.
	async openOwn() {
		const name = document.body.dataset.archive, embedded = this.find("embedded");
		if (!document.querySelector(".tile")) return;
		if (embedded) {
			this.own = await this.reader.open(new MemorySource(name, bytesOf(embedded.textContent)));
		} else if (location.protocol === "file:") {
			this.say(`From a file a browser does not let the page read ${name} beside it: drop it here, serve the folder, or make the page with --embed.`);
			return;
		} else {
			this.own = await this.reader.open(await serverSource(name, encodeURIComponent(name), (notice) => { this.notice = notice; }));
		}
		this.cost();
		for (const link of document.querySelectorAll(".tile[data-index] a:not([href])")) link.href = "#viewer"; // to be reached by keys
		await this.names(this.own);
		const first = document.querySelector(".tile[data-index]");
		if (first) await this.show("a", this.own, Number(first.dataset.index));
		if (this.notice) this.say(this.notice);
	}
	cost() {
		const archive = (this.slots.a || {}).archive || this.own;
		if (!archive) return;
		const { source } = archive;
		this.find("v-cost").textContent = source.fetched ? `${source.fetched.toLocaleString("en")} of ${source.size.toLocaleString("en")} bytes of ${source.name} were fetched.`
			: `${source.name}: ${source.size.toLocaleString("en")} bytes, all in this page; nothing was fetched.`;
	}
	// Offers the archive's names: those that the page has, else the first that the archive has.
	async names(archive) {
		const select = this.find("v-names"), tiles = archive === this.own ? document.querySelectorAll(".tile[data-index]") : [];
		const options = Array.from(tiles, (tile) => [tile.dataset.index, tile.dataset.name]);
		const told = options.length ? 0 : Math.min(archive.count, NAMES_MAX);
		for (let n = 0; n < told; n++) {
			try {
				options.push([n, (await archive.info(n)).name]);
			} catch (error) {
				options.push([n, `number ${n}: ${error.message}`]);
			}
		}
		select.replaceChildren(...options.map(([index, name]) => new Option(name, index)));
		this.listed = archive;
	}
	target() {
		return document.querySelector("input[name=v-target]:checked").value;
	}
	// Layers 0: all. The preview comes first, then the record takes its place.
	async show(slot, archive, index, layers = 0) {
		const turn = ++this.turns[slot], started = performance.now();
		this.busy++;
		try {
			const info = await archive.info(index), tile = archive === this.own && document.querySelector(`.tile[data-index="${index}"]`);
			if (tile && tile.dataset.name !== info.name) throw new Error(`this page was made of another archive: number ${index} is ${info.name}, not ${tile.dataset.name}`);
			const same = this.slots[slot] && this.slots[slot].archive === archive && this.slots[slot].index === index;
			if (!same) {
				const preview = await archive.load(index, info, 1, true);
				if (turn !== this.turns[slot]) return preview.free();
				this.put(slot, { archive, index, info, layers: 1, material: preview });
				this.previewed = performance.now() - started;
				await this.draw();
			}
			const material = await archive.load(index, info, layers, false);
			if (turn !== this.turns[slot]) return material.free(); // another click came
			this.put(slot, { archive, index, info, layers, material });
			await this.draw();
			this.read([0, 0.25]); // something to look at before the pointer comes
			this.say(this.notice || "");
			this.cost();
		} catch (error) {
			this.say(`${archive.source.name}: ${error.message}`, true);
		} finally {
			this.busy--;
		}
	}
	put(slot, shown) {
		const old = this.slots[slot];
		this.slots[slot] = shown;
		if (old) old.material.free();
		this.drawing.put(slot, shown.material);
		this.find("v-body").hidden = false;
		this.find("v-" + slot).textContent = shown.info.name;
		const select = this.find("v-layers-" + slot), { layers } = shown.info;
		select.replaceChildren(...layers.map((layer, n) => new Option(`${n + 1}: ${layer.bytes} bytes, log RMSE ${layer.error.toPrecision(2)}`, n + 1)));
		if (layers.length) select.value = shown.layers || layers.length;
		select.parentElement.hidden = layers.length < 2;
		if (slot === "b" && this.find("v-mode").value === "a") this.find("v-mode").value = "split";
		this.find("v-split-label").hidden = this.find("v-mode").value !== "split";
		this.find("v-canvas").setAttribute("aria-label", ["a", "b"].filter((s) => this.slots[s]).map((s) => `${s.toUpperCase()}: ${this.slots[s].info.name}`).join(", "));
		this.expose = true;
		this.draw();
	}
	// A MERL file or an archive that was dropped or chosen.
	async open(file) {
		const slot = this.target();
		this.busy++;
		try {
			const head = new DataView(await file.slice(0, 12).arrayBuffer()), merl = file.size === 34992012 && head.getInt32(0, true) === 90;
			this.say(`Reading ${file.name} …`);
			if (merl) {
				const material = this.reader.measured(new Uint8Array(await file.arrayBuffer()));
				this.put(slot, { archive: null, index: -1, info: { name: file.name, layers: [] }, layers: 0, material });
				await this.draw();
				this.say(`${file.name} is shown; it stayed on this machine.`);
				return;
			}
			const source = new RangeSource(file.name, file.size, async (from, end) => new Uint8Array(await file.slice(from, end).arrayBuffer()));
			const archive = await this.reader.open(source);
			if (!archive.count) throw new Error("there is no material in this archive");
			await this.names(archive);
			await this.show(slot, archive, 0);
		} catch (error) {
			this.say(`${file.name} cannot be shown: ${error.message}${error.offset >= 0 ? ` (at byte ${error.offset})` : ""}`, true);
		} finally {
			this.busy--;
		}
	}
	relight() {
		const kind = this.find("v-light").value, fixed = { key: 0, env: 1, point: 2, sky: 1 }[kind], c = Math.cos(this.turn), s = Math.sin(this.turn);
		const lights = fixed === undefined ? [] : this.reader.lights(fixed).map(({ at: [x, y, z], weight, point }) => ({ at: [c * x + s * z, y, c * z - s * x], weight: kind === "sky" ? weight / 2 : weight, point }));
		if (kind === "one" || kind === "sky") lights.push({ at: this.lamp, weight: 3, point: 0 });
		this.drawing.light(lights);
		this.draw();
	}
	// Draws in the frames that come; what changes meanwhile is drawn after that.
	draw() {
		this.dirty = true;
		if (!this.drawn) this.drawn = new Promise((resolve) => requestAnimationFrame(() => this.frame(resolve)));
		return this.drawn;
	}
	frame(resolve) {
		const { drawing } = this;
		if (this.dirty) {
			this.dirty = false;
			drawing.resize(this.size || 512);
			drawing.restart();
		}
		let whole = false;
		for (let pass = 0; pass < 4 && !whole; pass++) whole = drawing.add();
		if (whole) {
			if (this.expose) this.base = drawing.exposure(this.slots.a ? "a" : "b");
			this.expose = false;
			const mode = this.find("v-mode").value;
			drawing.present(mode, this.base * 2 ** this.find("v-exposure").value, this.find("v-split").value);
			this.find("v-canvas").classList.toggle("wide", mode === "side");
		}
		if (!whole || this.dirty) return requestAnimationFrame(() => this.frame(resolve));
		this.drawn = null;
		resolve();
	}
	// Where the pointer is, -1 to 1; and the place there: normal, direction to the eye, point.
	place(event) {
		const box = this.find("v-canvas").getBoundingClientRect(), wide = this.find("v-mode").value === "side" ? 2 : 1;
		let u = (event.clientX - box.left) / box.width * wide;
		u = 2 * (u > 1 ? u - 1 : u) - 1;
		return [u, 1 - 2 * (event.clientY - box.top) / box.height];
	}
	surface([u, v]) {
		if (this.drawing.scene === 0) {
			const square = u * u + v * v;
			if (square >= 0.99) return null;
			const n = [u, v, Math.sqrt(1 - square)];
			return { n, wo: [0, 0, 1], p: n };
		}
		const eye = [0, 0.35, 2.4], ray = unit([0.55 * u, 0.4 * v - this.drawing.tilt, -1]);
		return ray[1] >= -1e-3 ? null : { n: [0, 1, 0], wo: scaled(ray, -1), p: eye.map((x, k) => x - ray[k] * eye[1] / ray[1]) };
	}
	// The light whose share at that place is the one to look at: the lamp, or the strongest that reaches it.
	lightAt({ n, p }) {
		let best = null, most = 0;
		for (const { at, weight, point } of this.drawing.lights) {
			const to = point ? at.map((x, k) => x - p[k]) : at, wi = unit(to), lit = dot(n, wi) * weight / (point ? dot(to, to) : 1);
			if (lit > most) [best, most] = [wi, lit];
		}
		return best;
	}
	read(at) {
		const place = this.surface(at), light = place && this.lightAt(place);
		if (!light || (!this.slots.a && !this.slots.b)) return;
		const [wi, wo] = localPair(place.n, light, place.wo), [h, d, phi] = halfDifference(wi, wo), curves = {}, values = [];
		for (const slot of ["a", "b"]) {
			if (!this.slots[slot]) continue;
			const { material } = this.slots[slot];
			curves[slot] = polarCurve(material, wi);
			values.push(`${slot.toUpperCase()} ${Array.from(material.evaluate(Float32Array.from([...wi, ...wo])), (x) => x.toPrecision(3)).join(", ")}`);
		}
		const theta = Math.atan2(wo[0], wo[2]) / DEGREE;
		this.polar.draw(curves, theta);
		this.find("v-reading").textContent = `θi ${(Math.acos(wi[2]) / DEGREE).toFixed(1)}°, θo ${(Math.acos(wo[2]) / DEGREE).toFixed(1)}°; θh ${h.toFixed(2)}°, θd ${d.toFixed(2)}°, φd ${phi.toFixed(1)}°; f in 1/sr (R, G, B): ${values.join("; ")}`;
	}
	// The lamp goes where its reflection is seen under the pointer.
	moveLamp([u, v]) {
		if (this.drawing.scene === 1) {
			const place = this.surface([u, v]);
			if (place) this.lamp = [-place.wo[0], place.wo[1], -place.wo[2]];
			return this.relight();
		}
		const length = Math.hypot(u, v), r = Math.min(length, 0.985) / (length || 1), n = [u * r, v * r, Math.sqrt(1 - Math.min(length, 0.985) ** 2)];
		this.lamp = unit([2 * n[2] * n[0], 2 * n[2] * n[1], 2 * n[2] * n[2] - 1]);
		this.relight();
	}
	turnBy(angle) {
		this.turn += angle;
		this.relight();
	}
	hasLamp() {
		return ["one", "sky"].includes(this.find("v-light").value);
	}
	listen() {
		const canvas = this.find("v-canvas"), on = (id, kind, run) => this.find(id).addEventListener(kind, run);
		let last = null;
		canvas.addEventListener("pointerdown", (event) => {
			last = this.place(event);
			canvas.setPointerCapture(event.pointerId);
			if (this.hasLamp() && !event.shiftKey) this.moveLamp(last);
		});
		canvas.addEventListener("pointermove", (event) => {
			this.read(this.place(event));
			if (!last) return;
			const now = this.place(event);
			if (this.hasLamp() && !event.shiftKey) this.moveLamp(now);
			else {
				if (this.drawing.scene === 1) this.drawing.tilt = Math.min(0.6, Math.max(0.05, this.drawing.tilt + (now[1] - last[1]) / 4));
				this.turnBy((now[0] - last[0]) * 2);
			}
			last = now;
		});
		for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, () => { last = null; });
		canvas.addEventListener("keydown", (event) => this.key(event));
		on("v-light", "change", () => { this.expose = true; this.relight(); });
		on("v-mode", "change", () => { this.find("v-split-label").hidden = this.find("v-mode").value !== "split"; this.draw(); });
		on("v-scene", "change", () => {
			this.drawing.scene = Number(this.find("v-scene").value);
			if (this.drawing.scene === 1 && this.lamp[1] < 0.1) this.lamp = LAMP; // it would be under the floor
			this.expose = true;
			this.relight();
		});
		on("v-split", "input", () => this.draw());
		on("v-exposure", "input", () => this.draw());
		on("v-names", "change", () => this.show(this.target(), this.listed, Number(this.find("v-names").value)));
		on("v-file", "change", (event) => event.target.files.length && this.open(event.target.files[0]));
		on("v-same", "click", () => {
			const { a } = this.slots;
			if (a && a.archive) this.show("b", a.archive, a.index, 1);
		});
		for (const slot of ["a", "b"])
			on("v-layers-" + slot, "change", () => {
				const { archive, index } = this.slots[slot];
				this.show(slot, archive, index, Number(this.find("v-layers-" + slot).value));
			});
		document.addEventListener("click", (event) => {
			const tile = event.target.closest(".tile[data-index]");
			if (!tile || !this.own || event.ctrlKey || event.metaKey) return;
			event.preventDefault();
			this.show(this.target(), this.own, Number(tile.dataset.index));
			this.find("viewer").scrollIntoView({ block: "nearest" });
		});
		document.addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("v-drop"); });
		document.addEventListener("dragleave", () => document.body.classList.remove("v-drop"));
		document.addEventListener("drop", (event) => {
			event.preventDefault();
			document.body.classList.remove("v-drop");
			if (event.dataTransfer.files.length) this.open(event.dataTransfer.files[0]);
		});
	}
	key(event) {
		const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key], exposure = this.find("v-exposure");
		if (step && this.hasLamp() && this.drawing.scene === 0) {
			const half = unit([this.lamp[0], this.lamp[1], this.lamp[2] + 1]);
			this.moveLamp([half[0] + 0.05 * step[0], half[1] + 0.05 * step[1]]);
		} else if (step && this.hasLamp()) {
			this.lamp = unit([this.lamp[0] + 0.05 * step[0], Math.max(0.05, this.lamp[1] + 0.05 * step[1]), this.lamp[2]]);
			this.relight();
		} else if (step) this.turnBy(0.1 * step[0]);
		else if (event.key === "[" || event.key === "]") this.turnBy(event.key === "[" ? -0.1 : 0.1);
		else if (event.key === "+" || event.key === "-") {
			exposure.value = Number(exposure.value) + (event.key === "+" ? 0.2 : -0.2);
			this.draw();
		} else return;
		event.preventDefault();
	}
}

const bytesOf = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
const unpacked = async (base64) => new Uint8Array(await new Response(new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer());

const viewer = new Viewer();
// for those who want to look further from the console, and for tests
window.brdfpack = { viewer, ready: null };
document.addEventListener("DOMContentLoaded", () => {
	window.brdfpack.ready = viewer.start().catch((error) => {
		viewer.say(`The viewer cannot run here: ${error.message} The pictures and tables below need none of it.`, true);
	});
});
