#!/usr/bin/env bash
# Coverage-guided fuzzing: tests/fuzz.sh BUILD SECONDS CORPUS TARGET... BUILD holds the fuzz_TARGETs (libFuzzer).
# Seeds are made here: the test vectors, their records, small MERL files, some with such a record in them, tars and zips of them, tensor
# files, the manifests, command lines, scenes. What a run finds that reaches new code is added to CORPUS/TARGET, from where the next run goes on.
set -euo pipefail
build=$1 seconds=$2 grown=$3
shift 3
here=$(cd "$(dirname "$0")" && pwd)
corpus=$build/seeds
rm -rf "$corpus" && mkdir -p "$corpus"/{archive,record,merl,manifest,options,scene,container,tensor}
cp "$here"/../format-spec/vectors/*.bpk "$corpus/archive"
python3 - "$corpus" <<'END'
import bz2, glob, gzip, io, lzma, math, os, struct, sys, tarfile, zipfile
corpus = sys.argv[1]
magic = b"\x8bREC\r\n\x1a\n"
for path in glob.glob(corpus + "/archive/*.bpk"):
    data = open(path, "rb").read()
    at, n = data.find(magic), 0
    while at >= 0 and at + 16 <= len(data):
        length = struct.unpack_from("<I", data, at + 12)[0]
        open("%s/record/%s-%d" % (corpus, os.path.basename(path), n), "wb").write(data[at:at + min(length, 1 << 16)])
        record = data[at:at + length]
        cells = math.prod(struct.unpack_from("<3H", record, 24)) if len(record) > 30 else 0
        carried = b"\x8bCAR\r\n\x1a\n" + struct.pack("<I", length) + record
        if n == 0 and 6 * 2 * cells > len(carried) and 24 * cells < 16000: # a file that carries this record, cells of 1 around it
            words = [carried[i:i + 6].ljust(6, b"\0") + b"\xf0\xbf" for i in range(0, len(carried), 6)]
            words += [struct.pack("<d", 1)] * (3 * cells - len(words))
            body = struct.pack("<3i", *struct.unpack_from("<3H", record, 24)) + b"".join(words)
            open("%s/merl/carried-%s" % (corpus, os.path.basename(path)), "wb").write(body)
        at, n = data.find(magic, at + 1), n + 1
for h, d, p in (4, 4, 4), (5, 4, 6):
    cells = h * d * p
    values = [((i * 7919) % 1000) / 500 - 0.1 for i in range(3 * cells)]
    values[5], values[11], values[17] = float("nan"), float("inf"), -1.0
    body = struct.pack("<3i%dd" % (3 * cells), h, d, p, *values)
    open("%s/merl/%d%d%d" % (corpus, h, d, p), "wb").write(body)
    open("%s/merl/%d%d%d-short" % (corpus, h, d, p), "wb").write(body[:-3])
lines = ["-o\nout.bpk\n-j\n4\nin", "--budget\n60k\n--quiet", "--budget=1.5MiB\nx", "--max-error\n1e-3\n--\n-q",
         "-j0\n-j\n-5\n--jobs=9999999999999999999",
         "--max-error=nan\n--help", "-qqj2\n--bud\n1000\n--output="]
for n, line in enumerate(lines):
    open("%s/options/%d" % (corpus, n), "w").write(line)
scenes = ['Material "measured" "string filename" "brdfs/red-fabric.binary"\nMakeNamedMaterial "chrome"\n',
          '<bsdf type="measured" id="a&amp;b"><string name="filename" value=\'teflon.binary\'/></bsdf>\n<!-- don\'t &#x41;&#66; -->',
          '{"materials": ["./nickel.binary", "caf\\u00e9", "\\ud83d\\ude00", "a\\"b", "c\\\\"], "n": null}',
          'def Shader "s" {\n\tasset inputs:file = @brass.binary@\n\tstring x = "pearl%20paint"\n}\n']
for n, text in enumerate(scenes):
    open("%s/scene/%d" % (corpus, n), "w").write(text)

def tar_of(members):
    out = io.BytesIO()
    with tarfile.open(fileobj=out, mode="w") as tar:
        for name, content, kind in members:
            entry = tarfile.TarInfo(name)
            entry.type, entry.size, entry.linkname = kind, len(content), "a.binary" if kind in (tarfile.LNKTYPE, tarfile.SYMTYPE) else ""
            tar.addfile(entry, io.BytesIO(content))
    whole = out.getvalue() # its end is padded to 10,240 bytes: two empty blocks of 512 are enough
    used = (len(whole.rstrip(b"\0")) + 511) // 512 * 512
    return whole[:used] + bytes(1024)

def zip_of(members, method):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", method) as packed:
        for name, content, _ in members:
            packed.writestr(name, content)
    return out.getvalue()

table = struct.pack("<3i", 4, 4, 4) + b"".join(struct.pack("<d", i % 7) for i in range(192))
members = [("m/a.binary", table, tarfile.REGTYPE), ("m/b.binary", table[:-1], tarfile.REGTYPE), ("README", b"text", tarfile.REGTYPE)]
odd = [("c.binary", b"", tarfile.LNKTYPE), ("d.binary", b"", tarfile.SYMTYPE), ("m", b"", tarfile.DIRTYPE), ("caf\u00e9.binary", table, tarfile.REGTYPE)]
tar = tar_of(members + odd)
packed = {"tar": tar, "joined.tar": tar_of(members[:1]) + tar_of(odd[3:]), "tar.gz": gzip.compress(tar, mtime=0), "tar.bz2": bz2.compress(tar),
          "tar.xz": lzma.compress(tar), "binary.gz": gzip.compress(table, mtime=0), "stored.zip": zip_of(members, zipfile.ZIP_STORED),
          "deflated.zip": zip_of(members, zipfile.ZIP_DEFLATED), "html.zip": b"<!DOCTYPE html><html><body>not found</body></html>",
          "plain.binary": table}
for name, content in packed.items():
    open("%s/container/%s" % (corpus, name), "wb").write(content)
END
"$here/tensor_files.py" "$corpus/tensor"
for file in "$here"/../manifests/*; do head -c 4000 "$file" >"$corpus/manifest/$(basename "$file")"; done
failed=0
for target in "$@"; do
	mkdir -p "$build/found" "$grown/$target"
	# the first folder is the one that grows
	if ! "$build/tests/fuzz_$target" -max_total_time="$seconds" -seed=1 -max_len=16384 -timeout=20 -rss_limit_mb=3000 -print_final_stats=1 \
		-close_fd_mask=3 -artifact_prefix="$build/found/$target-" "$grown/$target" "$corpus/$target" >"$build/fuzz-$target.log" 2>&1; then
		failed=1
		echo "fuzz_$target failed:"
		tail -n 40 "$build/fuzz-$target.log"
	fi
	grep -a 'number_of_executed_units\|^Done' "$build/fuzz-$target.log" | sed "s/^/$target: /" || true
	echo "$target: $(find "$grown/$target" -type f | wc -l) files in $grown/$target"
done
exit $failed
