#!/usr/bin/env python3
"""One picture of what the two profiles make of measured materials: a row for each, a sphere of the table, of `paper`, of `spectral`.

    scripts/profiles_picture.py [--brdfpack PROGRAM] [--size N] -o OUT.png MERL-FILE...

All spheres of a row have the exposure of the first: the 90th percentile of its covered pixels becomes 0.9. Standard library only.
"""
import argparse
import os
import struct
import subprocess
import tempfile
import zlib


def pfm_read(path):
    """Rows from the top down, of (r, g, b)."""
    with open(path, "rb") as file:
        kind, size, scale = file.readline().strip(), file.readline().split(), float(file.readline())
        assert kind == b"PF"
        width, height = map(int, size)
        values = struct.unpack(("<" if scale < 0 else ">") + f"{3 * width * height}f", file.read())
    pixels = list(zip(values[0::3], values[1::3], values[2::3]))
    return [pixels[y * width:(y + 1) * width] for y in reversed(range(height))]


def exposure_of(rows):
    size = len(rows)
    covered = sorted(sum(rows[y][x]) / 3 for y in range(size) for x in range(size)
                     if ((x + 0.5) / size * 2 - 1) ** 2 + (1 - (y + 0.5) / size * 2) ** 2 < 0.99)
    return 0.9 / max(covered[int(0.9 * len(covered))], 1e-12)


def srgb(x):
    x = min(max(x, 0.0), 1.0)
    return round(255 * (12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055))


def png_write(path, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    raw = b"".join(b"\0" + bytes(v for pixel in row for v in pixel) for row in rows)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--brdfpack", default="build/brdfpack")
    parser.add_argument("--size", type=int, default=200)
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("files", nargs="+")
    arguments = parser.parse_args()
    picture = []
    with tempfile.TemporaryDirectory() as scratch:
        image, archive = os.path.join(scratch, "sphere.pfm"), os.path.join(scratch, "one.bpk")

        def sphere(*what):
            subprocess.run([arguments.brdfpack, "render", "--force", "--size", str(arguments.size), "-o", image, *what], check=True)
            return pfm_read(image)
        for path in arguments.files:
            name, spheres = os.path.splitext(os.path.basename(path))[0], [sphere(path)]
            for profile in "paper", "spectral":
                subprocess.run([arguments.brdfpack, "build", "-q", "--profile", profile, "-o", archive, path], check=True)
                spheres.append(sphere(archive, name))
            exposure = exposure_of(spheres[0])
            for y in range(arguments.size):
                picture.append([tuple(srgb(exposure * v) for v in pixel) for rows in spheres for pixel in rows[y]])
    png_write(arguments.output, picture)


if __name__ == "__main__":
    main()
