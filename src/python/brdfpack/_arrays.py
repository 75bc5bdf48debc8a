"""NumPy arrays as the C functions of strided.h want them."""
from __future__ import annotations

import numpy as np

from ._native import ffi

FLOAT = np.dtype(np.float32)


def real(values, what: str) -> np.ndarray:
    """An array of float32, copied only where it is something else; what exceeds a float becomes infinite."""
    array = np.asarray(values)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{what} holds {array.dtype}, not real numbers")
    if array.dtype == FLOAT:
        return array.astype(FLOAT, copy=False)
    with np.errstate(over="ignore"):
        return array.astype(FLOAT)


def vectors(values, what: str) -> np.ndarray:
    """The same of shape (..., 3)."""
    array = real(values, what)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"{what} has shape {array.shape}; (..., 3) is needed")
    return array


def together(a: np.ndarray, b: np.ndarray, names: str) -> tuple[np.ndarray, np.ndarray, tuple[int, ...]]:
    """Both as (n, 3), and the leading shape that they have in common, broadcast as NumPy does."""
    if a.shape != b.shape:
        try:
            a, b = np.broadcast_arrays(a, b)
        except ValueError:
            raise ValueError(f"{names} have shapes {a.shape} and {b.shape}, which do not go together") from None
    if a.ndim != 2:
        lead = a.shape[:-1]
        return a.reshape(-1, 3), b.reshape(-1, 3), lead
    return a, b, a.shape[:1]


def strided(array: np.ndarray):
    """(pointer, row, column) of an (n, 3) array, strides in floats; and the array that owns the memory, for the time of the call."""
    if any(stride % FLOAT.itemsize for stride in array.strides) or not array.flags.aligned:
        array = np.ascontiguousarray(array)
    return (ffi.cast("const float *", array.ctypes.data), array.strides[0] // FLOAT.itemsize, array.strides[1] // FLOAT.itemsize), array


def result(out: np.ndarray | None, shape: tuple[int, ...], *inputs: np.ndarray) -> np.ndarray:
    """A new array, or the caller's own, checked: it may share no memory with the inputs."""
    if out is None:
        return np.empty(shape, FLOAT)
    if not isinstance(out, np.ndarray) or out.dtype != FLOAT or out.shape != shape or not out.flags.c_contiguous:
        raise ValueError(f"out must be a C-contiguous float32 array of shape {shape}")
    if not out.flags.writeable:
        raise ValueError("out is read-only")
    if any(np.may_share_memory(out, array) for array in inputs):
        raise ValueError("out overlaps an input")
    return out


def pointer(array: np.ndarray):
    return ffi.cast("float *", array.ctypes.data)
