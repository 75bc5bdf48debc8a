#!/usr/bin/env python3
"""Writes the small measured files that the command-line tests use: fixtures.py FOLDER.

Tables of 6 x 6 x 8 cells (theta_h, theta_d, phi_d) in MERL's layout, read with --any-lattice:
a lobe over a diffuse floor, a few per cent noise, and cells that are not measured. The numbers
come from a fixed formula, so every run writes the same bytes.
"""
import math
import os
import struct
import sys

DIMS = (6, 6, 8)
SCALE = (1 / 1500, 1.15 / 1500, 1.66 / 1500)


def table(seed, dims=DIMS):
    """Planes R, G, B of stored values."""
    planes = [[], [], []]
    state = seed * 2654435761 % 2**32
    for i in range(dims[0]):
        theta_h = (i / dims[0]) ** 2 * math.pi / 2
        lobe = math.exp(-(math.tan(theta_h) / (0.1 + 0.05 * seed)) ** 2)
        for j in range(dims[1]):
            fresnel = 0.04 + 0.96 * (j / dims[1]) ** 5
            for k in range(dims[2]):
                state = (1103515245 * state + 12345) % 2**31
                noise = 1 + 0.02 * (state / 2**30 - 1)
                measured = not (i >= dims[0] - 2 and j >= dims[1] - 2 and k < dims[2] // 2)
                for c in range(3):
                    value = (0.1 + 0.05 * c + 5 * lobe * fresnel) * noise
                    planes[c].append(value / SCALE[c] if measured else -1.0)
    return planes


def write(path, planes, dims=DIMS, extra=b"", cut=0):
    data = struct.pack("<3i", *dims)
    for plane in planes:
        data += struct.pack("<%dd" % len(plane), *plane)
    data += extra
    with open(path, "wb") as file:
        file.write(data[: len(data) - cut])


def main(folder):
    def to(name):
        return os.path.join(folder, name + ".binary")

    cells = DIMS[0] * DIMS[1] * DIMS[2]
    for seed, name in enumerate(["alpha", "beta", "gamma"], 1):
        write(to(name), table(seed))
    write(to("truncated"), table(1), cut=100)
    write(to("trailing"), table(1), extra=b"xyz")
    write(to("header"), table(1), dims=(6, 6, 9))
    write(to("extents"), table(1), dims=(-1, 6, 8))
    open(to("empty"), "wb").close()
    dirty = table(1)
    dirty[0][5], dirty[1][6], dirty[2][7] = math.nan, math.inf, -math.inf
    write(to("dirty"), dirty)
    write(to("unmeasured"), [[-1.0] * cells] * 3)
    write(to("zero"), [[0.0] * cells] * 3)
    write(to("constant"), [[0.25 / s] * cells for s in SCALE])
    write(to("spark"), [[0.0] * 100 + [1e6] + [0.0] * (cells - 101)] * 3)
    write(to("faint"), [[1e-300] * cells] * 3)
    write(to("huge"), [[1e300] * cells] * 3)


if __name__ == "__main__":
    main(sys.argv[1])
