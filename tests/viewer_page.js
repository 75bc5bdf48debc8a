// The report and its viewer in a real browser: node tests/viewer_page.js CHROMIUM TOOL FOLDER SHOTS
// FOLDER holds what tests/viewer.sh made; screenshots for people go to SHOTS.
"use strict";
const fs = require("fs"), http = require("http"), path = require("path"), { execFileSync } = require("child_process");
const { Browser } = require("./browser.js");
const [program, tool, folder, shots] = process.argv.slice(2);
let count = 0, bad = 0;

function check(what, right, found) {
	count++;
	if (right) return;
	bad++;
	console.error(`viewer_page: ${what}${found === undefined ? "" : `: found ${JSON.stringify(found)}`}`);
}

// Serves the folder, under /plain/ without ranges; counts the bytes of archives that went out.
function serve() {
	const server = http.createServer((request, answer) => {
		const plain = request.url.startsWith("/plain/"), name = decodeURIComponent(request.url.replace("/plain/", "/").slice(1));
		const file = path.join(folder, name), range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range || "");
		if (!fs.existsSync(file)) {
			answer.writeHead(name === "favicon.ico" ? 204 : 404);
			return answer.end();
		}
		let bytes = fs.readFileSync(file);
		const head = { "Content-Type": file.endsWith(".html") ? "text/html" : "application/octet-stream" };
		if (range && !plain) {
			head["Content-Range"] = `bytes ${range[1]}-${Math.min(Number(range[2]), bytes.length - 1)}/${bytes.length}`;
			bytes = bytes.subarray(Number(range[1]), Number(range[2]) + 1);
		}
		if (file.endsWith(".bpk")) Object.assign(server, { bytes: server.bytes + bytes.length, requests: server.requests + 1 });
		answer.writeHead(range && !plain ? 206 : 200, head);
		answer.end(bytes);
	});
	Object.assign(server, { bytes: 0, requests: 0 });
	return new Promise((resolve) => server.listen(0, "127.0.0.1", () => resolve(server)));
}

// A linear picture of `brdfpack render`: {size, rgb}, top row first
function rendered(...options) {
	const file = path.join(folder, "render.pfm");
	execFileSync(tool, ["render", "--force", "-o", file, ...options]);
	const bytes = fs.readFileSync(file), size = Number(/^PF\n(\d+)/.exec(bytes.toString("latin1", 0, 20))[1]), first = bytes.length - 12 * size * size;
	const value = (x, y, c) => bytes.readFloatLE(first + 4 * (3 * ((size - 1 - y) * size + x) + c));
	return { size, rgb: Float64Array.from({ length: 3 * size * size }, (_, n) => value(Math.floor(n / 3) % size, Math.floor(n / 3 / size), n % 3)) };
}

const srgb = (x) => (x = Math.min(1, Math.max(0, x))) <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;

// PSNR in dB of a canvas's bytes (RGBA, top row first) beside a rendering that is exposed as `render` does it.
function psnr({ size, rgb }, canvas) {
	const means = [];
	const covered = (x, y) => ((2 * x + 1) / size - 1) ** 2 + (1 - (2 * y + 1) / size) ** 2 < 0.99;
	for (let n = 0; n < size * size; n++) if (covered(n % size, Math.floor(n / size))) means.push((rgb[3 * n] + rgb[3 * n + 1] + rgb[3 * n + 2]) / 3);
	const exposure = 0.9 / [...means].sort((a, b) => a - b)[Math.floor(0.9 * means.length)];
	let sum = 0;
	for (let n = 0; n < size * size; n++)
		if (covered(n % size, Math.floor(n / size))) for (let c = 0; c < 3; c++) sum += (srgb(rgb[3 * n + c] * exposure) - canvas[4 * n + c] / 255) ** 2;
	return 10 * Math.log10(3 * means.length / Math.max(1e-12, sum));
}

const CANVAS = `(() => { const from = viewer.find("v-canvas"), to = document.createElement("canvas"); to.width = from.width; to.height = from.height;
	const context = to.getContext("2d"); context.drawImage(from, 0, 0); return Array.from(context.getImageData(0, 0, to.width, to.height).data); })()`;
// When nothing is being loaded or drawn any more.
const IDLE = `(async () => { do { await new Promise((done) => setTimeout(done, 50)); await viewer.draw(); } while (viewer.busy); })()`;
const set = (id, value) => `(() => { const e = document.getElementById("${id}"); e.value = "${value}"; e.dispatchEvent(new Event("change")); e.dispatchEvent(new Event("input")); return ${IDLE}; })()`;
const drop = (name, text) => `(async () => { const data = new DataTransfer(); data.items.add(new File([${text}], ${JSON.stringify(name)}));
	document.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true })); await ${IDLE}; })()`;
const bytesOf = (file) => `Uint8Array.from(atob("${fs.readFileSync(file).toString("base64")}"), (c) => c.charCodeAt(0))`;
const status = `document.getElementById("v-status").textContent`;
const url = (name) => "file://" + path.resolve(folder, name);

async function sheet(page) {
	await page.go(url("report.html"));
	check("the sheet is there", await page.value(`document.querySelectorAll(".tile").length`) === 3);
	const names = `Array.from(document.querySelectorAll(".tile:not([hidden])"), (t) => t.dataset.name).join(" ")`;
	const byName = await page.value(names);
	await page.value(`(() => { const s = document.getElementById("sort"); s.value = "error"; s.dispatchEvent(new Event("change")); })()`);
	const errors = await page.value(`Array.from(document.querySelectorAll(".tile"), (t) => Number(t.dataset.error))`);
	check("sorting by error", errors.every((e, n) => !n || errors[n - 1] <= e), errors);
	await page.value(`(() => { const d = document.getElementById("down"); d.checked = true; d.dispatchEvent(new Event("change")); document.getElementById("sort").value = "albedo"; document.getElementById("sort").dispatchEvent(new Event("change")); })()`);
	const albedos = await page.value(`Array.from(document.querySelectorAll(".tile"), (t) => Number(t.dataset.albedo))`);
	check("sorting by albedo, largest first", albedos.every((e, n) => !n || albedos[n - 1] >= e), albedos);
	await page.value(`(() => { const f = document.getElementById("filter"); f.value = "MIRROR"; f.dispatchEvent(new Event("input")); })()`);
	check("the filter leaves one", await page.value(names) === "silvered-mirror", await page.value(names));
	check("all had been there", byName === "gold-spray-paint silvered-mirror wine-velvet", byName);
	check("every picture has a text", await page.value(`Array.from(document.images).every((i) => i.alt.length > 10)`));
	check("every table has a caption and scopes", await page.value(`Array.from(document.querySelectorAll("table")).every((t) => t.caption && t.querySelector("th[scope]"))`));
	check("every plot has a text", await page.value(`Array.from(document.querySelectorAll("svg[role=img]")).every((s) => s.getAttribute("aria-label").length > 20)`));
	check("no wider than a phone", await page.window(390, 800) === undefined && await page.value(`document.documentElement.scrollWidth`) <= 390, await page.value(`document.documentElement.scrollWidth`));
	await page.window(1280, 900);
	const pdf = Buffer.from((await page.send("Page.printToPDF", { printBackground: false })).data, "base64");
	check("it prints", pdf.length > 20000 && pdf.subarray(0, 5).toString() === "%PDF-", pdf.length);
	fs.writeFileSync(path.join(shots, "report.pdf"), pdf);
	// without the viewer's own archive: it lies beside, but a file may not be read from a file
	check("from a file it says what to do", /--embed/.test(await page.value(`window.brdfpack.ready.then(() => ${status})`)), await page.value(status));
}

async function embedded(page) {
	await page.go(url("embedded.html"));
	await page.value(`window.brdfpack.ready`);
	check("the first material is shown", await page.value(`viewer.find("v-a").textContent`) === "gold-spray-paint", await page.value(status));
	await page.value(`(viewer.size = 160, ${set("v-light", "key")})`);
	for (const light of ["key", "env", "point"]) {
		await page.value(set("v-light", light));
		const dB = psnr(rendered("--light", light, path.join(folder, "three.bpk"), "gold-spray-paint"), await page.value(CANVAS));
		console.log(`canvas beside render, ${light}: ${dB.toFixed(1)} dB`);
		check(`the canvas is what render draws, ${light}`, dB >= 40, dB);
	}
	await page.value(`(viewer.size = 512, ${set("v-light", "one")})`);
	// drag the light: the highlight follows
	const brightest = `(() => { const p = ${CANVAS}, w = viewer.find("v-canvas").width; let most = -1, at = 0; for (let n = 0; n < p.length; n += 4) if (p[n] + p[n + 1] + p[n + 2] > most) { most = p[n] + p[n + 1] + p[n + 2]; at = n / 4; } return [at % w / w, Math.floor(at / w) / w]; })()`;
	await page.value(set("v-exposure", -3));
	const box = await page.value(`(() => { viewer.find("v-canvas").scrollIntoView(); const b = viewer.find("v-canvas").getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()`);
	const at = (x, y) => [box[0] + x * box[2], box[1] + y * box[3]];
	await page.mouse("mousePressed", ...at(0.5, 0.5), "left");
	await page.mouse("mouseMoved", ...at(0.3, 0.6), "left");
	await page.mouse("mouseReleased", ...at(0.3, 0.6), "left");
	await page.value(`viewer.draw()`);
	const light = await page.value(brightest);
	check("the highlight is where the light was dragged", Math.hypot(light[0] - 0.3, light[1] - 0.6) < 0.08, light);
	await page.mouse("mouseMoved", ...at(0.45, 0.5));
	const reading = await page.value(`viewer.find("v-reading").textContent`);
	check("the pointer reads angles and a value", /θh \d+\.\d+°, θd \d+\.\d+°, φd \d+/.test(reading) && /A \d/.test(reading), reading);
	check("the polar plot has a curve", (await page.value(`viewer.find("v-curve-a").getAttribute("d").length`)) > 1000);
	await page.value(set("v-exposure", 0));
	// keys do what the pointer does
	const before = await page.value(`viewer.lamp.join()`);
	await page.value(`viewer.find("v-canvas").focus()`);
	await page.send("Input.dispatchKeyEvent", { type: "keyDown", key: "ArrowRight", code: "ArrowRight" });
	check("an arrow key moves the light", await page.value(`viewer.lamp.join()`) !== before);
	// another layer beside it
	await page.value(`viewer.find("v-same").click(), ${IDLE}`);
	check("the first layer is B", await page.value(`viewer.slots.b.layers`) === 1);
	await page.value(set("v-mode", "difference"));
	const difference = await page.value(CANVAS), lit = difference.filter((x, n) => n % 4 < 3 && x > 0).length;
	check("the difference of layers shows, and is small", lit > 1000 && difference.reduce((s, x, n) => s + (n % 4 < 3 ? x : 0), 0) / (0.75 * difference.length) < 60, lit);
	await page.value(set("v-mode", "split"));
	await page.value(set("v-scene", 1));
	const floor = await page.value(CANVAS);
	check("the floor is lit", floor.filter((x, n) => n % 4 < 3 && x > 20).length > 10000);
	await page.value(set("v-scene", 0));
	await page.value(set("v-mode", "side"));
	check("side by side is twice as wide", await page.value(`viewer.find("v-canvas").width`) === 1024);
	await page.value(set("v-mode", "split"));
	// a click shows another; its preview is quick
	await page.value(`document.querySelector("input[name=v-target][value=a]").checked = true, document.querySelectorAll(".tile a")[1].click(), ${IDLE}`);
	check("a click on a sphere shows it", await page.value(`viewer.find("v-a").textContent`) === "silvered-mirror");
	const preview = await page.value(`viewer.previewed`);
	console.log(`preview ready ${preview.toFixed(0)} ms after the click (asked: 100; this machine draws by software)`);
	// what is dropped
	const whole = fs.readFileSync(path.join(folder, "three.bpk")), damaged = path.join(folder, "damaged-header.bpk");
	whole[20] ^= 1;
	fs.writeFileSync(damaged, whole);
	await page.value(drop("damaged-header.bpk", bytesOf(damaged)));
	const said = await page.value(status);
	check("a damaged archive is told", /damaged-header\.bpk cannot be shown: /.test(said) && said.length > 50, said);
	check("and the page is still there", await page.value(`document.querySelectorAll(".tile").length`) === 3 && (await page.value(CANVAS)).some((x, n) => n % 4 < 3 && x > 50));
	await page.value(drop("notes.txt", `"no archive at all, but long enough to have a header of sixty-four bytes or more"`));
	check("a text is no archive", /notes\.txt cannot be shown: /.test(await page.value(status)), await page.value(status));
	await page.value(drop("damaged-record.bpk", bytesOf(path.join(folder, "damaged.bpk"))));
	check("of an archive with a damaged record the names are there", await page.value(`viewer.find("v-names").length`) === 3, await page.value(status));
	await page.value(set("v-names", 1));
	check("its damaged record is told", /checksum/i.test(await page.value(status)), await page.value(status));
	// a measured file: 35 MB, by the file input, as a drop would give it
	const { root } = await page.send("DOM.getDocument"), { nodeId } = await page.send("DOM.querySelector", { nodeId: root.nodeId, selector: "#v-file" });
	await page.send("DOM.setFileInputFiles", { nodeId, files: [path.resolve(folder, "measured/gold-spray-paint.binary")] });
	await page.value(IDLE);
	check("a MERL file is shown", /gold-spray-paint\.binary is shown/.test(await page.value(status)), await page.value(status));
	await page.value(`(viewer.size = 160, document.getElementById("v-mode").value = "a", ${set("v-light", "key")})`);
	const dB = psnr(rendered("--light", "key", path.join(folder, "measured/gold-spray-paint.binary")), await page.value(CANVAS));
	console.log(`canvas of the measured file beside render: ${dB.toFixed(1)} dB`);
	check("and is what render draws of it", dB >= 40, dB);
}

async function served(page, server) {
	const here = `http://127.0.0.1:${server.address().port}/`, size = fs.statSync(path.join(folder, "three.bpk")).size;
	await page.go(here + "report.html");
	await page.value(`window.brdfpack.ready`);
	check("served: a material is shown", await page.value(`viewer.find("v-a").textContent`) === "gold-spray-paint", await page.value(status));
	const record = await page.value(`viewer.slots.a.info.bytes`), cost = await page.value(`viewer.find("v-cost").textContent`);
	console.log(`a material by ranges: ${server.bytes} bytes in ${server.requests} requests; its record has ${record}, the archive ${size}`);
	check("a material costs its record and at most 16 KB", server.bytes <= record + 16384, server.bytes);
	check("the page tells what it cost", cost.startsWith(server.bytes.toLocaleString("en") + " of "), cost);
	// another archive under the name of the one that the page was made of
	const three = path.join(folder, "three.bpk"), kept = fs.readFileSync(three);
	fs.copyFileSync(path.join(folder, "odd.bpk"), three);
	await page.go(here + "report.html");
	await page.value(`window.brdfpack.ready`);
	check("another archive beside the page is told", /made of another archive/.test(await page.value(status)), await page.value(status));
	fs.writeFileSync(three, kept);
	await page.go(here + "many.html");
	await page.value(`window.brdfpack.ready`);
	check("a large contact sheet is live, and its links can be reached by keys", await page.value(`document.querySelectorAll(".tile a[href]").length`) === 200 && await page.value(`viewer.find("v-a").textContent`) === "material-000", await page.value(status));
	server.bytes = 0;
	await page.go(here + "plain/report.html");
	await page.value(`window.brdfpack.ready`);
	check("no ranges: shown all the same", await page.value(`viewer.find("v-a").textContent`) === "gold-spray-paint", await page.value(status));
	check("no ranges: told", /no ranges/.test(await page.value(status)), await page.value(status));
	check("no ranges: the file is read once", server.bytes === size, server.bytes);
}

async function poorer(browser) {
	for (const [what, script, text] of [["WebGL 2", `HTMLCanvasElement.prototype.getContext = () => null`, /no WebGL 2/], ["WebAssembly", `delete window.WebAssembly`, /no WebAssembly/]]) {
		const page = await browser.page();
		await page.send("Page.addScriptToEvaluateOnNewDocument", { source: script });
		await page.go(url("embedded.html"));
		await page.value(`window.brdfpack.ready`);
		check(`without ${what} the page says so`, text.test(await page.value(status)), await page.value(status));
		check(`without ${what} pictures and tables are there`, await page.value(`document.querySelectorAll(".tile img").length === 3 && document.querySelectorAll("table").length > 3`));
		check(`without ${what}: no errors`, page.errors.length === 0, page.errors);
	}
	const page = await browser.page();
	await page.send("Emulation.setScriptExecutionDisabled", { value: true });
	await page.go(url("report.html"));
	await page.send("Emulation.setScriptExecutionDisabled", { value: false });
	check("without scripts the page is there", await page.value(`document.querySelectorAll(".material").length === 3 && document.getElementById("controls").hidden`));
}

async function odd(page) {
	await page.go(url("odd.html"));
	await page.value(`window.brdfpack.ready`);
	const names = await page.value(`Array.from(document.querySelectorAll(".tile .name"), (e) => e.textContent)`);
	const wanted = JSON.parse(fs.readFileSync(path.join(folder, "odd.json")));
	check("names with quotes, markup and right-to-left script are shown as they are", String(names.sort()) === String(wanted.sort()), names);
	check("and nothing of them runs", await page.value(`window.ran`) === undefined);
	await page.go(url("damaged.html"));
	check("a damaged record is named", /silvered-mirror/.test(await page.value(`document.querySelector(".tile.missing").textContent`)));
	check("the others are shown", await page.value(`document.querySelectorAll(".tile img").length`) === 2);
	check("verify's words are there", /silvered-mirror/.test(await page.value(`document.getElementById("verify").textContent`)));
	await page.go(url("empty.html"));
	check("an archive without materials says so", /no material/.test(await page.value(`document.getElementById("sheet").textContent`)));
	check("and takes at most 400 KB", fs.statSync(path.join(folder, "empty.html")).size <= 400000, fs.statSync(path.join(folder, "empty.html")).size);
	await page.go(url("many.html"));
	const many = await page.value(`document.querySelectorAll(".tile img").length`), each = fs.statSync(path.join(folder, "many.html")).size / many;
	console.log(`a page of ${many} materials: ${each.toFixed(0)} bytes each`);
	check("10,000 materials would take at most 50 MB", many > 150 && each <= 4900, each);
}

async function look(page) {
	await page.go(url("embedded.html"));
	await page.value(`window.brdfpack.ready`);
	for (const [name, width, height, scheme] of [["wide", 1280, 2600, "light"], ["narrow", 390, 2600, "light"], ["dark", 1280, 1400, "dark"]]) {
		await page.window(width, height, [{ name: "prefers-color-scheme", value: scheme }]);
		await page.value(`viewer.draw()`);
		await page.shot(path.join(shots, `page-${name}.png`));
	}
}

(async () => {
	const browser = await Browser.start(program), server = await serve();
	try {
		const page = await browser.page();
		await page.window(1280, 1000);
		await sheet(page);
		await embedded(page);
		await served(page, server);
		await odd(page);
		await look(page);
		check("no errors on the console", page.errors.length === 0, page.errors);
		await poorer(browser);
	} finally {
		await browser.end();
		server.close();
	}
	console.log(`viewer_page: ${count} checks, ${bad} failed`);
	process.exitCode = bad || count < 40 ? 1 : 0;
})();
