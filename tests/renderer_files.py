#!/usr/bin/env python3
"""Reads what `extract --format bsdf` and `--format mbsdf` write, by code of its own, and draws a sphere of it.

    renderer_files.py DECODED.json FILE LEAST

DECODED.json is what scripts/read_bpk.py decode prints of the material. FILE's sphere under the four point lights must have LEAST dB at least
against the table's, as compare_by_hand.py draws and measures it. A tensor file is looked up as Dupuy and Jakob (2018) and
rgl-epfl/brdf-loader have it, one with `spectra` at its first, middle and last wavelengths only, which must lie between what the channels are. Python's standard library only.
"""
import array
import bisect
import json
import math
import struct
import sys

from compare_by_hand import dot, point, psnr, spheres

SIZE = 24


def tensors(data):
    """Fields of a tensor file as (shape, values)."""
    assert data[:14] == b"tensor_file\0\1\0", "no tensor file of version 1.0"
    count, = struct.unpack_from("<I", data, 14)
    at, fields = 18, {}
    for _ in range(count):
        length, = struct.unpack_from("<H", data, at)
        name = data[at + 2:at + 2 + length].decode()
        rank, kind, offset = struct.unpack_from("<HBQ", data, at + 2 + length)
        shape = struct.unpack_from(f"<{rank}Q", data, at + 13 + length)
        at += 13 + length + 8 * rank
        assert offset % 8 == 0 and name not in fields
        values = array.array({1: "B", 5: "I", 10: "f"}[kind])
        values.frombytes(data[offset:offset + values.itemsize * math.prod(shape)])
        assert len(values) == math.prod(shape), f"{name} is cut"
        fields[name] = shape, values
    return fields


def split(x, count):
    """The interval of `count` nodes on [0, 1] where x lies, and how far into it."""
    x = min(max(x, 0.0), 1.0) * (count - 1)
    n = min(int(x), count - 2)
    return n, x - n


class Tensor:
    def __init__(self, data):
        fields = tensors(data)
        for name, wanted in (("phi_i", (1,)), ("jacobian", (1,))):
            assert fields[name][0] == wanted, name
        assert fields["jacobian"][1][0] == 1 and fields["phi_i"][1][0] == 0
        self.theta = list(fields["theta_i"][1])
        assert self.theta[0] == 0 and abs(self.theta[-1] - math.pi / 2) < 1e-6 and self.theta == sorted(self.theta)
        (rows, self.nodes), ndf = fields["ndf"]
        self.ndf, self.sigma = list(ndf[:self.nodes]), list(fields["sigma"][1][:self.nodes])
        assert rows == 2 and list(ndf[self.nodes:]) == self.ndf
        self.vndf_shape, self.vndf = fields["vndf"]
        if "rgb" in fields:
            (one, angles, self.channels, self.size, also), self.samples = fields["rgb"]
            assert self.channels == 3
        else:
            (one, angles, self.channels, self.size, also), self.samples = fields["spectra"]
            assert list(fields["wavelengths"][1]) == sorted(fields["wavelengths"][1]) and len(fields["wavelengths"][1]) == self.channels
        assert one == 1 and angles == len(self.theta) and self.size == also
        assert fields["luminance"][0] == (1, angles, self.size, self.size) and min(fields["luminance"][1]) > 0
        assert min(self.vndf) >= 0 and min(self.ndf) > 0 and abs(self.sigma[0] - 1) < 1e-5
        self.slices = [self.integrals(n) for n in range(angles)]

    def integrals(self, angle):
        """(density, integral along each line, integral of the lines before) of one angle, of mass 1."""
        height, width = self.vndf_shape[2:]
        first = angle * height * width
        density = [list(self.vndf[first + y * width:first + (y + 1) * width]) for y in range(height)]
        along = [[0.0] for _ in range(height)]
        for line, total in zip(density, along):
            for x in range(1, width):
                total.append(total[-1] + (line[x - 1] + line[x]) / 2 / (width - 1))
        before = [0.0]
        for y in range(1, height):
            before.append(before[-1] + (along[y - 1][-1] + along[y][-1]) / 2 / (height - 1))
        mass = before[-1]
        return [[v / mass for v in line] for line in density], [[v / mass for v in line] for line in along], [v / mass for v in before]

    def warp(self, angle, weight, u, v):
        height, width = self.vndf_shape[2:]
        x, fx = split(u, width)
        y, fy = split(v, height)
        one, two = self.slices[angle], self.slices[angle + 1]

        def mix(part, *at):
            a, b = one[part], two[part]
            for n in at:
                a, b = a[n], b[n]
            return (1 - weight) * a + weight * b

        def lines(part, column):
            return (1 - fy) * mix(part, y, column) + fy * mix(part, y + 1, column)
        left, right = lines(0, x), lines(0, x + 1)
        whole = lines(1, width - 1)
        s = (lines(1, x) + (fx * left + fx * fx / 2 * (right - left)) / (width - 1)) / whole
        low, high = mix(1, y, width - 1), mix(1, y + 1, width - 1)
        t = mix(2, y) + (fy * low + fy * fy / 2 * (high - low)) / (height - 1)
        return s, t

    def sample(self, angle, channel, s, t):
        x, fx = split(s, self.size)
        y, fy = split(t, self.size)
        at = ((angle * self.channels + channel) * self.size + y) * self.size + x
        low = (1 - fx) * self.samples[at] + fx * self.samples[at + 1]
        high = (1 - fx) * self.samples[at + self.size] + fx * self.samples[at + self.size + 1]
        return (1 - fy) * low + fy * high

    def evaluate(self, theta_i, half, channels):
        """f cos theta_o; `half` is (theta_m, phi_m - phi_i)."""
        def node(values, theta):
            n, f = split(math.sqrt(theta * 2 / math.pi), self.nodes)
            return (1 - f) * values[n] + f * values[n + 1]
        angle = min(max(bisect.bisect_right(self.theta, theta_i) - 1, 0), len(self.theta) - 2)
        weight = min((theta_i - self.theta[angle]) / (self.theta[angle + 1] - self.theta[angle]), 1)
        s, t = self.warp(angle, weight, math.sqrt(half[0] * 2 / math.pi), (half[1] / (2 * math.pi) + 0.5) % 1)
        scale = node(self.ndf, half[0]) / (4 * node(self.sigma, theta_i))
        return [scale * ((1 - weight) * self.sample(angle, c, s, t) + weight * self.sample(angle + 1, c, s, t)) for c in channels]


class Mbsdf:
    channels = 3

    def __init__(self, data):
        head, rest = data.split(b"MBSDF_DATA=\n", 1)
        lines = head.split(b"\n")
        assert lines[0] == b"NVIDIA ARC MBSDF V1" and all(line.isascii() and b"=" in line for line in lines[1:-1]) and lines[-1] == b""
        kind, self.theta, self.phi = struct.unpack_from("<3I", rest)
        assert kind == 1
        self.values = array.array("f", rest[12:])
        assert len(self.values) == 3 * self.theta ** 2 * self.phi

    def evaluate(self, theta_i, theta_o, phi):
        """f cos theta_o between the cells' centres, the outermost of which hold on."""
        axes = []
        for x, count, most in ((theta_i, self.theta, math.pi / 2), (theta_o, self.theta, math.pi / 2), (phi, self.phi, math.pi)):
            x = min(max(x / most * count - 0.5, 0), count - 1)
            n = min(int(x), count - 2)
            axes.append(((n, 1 - x + n), (n + 1, x - n)))
        total = [0.0] * 3
        for a, wa in axes[0]:
            for b, wb in axes[1]:
                for c, wc in axes[2]:
                    at = 3 * ((a * self.theta + b) * self.phi + c)
                    for k in range(3):
                        total[k] += wa * wb * wc * self.values[at + k]
        return [v * math.cos(theta_o) for v in total]


def in_frame(normal, light):
    """(theta_i, theta_o, phi_o - phi_i, theta_m, phi_m - phi_i) of the view along z as w_i and the light as w_o."""
    across = math.hypot(normal[0], normal[1])
    x = [-normal[0] * normal[2] / across, -normal[1] * normal[2] / across, across] if across > 0 else [1, 0, 0]
    y = [normal[1] * x[2] - normal[2] * x[1], normal[2] * x[0] - normal[0] * x[2], normal[0] * x[1] - normal[1] * x[0]]
    wi, wo = [x[2], y[2], normal[2]], [dot(light, x), dot(light, y), dot(light, normal)]
    m = [a + b for a, b in zip(wi, wo)]

    def angles(w):
        return math.atan2(math.hypot(w[0], w[1]), w[2]), math.atan2(w[1], w[0])
    (theta_i, phi_i), (theta_o, phi_o), (theta_m, phi_m) = angles(wi), angles(wo), angles(m)
    return theta_i, theta_o, phi_o - phi_i, theta_m, phi_m - phi_i


def sphere(material, channels):
    image = []
    for y in range(SIZE):
        for x in range(SIZE):
            u, v = (x + 0.5) / SIZE * 2 - 1, 1 - (y + 0.5) / SIZE * 2
            if u * u + v * v >= 0.99:
                continue
            normal, total = [u, v, math.sqrt(1 - u * u - v * v)], [0.0] * len(channels)
            for light, weight in point(normal):
                if dot(normal, light) <= 1e-3:
                    continue
                theta_i, theta_o, phi, theta_m, phi_m = in_frame(normal, light)
                if isinstance(material, Mbsdf):
                    value = material.evaluate(theta_i, theta_o, abs((phi + math.pi) % (2 * math.pi) - math.pi))
                else:
                    value = material.evaluate(theta_i, (theta_m, phi_m), channels)
                total = [t + weight * w for t, w in zip(total, value)]
            image.append(total)
    return image


def main(decoded_path, path, least):
    with open(decoded_path) as file:
        decoded = json.load(file)
    dims = [decoded["lattice"][axis] for axis in ("theta_h", "theta_d", "phi_d")] if "lattice" in decoded else decoded["dims"]
    table = [plane[:] for plane in decoded["rgb"]]
    with open(path, "rb") as file:
        data = file.read()
    material = Tensor(data) if data.startswith(b"tensor_file") else Mbsdf(data)
    reference, = spheres(dims, SIZE, point, [table])
    if material.channels == 3:
        figure = psnr(reference, sphere(material, (0, 1, 2)))[1]
        print(f"{path}: " + (f"{least} dB at least" if figure >= float(least) else f"{figure:.1f} dB"))
        return 0 if figure >= float(least) else 1
    # short, middle and long waves: between what the three channels are, but for what they are off themselves
    spectral = sphere(material, (0, material.channels // 2, material.channels - 1))
    slack = 0.1 * max(max(p) for p in reference)
    outside = sum(not min(p) - slack <= w <= max(p) + slack for p, q in zip(reference, spectral) for w in q)
    print(f"{path}: {material.channels} wavelengths, {outside} values beyond the channels")
    return 1 if outside else 0


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
