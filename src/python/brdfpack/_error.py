"""Errors of the C library as exceptions."""
from __future__ import annotations

from ._native import ffi, lib


class Error(Exception):
    """What the library refused: str() is its message, with the archive and the material where there are such. status: a number that never changes its meaning, offset: byte in the file, or None."""

    def __init__(self, status: int, message: str, offset: int | None = None):
        super().__init__(message)
        self.status = status
        self.offset = offset

    def __reduce__(self):
        return Error, (self.status, self.args[0], self.offset)


class NotFound(Error, KeyError):
    """There is no material of that name: a KeyError too, as mappings have it."""

    __str__ = Exception.__str__

    def __reduce__(self):
        return NotFound, (self.status, self.args[0], self.offset)


def check(status: int, error, *where: str) -> None:
    """Raises what `error`, a bp_error that the call filled, says; of damage also `where` it is: the archive, the material, the offset."""
    if status == lib.BP_OK:
        return
    message = ffi.string(error.message).decode("utf-8", "replace")
    if status == lib.BP_ERROR_MEMORY:
        raise MemoryError(message)
    offset = None if error.offset == 2**64 - 1 else error.offset
    if status in (lib.BP_ERROR_CORRUPT, lib.BP_ERROR_CHECKSUM) and offset is not None:
        message = ": ".join((*where, f"corrupt at offset {offset}", message))
    elif status in (lib.BP_ERROR_CORRUPT, lib.BP_ERROR_CHECKSUM, lib.BP_ERROR_UNSUPPORTED, lib.BP_ERROR_NOT_OURS):
        kind = ffi.string(lib.bp_status_text(status)).decode()
        message = ": ".join((*where, message) if message.startswith(kind) else (*where, kind, message))
    raise (NotFound if status == lib.BP_ERROR_NOT_FOUND else Error)(status, message, offset)


def run(call, *arguments, where: tuple[str, ...] = ()) -> None:
    """Calls a function of the library, whose last parameter is a bp_error, and raises what that says."""
    error = ffi.new("bp_error *")
    check(call(*arguments, error), error, *where)


def taken(call, *arguments, where: tuple[str, ...] = ()) -> bytes:
    """The bytes that such a function allocates, for which it has two parameters before the last."""
    out, count = ffi.new("uint8_t **"), ffi.new("size_t *")
    run(call, *arguments, out, count, where=where)
    try:
        return ffi.buffer(out[0], count[0])[:]
    finally:
        lib.bp_free(out[0])


class NoPickle:
    """A base for what holds memory of the library."""

    def __reduce__(self):
        raise TypeError(f"a brdfpack.{type(self).__name__} cannot be pickled: open the archive anew in the other process")
