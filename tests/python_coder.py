#!/usr/bin/env python3
"""The range encoder of FORMAT.md, section 7, written from its text alone: tests/python_coder.py VECTORS-FOLDER

Decodes every section of coefficients of the paper's profile in the good vectors with scripts/read_bpk.py, encodes what came out
again by the specification's pseudo-code, and demands the library's own bytes. Standard library only.
"""
import glob
import os
import random
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "scripts"))
import read_bpk  # noqa: E402


class RangeEncoder:
    def __init__(self):
        self.low, self.range, self.out = 0, 0xFFFFFFFF, []

    def move_byte_out(self):
        if self.low >= 1 << 32:
            self.low -= 1 << 32
            at = len(self.out) - 1
            while self.out[at] == 255:
                self.out[at] = 0
                at -= 1
            self.out[at] += 1
        self.out.append(self.low >> 24)
        self.low = self.low << 8 & 0xFFFFFFFF

    def refill(self):
        while self.range < 1 << 24:
            self.range <<= 8
            self.move_byte_out()

    def bit(self, model, bit):
        p, s = model
        shift = min(2 + s // 4, 7)
        if shift < 7:
            s += 1
        bound = (self.range >> 16) * p
        if bit:
            self.low, self.range, p = self.low + bound, self.range - bound, p - (p >> shift)
        else:
            self.range, p = bound, p + (65536 - p >> shift)
        model[:] = p, s
        self.refill()

    def even(self, value, count):
        for n in reversed(range(count)):
            self.range >>= 1
            if value >> n & 1:
                self.low += self.range
            self.refill()

    def end(self):
        for _ in range(5):
            self.move_byte_out()
        assert self.out[-1] == 0
        return bytes(self.out[:-1])


def gamma_encode(coder, models, number):
    v = number + 1
    n = v.bit_length() - 1
    for k in range(n):
        coder.bit(models.length[k], 1)
    if n < 23:
        coder.bit(models.length[n], 0)
    if n >= 1:
        f = v >> n - 1 & 1
        coder.bit(models.first[n], f)
    if n >= 2:
        coder.bit(models.second[n][f], v >> n - 2 & 1)
        coder.even(v & (1 << n - 2) - 1, n - 2)


def fields_write(steps, fields):
    """The bytes of a section of codec 2 (FORMAT.md, "Sparse fields")."""
    coder, numbers, gaps = RangeEncoder(), read_bpk.Gamma(), [read_bpk.Gamma() for _ in range(8)]
    magnitudes, before = [[read_bpk.Gamma() for _ in range(4)] for _ in range(12)], {}
    for step, field in zip(steps, fields):
        if not step:
            continue
        unit = 2.0 ** ((step - 32768) / 256)
        levels = {index: round(value / unit) for index, value in field.coefficients.items()}
        gamma_encode(coder, numbers, len(levels) - 1)
        following, gap = 0, 0
        for index in sorted(levels):
            last, gap = gap, index - following
            gamma_encode(coder, gaps[min(read_bpk.size_class(last), 7)], gap)
            level = levels[index]
            gamma_encode(coder, magnitudes[min(field.band(index), 11)][min(abs(before.get(index, 0)), 3)], abs(level) - 1)
            coder.even(int(level < 0), 1)
            following = index + 1
        before = levels
    return struct.pack("<%dH" % len(steps), *steps) + coder.end()


def random_bits_come_back(seed):
    """Long runs of improbable bits move carries through many bytes of 255."""
    draw = random.Random(seed)
    share = draw.choice((0.5, 0.01, 0.001))
    bits = [int(draw.random() < share) for _ in range(3000)]
    coder, models = RangeEncoder(), read_bpk.bit_models(3)
    for n, bit in enumerate(bits):
        coder.bit(models[n % 3], bit) if n % 7 else coder.even(bit, 1)
    data = coder.end()
    decoder, models = read_bpk.RangeDecoder(data), read_bpk.bit_models(3)
    assert [decoder.bit(models[n % 3]) if n % 7 else decoder.even(1) for n in range(len(bits))] == bits
    assert decoder.at == len(data), (decoder.at, len(data))


def main():
    sections = 0
    captured = []
    plain = read_bpk.read_fields

    def capture(data, fields):
        plain(data, fields)
        captured.append((bytes(data), fields))

    read_bpk.read_fields = capture
    for path in sorted(glob.glob(os.path.join(sys.argv[1], "good-*.bpk"))):
        archive = read_bpk.Archive(path)
        for entry in archive.walk():
            record = archive.record(entry)
            if record.profile != 1:
                continue
            del captured[:]
            record.decode()
            for data, fields in captured:
                steps = struct.unpack_from("<%dH" % len(fields), data)
                assert fields_write(steps, fields) == data, "%s: another stream than the library's" % path
                sections += 1
    for seed in range(60):
        random_bits_come_back(seed)
    print("%d sections encoded again to the same bytes, 60 random streams" % sections)
    return 0 if sections >= 12 else 1


if __name__ == "__main__":
    sys.exit(main())
