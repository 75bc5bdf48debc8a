#!/usr/bin/env python3
"""Tensor files as those of the RGL database, made by code: tensor_files.py FOLDER writes good ones, bad ones, and what is none.

All arrays come from fixed formulas, so every run writes the same bytes. Standard library only; the layout is src/rgl/tensor_file.h's.
"""
import math
import os
import struct
import sys

FORMATS = {1: "B", 10: "f", 11: "d"}


def tensor_file(fields):
    """fields: (name, type, shape, values) -> bytes."""
    table, data = b"", b""
    start = 18 + sum(2 + len(name) + 11 + 8 * len(shape) for name, _, shape, _ in fields)
    for name, kind, shape, values in fields:
        data += bytes(-(start + len(data)) % 8)
        table += struct.pack("<H", len(name)) + name.encode() + struct.pack("<HBQ", len(shape), kind, start + len(data))
        table += struct.pack("<%dQ" % len(shape), *shape)
        data += struct.pack("<%d%s" % (len(values), FORMATS[kind]), *values)
    return b"tensor_file\0\1\0" + struct.pack("<I", len(fields)) + table + data


def material(azimuths=1, channels=3, side=8, angles=3, lobe=0.3):
    """A lobe of that width in u_m, brighter towards grazing incidence, over a floor."""
    theta = [k * 1.5707963 / (angles - 1) for k in range(angles)]
    normals = [math.exp(-(x / (side - 1) / lobe) ** 2) + 0.02 for _ in range(side) for x in range(side)]
    samples = [(0.2 + 0.1 * c / channels + 0.1 * a) * (1 - 0.3 * x / (side - 1))
               for _ in range(azimuths) for a in range(angles) for c in range(channels) for _ in range(side) for x in range(side)]
    fields = [("description", 1, [8], list(b"made up\0")), ("phi_i", 10, [azimuths], [0.5 * n for n in range(azimuths)]),
              ("theta_i", 10, [angles], theta), ("sigma", 10, [2, side], [1 - 0.9 * x / (side - 1) for _ in range(2) for x in range(side)]),
              ("ndf", 10, [2, side], [normals[x] for _ in range(2) for x in range(side)]),
              ("vndf", 10, [azimuths, angles, side, side], normals * (azimuths * angles)),
              ("luminance", 10, [azimuths, angles, side, side], [0.2] * (azimuths * angles * side * side)), ("jacobian", 1, [1], [1]),
              ("valid", 1, [azimuths * angles * side * side // 8], [255] * (azimuths * angles * side * side // 8))]
    shape = [azimuths, angles, channels, side, side]
    if channels == 3:
        return fields + [("rgb", 10, shape, samples)]
    return fields + [("spectra", 10, shape, samples), ("wavelengths", 10, [channels], [380 + 20 * n for n in range(channels)])]


def changed(fields, name, change):
    """The same, with one field's values, or shape, changed."""
    return [change(field) if field[0] == name else field for field in fields]


def value_changed(fields, name, element, value):
    return changed(fields, name, lambda f: f[:3] + (f[3][:element] + [value] + f[3][element + 1:],))


def files():
    """NAME -> bytes; the first three are whole."""
    good = material()
    whole = tensor_file(good)
    return {
        "rough.bsdf": whole,
        "spectral.bsdf": tensor_file(material(channels=16)),
        "glossy.bsdf": tensor_file(material(lobe=0.05)),
        "anisotropic.bsdf": tensor_file(material(azimuths=4)),
        "truncated.bsdf": whole[:-100],
        "cut-table.bsdf": whole[:100],
        "nan.bsdf": tensor_file(value_changed(good, "vndf", 7, math.nan)),
        "zero.bsdf": tensor_file(changed(good, "ndf", lambda f: f[:3] + ([0] * len(f[3]),))),
        "descending.bsdf": tensor_file(value_changed(good, "theta_i", 2, 0.1)),
        "other-shape.bsdf": tensor_file(changed(good, "rgb", lambda f: (f[0], f[1], [1, 3, 3, 4, 16], f[3]))),
        "no-ndf.bsdf": tensor_file([field for field in good if field[0] != "ndf"]),
        "unknown-type.bsdf": whole.replace(b"\x04\0vndf\x04\0\x0a", b"\x04\0vndf\x04\0\x0c"),
        "overflow.bsdf": whole.replace(struct.pack("<4Q", 1, 3, 8, 8), struct.pack("<4Q", 1 << 33, 1 << 33, 8, 8), 1),
        "zemax.bsdf": b"# text\nSource  Measured\nSymmetry  PlaneSymmetrical\nSpectralContent  Monochrome\nScatterType  BRDF\n",
        "fourier.bsdf": b"SCATFUN\1" + bytes(64),
    }


def main(folder):
    for name, content in files().items():
        with open(os.path.join(folder, name), "wb") as file:
            file.write(content)


if __name__ == "__main__":
    main(sys.argv[1])
