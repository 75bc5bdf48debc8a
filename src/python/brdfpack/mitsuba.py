"""The BSDF `brdfpack` for Mitsuba 3: a material of an archive.

    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    import brdfpack.mitsuba
    mi.load_dict({"type": "sphere", "bsdf": {"type": "brdfpack", "filename": "merl.bpk", "material": "nickel"}})

Parameters: filename (str), material (str), max_error (float, 0: all layers). One-sided, opaque, reflection only. It is made for the variant
that is set when this module is imported; after another mi.set_variant call register() again. RGB variants only: how a measured
R, G, B would become a spectrum is not in the data, so spectral, mono and polarised variants are refused.

Values are trilinear between the centres of the decoded table's cells, as FORMAT.md has it. Directions are drawn by the half-vector, in proportion to
the table's mean over theta_d and phi_d, with a share of the cosine's density.
"""
from __future__ import annotations

try:
    import drjit as dr
    import mitsuba as mi
except ModuleNotFoundError as missing:
    raise ModuleNotFoundError("brdfpack.mitsuba needs Mitsuba 3: pip install mitsuba", name=missing.name) from missing
import numpy as np

import brdfpack

COSINE_SHARE = 0.2


def half_density(table: np.ndarray) -> np.ndarray:
    """Probabilities of the H bins of theta_h: the table's mean over theta_d, phi_d and channels, times the bin's share of the hemisphere."""
    edges = np.cos((np.arange(table.shape[0] + 1) / table.shape[0]) ** 2 * (np.pi / 2))
    # sin theta_d: what a half-vector sees of directions; the cosine is that of the half-vector itself, so that the horizon gets little
    weight = np.sin((np.arange(table.shape[1]) + 0.5) / table.shape[1] * (np.pi / 2))
    mean = np.average(table.mean((2, 3), dtype=np.float64), axis=1, weights=weight)
    mass = np.maximum(mean, 1e-4 * mean.max() + 1e-30) * (edges[:-1] ** 2 - edges[1:] ** 2)
    return mass / mass.sum()


def register() -> None:
    """Makes the plugin for the variant that is set, and registers it."""
    variant = mi.variant()
    if variant is None:
        raise ImportError("set a variant first: mitsuba.set_variant('llvm_ad_rgb'), then import brdfpack.mitsuba")
    if not variant.endswith("_rgb"):
        raise ImportError(f"the BSDF 'brdfpack' has measured R, G and B: it needs an RGB variant, scalar_rgb or llvm_ad_rgb, not {variant}")
    mi.register_bsdf("brdfpack", bsdf_class())


def bsdf_class():
    """The class, over the types of the variant that is set."""
    scalar = mi.variant().startswith("scalar")

    class BrdfpackBSDF(mi.BSDF):
        def __init__(self, props):
            mi.BSDF.__init__(self, props)
            self.filename = mi.file_resolver().resolve(props["filename"]) if hasattr(mi, "file_resolver") else props["filename"]
            self.material = props["material"]
            max_error = props["max_error"] if props.has_property("max_error") else 0.0
            with brdfpack.open(str(self.filename)) as archive:
                table = archive[self.material].table(max_error=max_error, continued=True)
                self.scalar = archive.load(self.material, max_error=max_error) if scalar else None
            self.dims = table.shape[:3]
            mass = half_density(table)
            self.cumulative = np.concatenate([[0], np.cumsum(mass)]).astype(np.float32)
            self.cumulative[-1] = 1
            # 1 - cos theta_h, in which a float tells the first bins apart
            self.edges = (2 * np.sin((np.arange(self.dims[0] + 1) / self.dims[0]) ** 2 * (np.pi / 4)) ** 2).astype(np.float32)
            # per solid angle of the half-vector, in each bin, from the very numbers that samples are drawn by
            self.per = (np.diff(self.cumulative.astype(np.float64)) / (2 * np.pi * np.diff(self.edges.astype(np.float64)))).astype(np.float32)
            if not scalar:
                self.values = mi.Float(table.ravel())
                self.cumulative, self.edges, self.per = mi.Float(self.cumulative), mi.Float(self.edges), mi.Float(self.per)
            self.m_components = [mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide]
            self.m_flags = self.m_components[0]

        # ---- evaluation ----

        def _value(self, wi, wo, active):
            """f, trilinear between centres."""
            if scalar:
                return mi.Color3f([float(x) for x in self.scalar.evaluate(np.array(wi, np.float32).ravel(), np.array(wo, np.float32).ravel())])
            H, D, P = self.dims
            h = dr.normalize(wi + wo)
            rho2 = dr.maximum(h.x * h.x + h.y * h.y, 1e-14)  # nowhere a derivative of a square root at 0
            rho = dr.sqrt(rho2)
            theta_h = dr.atan2(rho, h.z)
            cos_d = dr.clip(dr.dot(h, wi), 0, 1)
            # wi in the frame of h: x along its meridian
            cos_p, sin_p = h.x / rho, h.y / rho
            along, across = cos_p * wi.x + sin_p * wi.y, cos_p * wi.y - sin_p * wi.x
            x = h.z * along - rho * wi.z
            far = x * x + across * across
            theta_d = dr.atan2(dr.sqrt(dr.maximum(far, 1e-14)), cos_d)
            near = far < 1e-14
            phi = dr.atan2(dr.select(near, 0, across), dr.select(near, 1, x))
            phi = dr.select(phi < 0, phi + dr.pi, phi)
            a = dr.clip(dr.sqrt(theta_h * (2 / dr.pi)) * H - 0.5, 0, H - 1)
            b = dr.clip(theta_d * (2 / dr.pi) * D - 0.5, 0, D - 1)
            c = phi * (P / dr.pi) - 0.5
            i, j, k = (mi.UInt32(dr.floor(dr.detach(t))) for t in (a, b, dr.maximum(c, 0)))
            i, j = dr.minimum(i, H - 2), dr.minimum(j, D - 2)
            before = c < 0  # between the last centre and the first
            k0 = dr.select(before, P - 1, dr.minimum(k, P - 1))
            k1 = dr.select(k0 == P - 1, 0, k0 + 1)
            u, v = a - mi.Float(i), b - mi.Float(j)
            w = dr.select(before, c + 1, c - mi.Float(k))

            def cell(row, column, turn):
                return dr.gather(mi.Color3f, self.values, (row * D + column) * P + turn, active)

            def plane(row):
                return (cell(row, j, k0) * (1 - w) + cell(row, j, k1) * w) * (1 - v) + (cell(row, j + 1, k0) * (1 - w) + cell(row, j + 1, k1) * w) * v

            return plane(i) * (1 - u) + plane(i + 1) * u

        def eval(self, ctx, si, wo, active=True):
            active = mi.Bool(active) & (si.wi.z > 0) & (wo.z > 0)
            if scalar and not active:
                return mi.Color3f(0)
            return dr.select(active, self._value(si.wi, wo, active) * wo.z, mi.Color3f(0))

        # ---- sampling ----

        def _take(self, array, index, active=True):
            return float(array[index]) if scalar else dr.gather(mi.Float, array, index, active)

        def _bin(self, h):
            """The bin of theta_h."""
            H = self.dims[0]
            edge = (h.x * h.x + h.y * h.y) / (1 + h.z)
            if scalar:
                return int(min(max(np.searchsorted(self.edges, edge, side="right") - 1, 0), H - 1))
            return dr.minimum(dr.binary_search(0, H, lambda n: dr.gather(mi.Float, self.edges, n + 1) <= edge), H - 1)

        def pdf(self, ctx, si, wo, active=True):
            active = mi.Bool(active) & (si.wi.z > 0) & (wo.z > 0)
            if scalar and not active:
                return 0.0
            h = dr.normalize(si.wi + wo)
            half = self._take(self.per, self._bin(h), active) / (4 * dr.maximum(dr.dot(h, wo), 1e-6))
            pdf = COSINE_SHARE * wo.z * dr.inv_pi + (1 - COSINE_SHARE) * half
            return dr.select(active, pdf, 0)

        def sample(self, ctx, si, sample1, sample2, active=True):
            active = mi.Bool(active) & (si.wi.z > 0)
            bs = dr.zeros(mi.BSDFSample3f)
            H = self.dims[0]
            if scalar:
                n = int(min(max(np.searchsorted(self.cumulative, sample2.x, side="right") - 1, 0), H - 1))
            else:
                n = dr.minimum(dr.binary_search(0, H, lambda m: dr.gather(mi.Float, self.cumulative, m + 1) <= sample2.x), H - 1)
            low, high = self._take(self.cumulative, n), self._take(self.cumulative, n + 1)
            first, last = self._take(self.edges, n), self._take(self.edges, n + 1)
            place = dr.clip((sample2.x - low) / dr.maximum(high - low, 1e-30), 0, 1)
            edge = first + (last - first) * place
            cosine, sine = 1 - edge, dr.safe_sqrt(edge * (2 - edge))
            angle = 2 * dr.pi * sample2.y
            h = mi.Vector3f(sine * dr.cos(angle), sine * dr.sin(angle), cosine)
            by_half = h * (2 * dr.dot(h, si.wi)) - si.wi
            wo = dr.select(sample1 < COSINE_SHARE, mi.warp.square_to_cosine_hemisphere(sample2), by_half)
            bs.wo = dr.normalize(wo)
            bs.pdf = self.pdf(ctx, si, bs.wo, active)
            bs.eta = 1.0
            bs.sampled_type = mi.UInt32(+mi.BSDFFlags.GlossyReflection)
            bs.sampled_component = mi.UInt32(0)
            active &= bs.pdf > 0
            weight = self.eval(ctx, si, bs.wo, active) / dr.select(active, bs.pdf, 1)
            return bs, dr.select(active, weight, mi.Color3f(0))

        def eval_pdf(self, ctx, si, wo, active=True):
            return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)

        def traverse(self, callback):
            pass

        def to_string(self):
            return f"BrdfpackBSDF[filename = {self.filename}, material = {self.material}]"

    return BrdfpackBSDF


register()
