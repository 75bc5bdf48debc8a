"""A loaded material."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ._arrays import pointer, real, result, strided, together, vectors
from ._error import NoPickle, run
from ._native import ffi, lib

LAYOUTS = {"float32": (lib.BP_NUMBER_FLOAT, np.float32), "float64": (lib.BP_NUMBER_DOUBLE, np.float64), "float16": (lib.BP_NUMBER_HALF, np.float16)}


def table_read(handle, index: int, shape: tuple[int, int, int], max_error: float, dtype, continued: bool,
               where: tuple[str, ...] = ()) -> np.ndarray:
    """The decoded table of one material: (H, D, P, 3), 1/sr."""
    name = np.dtype(dtype).name
    if name not in LAYOUTS:
        raise TypeError(f"a table holds float16, float32 or float64, not {name}")
    number, kind = LAYOUTS[name]
    values = np.empty(shape + (3,), kind)
    options = ffi.new("bp_table_options *", {"struct_bytes": ffi.sizeof("bp_table_options"), "max_log_rmse": max_error, "number": number,
                                             "layout": lib.BP_LAYOUT_INTERLEAVED, "continued": int(bool(continued))})
    run(lib.bp_archive_table, handle, index, options, ffi.cast("void *", values.ctypes.data), values.nbytes, where=where)
    return values


class Sample(NamedTuple):
    """What Material.sample draws: unit vectors (..., 3), and their densities per solid angle (...)."""

    wi: np.ndarray
    pdf: np.ndarray


class Material(NoPickle):
    """One material, ready to evaluate; brdfpack.Archive.load makes it. It never changes and outlives its archive.

    name: str; layers: how many of its record's were loaded; log_rmse: their recorded error over all measured cells;
    memory_bytes: what it occupies; shape: (H, D, P), values along theta_h, theta_d and phi_d, of a preview half the lattice's; sampling:
    whether sample, pdf and albedo can be called. Any number of threads may use it at once, and a forked process its copy.
    """

    def __init__(self, handle, name: str, record: bytes, max_error: float, shape: tuple[int, int, int]):
        self._handle = ffi.gc(handle, lib.bp_material_free)
        self._record = record
        self._max_error = max_error
        self._lattice = shape
        loaded = ffi.new("bp_loaded *", {"struct_bytes": ffi.sizeof("bp_loaded")})
        run(lib.bp_material_loaded, handle, loaded)
        self.name = name
        self.layers = loaded.layers
        self.log_rmse = loaded.log_rmse
        self.memory_bytes = loaded.memory_bytes
        self.shape = (loaded.theta_h, loaded.theta_d, loaded.phi_d)
        self.sampling = bool(loaded.sampling)

    def __repr__(self) -> str:
        return f"<brdfpack.Material {self.name!r}: {self.layers} layers, log RMSE {self.log_rmse:.4g}>"

    def _needs_sampling(self) -> None:
        if not self.sampling:
            raise ValueError(f"{self.name} was loaded without sampling=True")

    def evaluate(self, wi, wo, out: np.ndarray | None = None) -> np.ndarray:
        """f(wi, wo) in 1/sr.

        wi, wo: (n, 3), or any shapes (..., 3) that broadcast; float32 is taken as it is, other real numbers are converted.
        Returns (n, 3) float32, R G B, finite and not negative; out: such an array to write to, C-contiguous, which must not overlap
        the inputs. ValueError for other shapes, TypeError for what are no real numbers.
        """
        wi, wo, lead = together(vectors(wi, "wi"), vectors(wo, "wo"), "wi and wo")
        rgb = result(out, lead + (3,), wi, wo)
        (a, keep_a), (b, keep_b) = strided(wi), strided(wo)
        lib.strided_evaluate(self._handle, len(wi), *a, *b, pointer(rgb))
        del keep_a, keep_b
        return rgb

    def sample(self, wo, u) -> Sample:
        """Draws wi for each wo, nearly in proportion to f cos theta_i.

        wo: (n, 3) directions; u: (n, 3) independent uniform numbers in [0, 1). Returns wi (n, 3), of unit length, and its density per
        solid angle (n,), which is what pdf gives; both float32. An unusable wo gives wi = 0 and density 0.
        """
        self._needs_sampling()
        wo, u, lead = together(vectors(wo, "wo"), vectors(u, "u"), "wo and u")
        wi, pdf = np.empty(lead + (3,), np.float32), np.empty(lead, np.float32)
        (a, keep_a), (b, keep_b) = strided(wo), strided(u)
        lib.strided_sample(self._handle, len(wo), *a, *b, pointer(wi), pointer(pdf))
        del keep_a, keep_b
        return Sample(wi, pdf)

    def pdf(self, wi, wo) -> np.ndarray:
        """The density of sample per solid angle: (n,) float32 for wi and wo of (n, 3), or shapes that broadcast; 0 for unusable ones."""
        self._needs_sampling()
        wi, wo, lead = together(vectors(wi, "wi"), vectors(wo, "wo"), "wi and wo")
        pdf = np.empty(lead, np.float32)
        (a, keep_a), (b, keep_b) = strided(wi), strided(wo)
        lib.strided_pdf(self._handle, len(wi), *a, *b, pointer(pdf))
        del keep_a, keep_b
        return pdf

    def albedo(self, theta) -> np.ndarray:
        """The directional albedo, the integral of f cos theta_i over wi, R G B: (..., 3) float32 for theta of shape (...).

        theta: theta_o in radians, 0 <= theta < pi/2; elsewhere and for NaN it is 0. Measurements can exceed 1. An angle that is asked
        for first takes some milliseconds.
        """
        self._needs_sampling()
        theta = real(theta, "theta")
        rgb = np.empty(theta.shape + (3,), np.float32)
        theta = np.ascontiguousarray(theta)
        lib.strided_albedo(self._handle, theta.size, pointer(theta), pointer(rgb))
        return rgb

    def table(self, dtype="float32", continued: bool = False) -> np.ndarray:
        """The decoded table of the layers that were loaded: (H, D, P, 3), (90, 90, 180, 3) for MERL's lattice, in 1/sr.

        Axes as in FORMAT.md: cell (i, j, k) starts at theta_h = (i/H)^2 pi/2, theta_d = (j/D) pi/2, phi_d = (k/P) pi, and its value
        stands for its centre. dtype: float16, float32 or float64. Cells below the horizon, beyond anything measured, are -1;
        with continued=True they hold the model's smooth continuation.
        """
        writer, archive = ffi.new("bp_writer **"), ffi.new("bp_archive **")
        bytes_, count = ffi.new("uint8_t **"), ffi.new("size_t *")
        run(lib.bp_writer_create, writer)
        try:  # an archive of this one record, in memory
            run(lib.bp_writer_add, writer[0], self._record, len(self._record))
            run(lib.bp_writer_save_memory, writer[0], bytes_, count)
            run(lib.bp_archive_open_memory, bytes_[0], count[0], archive)
            return table_read(archive[0], 0, self._lattice, self._max_error, dtype, continued)
        finally:
            lib.bp_archive_close(archive[0])
            lib.bp_free(bytes_[0])
            lib.bp_writer_free(writer[0])
