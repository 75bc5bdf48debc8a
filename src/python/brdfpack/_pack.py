"""Packing tables, and writing archives."""
from __future__ import annotations

import hashlib
import operator
import os
import threading
import warnings
from collections.abc import Callable

import numpy as np

from ._archive import ZEROS
from ._error import Error, NoPickle, run, taken
from ._native import ffi, lib
from ._text import name_bytes, path_bytes

PROFILES = {"paper": 1, "spectral": 2}
MERL_SCALE = (1.0 / 1500, 1.15 / 1500, 1.66 / 1500)


class Watch:
    """What the library is to tell of its progress, and what came of it."""

    def __init__(self, progress: Callable[[float], object] | None):
        self.progress = progress
        self.raised: BaseException | None = None


def keep_raised(_type, value, traceback) -> int:
    """An exception of the callback, KeyboardInterrupt too, cancels; pack raises it again."""
    watch = ffi.from_handle(traceback.tb_frame.f_locals["user"])
    watch.raised = value
    return 1


@ffi.def_extern(name="tell_python", error=1, onerror=keep_raised)
def tell_python(user, share):
    watch = ffi.from_handle(user)
    if watch.progress is not None:
        watch.progress(share)
    return 0


def merl_read(path) -> tuple[np.ndarray, tuple[float, float, float], int, bytes]:
    """(planes (3, H, D, P) float64 as stored, their scale to 1/sr, bytes of the file, its SHA-256)."""
    with open(path, "rb") as file:
        data = file.read()
    dims = np.frombuffer(data, "<i4", 3) if len(data) >= 12 else np.zeros(3, "<i4")
    cells = int(np.prod(dims.astype(object)))
    if (dims < 4).any() or (dims > 1024).any():
        raise Error(lib.BP_ERROR_BAD_INPUT, f"{os.fspath(path)}: not a MERL file: three extents from 4 to 1024 are expected at its start")
    if len(data) != 12 + 24 * cells:
        raise Error(lib.BP_ERROR_BAD_INPUT, f"{os.fspath(path)}: {len(data)} bytes; a MERL file of {' x '.join(map(str, dims))} cells has {12 + 24 * cells}")
    values = np.frombuffer(data, "<f8", offset=12).astype(np.float64, copy=False).reshape(3, *map(int, dims))
    return values, MERL_SCALE, len(data), hashlib.sha256(data).digest()


def table_take(table) -> tuple[np.ndarray, int, tuple[int, ...]]:
    """(values in C order, bp_layout, (H, D, P)) of an array of shape (H, D, P, 3)."""
    values = np.asarray(table)
    if values.dtype.kind not in "fiu":
        raise TypeError(f"the table holds {values.dtype}, not real numbers")
    if values.ndim != 4 or values.shape[3] != 3:
        raise ValueError(f"the table has shape {values.shape}; (H, D, P, 3) is needed, (90, 90, 180, 3) for MERL's lattice")
    kind = np.float32 if values.dtype in (np.float16, np.float32) else np.float64
    return np.ascontiguousarray(values, kind), lib.BP_LAYOUT_INTERLEAVED, values.shape[:3]


def option(value, what: str) -> int:
    """A whole number above 0 for the library, which refuses what is beyond its limits; 0, its own choice, for None."""
    if value is None:
        return 0
    number = operator.index(value)
    if not 0 < number < 2**32:
        raise ValueError(f"{what} is {number}, out of range")
    return number


def pack(table, budget: int | None = None, *, name: str | None = None, max_error: float | None = None, profile: str = "spectral",
         effort: int = 5, mask=None, zeros: str = "auto", progress: Callable[[float], object] | None = None) -> bytes:
    """Packs one material into a record, which Writer.add takes.

    table: (H, D, P, 3) real numbers in 1/sr, extents from 4 to 1024, or the path of a MERL file. A cell with a negative value, NaN or infinity in any channel counts as not
    measured, and so does one that is False in mask (H, D, P). budget: most bytes, 1000 to 4,000,000, 60,400 unless told; max_error:
    instead, the smallest record whose log RMSE is at most this, 1e-6 to 10. profile: "spectral" or "paper". effort: 1 to 9. progress is
    called with the share that is done, 0 to 1; what it raises ends the packing. Of a file, with its name, this is the record that
    `brdfpack build` makes: one that `brdfpack extract` wrote gives the record it carries, where `build` would keep it.

    zeros: what cells mean that are 0 in all channels. "auto": where no value is negative, a value that all cells below the horizon
    hold, 0 or another constant, is no measurement; a warning tells how many, and so does Info.source_holes. "holes": besides, every
    cell that is 0 in all channels. "measured": values are taken as they are.
    """
    if profile not in PROFILES:
        raise ValueError(f"{profile!r} is neither 'spectral' nor 'paper'")
    if zeros not in ZEROS:
        raise ValueError(f"{zeros!r} is neither 'auto' nor 'holes' nor 'measured'")
    if budget is not None and max_error is not None:
        raise ValueError("a budget and an error bound exclude each other")
    if max_error == 0:
        raise ValueError("max_error is 0; 1e-6 to 10 are possible")
    if isinstance(table, np.ma.MaskedArray):
        raise TypeError("the table is a masked array; give table.data, and mask=~table.mask.any(axis=3)")
    if isinstance(table, (str, bytes, os.PathLike)):
        path = os.fsdecode(table)
        values, scale, source_bytes, sha256 = merl_read(path)
        layout, shape = lib.BP_LAYOUT_PLANES, values.shape[1:]
        name = os.path.splitext(os.path.basename(path))[0] if name is None else name
    else:
        values, layout, shape = table_take(table)
        scale, source_bytes, sha256 = (0.0, 0.0, 0.0), 0, bytes(32)
    masked = None
    if mask is not None:
        masked = np.ascontiguousarray(np.asarray(mask) != 0, np.uint8)
        if masked.shape != tuple(shape):
            raise ValueError(f"the mask has shape {masked.shape}, the table {tuple(shape)}")
    watch = Watch(progress)
    handle = ffi.new_handle(watch)
    watched = progress is not None or threading.current_thread() is threading.main_thread()
    measured = ffi.new("bp_measured *", {
        "struct_bytes": ffi.sizeof("bp_measured"), "theta_h": shape[0], "theta_d": shape[1], "phi_d": shape[2],
        "number": lib.BP_NUMBER_FLOAT if values.dtype == np.float32 else lib.BP_NUMBER_DOUBLE, "layout": layout,
        "values": ffi.cast("void *", values.ctypes.data), "mask": ffi.cast("uint8_t *", masked.ctypes.data) if masked is not None else ffi.NULL,
        "scale": scale, "source_bytes": source_bytes, "source_sha256": sha256})
    options = ffi.new("bp_pack_options *", {
        "struct_bytes": ffi.sizeof("bp_pack_options"), "profile": PROFILES[profile], "budget_bytes": option(budget, "budget"), "max_error": max_error or 0.0,
        "effort": option(effort, "effort"), "zeros": ZEROS.index(zeros), "progress": lib.tell_python if watched else ffi.NULL, "user": handle})
    try:
        packed = taken(lib.bp_pack, measured, name_bytes("material" if name is None else name), options)
    except (Error, MemoryError):
        if watch.raised is None:
            raise
    if watch.raised is not None:
        raise watch.raised
    holes = int.from_bytes(packed[52:56], "little") & 0xFFFFFFF  # FORMAT.md, section 5
    if holes and zeros == "auto":
        warnings.warn(f"{name or 'material'}: no value is negative, and {holes} cells below the horizon hold one value: treated as not "
                      "measured (unless zeros='measured')", stacklevel=2)
    return packed


class Writer(NoPickle):
    """An archive to be: add records in any order, then it appears under its path, whole or not at all.

        with brdfpack.Writer("out.bpk") as w:
            w.add("mine", record)

    It is written when the block ends without an exception, or by close. path None: bytes() gives it instead.
    """

    def __init__(self, path=None):
        handle = ffi.new("bp_writer **")
        run(lib.bp_writer_create, handle)
        self._handle = ffi.gc(handle[0], lib.bp_writer_free)
        self._path = None if path is None else path_bytes(path)
        self._lock = threading.Lock()
        self._closed = False

    def __len__(self) -> int:
        return lib.bp_writer_count(self._handle)

    def add(self, name: str | None, record: bytes) -> None:
        """Adds a record under a name, or, name None, under its own. A record that is refused leaves the writer as it was."""
        if not isinstance(record, bytes):
            raise TypeError(f"a record is bytes, as brdfpack.pack gives it, not {type(record).__name__}")
        with self._lock:
            if self._closed:
                raise ValueError("the writer is closed")
            if name is not None:
                record = taken(lib.bp_record_rename, record, len(record), name_bytes(name))
            run(lib.bp_writer_add, self._handle, record, len(record))

    def bytes(self) -> bytes:
        """The archive as it is now, in memory."""
        with self._lock:
            return taken(lib.bp_writer_save_memory, self._handle)

    def close(self) -> None:
        """Writes the archive to its path; again does nothing."""
        with self._lock:
            if self._closed:
                return
            if self._path is not None:
                run(lib.bp_writer_save, self._handle, self._path)
            self._closed = True

    def __enter__(self) -> "Writer":
        return self

    def __exit__(self, kind, *_) -> None:
        if kind is None:
            self.close()
        else:
            self._closed = True  # nothing is written
