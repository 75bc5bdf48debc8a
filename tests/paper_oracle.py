#!/usr/bin/env python3
"""The paper's profile worked out slowly: from a small measured lattice to its decoded table.

    paper_oracle.py TABLE.json        what `test_paper --table` writes: a lattice, and what the library makes of it

Written from the formulas (format-spec/FORMAT.md and the headers of src/model/paper), with dense matrices and double precision, and
nothing of the library's code. Its table must agree with the library's to 1e-5 of each channel's largest value; and a mutant of it, with
half the coefficients, another wavelet, or a slice for every theta_h, must not. Standard library only.
"""
import json
import math
import struct
import sys


def f32(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


def bits(x):
    return struct.unpack("<I", struct.pack("<f", x))[0]


def clamp(x, low, high):
    return min(max(x, low), high)


# ---- wavelets as matrices: row a of an axis' matrix is what coefficient a is made of ----

ROOT = math.sqrt(0.5)
HAAR = [ROOT, ROOT]
DAUBECHIES = [(a + b * math.sqrt(3)) / (4 * math.sqrt(2)) for a, b in ((1, 1), (3, 1), (3, -1), (1, -1))]


def axis_matrix(n, low):
    levels = max(int(math.log2(n)) - 1, 0)
    m = (n + 2 ** levels - 1) // 2 ** levels * 2 ** levels
    rows, high = [[float(a == b) for b in range(m)] for a in range(m)], [(-1) ** k * x for k, x in enumerate(reversed(low))]
    for level in range(levels):
        size, before = m >> level, [row[:] for row in rows]
        for i in range(size // 2):
            for b in range(m):
                rows[i][b] = sum(h * before[(2 * i + k) % size][b] for k, h in enumerate(low))
                rows[size // 2 + i][b] = sum(g * before[(2 * i + k) % size][b] for k, g in enumerate(high))
    return [row[:n] for row in rows]


class Plane:
    """Fields of rows x columns; coefficients indexed column-major, with an even and an odd part where mirrored."""

    def __init__(self, rows, columns, low, mirrored):
        self.rows, self.columns = rows, columns
        self.by_row = axis_matrix(rows, low)
        if not mirrored:
            self.by_column = axis_matrix(columns, low)
        else:
            half, self.by_column = axis_matrix((columns + 1) // 2, low), []
            for sign in 1, -1:
                for line in half:
                    out = [0.0] * columns
                    for k in range(columns // 2):
                        out[k], out[-1 - k] = line[k] * ROOT, sign * line[k] * ROOT
                    if columns % 2 and sign > 0:
                        out[columns // 2] = line[columns // 2]
                    self.by_column.append(out)
        self.count = len(self.by_row) * len(self.by_column)
        self.sparse = [[(k, v) for k, v in enumerate(line) if v] for line in self.by_column], \
            [[(r, v) for r, v in enumerate(line) if v] for line in self.by_row]

    def forward(self, field, power=1):
        columns, rows = self.sparse
        step = [[sum(v ** power * field[r * self.columns + k] for k, v in line) for r in range(self.rows)] for line in columns]
        return [sum(v ** power * of[r] for r, v in line) for of in step for line in rows]

    def inverse(self, x):
        height, out = len(self.by_row), [0.0] * (self.rows * self.columns)
        for c, line in enumerate(self.sparse[0]):
            part = x[c * height:(c + 1) * height]
            if not any(part):
                continue
            of_row = [0.0] * self.rows
            for a, v in enumerate(part):
                if v:
                    for r, w in self.sparse[1][a]:
                        of_row[r] += v * w
            for r in range(self.rows):
                for k, w in line:
                    out[r * self.columns + k] += of_row[r] * w
        return out


# ---- few coefficients ----

def energies(plane, weight):
    return plane.forward(weight, 2), max(f32(0.05) * sum(weight) / len(weight), 1e-30)


def gradient(plane, wanted, weight, x):
    return plane.forward([w * (y - v) for w, y, v in zip(weight, wanted, plane.inverse(x))])


def gains_of(x, g, energy, least):
    return [e * (a + 0.7 * b / (e + least)) ** 2 for a, b, e in zip(x, g, energy)]


def largest(gains, keep):
    """Which of the gains are kept, and the least gain of the bin in which that is decided."""
    count = {}
    for gain in gains:
        count[bits(gain) >> 17] = count.get(bits(gain) >> 17, 0) + 1
    edge, above = (1 << 14) - 1, 0
    while edge > 1 and above + count.get(edge, 0) <= keep:
        above += count.get(edge, 0)
        edge -= 1
    rest, kept = keep - above, []
    for gain in gains:
        at = bits(gain) >> 17
        kept.append(at > edge or at == edge and rest > 0)
        rest -= at == edge and rest > 0
    return kept, struct.unpack("<f", struct.pack("<I", edge << 17))[0]


def refine(plane, wanted, weight, energy, least, kept, steps, x):
    x = [a if k else 0.0 for a, k in zip(x, kept)]
    inverse = [1 / (e + least) if k else 0.0 for e, k in zip(energy, kept)]
    g = gradient(plane, wanted, weight, x)
    direction = [i * v for i, v in zip(inverse, g)]
    size = sum(a * b for a, b in zip(direction, g))
    noise = max(1e-9 * size, 1e-12 * sum(e * a * a for e, a in zip(energy, x)))
    for _ in range(steps):
        if not size > noise:
            break
        image = plane.inverse(direction)
        curvature = sum(w * v * v for w, v in zip(weight, image))
        if not curvature > 0:
            break
        length = size / curvature
        image = plane.forward([w * v for w, v in zip(weight, image)])
        x = [a + length * b for a, b in zip(x, direction)]
        g = [a - length * b for a, b in zip(g, image)]
        z = [i * v for i, v in zip(inverse, g)]
        following = sum(a * b for a, b in zip(z, g))
        direction = [a + following / size * b for a, b in zip(z, direction)]
        size = following
    return x, g


def rounds(plane, wanted, weight, energy, least, keep, count, steps, x):
    g, edge = gradient(plane, wanted, weight, x), 0
    for _ in range(count):
        kept, edge = largest(gains_of(x, g, energy, least), keep)
        x, g = refine(plane, wanted, weight, energy, least, kept, steps, x)
    return x, g, edge


def is_one(wanted, weight):
    squares = [(y - 1) ** 2 for y, w in zip(wanted, weight) if w > 0]
    return not sum(squares) > 1e-6 * len(squares)


def decoded(plane, wanted, weight, energy, least, unit, x, low):
    """The field as its quantised coefficients say."""
    there = [(e, a) for e, a in zip(energy, x) if a]
    if is_one(wanted, weight):
        return [1.0] * len(wanted)
    step = unit * 2 ** (-0.5 * sum(math.log2(e + 1e-6 * least + 1e-300) for e, _ in there) / len(there)) if there else 0
    step = max(step, max((abs(a) for _, a in there), default=0) / 1048574, 1e-30)
    step = 2.0 ** (clamp(math.ceil(256 * math.log2(step)), -25600, 7680) / 256)
    levels = [clamp(round(a / step), -1048575, 1048575) for a in x]
    if not any(levels):
        levels[0], step = 1, 2.0 ** -100
    return [clamp(v, low, 1e6) for v in plane.inverse([l * step for l in levels])]


# ---- one material ----

class Material:
    def __init__(self, dims, measured, mutant):
        self.dims, self.measured = dims, measured
        h, d, p = dims
        self.valid = [all(channel[n] >= 0 for channel in measured) for n in range(h * d * p)]
        self.shared = h - 1 if mutant == "no sharing" else next(i for i in range(h) if 9 * i * i >= 4 * h * h)
        self.fraction = 2 if mutant == "fraction" else 1
        slices = HAAR if mutant == "wavelet" else DAUBECHIES
        self.planes = Plane(h, d, HAAR, False), Plane(h, p, HAAR, True), Plane(d, p, slices, True)
        self.keep = [max(r * c // share // self.fraction, 1) for r, c, share in ((h, d, 16), (h, p, 16), (d, p, 64))]
        self.keep[2] *= self.shared + 1
        self.place()
        self.unit = self.unit_of()

    def place(self):
        h, d, p = self.dims
        self.even, self.odd, self.area = [], [], []
        for i in range(h):
            theta_h = ((i + 0.5) / h) ** 2 * math.pi / 2
            for j in range(d):
                theta_d = (j + 0.5) / d * math.pi / 2
                self.even.append(f32(math.cos(theta_d) * math.cos(theta_h)))
                self.odd.append(f32(math.sin(theta_d) * math.sin(theta_h)))
                self.area.append(f32((2 * i + 1) / h / h * math.pi / 2 * math.sin(theta_h) * math.sin(theta_d) * math.cos(theta_d)))
        self.cos_phi = [f32(math.cos((k + 0.5) / p * math.pi)) for k in range(p)]

    def unit_of(self):
        h, d, p = self.dims
        chance, total, state, pixels = [], 0.0, 1, []
        for area in self.area:
            total += area
            chance.append(total)

        def draw():
            nonlocal state
            state = (state * 6364136223846793005 + 1442695040888963407) % 2 ** 64
            return (state >> 11) * 2.0 ** -53
        for _ in range(1000):
            brightness = 0.0
            for light in range(29):
                at = draw() * total
                k = int(draw() * p)
                place = next(n for n, c in enumerate(chance) if c > at or n == h * d - 1)
                turn = self.odd[place] * self.cos_phi[k]
                i, o = self.even[place] - turn, self.even[place] + turn
                if draw() < i + o and i > 0 and o > 0:
                    mean = [sum(c[n] for c in self.measured) / 3 if self.valid[n] else 0.0 for n in (place * p + k, place * p + p - 1 - k)]
                    brightness += (3, 1.5, 1.5, 1, 0.6, *[0.15] * 24)[light] * (mean[0] * i + mean[1] * o) / 2
            pixels.append(brightness)
        mean, tenth = sum(pixels) / 1000, sorted(pixels)[900]
        return tenth if tenth > 1e-4 * mean else mean or 1.0

    def weights(self, x):
        p, weight, shown = self.dims[2], [], []
        for n, value in enumerate(x):
            place, k = divmod(n, p)
            turn = self.odd[place] * self.cos_phi[k]
            i, o = max(self.even[place] - turn, 0), max(self.even[place] + turn, 0)
            q, r = 2 * value * i + 0.25, 2 * value * o + 0.25
            picture = o * (2 * i) ** 2 / (q + q * q / 5) + i * (2 * o) ** 2 / (r + r * r / 5)
            least, true = min(i, o), self.even[place] - abs(turn)
            seen = min(0.1 + 4 * least, 1) if least > 0 else 0.02
            weight.append((0.5 * self.area[place] * picture + 0.01 / self.dims[0] * seen / (value + 0.02) ** 2) if self.valid[n] else 0.0)
            shown.append(0.0 if not self.valid[n] else (0.05 + 4 * true if true < 0.24 else 1.0) if true > 0 else 0.01)
        return weight, shown

    def marginals(self, x, shown):
        h, d, p = self.dims
        cells = [(i, j, k) for i in range(h) for j in range(d) for k in range(p)]
        logs, weight = [math.log2(max(v, 3e-4)) for v in x], [s * (1 if n // (d * p) < self.shared else 0.1) for n, s in enumerate(shown)]
        f = [[0.0] * extent for extent in self.dims]

        def turn(axis):
            sums, weights = [0.0] * self.dims[axis], [0.0] * self.dims[axis]
            for n, at in enumerate(cells):
                sums[at[axis]] += weight[n] * (logs[n] - sum(f[a][at[a]] for a in range(3) if a != axis))
                weights[at[axis]] += weight[n]
            for i in range(self.dims[axis]):
                mean = sums[i] / weights[i] if weights[i] > 0 else f[axis][i - 1] if i and axis < 2 else 0.0
                f[axis][i] = clamp(mean, -4.32, 4.32) if axis else mean
        for _ in range(3):
            for _ in range(8):
                turn(0)
                turn(1)
            turn(2)
        rest, measured = [], []
        for i in range(h):
            for j in range(d):
                w = sum(weight[(i * d + j) * p + k] for k in range(p))
                mean = sum(weight[(i * d + j) * p + k] * (logs[(i * d + j) * p + k] - f[2][k]) for k in range(p)) / w if w else 0
                measured.append(w)
                rest.append(2 ** clamp(mean - f[0][i] - f[1][j], -4.32, 4.32) if w else 1.0)
        f = [[2.0 ** v for v in axis] for axis in f]
        f[0] = [v if any(x[i * d * p:(i + 1) * d * p]) else 0.0 for i, v in enumerate(f[0])]
        return f, rest, measured

    def pairs(self, x, weight, f, rest, measured):
        """By turns: K, c_hd, c_hphi, and what the shared slice should be."""
        h, d, p = self.dims
        own = range(self.shared, h)
        a, a_weight, b_weight = [0.0] * (h * d), [0.0] * (h * d), [0.0] * (h * p)
        b, s, s_weight = [f[2][k] for _ in range(h) for k in range(p)], [1.0] * (d * p), [0.0] * (d * p)

        def ratio(terms):
            top = bottom = 0.0
            for n, factor in terms:
                top += weight[n] * x[n] * factor
                bottom += weight[n] * factor * factor
            return top, bottom

        def a_update():
            for i in own:
                for j in range(d):
                    top, bottom = ratio(((i * d + j) * p + k, b[i * p + k] * s[j * p + k]) for k in range(p))
                    a[i * d + j], a_weight[i * d + j] = top / bottom if bottom else 0.0, bottom

        def b_update():
            for i in own:
                for k in range(p):
                    top, bottom = ratio(((i * d + j) * p + k, a[i * d + j] * s[j * p + k]) for j in range(d))
                    b[i * p + k], b_weight[i * p + k] = top / bottom if bottom else f[2][k], bottom

        def s_update():
            sums = [ratio(((i * d + j) * p + k, a[i * d + j] * b[i * p + k]) for i in own) for j in range(d) for k in range(p)]
            ridge = 1e-3 * sum(bottom for _, bottom in sums) / (d * p)
            for n, (top, bottom) in enumerate(sums):
                s[n], s_weight[n] = min((top + ridge) / (bottom + ridge), 30) if ridge else 1.0, bottom
        a_update()
        for _ in range(3):
            b_update()
            s_update()
            a_update()
        for i in own:
            terms = [(a_weight[i * d + j] * a[i * d + j] ** 2, math.log2(a[i * d + j] / f[1][j])) for j in range(d) if a[i * d + j] > 0]
            if sum(w for w, _ in terms) > 0 and f[0][i] > 0:
                f[0][i] = 2 ** (sum(w * v for w, v in terms) / sum(w for w, _ in terms))
        level = 1.0
        for axis in range(3):
            mean = sum(f[axis]) / len(f[axis])
            f[axis] = [2.0 ** (max(round(1024 * math.log2(v / mean)), -32767) / 1024) if v else 0.0 for v in f[axis]]
            level *= mean
        a, a_weight = [v * mean for v in a], [v / mean ** 2 for v in a_weight]
        start = [[0.0] * plane.count for plane in self.planes[:2]]

        def code(kind, wanted, w, first, last):
            plane = self.planes[kind]
            if is_one(wanted, w):
                return [1.0] * len(wanted)
            energy, least = energies(plane, w)
            start[kind], _, edge = rounds(plane, wanted, w, energy, least, self.keep[kind], 4 if first else 1, 8, start[kind])
            if last:
                return decoded(plane, wanted, w, energy, least, math.sqrt(edge) / 16, start[kind], 1 / 32)
            return [max(v, 1 / 32) for v in plane.inverse(start[kind])]
        for turn in range(3):
            if turn:
                a_update()
            wanted, w = rest[:], measured[:]
            for i in own:
                for j in range(d):
                    of, n = level * f[0][i] * f[1][j], i * d + j
                    wanted[n], w[n] = clamp(a[n] / of if of and a_weight[n] else 1.0, 1 / 32, 1e6), a_weight[n] * of * of
            mean = sum(w[self.shared * d:]) / (len(own) * d) or 1.0
            for n in range(self.shared * d):
                w[n] = 0.2 * mean * 3 / p * measured[n]
            hd = code(0, wanted, w, turn == 0, turn == 2)
            for i in own:
                for j in range(d):
                    a[i * d + j] = level * f[0][i] * f[1][j] * hd[i * d + j]
            b_update()
            wanted, w = [1.0] * (h * p), [0.0] * (h * p)
            for i in own:
                for k in range(p):
                    wanted[i * p + k], w[i * p + k] = clamp(b[i * p + k] / f[2][k], 1 / 32, 1e6), b_weight[i * p + k] * f[2][k] ** 2
            mean = sum(w) / (len(own) * p) or 1.0
            w[:self.shared * p] = [0.1 * mean] * (self.shared * p)
            hphi = code(1, wanted, w, turn == 0, turn == 2)
            for i in own:
                for k in range(p):
                    b[i * p + k] = f[2][k] * hphi[i * p + k]
            s_update()
        return level, hd, hphi, s, s_weight

    def slices(self, x, weight, f, level, hd, hphi, s, s_weight):
        h, d, p = self.dims
        plane, count, tasks, out = self.planes[2], self.shared + 1, [None] * (self.shared + 1), []
        start = [0.0] * plane.count
        for i in reversed(range(count)):
            wanted, w = s[:], s_weight[:]
            for n in range(d * p if i < self.shared else 0):
                j, k = divmod(n, p)
                b = level * f[0][i] * f[1][j] * hd[i * d + j] * f[2][k] * hphi[i * p + k]
                wanted[n], w[n] = (min(x[i * d * p + n] / b, 1e6), weight[i * d * p + n] * b * b) if b > 1e-20 else (0.0, 0.0)
            total = sum(w)
            if total > 0:
                usual, mean = sum(a * b for a, b in zip(w, wanted)) / total, total / (d * p)
                for n in range(d * p):
                    bright = wanted[n] / usual if usual > 0 else 0.0
                    if w[n] > 0:
                        w[n] = max(w[n], 0.01 * mean / max(bright, 1) ** 2)
                    else:
                        wanted[n], w[n] = usual, 0.001 * mean
            energy, least = energies(plane, w)
            start, g, _ = rounds(plane, wanted, w, energy, least, self.keep[2] // count, 1 if i < self.shared else 2, 6, start)
            tasks[i] = wanted, w, energy, least, start, gains_of(start, g, energy, least)
        kept, edge = largest([gain for task in tasks for gain in task[5]], self.keep[2])
        for i, (wanted, w, energy, least, start, _) in enumerate(tasks):
            x_slice, _ = refine(plane, wanted, w, energy, least, kept[i * plane.count:(i + 1) * plane.count], 6, start)
            out.append(decoded(plane, wanted, w, energy, least, math.sqrt(edge) / 16, x_slice, 0.0))
        return out

    def channel(self, c):
        h, d, p = self.dims
        x = [v / self.unit if ok else 0.0 for v, ok in zip(self.measured[c], self.valid)]
        weight, shown = self.weights(x)
        f, rest, measured = self.marginals(x, shown)
        level, hd, hphi, s, s_weight = self.pairs(x, weight, f, rest, measured)
        slices = self.slices(x, weight, f, level, hd, hphi, s, s_weight)
        model = [f[0][i] * f[1][j] * hd[i * d + j] * f[2][k] * hphi[i * p + k] * slices[min(i, self.shared)][j * p + k] * level * self.unit
                 for i in range(h) for j in range(d) for k in range(p)]
        diffuse, specular = bisquare([m for m, ok in zip(model, self.valid) if ok], [v for v, ok in zip(self.measured[c], self.valid) if ok])

        def loss(a, b):
            return sum(w * (v - max(a + b * m, 0)) ** 2 for w, v, m, ok in zip(weight, self.measured[c], model, self.valid) if ok)
        if loss(diffuse, specular) > 1.25 * loss(0, 1):
            diffuse, specular = 0.0, 1.0
        return [max(0.0, diffuse + specular * m) for m in model]


def bisquare(x, y):
    """DuMouchel and O'Brien (1989)."""
    n, mean = len(x), sum(x) / len(x)
    spread = sum((v - mean) ** 2 for v in x)
    leverage = [min(1 / n + (v - mean) ** 2 / spread, 0.9999) for v in x]
    centre = sum(y) / n
    deviation = math.sqrt(sum((v - centre) ** 2 for v in y) / (n - 1)) or 1e6
    line, weight = None, [1.0] * n
    for _ in range(5001):
        total = sum(weight)
        mx, my = sum(w * v for w, v in zip(weight, x)) / total, sum(w * v for w, v in zip(weight, y)) / total
        slope = sum(w * (a - mx) * (b - my) for w, a, b in zip(weight, x, y)) / sum(w * (a - mx) ** 2 for w, a in zip(weight, x))
        before, line = line, (my - slope * mx, slope)
        if before and all(abs(a - b) <= 2 ** -26 * max(abs(a), abs(b)) for a, b in zip(line, before)):
            break
        residual = [(b - line[0] - slope * a) / math.sqrt(1 - l) for a, b, l in zip(x, y, leverage)]
        ranked = sorted(abs(v) for v in residual)[1:]
        scale = (ranked[(n - 2) // 2] + ranked[(n - 1) // 2]) / 2 / 0.6745
        weight = [max(1 - (v / (4.685 * max(scale, 1e-6 * deviation))) ** 2, 0) ** 2 for v in residual]
    return line


def deviation(table, mutant=None):
    material = Material(tuple(table["dims"]), table["measured"], mutant)
    worst = 0.0
    for c in range(3):
        found, most = table["decoded"][c], max(table["decoded"][c])
        worst = max(worst, max(abs(a - b) for a, b in zip(material.channel(c), found)) / most)
    return worst


def main(path):
    with open(path, encoding="utf-8") as file:
        table = json.load(file)
    plain, bad = deviation(table), 0
    print(f"paper_oracle: the library's table is the oracle's to {plain:.2g} of the largest value")
    bad += not plain <= 1e-5
    for mutant in "fraction", "wavelet", "no sharing":
        other = deviation(table, mutant)
        print(f"paper_oracle: with another rule ({mutant}) it would be off by {other:.2g}")
        bad += not other > 1e-3
    return min(bad, 1)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
