"""Archives of measured materials: read, evaluate, sample, pack and write them, with NumPy arrays.

    import brdfpack
    with brdfpack.open("merl.bpk") as archive:
        nickel = archive.load("nickel", max_error=0.01, sampling=True)
    f = nickel.evaluate(wi, wo)

Directions are in the local frame of the surface, z along the normal, away from it: wi towards the light, wo towards the eye. They
need not have unit length. One that is on or below the horizon, zero, infinite or NaN gives 0. Values are the BRDF in 1/sr, linear,
in the measured R, G and B; multiply by cos theta_i yourself. Angles are in radians.

What the C library refuses raises brdfpack.Error with its message; what Python can tell before it raises ValueError or TypeError.
Any number of threads may use an archive or a material, and calls run without the interpreter's lock.
"""
from ._archive import Archive, Channel, Info, Layer, Problem, Section, open  # noqa: A004
from ._error import Error
from ._material import Material
from ._native import ffi as _ffi, lib as _lib
from ._pack import Writer, pack

__version__ = _ffi.string(_lib.bp_version_text()).decode()
__all__ = ["Archive", "Channel", "Error", "Info", "Layer", "Material", "Problem", "Section", "Writer", "open", "pack", "__version__"]
