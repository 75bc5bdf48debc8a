#!/usr/bin/env python3
"""The picture at the front of the README: measured, 60 KB, 4 KB side by side, with the differences.

    scripts/front_picture.py TOOL FOLDER OUT.svg

FOLDER holds the demo materials as `TOOL synth` writes them. Each is packed twice, drawn by `TOOL render` under the key lights, exposed by the
measured picture and brought to sRGB as render does; differences are of the sRGB values, times ten. Standard library only.
"""
import base64
import math
import os
import subprocess
import sys
import tempfile

from spheres import covered, exposure, png, render, srgb

MATERIALS = [("beetle-wing", "a beetle's wing"), ("blue-car-paint", "a metallic paint"), ("cast-aluminium", "a rough metal")]
BUDGETS = [60400, 4096]
SIZE = 112


def difference(a, b):
    return [[tuple(min(1, 10 * abs(p - q)) for p, q in zip(x, y)) for x, y in zip(r, s)] for r, s in zip(a, b)]


def psnr(a, b):
    squares = [(p - q) ** 2 for y in range(SIZE) for x in range(SIZE) if covered(SIZE, x, y) for p, q in zip(a[y][x], b[y][x])]
    return 10 * math.log10(len(squares) / max(1e-12, sum(squares)))


def image(rows, column, row):
    """RGBA; what is not covered is transparent."""
    lines = [b"".join(bytes([round(255 * v) for v in pixel] + [255]) if covered(SIZE, x, y) else bytes(4) for x, pixel in enumerate(line))
             for y, line in enumerate(rows)]
    data = base64.b64encode(png(lines, 4)).decode()
    return '<image x="%d" y="%d" width="%d" height="%d" href="data:image/png;base64,%s"/>' % (column, row, SIZE, SIZE, data)


def text(x, y, size, words, anchor="middle"):
    return '<text x="%d" y="%d" font-size="%d" text-anchor="%s">%s</text>' % (x, y, size, anchor, words)


def main(tool, folder, out):
    step, top, height = SIZE + 10, 26, SIZE + 30
    parts, told = [], []
    heads = ["measured"] + [h for b in BUDGETS for h in ("%s bytes" % format(b, ","), "difference × 10")]
    for n, head in enumerate(heads):
        parts.append(text(n * step + SIZE // 2, 16, 13, head))
    with tempfile.TemporaryDirectory() as scratch:
        for line, (name, words) in enumerate(MATERIALS):
            source, y = os.path.join(folder, name + ".binary"), top + line * height
            measured = render(tool, scratch, SIZE, source)
            factor = exposure(measured)
            reference = srgb(measured, factor)
            parts += [image(reference, 0, y), text(SIZE // 2, y + SIZE + 15, 12, words)]
            for n, budget in enumerate(BUDGETS):
                archive = os.path.join(scratch, "one.bpk")
                subprocess.run([tool, "build", "-q", "--budget", str(budget), "-o", archive, source], check=True)
                decoded = srgb(render(tool, scratch, SIZE, archive, name), factor)
                dB, x = psnr(reference, decoded), (1 + 2 * n) * step
                told.append("%s at %d bytes: %.1f dB" % (words, budget, dB))
                parts += [image(decoded, x, y), image(difference(reference, decoded), x + step, y), text(x + SIZE + 5, y + SIZE + 15, 12, "%.1f dB" % dB)]
    width = len(heads) * step - 10
    with open(out, "w", encoding="utf-8") as file:
        file.write('<svg xmlns="http://www.w3.org/2000/svg" viewBox="-6 0 %d %d" width="%d" role="img" aria-label="Demo materials, measured and decoded. %s">\n'
                   "<style>text { font-family: sans-serif; fill: #57606a }</style>\n" % (width + 12, top + len(MATERIALS) * height, width + 12, "; ".join(told)))
        file.write("\n".join(parts) + "\n</svg>\n")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
