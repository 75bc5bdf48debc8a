#!/usr/bin/env python3
"""Mitsuba 3's own BSDF `measured` on published files against our records of them: mitsuba_measured.py TOOL FOLDER SCRATCH

FOLDER holds isotropic RGB .bsdf files of the RGL database. Each is packed, in 60,400 bytes and in 400,000, and evaluated at 10,000 random
pairs of directions, uniform over the solid angle within 85 degrees of the normal. Told of each: the median relative error over pairs
and channels and the share of errors beyond 5 %, against the file's function in one direction, as Mitsuba evaluates it, and
against the mean of both directions, which is what a reciprocal table can hold. The latter is to be at most 1 % in the median. Where the two
directions of a file differ by d, no reciprocal table is nearer to one of them than d/2, so the former is told, and bounds nothing. Materials
with lobes narrower than the lattice miss the bound at any size of the record (last column): MISSING has what they are held to instead.
"""
import glob
import os
import subprocess
import sys

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
import brdfpack  # noqa: E402

PAIRS, BUDGETS, BOUND, FAR = 10_000, (60_400, 400_000), 0.01, 0.05
MISSING = {"cc_iris_purple_gem_rgb": 0.06, "chm_mint_rgb": 0.06, "ilm_solo_m_68_rgb": 0.03, "irid_flake_paint2_rgb": 0.03}


def directions(rng, count):
    """Uniform over the solid angle within 85 degrees of the normal."""
    z = rng.uniform(np.cos(np.radians(85)), 1, count)
    phi = rng.uniform(0, 2 * np.pi, count)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], 1)


def mitsuba_values(path, wi, wo):
    """f in 1/sr: Mitsuba's value over the cosine of wo."""
    bsdf, context = mi.load_dict({"type": "measured", "filename": path}), mi.BSDFContext()
    si = mi.SurfaceInteraction3f()
    out = np.empty((len(wi), 3))
    for n, (a, b) in enumerate(zip(wi, wo)):
        si.wi = mi.Vector3f(*map(float, a))
        out[n] = np.array(bsdf.eval(context, si, mi.Vector3f(*map(float, b)))).ravel()[:3] / b[2]
    return out


def errors(found, expected):
    """Median and share beyond FAR of the relative errors where there is something to compare with."""
    there = expected > 1e-6
    relative = np.abs(found[there] / expected[there] - 1)
    return np.median(relative), np.mean(relative > FAR)


def main(tool, folder, scratch):
    rng = np.random.default_rng(16)
    wi, wo = directions(rng, PAIRS), directions(rng, PAIRS)
    paths = sorted(glob.glob(os.path.join(folder, "*_rgb.bsdf")))
    archives, off, failed = [], [], False
    for budget in BUDGETS:
        out = os.path.join(scratch, f"measured-{budget}.bpk")
        subprocess.run([tool, "build", "-q", "--budget", str(budget), "-o", out, *paths], check=True)
        archives.append(brdfpack.open(out))
    print(f"genuine (RGL), {PAIRS} pairs of directions; median relative error, share beyond {FAR:.0%}")
    print(f"{'material':24}  {'one direction':15}  {'mean of both':15}  {'file: the directions apart':26}  mean of both, {BUDGETS[1]} bytes")
    for path in paths:
        name = os.path.basename(path)[:-len(".bsdf")]
        one, other = mitsuba_values(path, wi, wo), mitsuba_values(path, wo, wi)
        small, large = (archive.load(name).evaluate(wi, wo) for archive in archives)
        mean = (one + other) / 2
        figures = [errors(small, one), errors(small, mean), errors(other, one), errors(large, mean)]
        print(f"{name:24}  " + "  ".join(f"{a:7.3%} {b:7.2%}".ljust(w) for (a, b), w in zip(figures, (15, 15, 26, 15))))
        if figures[1][0] > BOUND:
            off.append(name)
        failed |= figures[1][0] > MISSING.get(name, BOUND)
    if off:
        print(f"more than {BOUND:.0%} from the mean of both directions in the median: {', '.join(off)}")
    return 1 if failed or not paths else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
