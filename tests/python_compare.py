#!/usr/bin/env python3
"""Compares what read_bpk.py decodes with what brdfpack extracted: python_compare.py READER ARCHIVE FOLDER.

Where the extracted file holds a value (it is negative below the horizon), both must agree to 1e-5 relative,
or to 1e-9 of the material's largest value: the C library decodes in float. The negative values carry the material's
record (FORMAT.md, 11) where it fits, and are -1 elsewhere.
"""
import json
import os
import struct
import subprocess
import sys

SCALE = (1 / 1500, 1.15 / 1500, 1.66 / 1500)
reader, archive, folder = sys.argv[1:]
listed = subprocess.run([sys.executable, reader, "list", archive], check=True, capture_output=True, text=True).stdout
record_bytes = {line.split("  ")[0]: int(line.split("  ")[1].split()[0]) for line in listed.splitlines()}
whole_archive = open(archive, "rb").read()


def check_carried(name, values):
    negative = [struct.pack("<d", v) for v in values if v < 0]
    if any(v[6:] != b"\xf0\xbf" for v in negative):
        sys.exit("%s: a negative value is not from -1.0625 to -1" % name)
    string = b"".join(v[:6] for v in negative)
    size = record_bytes[name]
    if len(string) < 12 + size:
        if any(string):
            sys.exit("%s: a record has no room here, but something is carried" % name)
        return 0
    if string[:12] != b"\x8bCAR\r\n\x1a\n" + struct.pack("<I", size) or any(string[12 + size :]):
        sys.exit("%s: the record is not carried" % name)
    if string[12 : 12 + size] not in whole_archive:
        sys.exit("%s: what is carried is not the archive's record" % name)
    return 1


carried = 0
worst = 0.0
compared = 0
for file in sorted(os.listdir(folder)):
    name = file[: -len(".binary")]
    data = open(os.path.join(folder, file), "rb").read()
    dims = struct.unpack("<3i", data[:12])
    values = struct.unpack("<%dd" % ((len(data) - 12) // 8), data[12:])
    cells = dims[0] * dims[1] * dims[2]
    carried += check_carried(name, values)
    decoded = json.loads(subprocess.run([sys.executable, reader, "decode", archive, name], check=True, capture_output=True).stdout)
    if tuple(decoded["dims"]) != dims:
        sys.exit("%s: dims %s, extracted %s" % (name, decoded["dims"], dims))
    for c in range(3):
        ours = [v * SCALE[c] for v in values[c * cells : (c + 1) * cells]]
        theirs = decoded["rgb"][c]
        floor = 1e-9 * max(max(ours), 1e-300)
        for a, b in zip(ours, theirs):
            if a < 0:
                continue
            compared += 1
            error = 0.0 if abs(a - b) <= floor else abs(a - b) / max(abs(a), abs(b))
            worst = max(worst, error)
            if error > 1e-5:
                sys.exit("%s: channel %d: the library has %r, the Python reader %r" % (name, c, a, b))
print("%s: %d values compared, largest relative difference %.2g; %d records carried" % (archive, compared, worst, carried))
if compared == 0 or carried == 0:
    sys.exit("nothing was compared")
