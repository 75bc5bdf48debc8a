#!/usr/bin/env python3
"""One picture of what the two profiles make of measured materials: a row for each, a sphere of the table, of `paper`, of `spectral`.

    scripts/profiles_picture.py [--brdfpack PROGRAM] [--size N] -o OUT.png MERL-FILE...

All spheres of a row have the exposure of the first: the 90th percentile of its covered pixels becomes 0.9. Standard library only.
"""
import argparse
import os
import subprocess
import tempfile

from spheres import exposure, png, render, srgb


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--brdfpack", default="build/brdfpack")
    parser.add_argument("--size", type=int, default=200)
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("files", nargs="+")
    arguments = parser.parse_args()
    lines = []
    with tempfile.TemporaryDirectory() as scratch:
        archive = os.path.join(scratch, "one.bpk")
        for path in arguments.files:
            name, spheres = os.path.splitext(os.path.basename(path))[0], [render(arguments.brdfpack, scratch, arguments.size, path)]
            for profile in "paper", "spectral":
                subprocess.run([arguments.brdfpack, "build", "-q", "--profile", profile, "-o", archive, path], check=True)
                spheres.append(render(arguments.brdfpack, scratch, arguments.size, archive, name))
            shown = [srgb(sphere, exposure(spheres[0])) for sphere in spheres]
            for y in range(arguments.size):
                lines.append(bytes(round(255 * v) for rows in shown for pixel in rows[y] for v in pixel))
    with open(arguments.output, "wb") as file:
        file.write(png(lines, 3))


if __name__ == "__main__":
    main()
