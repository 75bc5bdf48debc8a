#!/usr/bin/env python3
"""Damages one record of an archive, near its end: damage.py IN.bpk OUT.bpk NAME. IN and OUT may be the same."""
import sys

MAGICS = (b"\x8bREC", b"\x8bIDX")

source, target, name = sys.argv[1:]
with open(source, "rb") as file:
    data = bytearray(file.read())
head = data.index(name.encode())
end = min(at for at in (data.find(magic, head) for magic in MAGICS) if at > 0)
data[end - 3] ^= 1
with open(target, "wb") as file:
    file.write(data)
