#!/usr/bin/env python3
"""Works out the figures of `brdfpack compare` a second time, from their definitions.

    compare_by_hand.py DECODED.json MEASURED.binary SIZE < COMPARED.json

DECODED.json is what scripts/read_bpk.py decode prints, COMPARED.json a row of `compare --size SIZE --json`.
Prints each figure that differs by more than 0.05 dB or 1 %, and ends with 1 then. Python's standard library
only; slow, so SIZE should be small.
"""
import json
import math
import struct
import sys

SCALE = (1 / 1500, 1.15 / 1500, 1.66 / 1500)
GOLDEN_ANGLE = 2.39996323


def read_measured(path):
    with open(path, "rb") as file:
        data = file.read()
    dims = struct.unpack_from("<3i", data)
    cells = dims[0] * dims[1] * dims[2]
    values = struct.unpack_from("<%dd" % (3 * cells), data, 12)
    return dims, [[values[c * cells + n] * SCALE[c] for n in range(cells)] for c in range(3)]


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def fibonacci(i, n):
    z = 1 - 2 * (i + 0.5) / n
    r, phi = math.sqrt(1 - z * z), i * GOLDEN_ANGLE
    return [r * math.cos(phi), r * math.sin(phi), z]


def key(_):
    strong = [((0.5, 0.6, 0.8), 3), ((-0.7, 0.2, 0.6), 1), ((0.1, -0.5, 0.7), 0.6), ((0.9, 0.1, -0.25), 1.5), ((-0.5, 0.8, -0.4), 1.5)]
    return [(unit(v), w) for v, w in strong] + [(fibonacci(i, 24), 0.15) for i in range(24)]


def env(_):
    window = unit((-0.6, 0.5, 0.6))
    directions = [fibonacci(i, 400) for i in range(400)]
    return [(v, (0.3 + 0.7 * max(0, v[1]) + 4 * max(0, dot(v, window)) ** 40) * 4 * math.pi / 400) for v in directions]


def point(at):
    lights = []
    for place, intensity in [((1.8, 2.4, 3.0), 40), ((-3.0, 0.8, 2.6), 16), ((2.6, -1.2, -0.6), 14), ((-1.4, 2.6, -1.0), 14)]:
        towards = [p - a for p, a in zip(place, at)]
        lights.append((unit(towards), intensity / dot(towards, towards)))
    return lights


def coordinates(dims, normal, light):
    """Rusinkiewicz's angles as cell coordinates, the view along z."""
    half = unit([light[0], light[1], light[2] + 1])
    theta_h, theta_d = math.acos(min(1, dot(normal, half))), math.acos(min(1, dot(light, half)))
    across = cross(normal, half)
    along = [h * math.cos(theta_h) - n for h, n in zip(half, normal)]
    phi_d = math.atan2(dot(light, across), dot(light, along)) % math.pi
    return math.sqrt(theta_h / (math.pi / 2)) * dims[0], theta_d / (math.pi / 2) * dims[1], phi_d / math.pi * dims[2]


def neighbours(dims, at):
    """Cells and weights of a trilinear look-up between the cells' centres."""
    found = []
    at = max(at[0] - 0.5, 0), max(at[1] - 0.5, 0), (at[2] - 0.5) % dims[2]
    i, j, k = (int(x) for x in at)
    for di, dj, dk in [(a, b, c) for a in (0, 1) for b in (0, 1) for c in (0, 1)]:
        weight = 1.0
        for d, x in ((di, at[0] - i), (dj, at[1] - j), (dk, at[2] - k)):
            weight *= x if d else 1 - x
        cell = (k + dk) % dims[2] + dims[2] * (min(j + dj, dims[1] - 1) + dims[1] * min(i + di, dims[0] - 1))
        found.append((cell, weight))
    return found


def spheres(dims, size, lights_at, tables):
    images = [[] for _ in tables]
    for y in range(size):
        for x in range(size):
            u, v = (x + 0.5) / size * 2 - 1, 1 - (y + 0.5) / size * 2
            if u * u + v * v >= 0.99:
                continue
            normal = [u, v, math.sqrt(1 - u * u - v * v)]
            sums = [[0.0] * 3 for _ in tables]
            for light, weight in lights_at(normal):
                cosine = dot(normal, light)
                if cosine <= 1e-3:
                    continue
                for cell, share in neighbours(dims, coordinates(dims, normal, light)):
                    for total, table in zip(sums, tables):
                        for c in range(3):
                            total[c] += share * cosine * weight * table[c][cell]
            for image, total in zip(images, sums):
                image.append(total)
    return images


def srgb(x):
    x = min(1, max(0, x))
    return 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055


def exposure_of(reference):
    means = sorted(sum(p) / 3 for p in reference)
    return 0.9 / max(1e-12, means[int(0.9 * len(means))])


def psnr(reference, estimate):
    exposure = exposure_of(reference)
    real = whole = 0.0
    for p, q in zip(reference, estimate):
        for a, b in zip(p, q):
            a, b = srgb(a * exposure), srgb(b * exposure)
            real += (a - b) ** 2
            whole += (math.floor(255 * a + 0.5) - math.floor(255 * b + 0.5)) ** 2
    terms = 3 * len(reference)
    return 10 * math.log10(255**2 / max(1e-6, whole / terms)), 10 * math.log10(1 / max(1e-12, real / terms))


def itp(rgb):
    """ITU-R BT.2100's I, C_T / 2 and C_P of sRGB's primaries in 0 .. 1, white at 100 cd/m^2."""
    wide = [100 * dot(row, rgb) for row in ((0.6274, 0.3293, 0.0433), (0.0691, 0.9195, 0.0114), (0.0164, 0.0880, 0.8956))]
    powers = [(dot(row, wide) / 4096 / 10000) ** (2610 / 16384) for row in ((1688, 2146, 262), (683, 2951, 462), (99, 309, 3688))]
    l, m, s = (((3424 / 4096 + 2413 / 128 * y) / (1 + 2392 / 128 * y)) ** (2523 / 32) for y in powers)
    return (l + m) / 2, (6610 * l - 13613 * m + 7003 * s) / 8192, (17933 * l - 17390 * m - 543 * s) / 4096


def delta_itp(reference, estimate):
    """The mean of ITU-R BT.2124's colour difference over the pixels, exposed and cut as for the PSNR."""
    exposure = exposure_of(reference)
    differences = [720 * math.dist(*(itp([min(1, max(0, x * exposure)) for x in p]) for p in pair)) for pair in zip(reference, estimate)]
    return sum(differences) / len(differences)


def wholly_below(dims, i, j, k):
    """FORMAT.md, section 6, horizon rule, first condition: even the cell's highest place has a direction below the horizon."""
    th, td = (i / dims[0]) ** 2 * math.pi / 2, j / dims[1] * math.pi / 2
    crosses = 2 * k <= dims[2] <= 2 * (k + 1)
    turn = 0 if crosses else min(abs(math.cos(edge / dims[2] * math.pi)) for edge in (k, k + 1))
    return math.cos(td) * math.cos(th) - math.sin(td) * math.sin(th) * turn <= 0


def table_figures(dims, measured, decoded, valid):
    logs = roots = largest = seen_logs = 0.0
    seen = 0
    for n in valid:
        i, j, k = n // (dims[1] * dims[2]), n // dims[2] % dims[1], n % dims[2]
        th, td, pd = (i / dims[0]) ** 2 * math.pi / 2, j / dims[1] * math.pi / 2, k / dims[2] * math.pi
        a, b = math.cos(td) * math.cos(th), math.sin(td) * math.cos(pd) * math.sin(th)
        cosine = max(0, min(a - b, a + b))
        below = wholly_below(dims, i, j, k)
        seen += not below
        for c in range(3):
            r, e = measured[c][n], decoded[c][n]
            ratio = math.log10((e + 1e-3) / (r + 1e-3)) ** 2
            logs += ratio
            seen_logs += 0 if below else ratio
            roots += ((r * cosine) ** (1 / 3) - (e * cosine) ** (1 / 3)) ** 2
            largest = max(largest, abs(e - r) / (r + 1e-2))
    return math.sqrt(logs / (3 * len(valid))), math.sqrt(seen_logs / (3 * seen)), math.sqrt(roots / (3 * len(valid))), largest


def main(decoded_path, measured_path, size):
    with open(decoded_path) as file:
        decoded = json.load(file)["rgb"]
    dims, measured = read_measured(measured_path)
    cells = range(len(measured[0]))
    valid = [n for n in cells if all(math.isfinite(p[n]) and p[n] >= 0 for p in measured)]
    kept = set(valid)
    for table in (measured, decoded):
        for plane in table:
            plane[:] = [plane[n] if n in kept else 0.0 for n in cells]
    found = json.load(sys.stdin)
    expected = {}
    for name, lights_at in (("key", key), ("env", env), ("point", point)):
        images = spheres(dims, size, lights_at, (measured, decoded))
        expected["psnr8_" + name], expected["psnr_" + name] = psnr(*images)
        expected["delta_itp_" + name] = delta_itp(*images)
    names = "log_rmse", "seen_log_rmse", "cube_root_rmse", "largest_relative"
    expected |= zip(names, table_figures(dims, measured, decoded, valid))
    wrong = 0
    for name, value in expected.items():
        allowed = 0.05 if name.startswith("psnr") else 0.01 * value
        if not abs(found[name] - value) <= allowed:
            print(f"{name}: compare says {found[name]:.6g}, the definition gives {value:.6g}")
            wrong += 1
    print(f"{len(expected) - wrong} of {len(expected)} figures agree")
    return 1 if wrong else 0


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], int(sys.argv[3])))
