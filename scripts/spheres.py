"""What the scripts that draw spheres have in common: what `brdfpack render` writes, exposed, in sRGB, as PNG. Standard library only.

A picture is a list of rows from the top down, each a list of (R, G, B).
"""
import os
import struct
import subprocess
import zlib

COVERED_BELOW = 0.99  # of the squared radius, as render draws


def render(tool, scratch, size, *material):
    """Linear radiances of a material, ARCHIVE NAME or a MERL file, under the key lights; `scratch` is a folder."""
    path = os.path.join(scratch, "sphere.pfm")
    subprocess.run([tool, "render", "--force", "--size", str(size), "-o", path, *material], check=True)
    with open(path, "rb") as file:
        kind, extents, scale, data = file.read().split(b"\n", 3)
    assert kind == b"PF" and extents == b"%d %d" % (size, size)
    unit = -float(scale)  # negative: little-endian
    values = [unit * v for v in struct.unpack("<%df" % (3 * size * size), data)]
    pixels = list(zip(values[0::3], values[1::3], values[2::3]))
    return [pixels[size * y:size * (y + 1)] for y in reversed(range(size))]


def covered(size, x, y):
    return ((2 * x + 1) / size - 1) ** 2 + (1 - (2 * y + 1) / size) ** 2 < COVERED_BELOW


def exposure(rows):
    """The factor by which the 90th percentile of the covered pixels' means becomes 0.9."""
    size = len(rows)
    means = sorted(sum(rows[y][x]) / 3 for y in range(size) for x in range(size) if covered(size, x, y))
    return 0.9 / max(1e-12, means[int(0.9 * len(means))])


def srgb(rows, factor):
    """The same exposed, as sRGB values from 0 to 1."""
    def curve(value):
        value = min(1, max(0, value * factor))
        return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055

    return [[tuple(curve(v) for v in pixel) for pixel in row] for row in rows]


def png(lines, channels):
    """A PNG file of lines of bytes, 3 (RGB) or 4 (RGBA) to a pixel. Each is coded as its difference from the one above (filter 2)."""
    above, data = bytes(len(lines[0])), b""
    for line in lines:
        data += b"\2" + bytes((p - q) % 256 for p, q in zip(line, above))
        above = line

    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    head = struct.pack(">IIBBBBB", len(lines[0]) // channels, len(lines), 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b"")
