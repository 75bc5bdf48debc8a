#!/usr/bin/env python3
"""The BSDF of Mitsuba 3 in one variant: mitsuba_plugin.py VARIANT TOOL ARCHIVE FOLDER"""
import subprocess
import sys

import drjit as dr
import mitsuba as mi
import numpy as np

variant, tool, path, folder = sys.argv[1:5]
mi.set_variant(variant)
import brdfpack  # noqa: E402
import brdfpack.mitsuba  # noqa: E402

NAMES = sys.argv[5:]
vector = not variant.startswith("scalar")


def bsdf_of(name):
    return mi.load_dict({"type": "brdfpack", "filename": path, "material": name})


def frame_at(theta):
    si = dr.zeros(mi.SurfaceInteraction3f)
    si.wi = mi.Vector3f(float(np.sin(theta)), 0, float(np.cos(theta)))
    return si


def chi_square(name):
    from mitsuba.chi2 import BSDFAdapter, ChiSquareTest, SphericalDomain
    for theta in (0.02, 0.7, 1.2, 1.5):
        wi = [float(np.sin(theta)), 0.0, float(np.cos(theta))]
        sample, pdf = BSDFAdapter("brdfpack", f"<string name='filename' value='{path}'/><string name='material' value='{name}'/>", wi=wi)
        test = ChiSquareTest(domain=SphericalDomain(), sample_func=sample, pdf_func=pdf, sample_dim=3, sample_count=400_000, res=101, ires=16)
        assert test.run(), f"{name}, theta {theta}: {test.messages}"


def white_furnace(name):
    """Light of 1 from everywhere: what comes back is the albedo."""
    material = brdfpack.open(path).load(name, sampling=True)
    bsdf = bsdf_of(name)
    count = 1 << 21
    for theta in (0.1, 0.8, 1.3):
        si = frame_at(theta)
        rng = np.random.default_rng(5)
        one, two = rng.random(count, np.float32), rng.random((2, count), np.float32)
        _, weight = bsdf.sample(mi.BSDFContext(), si, mi.Float(one), mi.Point2f(two))
        got = np.array(weight, np.float64).reshape(3, -1).mean(1)
        expected = material.albedo(theta)
        off = abs(got / expected - 1).max()
        print(f"furnace {name} {theta}: {off:.5f}")
        assert off < 0.005


def key_lights():
    lights = [((0.5, 0.6, 0.8), 3), ((-0.7, 0.2, 0.6), 1), ((0.1, -0.5, 0.7), 0.6), ((0.9, 0.1, -0.25), 1.5), ((-0.5, 0.8, -0.4), 1.5)]
    for i in range(24):
        z = 1 - 2 * (i + 0.5) / 24
        lights.append(((np.sqrt(1 - z * z) * np.cos(i * 2.39996323), np.sqrt(1 - z * z) * np.sin(i * 2.39996323), z), 0.15))
    return [(np.array(d) / np.linalg.norm(d), w) for d, w in lights]


def sphere(name):
    """The sphere that `brdfpack render` draws, by Mitsuba's own intersection of the same rays."""
    size = 160
    image = f"{folder}/{name}.pfm"
    subprocess.run([tool, "render", "--size", str(size), "-o", image, path, name], check=True)
    with open(image, "rb") as file:
        data = file.read()
    expected = np.frombuffer(data[-12 * size * size:], "<f4").reshape(size, size, 3)[::-1].astype(np.float64)
    axis = (np.arange(size) + 0.5) / size * 2 - 1
    u, v = np.meshgrid(axis, -axis)
    covered = u * u + v * v < 0.99
    scene = mi.load_dict({"type": "scene", "ball": {"type": "sphere", "bsdf": {"type": "brdfpack", "filename": path, "material": name}}})
    origin = np.stack([u[covered], v[covered], np.full(covered.sum(), 3.0)]).astype(np.float32)
    si = scene.ray_intersect(mi.Ray3f(mi.Point3f(origin), mi.Vector3f(0, 0, -1)))
    radiance = np.zeros((3, covered.sum()))
    for direction, weight in key_lights():
        wo = si.to_local(mi.Vector3f(*map(float, direction)))
        value = si.bsdf().eval(mi.BSDFContext(), si, wo, wo.z > 1e-3)
        radiance += np.array(value, np.float64).reshape(3, -1) * weight
    got = radiance.T
    want = expected[covered]
    psnr = 20 * np.log10(np.percentile(want, 90) / np.sqrt(((got - want) ** 2).mean()))
    print(f"sphere {name}: {psnr:.1f} dB")
    assert psnr >= 50


def gradients(name):
    bsdf = bsdf_of(name)
    wo = np.random.default_rng(2).normal(size=(3, 20000)).astype(np.float32)
    wo[2] = abs(wo[2])
    wo /= np.linalg.norm(wo, axis=0)
    for theta in (0.0, 0.5, 1.4):
        si = frame_at(theta)
        special = np.array([[0, 0, 1], [np.sin(theta), 0, np.cos(theta)], [-np.sin(theta), 0, np.cos(theta)], [1, 0, 1e-6]], np.float32).T
        w = mi.Vector3f(np.concatenate([wo, special], 1))
        dr.enable_grad(w)
        value = bsdf.eval(mi.BSDFContext(), si, w, True)
        dr.backward(dr.sum(dr.sum(value)))
        slope = np.array(dr.grad(w))
        assert np.isfinite(slope).all() and abs(slope).max() > 0


def same_as_the_library(name):
    material = brdfpack.open(path).load(name)
    bsdf, rng = bsdf_of(name), np.random.default_rng(4)
    for theta in (0.0, 0.6, 1.4):
        si = frame_at(theta)
        for _ in range(60):
            wo = rng.normal(size=3)
            wo[2] = abs(wo[2])
            wo /= np.linalg.norm(wo)
            got = np.array(bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(*map(float, wo)), True)).ravel()
            want = material.evaluate([np.sin(theta), 0, np.cos(theta)], wo) * wo[2]
            # the library's table is rounded to 11 bits, its angles to a float's
            np.testing.assert_allclose(got, want, rtol=4e-3, atol=1e-6)
            below = bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(float(wo[0]), float(wo[1]), -float(wo[2])), True)
            assert (np.array(below) == 0).all()
        one, two = rng.random(2000), rng.random((2000, 2))
        if vector:
            bs, weight = bsdf.sample(mi.BSDFContext(), si, mi.Float(one), mi.Point2f(two.T))
            pdf = bsdf.pdf(mi.BSDFContext(), si, bs.wo, True)
            np.testing.assert_allclose(np.array(bs.pdf), np.array(pdf), rtol=1e-5)
        else:
            for n in range(200):
                bs, weight = bsdf.sample(mi.BSDFContext(), si, float(one[n]), mi.Point2f(*map(float, two[n])), True)
                assert abs(bs.pdf - bsdf.pdf(mi.BSDFContext(), si, bs.wo, True)) <= 1e-5 * bs.pdf
                value = np.array(bsdf.eval(mi.BSDFContext(), si, bs.wo, True))
                if bs.pdf > 0:
                    np.testing.assert_allclose(np.array(weight), value / bs.pdf, rtol=1e-5)


for name in NAMES:
    same_as_the_library(name)
    if vector:
        sphere(name)
        gradients(name)
        white_furnace(name)
if vector:
    for name in NAMES[:2]:
        chi_square(name)
    mi.set_variant("llvm_ad_spectral")
    try:
        brdfpack.mitsuba.register()
    except ImportError as refused:
        assert "RGB variant" in str(refused)
    else:
        raise AssertionError("a spectral variant was accepted")
else:  # a whole render, however small
    scene = mi.load_dict({"type": "scene", "integrator": {"type": "path", "max_depth": 3}, "light": {"type": "constant"},
                          "sensor": {"type": "perspective", "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0, 0], [0, 1, 0]),
                                     "film": {"type": "hdrfilm", "width": 12, "height": 12}},
                          "ball": {"type": "sphere", "bsdf": {"type": "brdfpack", "filename": path, "material": NAMES[0]}}})
    image = np.array(mi.render(scene, spp=4))
    assert np.isfinite(image).all() and image.min() >= 0 and image.std() > 0
print(f"{variant}: all well")
