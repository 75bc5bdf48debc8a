#!/usr/bin/env python3
"""Draws a sphere of one material under a sky with a sun, as sphere.c does: sphere.py ARCHIVE NAME OUT.png"""
import struct, sys, zlib
import numpy as np
import brdfpack

SIZE, SAMPLES = 160, 64

def sky(d):  # radiance from directions d: brighter upwards, and a small sun
    return 0.3 + 0.7 * np.maximum(d[..., 1], 0) + 20 * np.maximum(d @ [-0.6, 0.5, 0.62], 0) ** 200

def png_write(path, rgb):
    rows = b"".join(b"\0" + row.tobytes() for row in rgb)
    head = struct.pack(">IIBBBBB", rgb.shape[1], rgb.shape[0], 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, data in (b"IHDR", head), (b"IDAT", zlib.compress(rows)), (b"IEND", b""):
            file.write(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)))

if len(sys.argv) != 4:
    sys.exit(__doc__)
with brdfpack.open(sys.argv[1]) as archive:
    material = archive.load(sys.argv[2], form="compact", sampling=True)
axis = (np.arange(SIZE) + 0.5) / SIZE * 2 - 1
x, y = np.meshgrid(axis, -axis)
seen = x * x + y * y < 1
n = np.stack([x, y, np.sqrt(np.maximum(0, 1 - x * x - y * y))], -1)[seen]
a, b = -1 / (1 + n[:, 2]), -n[:, 0] * n[:, 1] / (1 + n[:, 2])  # a frame around n (Duff et al. 2017)
frame = np.stack([np.stack([1 + n[:, 0] ** 2 * a, b, -n[:, 0]], -1), np.stack([b, 1 + n[:, 1] ** 2 * a, -n[:, 1]], -1), n], 1)
wo = np.repeat(frame[:, None, :, 2], SAMPLES, 1)  # (0, 0, 1) in that frame
wi, pdf = material.sample(wo, np.random.default_rng(1).random(wo.shape))
light = sky(np.einsum("ski,sij->skj", wi, frame)) * wi[..., 2] / np.where(pdf > 0, pdf, np.inf)
rgb = np.zeros((SIZE, SIZE, 3))
rgb[seen] = (material.evaluate(wi, wo) * light[..., None]).mean(1)
png_write(sys.argv[3], (255 * np.minimum(1, 2 * rgb) ** (1 / 2.2) + 0.5).astype(np.uint8))
