"""Names and paths on their way to C, whose strings end at the first NUL."""
from __future__ import annotations

import os


def name_bytes(name: str) -> bytes:
    """A name for C: refused where C would see another one."""
    if not isinstance(name, str):
        raise TypeError(f"materials are called by str, not {type(name).__name__}")
    text = name.encode("utf-8", "replace")  # a lone surrogate becomes "?"
    if b"\0" in text or text.decode() != name:
        raise ValueError(f"{name!r} is not a legal name: it has a NUL or a lone surrogate")
    return text


def path_bytes(path) -> bytes:
    """A path, str, bytes or os.PathLike, as the system has it."""
    text = os.fsencode(path)
    if b"\0" in text:
        raise ValueError("embedded null byte in a path")
    return text
