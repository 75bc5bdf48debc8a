#!/bin/sh
# The viewer's part of the page, on standard output: bundle.sh VIEWER.wasm. The module is packed by gzip: a third of the size, and browsers unpack it.
set -eu
wasm=$1
here=$(dirname "$0")
printf '<style>\n'
cat "$here/viewer.css"
printf '</style>\n'
cat "$here/viewer.html"
printf '<script type="application/gzip" id=v-wasm>'
gzip -9 -n -c "$wasm" | base64 -w 0
printf '</script>\n'
for shader in brdfpack sphere show; do
	printf '<script type="text/plain" id=v-%s.glsl>\n' "$shader"
	cat "$here/$shader.glsl"
	printf '</script>\n'
done
printf '<script>\n'
for part in module draw polar viewer; do grep -v '^"use strict";$' "$here/$part.js"; done
printf '</script>\n'
