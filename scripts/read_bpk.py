#!/usr/bin/env python3
"""Reads brdfpack archives, slowly: a second reader made from format-spec/FORMAT.md alone.

    read_bpk.py list ARCHIVE                     one line per material
    read_bpk.py verify ARCHIVE                   checks everything, decodes every layer
    read_bpk.py decode [--layers N] ARCHIVE NAME decoded values as JSON:
                                                 {"dims": [H, D, P], "rgb": [[...], [...], [...]]}
    read_bpk.py evaluate [--layers N] ARCHIVE NAME THETA_H THETA_D PHI_D...
                                                 R G B in 1/sr for each three angles in degrees

Needs Python 3.7 and nothing else. Exit status: 0 ok, 1 the archive is not, 2 usage. Chapter numbers in
comments are FORMAT.md's.
"""
import json
import math
import struct
import sys
import zlib


class Fault(Exception):
    """kind: "not ours", "unsupported", "checksum" or "corrupt" (chapter 1)."""

    def __init__(self, kind, offset, text):
        super().__init__(f"{kind} at offset {offset}: {text}")
        self.kind = kind


def demand(condition, kind, offset, text):
    if not condition:
        raise Fault(kind, offset, text)


# ---- 2: names ----

def check_name(raw, offset):
    try:
        text = raw.decode("utf-8")
    except UnicodeDecodeError:
        raise Fault("corrupt", offset, "a name is not UTF-8")
    demand(1 <= len(raw) <= 255 and text not in (".", ".."), "corrupt", offset, "an illegal name")
    demand(not any(ord(c) < 0x20 or 0x7F <= ord(c) < 0xA0 or c == "/" for c in text), "corrupt", offset, "an illegal name")
    return text


# ---- 3, 4: header and index ----

class Archive:
    PAGE = 4096

    def __init__(self, path):
        self.file = open(path, "rb")
        self.file.seek(0, 2)
        self.size = self.file.tell()
        head = self.read(0, min(64, self.size))
        demand(head[:8] == b"\x8bBPK\r\n\x1a\n", "not ours", 0, "no archive magic")
        demand(len(head) == 64, "corrupt", self.size, "the header is cut")
        demand(zlib.crc32(head[:60]) == struct.unpack_from("<I", head, 60)[0], "checksum", 60, "header")
        major, minor, flags, size, self.count, self.index, self.pages, self.depth = struct.unpack_from("<HHIQQQII", head, 8)
        demand(major == 1, "unsupported", 8, f"version {major}.{minor}")
        demand(flags & 0xFFFF == 0, "unsupported", 12, f"flags {flags:#x}")
        demand(minor > 0 or head[48:60] == bytes(12), "corrupt", 48, "reserved bytes")
        demand(size == self.size, "corrupt", min(size, self.size), "the file was cut or extended")
        demand(self.count <= min(100000000, 226 * self.pages) and self.pages <= 16000000 and self.depth <= 8 and self.depth <= self.pages and
               (self.count == 0) == (self.pages == 0) == (self.depth == 0), "corrupt", 24, "counts")
        demand(self.index >= 64 and self.index + self.PAGE * self.pages == size, "corrupt", 32, "index offset")

    def read(self, offset, count):
        self.file.seek(offset)
        data = self.file.read(count)
        demand(len(data) == count, "corrupt", offset + len(data), "the file ends here")
        return data

    def page(self, number, level, first_ordinal, first_name):
        """[(name, first ordinal, child)] of an inner page, [(name, ordinal, offset, bytes, head bytes)] of a leaf."""
        demand(0 <= number < self.pages, "corrupt", self.index, "a page number")
        base = self.index + self.PAGE * number
        data = self.read(base, self.PAGE)
        demand(data[:4] == b"\x8bIDX", "corrupt", base, "no page magic")
        demand(zlib.crc32(data[:4092]) == struct.unpack_from("<I", data, 4092)[0], "checksum", base + 4092, "index page")
        its_level, count, ordinal = struct.unpack_from("<HHQ", data, 4)
        demand(its_level == level and ordinal == first_ordinal and 1 <= count <= 255, "corrupt", base + 4, "page head")
        entries, at, fixed = [], 16, 13 if level else 17
        for i in range(count):
            demand(at + fixed <= 4092 and at + fixed + data[at + fixed - 1] <= 4092, "corrupt", base + at, "entry")
            raw = data[at + fixed:at + fixed + data[at + fixed - 1]]
            check_name(raw, base + at)
            demand(not entries or entries[-1][0] < raw, "corrupt", base + at, "names do not ascend")
            if level:
                child, first = struct.unpack_from("<IQ", data, at)
                demand(child < number, "corrupt", base + at, "child page")
                demand(first > entries[-1][1] if entries else first == ordinal, "corrupt", base + at, "ordinals")
                entries.append((raw, first, child))
            else:
                offset, size, head = struct.unpack_from("<QII", data, at)
                demand(245 <= head <= 4096 and head <= size <= 1 << 24, "corrupt", base + at, "entry's sizes")
                demand(64 <= offset and offset + size <= self.index, "corrupt", base + at, "entry's offset")
                entries.append((raw, ordinal + i, offset, size, head))
            at += fixed + len(raw)
        demand(data[at:4092] == bytes(4092 - at), "corrupt", base + at, "padding")
        demand(first_name is None or entries[0][0] == first_name, "corrupt", base + 16, "not the name its parent says")
        return entries

    def walk(self):
        """All leaf entries in order, checking the tree as a whole."""
        seen, last, ordinal, end = 0, b"", 0, 64
        todo = [(self.pages - 1, self.depth - 1, 0, None)] if self.pages else []
        while todo:
            number, level, first, name = todo.pop()
            seen += 1
            demand(seen <= self.pages, "corrupt", self.index, "pages are used twice")
            entries = self.page(number, level, first, name)
            if level:
                todo += [(child, level - 1, its_first, its_name) for its_name, its_first, child in reversed(entries)]
                continue
            for entry in entries:
                demand(entry[0] > last and entry[1] == ordinal, "corrupt", self.index + self.PAGE * number, "order of materials")
                demand(entry[2] == end, "corrupt", end, "a gap or an overlap")
                last, ordinal, end = entry[0], ordinal + 1, entry[2] + entry[3]
                yield entry
        demand(ordinal == self.count and seen == self.pages and end == self.index, "corrupt", self.index, "totals")

    def find(self, name):
        raw = name.encode()
        demand(self.count > 0, "not found", 0, name)
        number, level, first, its_name = self.pages - 1, self.depth - 1, 0, None
        while True:
            entries = self.page(number, level, first, its_name)
            at = max((i for i, e in enumerate(entries) if e[0] <= raw), default=0)
            if level == 0:
                demand(entries[at][0] == raw, "not found", 0, name)
                return entries[at]
            its_name, first, number = entries[at]
            level -= 1

    def record(self, entry):
        return Record(self, entry)


# ---- 5: records ----

class Record:
    def __init__(self, archive, entry):
        self.archive, self.base = archive, entry[2]
        head = archive.read(self.base, entry[4])
        at = self.base
        demand(head[:8] == b"\x8bREC\r\n\x1a\n", "corrupt", at, "no record magic")
        self.head_bytes, self.bytes = struct.unpack_from("<II", head, 8)
        demand(self.head_bytes == entry[4] and self.bytes == entry[3], "corrupt", at + 8, "sizes differ from the index")
        demand(zlib.crc32(head[:-4]) == struct.unpack("<I", head[-4:])[0], "checksum", at + self.head_bytes - 4, "record's head")
        (version, self.profile, self.codec_version, h, d, p, n, layers, sections, self.left_out, self.budget, self.max_error,
         self.effort, holes, self.horizon, self.source_bytes) = struct.unpack_from("<HHIHHHBBHHIdIIdQ", head, 16)
        demand(version == 2, "unsupported", at + 16, f"record version {version}")
        self.dims = (h, d, p)
        demand(all(4 <= x <= 1024 for x in self.dims) and h * d * p <= 1 << 24, "corrupt", at + 24, "lattice")
        demand(1 <= layers <= 16 and sections <= 64 and n >= 1, "corrupt", at + 30, "counts")
        demand(self.head_bytes == 212 + 32 * (layers + sections) + n, "corrupt", at + 8, "head bytes")
        demand(0 <= self.max_error < math.inf and self.effort <= 9, "corrupt", at + 40, "options")
        self.holes, self.zeros = holes & 0xFFFFFFF, holes >> 28  # cells taken as not measured, and by which rule
        demand(self.zeros <= 2 and self.holes <= (0 if self.zeros == 2 else h * d * p), "corrupt", at + 52, "holes")
        demand(-1 <= self.horizon <= 0, "corrupt", at + 56, "horizon")
        self.sha256 = head[72:104].hex()
        self.colour = [struct.unpack_from("<dddII", head, 112 + 32 * c) for c in range(3)]
        for diffuse, specular, rejected, _, converged in self.colour:
            demand(math.isfinite(diffuse) and math.isfinite(specular) and 0 <= rejected <= 1 and converged <= 1,
                   "corrupt", at + 112, "colour")
        self.layers = [struct.unpack_from("<Ifddd", head, 208 + 32 * i) for i in range(layers)]
        self.sections = [struct.unpack_from("<HHHHHHIIId", head, 208 + 32 * (layers + i)) for i in range(sections)]
        end, before = self.head_bytes, 0
        for kind, codec, version, layer, flags, reserved, offset, size, crc, error in self.sections:
            demand(reserved == 0 and before <= layer < layers and offset == end and size >= 1, "corrupt", at + 208, "section table")
            end, before = end + size, layer
        demand(end == self.bytes, "corrupt", at + 12, "record bytes")
        for number, (size, *figures) in enumerate(self.layers):
            ends = [s[6] + s[7] for s in self.sections if s[3] <= number]
            demand(size == max(ends, default=self.head_bytes) and all(f >= 0 for f in figures),
                   "corrupt", at + 208, "layer table")
        self.name = check_name(head[-4 - n:-4], at)
        demand(self.name.encode() == entry[0], "corrupt", at, "not the name that the index says")

    def section(self, entry):
        """Its bytes, checked."""
        data = self.archive.read(self.base + entry[6], entry[7])
        demand(zlib.crc32(data) == entry[8], "checksum", self.base + entry[6], f"section of type {entry[0]}")
        return data

    def origin(self):
        """What the source was, or None: the optional section of type 32 (chapter 5, Origin)."""
        for entry in self.sections:
            if entry[:3] != (32, 0, 1) or entry[7] != 28:
                continue
            kind, observer, illuminant, primaries, count, first, last, cells, median, most = struct.unpack("<BBBBIffIff", self.section(entry))
            at = self.base + entry[6]
            demand(kind in ORIGINS, "corrupt", at, f"origin of kind {kind}")
            demand(0 <= first <= last < 1e6 and 0 <= median <= 2 and 0 <= most <= 2, "corrupt", at + 8, "origin's figures")
            spectra = f", {count} wavelengths from {first:g} to {last:g} nm" if kind == 2 else ""
            return f"{ORIGINS[kind]}{spectra}; directions differed by {100 * median:.1f} % (median), {100 * most:.1f} % (95th percentile)"
        return None

    def load(self, layers, known):
        """{type: bytes} of the sections of layers 0..layers-1 whose (type, codec, version) is known, each type once."""
        return {entry[0]: data for entry, data in self.load_list(layers, known, True)}

    def load_list(self, layers, known, unique=False):
        """[(entry, bytes)] likewise, in the order of the file."""
        found = []
        for entry in self.sections:
            if entry[3] >= layers:
                continue
            if entry[:3] not in known:
                demand(not entry[4] & 1, "unsupported", self.base + entry[6], f"section {entry[:3]}")
                continue
            demand(not unique or all(entry[0] != other[0] for other, _ in found), "corrupt", self.base + entry[6], "a section twice")
            found.append((entry, self.section(entry)))
        return found

    def decode(self, layers=0):
        """Three lists of H * D * P values, in 1/sr."""
        layers = min(layers or len(self.layers), len(self.layers))
        demand(self.profile in DECODERS, "unsupported", self.base + 18, f"profile {self.profile}")
        return DECODERS[self.profile](self, layers)


ORIGINS = {1: "RGL tensor file, RGB", 2: "RGL tensor file, spectra", 3: "MERL-like table, mean of two halves"}


# ---- 7: range coder ----

class RangeDecoder:
    def __init__(self, data):
        self.data, self.at, self.range, self.code = data, 0, 0xFFFFFFFF, 0
        for _ in range(4):
            self.code = self.code << 8 | self.byte()

    def byte(self):
        self.at += 1
        return self.data[self.at - 1] if self.at <= len(self.data) else 0

    def refill(self):
        while self.range < 1 << 24:
            self.range <<= 8
            self.code = self.code << 8 | self.byte()

    def bit(self, model):
        p, s = model
        shift = min(2 + s // 4, 7)
        if shift < 7:
            s += 1
        bound = (self.range >> 16) * p
        if self.code < bound:
            bit, self.range, p = 0, bound, p + (65536 - p >> shift)
        else:
            bit, self.code, self.range, p = 1, self.code - bound, self.range - bound, p - (p >> shift)
        model[:] = p, s
        self.refill()
        return bit

    def bit_with(self, p):
        bound = (self.range >> 16) * p
        bit = int(self.code >= bound)
        if bit:
            self.code -= bound
        self.range = self.range - bound if bit else bound
        self.refill()
        return bit

    def even(self, count):
        value = 0
        for _ in range(count):
            self.range >>= 1
            bit = int(self.code >= self.range)
            if bit:
                self.code -= self.range
            value = value << 1 | bit
            self.refill()
        return value


def bit_models(count):
    return [[32768, 0] for _ in range(count)]


class Gamma:
    def __init__(self):
        self.length, self.first, self.second = bit_models(24), bit_models(24), [bit_models(2) for _ in range(24)]

    def decode(self, coder):
        n = 0
        while n < 23 and coder.bit(self.length[n]):
            n += 1
        v = 1
        if n >= 1:
            f = coder.bit(self.first[n])
            v = 2 * v + f
        if n >= 2:
            v = 2 * v + coder.bit(self.second[n][f])
            v = (v << n - 2) + coder.even(n - 2)
        return v - 1


def size_class(number):
    return (number + 1).bit_length() - 1


# ---- 8: the paper's profile ----

HAAR = [math.sqrt(0.5)] * 2
DAUBECHIES = [(a + b * math.sqrt(3)) / (4 * math.sqrt(2)) for a, b in ((1, 1), (3, 1), (3, -1), (1, -1))]


def plane_axis(n):
    """(levels, cells) of the transform's axis for n cells."""
    levels = max(n.bit_length() - 2, 0)
    return levels, (n + (1 << levels) - 1 >> levels) << levels


def inverse_line(line, levels, low):
    high = [(-1) ** k * x for k, x in enumerate(reversed(low))]
    for level in reversed(range(levels)):
        n = len(line) >> level
        joined = [0.0] * n
        for i in range(n // 2):
            for k in range(len(low)):
                joined[(2 * i + k) % n] += low[k] * line[i] + high[k] * line[n // 2 + i]
        line[:n] = joined
    return line


class Field:
    """A sparse field: a density over rows x columns, 1 everywhere without coefficients."""

    def __init__(self, rows, columns, low, mirrored, least):
        self.rows, self.columns, self.low, self.mirrored, self.least = rows, columns, low, mirrored, least
        self.row_axis, self.column_axis = plane_axis(rows), plane_axis((columns + 1) // 2 if mirrored else columns)
        self.parts = 2 if mirrored else 1
        self.cells = self.row_axis[1] * self.column_axis[1] * self.parts
        self.coefficients = {}

    def band(self, index):
        column, row = divmod(index, self.row_axis[1])

        def level(axis, x):
            return (x // (axis[1] >> axis[0])).bit_length()
        return level(self.column_axis, column % self.column_axis[1]) + level(self.row_axis, row)

    def expand(self):
        if not self.coefficients:
            return [[1.0] * self.columns for _ in range(self.rows)]
        (row_levels, m), (column_levels, n) = self.row_axis, self.column_axis
        plane = [[[0.0] * n for _ in range(self.parts)] for _ in range(m)]
        for index, value in self.coefficients.items():
            column, row = divmod(index, m)
            plane[row][column // n][column % n] = value
        plane = [sum((inverse_line(part, column_levels, self.low) for part in row), []) for row in plane]
        plane = list(zip(*[inverse_line(list(column), row_levels, self.low) for column in zip(*plane)]))
        return [[min(max(v, self.least), 1e6) for v in self.unfold(plane[r])] for r in range(self.rows)]

    def unfold(self, row):
        if not self.mirrored:
            return row[:self.columns]
        even, odd, half, out = row[:self.column_axis[1]], row[self.column_axis[1]:], math.sqrt(0.5), [0.0] * self.columns
        for k in range(self.columns // 2):
            out[k], out[-1 - k] = (even[k] + odd[k]) * half, (even[k] - odd[k]) * half
        if self.columns % 2:
            out[self.columns // 2] = even[self.columns // 2]
        return out


def read_fields(data, fields):
    demand(len(data) >= 2 * len(fields), "corrupt", 0, "a section of coefficients is short")
    steps = struct.unpack_from(f"<{len(fields)}H", data)
    demand(any(steps) and all(s == 0 or 7168 <= s <= 40448 for s in steps), "corrupt", 0, "steps")
    stream = data[2 * len(fields):]
    coder, numbers, gaps = RangeDecoder(stream), Gamma(), [Gamma() for _ in range(8)]
    magnitudes, before, room = [[Gamma() for _ in range(4)] for _ in range(12)], {}, 8 * len(stream)
    for field, step in zip(fields, steps):
        if not step:
            continue
        count, following, gap, levels = numbers.decode(coder) + 1, 0, 0, {}
        demand(count <= field.cells and count <= room, "corrupt", 0, "a field's number of coefficients")
        room -= count
        for _ in range(count):
            gap = gaps[min(size_class(gap), 7)].decode(coder)
            index = following + gap
            demand(index < field.cells, "corrupt", 0, "a coefficient's place")
            level = magnitudes[min(field.band(index), 11)][min(abs(before.get(index, 0)), 3)].decode(coder) + 1
            demand(level <= 1048575, "corrupt", 0, "a level")
            levels[index] = -level if coder.even(1) else level
            following = index + 1
        before = levels
        field.coefficients = {index: level * 2.0 ** ((step - 32768) / 256) for index, level in levels.items()}
    demand(coder.at == len(stream), "corrupt", 0, "the stream's length")


PAPER_KINDS = {(4 * c + t, *kind) for c in range(3) for t, kind in ((1, (0, 2)), (2, (2, 1)), (3, (2, 1)), (4, (2, 1)))}


def decode_paper(record, layers):
    found = record.load(layers, PAPER_KINDS)
    return [decode_paper_channel(record, c, {t: found[4 * c + t] for t in range(1, 5) if 4 * c + t in found}) for c in range(3)]


def decode_paper_channel(record, channel, found):
    h, d, p = record.dims
    diffuse, specular = record.colour[channel][:2]
    demand(1 in found and len(found[1]) == 8 + 2 * (h + d + p), "corrupt", record.base, "marginals")
    scale, *codes = struct.unpack(f"<d{h + d + p}H", found[1])
    demand(0 <= scale < math.inf and math.isfinite(specular * scale), "corrupt", record.base, "the scale")
    marginals = [2.0 ** ((code - 32768) / 1024) if code else 0.0 for code in codes]
    f_h, f_d, f_phi = marginals[:h], marginals[h:h + d], marginals[h + d:]
    shared = next(i for i in range(h + 1) if 9 * i * i >= 4 * h * h)
    hd, hphi = Field(h, d, HAAR, False, 1 / 32), Field(h, p, HAAR, True, 1 / 32)
    slices = [Field(d, p, DAUBECHIES, True, 0.0) for _ in range(shared + 1)]
    for section, fields in (2, [hd]), (3, [hphi]), (4, slices):
        if section in found:
            read_fields(found[section], fields)
    c_hd, c_hphi, c_slices, out = hd.expand(), hphi.expand(), [s.expand() for s in slices], []
    for i in range(h):
        conditional = c_slices[min(i, shared)]
        for j in range(d):
            row = min(min(f_h[i] * f_d[j], 1e15) * c_hd[i][j], 1e15)
            for k in range(p):
                b = row * min(f_phi[k] * c_hphi[i][k], 1e15) * conditional[j][k]
                out.append(min(max(0.0, diffuse + specular * scale * b), 1e304))
    return out


# ---- 9: the spectral profile ----

def rounded(x, least, most):
    return math.floor(min(max(x, least), most) + 0.5)


STRETCH = [rounded(256 * math.log((i + 0.5) / (4095.5 - i)), -2047, 2047) for i in range(4096)]
SQUASH = [rounded(65536 / (1 + math.exp(-(i - 2048) / 256)), 16, 65520) for i in range(4096)]
RATE = [min(655360 // (10 * n + 16), 32767) for n in range(251)]
LEAST = [0, 1, 2, 3, 4, 7, 11, 16, 26, 41, 64, 102, 162, 256, 407, 646]
SIZES = [sum(v >= x for x in LEAST) - 1 for v in range(647)]


def size(v):
    return SIZES[min(v, 646)]


class Mixer:
    """Contexts [p, n] and weights of bits by a mix of four, made as they are asked for."""

    def __init__(self):
        self.contexts, self.weights = [{}, {}, {}, {}], {}

    def bit(self, coder, indices, weights_set):
        contexts = [c.setdefault(i, [1 << 21, 0]) for c, i in zip(self.contexts, indices)]
        weights = self.weights.setdefault(weights_set, [19661] * 4)
        t = [STRETCH[c[0] >> 10] for c in contexts]
        q = SQUASH[min(max(sum(w * x for w, x in zip(weights, t)) >> 16, -2047), 2047) + 2048]
        bit = coder.bit_with(65536 - q)
        e = (bit << 16) - q
        for i in range(4):
            weights[i] = min(max(weights[i] + (t[i] * e + 16384 >> 15), 1 - (1 << 18)), (1 << 18) - 1)
            learn(contexts[i], bit, 60)
        return bit


class Pair:
    """Contexts of one kind of bit by a pair."""

    def __init__(self):
        self.contexts = [{}, {}]

    def bit(self, coder, indices):
        a, b = [c.setdefault(i, [1 << 21, 0]) for c, i in zip(self.contexts, indices)]
        bit = coder.bit_with(65536 - min(max(a[0] + b[0] >> 7, 16), 65520))
        learn(a, bit, 40)
        learn(b, bit, 40)
        return bit


def learn(context, bit, limit):
    p, n = context
    context[:] = p + ((1 << 22) - p >> 6) * RATE[n] // 1024 if bit else p - (p >> 6) * RATE[n] // 1024, n + (n < limit)


class Alone:
    """Bits by one context each."""

    def __init__(self, *start):
        self.contexts, self.start = {}, start

    def bit(self, coder, index):
        context = self.contexts.setdefault(index, list(self.start))
        bit = coder.bit_with(65536 - min(max(context[0] >> 6, 16), 65520))
        learn(context, bit, 250)
        return bit


class Band:
    def __init__(self, rows, columns, orientation, parent, shift):
        self.y0, self.y1, self.x0, self.x1 = *rows, *columns
        self.rows, self.columns = self.y1 - self.y0, self.x1 - self.x0
        self.block_rows, self.block_columns = self.rows + 7 >> 3, self.columns + 7 >> 3
        self.orientation, self.parent, self.shift = orientation, parent, shift


class Planes:
    """Levels of all fields and harmonics while they are decoded."""
    B = 22

    def __init__(self, dims, planes):
        h, d, self.p = dims
        self.planes, self.hs, self.ds = planes, [h], [d]
        while min(self.hs[-1], self.ds[-1]) + 1 >> 1 >= 8:
            self.hs.append(self.hs[-1] + 1 >> 1)
            self.ds.append(self.ds[-1] + 1 >> 1)
        top = len(self.hs) - 1
        self.bands = [Band((0, self.hs[top]), (0, self.ds[top]), 0, None, 0)]
        for l in range(top, 0, -1):
            low_h, low_d = (0, self.hs[l]), (0, self.ds[l])
            high_h, high_d = (self.hs[l], self.hs[l - 1]), (self.ds[l], self.ds[l - 1])
            for rows, columns, orientation in (low_h, high_d, 1), (high_h, low_d, 2), (high_h, high_d, 3):
                b = len(self.bands)
                self.bands.append(Band(rows, columns, orientation, 0 if l == top else b - 3, int(l != top)))
        # keyed by (field, harmonic, band, row, column); what is not there is 0
        self.known, self.sign, self.active_bands, self.active_blocks = {}, {}, set(), set()
        self.band_bits, self.block_bits, self.zero_bits, self.refine_bits = (Pair() for _ in range(4))
        self.quiet_cell, self.quiet_row, self.quiet_band, self.quiet_block = (Alone(83886, 6) for _ in range(4))
        self.sign_bits, self.first_bits = Mixer(), Alone(1 << 21, 0)

    def units(self):
        return 3 * self.p * self.planes

    def unit(self, coder, u):
        self.coder = coder
        plane, f, m = self.planes - 1 - u // (3 * self.p), u // self.p % 3, u % self.p
        self.plane, self.f, self.m, self.c, self.cls = plane, f, m, int(f > 0), min(m.bit_length(), 7)
        for b, band in enumerate(self.bands):
            if (f, m, b) not in self.active_bands:
                if not self.band_flag(b):
                    continue
                self.active_bands.add((f, m, b))
            for by in range(band.block_rows):
                for bx in range(band.block_columns):
                    fresh = int((f, m, b, by, bx) not in self.active_blocks)
                    if fresh:
                        if not self.block_flag(b, by, bx):
                            continue
                        self.active_blocks.add((f, m, b, by, bx))
                    for y in range(8 * by, min(8 * by + 8, band.rows)):
                        self.row(b, y, range(8 * bx, min(8 * bx + 8, band.columns)), fresh)

    def around_flag(self, flags, *place):
        f, m = self.f, self.m
        near = ((f, m - 1, *place) in flags) + ((f, m + 1, *place) in flags)
        alike = ((f, m - 2, *place) in flags) + ((f, m + 2, *place) in flags)
        return near, alike, (f > 0 and (0, m, *place) in flags) + (f > 1 and (1, m, *place) in flags)

    def band_flag(self, b):
        near, alike, others = self.around_flag(self.active_bands, b)
        parent = int(b == 0 or (self.f, self.m, self.bands[b].parent) in self.active_bands)
        if not (near or alike or others) and (b == 0 or not parent):
            return self.quiet_band.bit(self.coder, 2 * self.cls + self.c)
        return self.band_bits.bit(self.coder, (
            (((3 * near + alike) * 2 + parent) * 3 + others) * 2 + self.c, (near + alike) * self.B + b))

    def block_flag(self, b, y, x):
        band, flags = self.bands[b], self.active_blocks

        def at(dy, dx):
            return (self.f, self.m, b, y + dy, x + dx) in flags
        beside, corners = at(0, -1) + at(-1, 0) + at(0, 1) + at(1, 0), at(-1, -1) + at(-1, 1)
        near, alike, others = self.around_flag(flags, b, y, x)
        parent = 0
        if b:
            above = self.bands[band.parent]
            parent = int((self.f, self.m, band.parent, min(y >> band.shift, above.block_rows - 1),
                          min(x >> band.shift, above.block_columns - 1)) in flags)
        if not (beside or corners or near or alike or others or parent):
            return self.quiet_block.bit(self.coder, 2 * (self.cls * self.B + b) + self.c)
        return self.block_bits.bit(self.coder, (
            (((3 * beside + corners) * 3 + alike) * 3 + near) * 2 + parent, (((3 * b + alike) * 3 + near) * 3 + others) * 2 + self.c))

    def sums(self, b, y, x):
        """k itself, around, along, others and parent of a cell."""
        f, m, p, band, k = self.f, self.m, self.plane, self.bands[b], self.known.get
        around = (2 * (k((f, m, b, y, x - 1), 0) + k((f, m, b, y, x + 1), 0) + k((f, m, b, y - 1, x), 0) + k((f, m, b, y + 1, x), 0)) +
                  k((f, m, b, y - 1, x - 1), 0) + k((f, m, b, y - 1, x + 1), 0) + k((f, m, b, y + 1, x - 1), 0) + k((f, m, b, y + 1, x + 1), 0)) >> p
        along = 2 * (k((f, m - 2, b, y, x), 0) + k((f, m + 2, b, y, x), 0)) + k((f, m - 1, b, y, x), 0) + k((f, m + 1, b, y, x), 0) >> p
        others = k(((f + 1) % 3, m, b, y, x), 0) + k(((f + 2) % 3, m, b, y, x), 0) >> p
        parent = k((f, m, band.parent, y >> band.shift, x >> band.shift), 0) >> p if b else 0
        return k((f, m, b, y, x), 0), around, along, others, parent

    def row(self, b, y, xs, fresh):
        if any(any(self.sums(b, y, x)) for x in xs):
            for x in xs:
                self.cell(b, y, x, fresh)
            return
        if not self.quiet_row.bit(self.coder, self.quiet_index(b, fresh)):
            return
        x = next((x for x in xs[:-1] if self.first_bits.bit(self.coder, xs[-1] - x)), xs[-1])
        self.begin(b, y, x)
        for x in range(x + 1, xs.stop):
            self.cell(b, y, x, fresh)

    def quiet_index(self, b, fresh):
        depth = 0 if self.plane == 0 else 1 if self.plane < 3 else 2
        return (((self.cls * self.B + b) * 3 + depth) * 2 + self.c) * 2 + fresh

    def cell(self, b, y, x, fresh):
        known, p, f, m, c = self.known, self.plane, self.f, self.m, self.c
        k, around, along, others, parent = self.sums(b, y, x)
        if k:
            v = k >> p + 3
            tall = v if v < 4 else 4 if v < 8 else 5
            bit = self.refine_bits.bit(self.coder, (
                (16 * tall + size(along)) * 2 + c, (self.B * tall + b) * 16 + size(around + along >> 1)))
            known[f, m, b, y, x] = (2 * v + bit << p + 2) + (2 << p if p else 0)
        elif not (around or along or others or parent):
            if self.quiet_cell.bit(self.coder, self.quiet_index(b, fresh)):
                self.begin(b, y, x)
        else:
            def tier(dy=0, dx=0, dm=0):
                v = known.get((f, m + dm, b, y + dy, x + dx), 0)
                return 0 if v == 0 else 1 if v >> p < 6 else 2
            sizes = ((8 * (size(parent) >> 2) + (size(others) >> 1)) * 16 + size(around)) * 16 + size(along)
            ring = ((3 * tier(dm=-2) + tier(dm=2)) * 3 + tier(dm=-1)) * 3 + tier(dm=1)
            beside = ((3 * tier(0, -1) + tier(-1)) * 3 + tier(0, 1)) * 3 + tier(1)
            if self.zero_bits.bit(self.coder, (2 * sizes + c, 81 * ring + beside)):
                self.begin(b, y, x)

    def begin(self, b, y, x):
        known, p, f, m, c, band = self.known, self.plane, self.f, self.m, self.c, self.bands[b]

        def s(dy=0, dx=0, dm=0):
            return self.sign.get((f, m + dm, b, y + dy, x + dx), 0)
        first = self.sign.get((0, m, b, y, x), 0) if f else 0
        self.sign[f, m, b, y, x] = 1 + self.sign_bits.bit(self.coder, (
            (3 * s(0, -1) + s(-1)) * self.B + b, ((3 * s(dm=-2) + s(dm=2)) * 3 + s(dm=-1)) * 3 + first,
            (((3 * s(0, -1) + s(0, 1)) * 3 + s(-1)) * 3 + s(1)) * 4 + band.orientation, (2 * first + (f > 1)) * self.B + b), c)
        known[f, m, b, y, x] = (4 << p) + (2 << p if p else 0)


def binary32(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


LIFTING = [(0, -binary32(0.443506852043971)), (1, -binary32(0.882911075530934)), (0, binary32(0.052980118572961)), (1, binary32(1.586134342059924))]
GAIN = binary32(1.149604398860241)
LOSS = binary32(1 / GAIN)


def inverse_lift(x):
    n = len(x)
    g, z = n + 1 >> 1, [0.0] * n
    z[0::2], z[1::2] = [v * LOSS for v in x[:g]], [v * GAIN for v in x[g:]]
    for first, factor in LIFTING:
        for i in range(first, n, 2):
            z[i] += factor * (z[i - 1 if i else 1] + z[i + 1 if i + 1 < n else n - 2])
    return z


SPECTRAL_KINDS = {(16, 0, version) for version in range(3, 9)} | {(17, 1, 2)}


def spans(h, d, p, limit):
    """span[i][j]: how many cells of a row of phi_d are coded where rows are cut."""
    borders = [math.cos(math.pi * k / p) for k in range(p + 1)]
    least = [0.0 if 2 * k <= p <= 2 * (k + 1) else min(abs(borders[k]), abs(borders[k + 1])) for k in range(p)]

    def span(theta_h, theta_d):
        a, b = math.cos(theta_h) * math.cos(theta_d), math.sin(theta_h) * math.sin(theta_d)
        return sum(a - b * c > limit for c in least) or 2 - p % 2

    return [[span((i / h) ** 2 * math.pi / 2, j / d * math.pi / 2) for j in range(d)] for i in range(h)]


def cosine_basis(n, p):
    """basis[m][k]: of a row of which n of p cells are coded; cells beyond them repeat the nearest."""
    first = (p - n) // 2

    def value(m, k):
        return math.sqrt((2 if m else 1) / p) * math.cos(math.pi * m * (2 * k + 1) / (2 * n))
    return [[value(m, min(max(k - first, 0), n - 1)) for k in range(p)] for m in range(n)]


def coded_weights(data, record):
    """18 x 18 weights in half octaves, each coded as its difference from what its neighbours make likely."""
    coder, gamma, weights = RangeDecoder(data), Gamma(), []
    for n in range(324):
        left, up, corner = (weights[n - s] if n >= s else 0 for s in (1, 18, 19))
        if n < 18 or n % 18 == 0:
            likely = left if n < 18 else up
        else:
            low, high = min(left, up), max(left, up)
            likely = low if corner >= high else high if corner <= low else left + up - corner
        off = gamma.decode(coder)
        weights.append(likely + (-(off // 2) - 1 if off % 2 else off // 2))
        demand(0 <= weights[n] <= 63, "corrupt", record.base, "a weight")
    demand(coder.at == len(data), "corrupt", record.base, "the weights' end")
    return weights


def weight_factors(hs, ds, weights, graded):
    """factor[row][column] of a spectrum's coefficients: they are coded divided by these."""
    steps, edge, octave = len(hs) - 1, 18 if graded else 10, 2 if graded else 16

    def place(extents, i, level):
        cell = i if level == steps else 2 * i if i < extents[level + 1] else 2 * (i - extents[level + 1]) + 1
        return min(max((cell + 0.5) / extents[level] * edge - 0.5, 0.0), edge - 1.0)

    def factor(i, j):
        level = next((l for l in range(steps) if i >= hs[l + 1] or j >= ds[l + 1]), steps)
        y, x = place(hs, i, level), place(ds, j, level)
        row, column = min(int(y), edge - 2), min(int(x), edge - 2)
        w = [weights[edge * (row + a) + column + b] for a in (0, 1) for b in (0, 1)]
        above, below = (w[n] + (x - column) * (w[n + 1] - w[n]) for n in (0, 2))
        octaves = (above + (y - row) * (below - above)) / octave
        if graded and level < min(steps, 3):
            octaves += (9, 3, 1)[level] / 16 * ((i >= hs[level + 1]) + (j >= ds[level + 1]))
        return 2.0 ** octaves

    return [[factor(i, j) for j in range(ds[0])] for i in range(hs[0])]


NEXT_STATE = ((0, 1), (4, 5), (1, 0), (5, 4), (6, 7), (3, 2), (2, 3), (7, 6))  # by the parity of a level that is not 0


def decode_spectral(record, layers):
    h, d, p = record.dims
    wanted = record.load_list(layers, SPECTRAL_KINDS)
    version = wanted[0][0][2] if wanted else 3
    dependent, form = version >= 6, (version - 3) % 3
    cut, graded = form > 0, form == 2
    demand([(s[0], s[3]) for s, _ in wanted] == [(16, 0)] + [(17, l) for l in range(layers)], "corrupt", record.base, "sections of fields and planes")
    data = wanted[0][1]
    more = 4 * dependent
    demand(len(data) >= 80 + more if graded else len(data) == 176 + more, "corrupt", record.base, "the fields' bytes")
    unit, *rotation, step = struct.unpack_from("<d13f", data)
    *centres, c3, count = struct.unpack_from("<4fI" if dependent else "<3fI", data, 60)
    c0, c1, c2 = centres if dependent else (centres[0], 0.0, centres[1])
    base, rotation = rotation[:3], rotation[3:]
    demand(2.0 ** -1022 <= unit <= 2.0 ** 999 and all(abs(x) <= 64 for x in base) and
           all(abs(r) <= 1.001 for r in rotation) and
           0 < step <= 2.0 ** 40 and all(abs(c) <= 1 for c in (c0, c1, c2, c3)) and count <= 24, "corrupt", record.base, "fields")
    limit, = struct.unpack_from("<f", data, 76 + more) if graded else (2.0 ** -30,)
    demand(2.0 ** -30 <= limit < 1, "corrupt", record.base, "the rows' limit")
    weights = coded_weights(data[80 + more:], record) if graded else data[76 + more:]
    planes, end = Planes(record.dims, count), 0
    for _, data in wanted[1:]:
        demand(len(data) >= 4, "corrupt", record.base, "planes")
        start, end = end, struct.unpack_from("<I", data)[0]
        demand(start <= end <= planes.units(), "corrupt", record.base, "the planes' end")
        coder = RangeDecoder(data[4:])
        for u in range(start, end):
            planes.unit(coder, u)
            demand(coder.at <= len(data) - 4, "corrupt", record.base, "planes are short")
        demand(coder.at == len(data) - 4, "corrupt", record.base, "planes are long")

    factor = weight_factors(planes.hs, planes.ds, weights, graded)
    harmonic = [math.sqrt(3 / (2 + math.cos(math.pi * m / p))) if graded else 1.0 for m in range(p)]
    fields = []
    for f in range(3):
        spectra = [[[0.0] * d for _ in range(h)] for _ in range(p)]
        state, last = 0, None
        # in the order of coding: band by band, block by block
        places = sorted(place for place in planes.known if place[0] == f)
        places.sort(key=lambda at: (*at[1:3], at[3] >> 3, at[4] >> 3, at[3], at[4]))
        for g, m, b, y, x in places:
            k, state, last = planes.known[g, m, b, y, x], state if m == last else 0, m
            if end <= f * p + m:
                continue
            r = count - 1 - (end - 1 - (f * p + m)) // (3 * p)
            a = (k >> 2) >> r << r
            if a:
                negative = planes.sign[g, m, b, y, x] == 2
                second = state >> 2
                value = a + (c3 * 2 ** r - 0.25 * dependent if r else (c2 if a > 1 else c1 if second else c0) - 0.5 * second)
                if dependent and not r:
                    state = NEXT_STATE[state][a & 1]
                value *= step
                y, x = planes.bands[b].y0 + y, planes.bands[b].x0 + x
                value *= factor[y][x] * harmonic[m]
                spectra[m][y][x] = -value if negative else value
        for plane in spectra:
            if not any(map(any, plane)):
                continue
            for l in range(len(planes.hs) - 2, -1, -1):
                rows, columns = planes.hs[l], planes.ds[l]
                for x in range(columns):
                    for y, value in enumerate(inverse_lift([plane[y][x] for y in range(rows)])):
                        plane[y][x] = value
                for y in range(rows):
                    plane[y][:columns] = inverse_lift(plane[y][:columns])
        fields.append(spectra)
    span = spans(h, d, p, limit) if cut else [[p] * d] * h
    bases = {n: cosine_basis(n, p) for n in {n for row in span for n in row}}
    rgb, most = [[], [], []], min(40.0, 1011.0 - math.frexp(unit)[1])
    for i in range(h):
        for j in range(d):
            basis = bases[span[i][j]]
            lines = [[(s[m][i][j], line) for m, line in enumerate(basis) if s[m][i][j]] for s in fields]
            for k in range(p):
                y = [sum(x * line[k] for x, line in terms) for terms in lines]
                for c in range(3):
                    l = min(max(base[c] + sum(rotation[3 * f + c] * y[f] for f in range(3)), 0.0), most)
                    rgb[c].append(unit * math.expm1(l * math.log(2)))
    return rgb


DECODERS = {1: decode_paper, 2: decode_spectral}


# ---- 6: look-up ----

def look_up(dims, plane, theta_h, theta_d, phi_d):
    """Between the centres of cells; angles in degrees."""
    x = min(max(dims[0] * math.sqrt(theta_h / 90) - 0.5, 0), dims[0] - 1)
    y = min(max(dims[1] * theta_d / 90 - 0.5, 0), dims[1] - 1)
    z = (dims[2] * phi_d / 180 - 0.5) % dims[2]
    i, j, k = int(x), int(y), int(z)
    total = 0.0
    for a, wa in ((i, 1 - (x - i)), (min(i + 1, dims[0] - 1), x - i)):
        for b, wb in ((j, 1 - (y - j)), (min(j + 1, dims[1] - 1), y - j)):
            for c, wc in ((k % dims[2], 1 - (z - k)), ((k + 1) % dims[2], z - k)):
                total += wa * wb * wc * plane[c + dims[2] * (b + dims[1] * a)]
    return total


# ---- commands ----

def command_list(archive):
    for entry in archive.walk():
        record = archive.record(entry)
        print(f"{record.name}  {record.bytes} bytes  profile {record.profile}  {'x'.join(map(str, record.dims))}  "
              f"{len(record.layers)} layers  log RMSE of all cells {record.layers[-1][2]:.6g}  {len(record.sections)} sections"
              + (f"  from: {record.origin()}" if record.origin() else ""))


def command_verify(archive):
    for entry in archive.walk():
        record = archive.record(entry)
        for section in record.sections:
            record.section(section)
        record.origin()
        for layers in range(1, len(record.layers) + 1):
            for channel in record.decode(layers):
                demand(all(0 <= x < math.inf for x in channel), "corrupt", record.base, "a value is negative or not finite")
    print("ok")


def command_decode(archive, name, layers):
    record = archive.record(archive.find(name))
    json.dump({"dims": record.dims, "rgb": record.decode(layers)}, sys.stdout)
    print()


def command_evaluate(archive, name, *rest):
    *angles, layers = rest
    record = archive.record(archive.find(name))
    decoded = record.decode(layers)
    for at in range(0, len(angles), 3):
        print(*("%.9g" % look_up(record.dims, plane, *map(float, angles[at:at + 3])) for plane in decoded))


def command_compare(archive, path):
    """Every line of a .values file against what this reader decodes: to 1e-5 (8, "Accuracy")."""
    with open(path, encoding="utf-8") as file:
        lines = file.read().split("\n")
    for at in range(0, len(lines) - 1, 4):
        name, layers, *dims = lines[at].rsplit(" ", 4)
        record = archive.record(archive.find(name))
        demand(list(map(int, dims)) == list(record.dims), "corrupt", 0, f"{name}: extents differ")
        for c, decoded in enumerate(record.decode(int(layers))):
            expected = list(map(float, lines[at + 1 + c].split()))
            top = max(expected)
            demand(len(expected) == len(decoded), "corrupt", 0, f"{name}: number of values")
            for i, (a, b) in enumerate(zip(decoded, expected)):
                demand(abs(a - b) <= max(1e-5 * abs(b), 1e-6 * top), "corrupt", 0, f"{name}, layer {layers}, cell {i}: {a} and {b}")


def main(arguments):
    layers = 0
    if "--layers" in arguments:
        at = arguments.index("--layers")
        layers = int(arguments[at + 1])
        del arguments[at:at + 2]
    # how many operands each has behind the archive, and in what steps more
    commands = {"list": (command_list, 0, 0), "verify": (command_verify, 0, 0), "decode": (command_decode, 1, 0),
                "evaluate": (command_evaluate, 4, 3), "compare": (command_compare, 1, 0)}
    function, least, step = commands.get(arguments[0] if arguments else "", (None, 0, 0))
    more = len(arguments) - 2 - least
    if function is None or more < 0 or (more % step if step else more):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        archive = Archive(arguments[1])
        function(archive, *arguments[2:], *([layers] if function in (command_decode, command_evaluate) else []))
    except (Fault, OSError) as fault:
        print(f"read_bpk: {arguments[1]}: {fault}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
