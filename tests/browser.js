// Debian's Chromium, driven over its debugging pipe: Node's standard library is enough.
"use strict";
const { spawn } = require("child_process"), fs = require("fs"), os = require("os"), path = require("path");

class Browser {
	static async start(program) {
		const browser = new Browser();
		browser.profile = fs.mkdtempSync(path.join(os.tmpdir(), "brdfpack-chromium-"));
		browser.process = spawn(program, ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
			"--no-first-run", "--disable-background-networking", "--disable-component-update", `--user-data-dir=${browser.profile}`, "--remote-debugging-pipe", "about:blank"],
			{ stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"], detached: true }); // a group of its own, which ends as one
		browser.waiting = new Map();
		browser.number = 0;
		browser.heard = [];
		let rest = "";
		browser.process.stdio[4].setEncoding("utf8").on("data", (text) => {
			const messages = (rest + text).split("\0");
			rest = messages.pop();
			for (const message of messages) browser.hear(JSON.parse(message));
		});
		browser.process.on("exit", () => { for (const { reject } of browser.waiting.values()) reject(new Error("the browser ended")); });
		return browser;
	}
	hear(message) {
		const waiting = this.waiting.get(message.id);
		if (!waiting) {
			for (const listener of this.heard) listener(message);
			return;
		}
		this.waiting.delete(message.id);
		if (message.error) waiting.reject(new Error(`${waiting.method}: ${message.error.message}`));
		else waiting.resolve(message.result);
	}
	send(method, params = {}, sessionId) {
		const id = ++this.number;
		this.process.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + "\0");
		return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject, method }));
	}
	async page() {
		const page = new Page(this);
		page.target = (await this.send("Target.createTarget", { url: "about:blank" })).targetId;
		page.session = (await this.send("Target.attachToTarget", { targetId: page.target, flatten: true })).sessionId;
		this.heard.push((message) => message.sessionId === page.session && page.hear(message));
		for (const domain of ["Page", "Runtime", "Log"]) await page.send(domain + ".enable");
		return page;
	}
	async end() {
		const ended = new Promise((resolve) => this.process.once("exit", resolve));
		process.kill(-this.process.pid, "SIGKILL");
		await ended;
		fs.rmSync(this.profile, { recursive: true, force: true, maxRetries: 20, retryDelay: 200 });
	}
}

class Page {
	constructor(browser) {
		this.browser = browser;
		this.errors = []; // of the console, and exceptions
		this.loaded = [];
	}
	hear({ method, params }) {
		if (method === "Page.loadEventFired") this.loaded.splice(0).forEach((resolve) => resolve());
		if (method === "Page.javascriptDialogOpening") this.errors.push("a dialog: " + params.message);
		if (method === "Runtime.exceptionThrown") this.errors.push(params.exceptionDetails.exception ? params.exceptionDetails.exception.description : params.exceptionDetails.text);
		if (method === "Runtime.consoleAPICalled" && ["error", "assert", "warning"].includes(params.type)) this.errors.push("console: " + params.args.map((a) => a.value || a.description).join(" "));
		if (method === "Log.entryAdded" && params.entry.level === "error") this.errors.push(`${params.entry.text} ${params.entry.url || ""}`);
	}
	send(method, params) {
		return this.browser.send(method, params, this.session);
	}
	async go(url) {
		const loaded = new Promise((resolve) => this.loaded.push(resolve));
		await this.send("Page.navigate", { url });
		await loaded;
	}
	// The value of an expression in the page, promises waited for.
	async value(expression) {
		const answer = await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
		if (answer.exceptionDetails) throw new Error(`${expression.slice(0, 200)}: ${answer.exceptionDetails.exception.description}`);
		return answer.result.value;
	}
	async window(width, height, media = []) {
		await this.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: width < 600 });
		await this.send("Emulation.setEmulatedMedia", { features: media });
	}
	async shot(file) {
		fs.writeFileSync(file, Buffer.from((await this.send("Page.captureScreenshot", {})).data, "base64"));
	}
	async mouse(type, x, y, button = "none") {
		await this.send("Input.dispatchMouseEvent", { type, x, y, button, buttons: button === "none" ? 0 : 1, clickCount: type === "mouseMoved" ? 0 : 1 });
	}
}

module.exports = { Browser };
