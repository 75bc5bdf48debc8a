"""Archives as mappings from names to materials."""
from __future__ import annotations

import builtins
import contextlib
import os
import threading
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from ._error import Error, NoPickle, NotFound, check, run, taken
from ._material import Material, table_read
from ._native import ffi, lib
from ._text import name_bytes, path_bytes

FORMS = {"expanded": lib.BP_FORM_EXPANDED, "compact": lib.BP_FORM_COMPACT, "preview": lib.BP_FORM_PREVIEW}
COLOURS = {"rgb": lib.BP_COLOUR_RGB, "mean": lib.BP_COLOUR_MEAN}
PROFILES = {1: "paper", 2: "spectral"}
ZEROS = ("auto", "holes", "measured")


class Layer(NamedTuple):
    """A set of sections: what loading it costs, and what error is left against the measured values b, decoded e, in 1/sr."""

    bytes: int  # of the record up to and including this layer
    log_rmse: float  # rms of log10((e + 1e-3)/(b + 1e-3)) over the valid cells and channels
    cube_root_rmse: float  # rms of cbrt(b cos) - cbrt(e cos), cos the smaller cosine of the two directions
    largest_relative: float  # the largest |e - b|/(b + 1e-2)
    seen_log_rmse: float  # log_rmse over the valid cells that do not lie wholly below the horizon


class Section(NamedTuple):
    """A part of a record with a checksum of its own. type, codec, version, flags: numbers of FORMAT.md."""

    type: int
    codec: int
    version: int
    layer: int  # the first that needs it
    flags: int
    bytes: int
    error: float  # its own figure, or NaN


class Channel(NamedTuple):
    """The robust regression of one channel's measured values, diffuse + specular x (bp_channel of brdfpack.h says what x is)."""

    diffuse: float  # 1/sr
    specular: float  # a ratio
    rejected: float  # share of the valid cells without weight, 0 to 1
    iterations: int
    converged: bool


class Problem(NamedTuple):
    """One thing that is wrong: material is its name, or None where the header or the index is meant."""

    material: str | None
    error: Error


class Info(NamedTuple):
    """What a record's head says.

    shape: cells (H, D, P); record_offset: in the file; channels: of R, G, B; effort, budget_bytes and max_error: the options it was made with
    (max_error 0: a budget was asked for); source_bytes, source_sha256 (32 bytes): of the measured file; source_nonfinite: its cells with
    NaN or infinity; source_holes: its cells that were taken as not measured for the value they hold, by the rule zeros (see pack);
    horizon_limit: the lowest cosine at which anything was measured, -1 to 0; left_out: bp_material_info of brdfpack.h.
    """

    name: str
    profile: str
    codec_version: int
    shape: tuple[int, int, int]
    head_bytes: int
    record_bytes: int
    record_offset: int
    channels: tuple[Channel, ...]
    layers: tuple[Layer, ...]
    sections: tuple[Section, ...]
    left_out: int
    effort: int
    budget_bytes: int
    max_error: float
    source_bytes: int
    source_sha256: bytes
    source_nonfinite: int
    horizon_limit: float
    source_holes: int
    zeros: str


def elements(call, handle, index: int, kind: str, most: int, where: tuple[str, ...]) -> list:
    array, count = ffi.new(f"{kind}[]", most), ffi.new("uint32_t *")
    run(call, handle, index, ffi.sizeof(kind), array, most, count, where=where)
    return [array[n] for n in range(count[0])]


class Entry(NoPickle):
    """A material of an archive, not loaded: archive["nickel"]. info, record(), load(...), table(...)."""

    def __init__(self, archive: "Archive", name: str, index: int):
        self._archive = archive
        self._index = index
        self.name = name
        self._where = (archive.path, name)  # what errors name

    def __repr__(self) -> str:
        return f"<brdfpack material {self.name!r}, not loaded>"

    @property
    def info(self) -> Info:
        """What is known of it without loading it."""
        info = ffi.new("bp_material_info *", {"struct_bytes": ffi.sizeof("bp_material_info")})
        with self._archive._open() as handle:
            run(lib.bp_archive_info, handle, self._index, info, where=self._where)
            layers = elements(lib.bp_archive_layers, handle, self._index, "bp_layer", lib.BP_LAYERS_MAX, self._where)
            sections = elements(lib.bp_archive_sections, handle, self._index, "bp_section", lib.BP_SECTIONS_MAX, self._where)
        return Info(
            name=self.name, profile=PROFILES.get(info.profile, str(info.profile)), codec_version=info.codec_version,
            shape=(info.theta_h, info.theta_d, info.phi_d), head_bytes=info.head_bytes, record_bytes=info.record_bytes,
            record_offset=info.record_offset,
            channels=tuple(Channel(c.diffuse, c.specular, c.rejected, c.iterations, bool(c.converged)) for c in info.channels),
            layers=tuple(Layer(x.bytes, x.log_rmse, x.cube_root_rmse, x.largest_relative, x.seen_log_rmse) for x in layers),
            sections=tuple(Section(s.type, s.codec, s.version, s.layer, s.flags, s.bytes, s.error) for s in sections),
            left_out=info.left_out, effort=info.effort, budget_bytes=info.budget_bytes, max_error=info.max_error,
            source_bytes=info.source_bytes, source_sha256=bytes(ffi.buffer(info.source_sha256)),
            source_nonfinite=info.source_nonfinite, horizon_limit=info.horizon_limit,
            source_holes=info.source_holes, zeros=ZEROS[info.zeros])

    def record(self) -> bytes:
        """Its record, byte for byte: what Writer.add takes."""
        with self._archive._open() as handle:
            return taken(lib.bp_archive_record, handle, self._index, where=self._where)

    def load(self, max_error: float = 0.0, form: str = "expanded", colour: str = "rgb", sampling: bool = False) -> Material:
        """As Archive.load."""
        for value, known in ((form, FORMS), (colour, COLOURS)):
            if value not in tuple(known):
                raise ValueError(f"{value!r} is none of {', '.join(known)}")
        material = ffi.new("bp_material **")
        options = ffi.new("bp_load_options *", {"struct_bytes": ffi.sizeof("bp_load_options"), "max_log_rmse": max_error, "form": FORMS[form],
                                                "colour": COLOURS[colour], "sampling": int(bool(sampling))})
        record, shape = self.record(), self.info.shape
        with self._archive._open() as handle:
            run(lib.bp_material_load, handle, self._index, options, material, where=self._where)
        return Material(material[0], self.name, record, max_error, shape)

    def table(self, max_error: float = 0.0, dtype="float32", continued: bool = False):
        """The decoded table without loading the material: (H, D, P, 3), 1/sr; max_error as in Archive.load, the rest as in Material.table."""
        shape = self.info.shape
        with self._archive._open() as handle:
            return table_read(handle, self._index, shape, max_error, dtype, continued, self._where)


class Archive(Mapping, NoPickle):
    """An open archive: a mapping from names, in the order of their bytes, to what is known of each material. brdfpack.open makes it."""

    def __init__(self, handle, path: str):
        self._handle = handle
        self._uses = 0  # calls that are in the library; close waits for none, the last one of them closes
        self._closed = False
        self._lock = threading.Lock()
        self.path = path

    def __repr__(self) -> str:
        return f"<brdfpack.Archive {self.path!r}{', closed' if self._closed else f': {len(self)} materials'}>"

    @contextlib.contextmanager
    def _open(self):
        """The handle for the time of one call, during which another thread's close waits."""
        with self._lock:
            if self._closed:
                raise ValueError(f"the archive {self.path} is closed")
            self._uses += 1
        try:
            yield self._handle
        finally:
            with self._lock:
                self._uses -= 1
            self._drop()

    def _drop(self) -> None:
        with self._lock:
            handle = self._handle if self._closed and not self._uses else None
            if handle is not None:
                self._handle = None
        if handle is not None:
            lib.bp_archive_close(handle)

    def close(self) -> None:
        """Closes it; again does nothing. Materials that were loaded stay usable."""
        self._closed = True
        self._drop()

    def __enter__(self) -> "Archive":
        return self

    def __exit__(self, *_) -> None:
        self.close()

    def __del__(self) -> None:
        if hasattr(self, "_lock"):
            self.close()

    def __len__(self) -> int:
        with self._open() as handle:
            return lib.bp_archive_count(handle)

    def __iter__(self) -> Iterator[str]:
        name = ffi.new("char[256]")
        for index in range(len(self)):
            with self._open() as handle:
                run(lib.bp_archive_name, handle, index, name, where=(self.path,))
            yield ffi.string(name).decode()

    def _find(self, name: str) -> int:
        index = ffi.new("uint64_t *")
        with self._open() as handle:
            try:
                sought = name_bytes(name)
            except ValueError:
                raise NotFound(lib.BP_ERROR_NOT_FOUND, f"there is no material {name!r}") from None
            run(lib.bp_archive_find, handle, sought, index, where=(self.path,))
        return index[0]

    def __contains__(self, name: object) -> bool:
        try:
            self._find(name)  # type: ignore[arg-type]
        except (KeyError, TypeError):
            return False
        return True

    def __getitem__(self, name: str) -> Entry:
        return Entry(self, name, self._find(name))

    def __eq__(self, other: object) -> bool:
        return self is other

    __hash__ = object.__hash__

    def load(self, name: str, max_error: float = 0.0, form: str = "expanded", colour: str = "rgb", sampling: bool = False) -> Material:
        """Loads a material to evaluate.

        max_error: > 0: the fewest layers whose recorded log RMSE over the cells above the horizon (Layer.seen_log_rmse) is at most this,
        all where none is; 0: all. form: "expanded", "compact" (a third
        of the memory) or "preview" (every second value, quick). colour: "rgb" or "mean". sampling: also what sample, pdf and albedo need.
        """
        return self[name].load(max_error, form, colour, sampling)

    @property
    def bytes_read(self) -> int:
        """Bytes read from the file so far."""
        with self._open() as handle:
            return lib.bp_archive_bytes_read(handle)

    def verify(self, deep: bool = False) -> list[Problem]:
        """Reads all of it and checks every checksum; deep: decodes every layer too. Returns what is wrong: nothing, where all is well."""
        problems: list[Problem] = []

        @ffi.callback("bp_problem_fn")
        def note(_, problem):
            name = None if problem.material == ffi.NULL else ffi.string(problem.material).decode("utf-8", "replace")
            try:
                check(problem.error.status, problem.error)
            except (Error, MemoryError) as error:
                problems.append(Problem(name, error))  # type: ignore[arg-type]
            return 0

        error = ffi.new("bp_error *")
        with self._open() as handle:
            status = lib.bp_archive_verify(handle, lib.BP_VERIFY_DEEP if deep else 0, note, ffi.NULL, error)
        if status and not problems:
            check(status, error)
        return problems


def open(source) -> Archive:  # noqa: A001
    """Opens the archive at a path, or one that bytes hold, which are not copied.

    Raises what Python's open would for a file that cannot be opened, and Error for one that is no archive, or damaged.
    """
    handle = ffi.new("bp_archive **")
    if isinstance(source, bytes):
        held = ffi.from_buffer(source)
        run(lib.bp_archive_open_memory, held, len(source), handle, where=("in memory",))
        archive = Archive(handle[0], "in memory")
        archive._held = held  # type: ignore[attr-defined]  # for as long as the handle reads it
        return archive
    path = os.fspath(source)
    try:
        run(lib.bp_archive_open, path_bytes(path), handle)
    except Error as refused:
        name = path if isinstance(path, str) else os.fsdecode(path)
        if refused.status == lib.BP_ERROR_IO:
            with builtins.open(path, "rb"):  # says it as Python does: FileNotFoundError, PermissionError
                pass
        raise Error(refused.status, f"{name}: {refused}", refused.offset) from None
    return Archive(handle[0], path if isinstance(path, str) else os.fsdecode(path))
