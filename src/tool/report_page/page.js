"use strict";
// Filter and sort of the contact sheet. The page can be read without.
(function () {
	const sheet = document.querySelector("ul.sheet"), controls = document.getElementById("controls");
	if (!sheet || !controls) return;
	const tiles = Array.from(sheet.children), filter = document.getElementById("filter"), sort = document.getElementById("sort");
	const down = document.getElementById("down"), shown = document.getElementById("shown");
	function show() {
		const text = filter.value.toLowerCase();
		let count = 0;
		for (const tile of tiles) {
			tile.hidden = !tile.dataset.name.toLowerCase().includes(text);
			count += !tile.hidden;
		}
		shown.textContent = count === tiles.length ? "" : count + " of " + tiles.length;
	}
	function order() {
		const by = sort.value, sign = down.checked ? -1 : 1;
		const names = (a, b) => a.dataset.name < b.dataset.name ? -1 : a.dataset.name > b.dataset.name ? 1 : 0;
		// what could not be decoded has no figures and comes last
		const value = (tile) => by in tile.dataset ? Number(tile.dataset[by]) : sign * Infinity;
		tiles.sort((a, b) => by === "name" ? sign * names(a, b) : sign * (value(a) < value(b) ? -1 : value(a) > value(b) ? 1 : 0) || names(a, b));
		sheet.append(...tiles);
	}
	filter.addEventListener("input", show);
	sort.addEventListener("change", order);
	down.addEventListener("change", order);
	controls.addEventListener("submit", (event) => event.preventDefault());
	controls.hidden = false;
})();
