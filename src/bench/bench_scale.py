#!/usr/bin/env python3
"""Does the cost of a material stay flat? Time and peak memory of every command over archives of 100 to 1,000,000 materials.

    BRDFPACK=path/to/brdfpack src/bench/bench_scale.py [--scale PROGRAM] [--most N] [--out PREFIX] [FOLDER]

The archives hold one small record under many names (brdfpack-bench-scale); build and update fit small tables, to 10,000. FOLDER is
where they are made (a temporary one otherwise): 0.6 GB for a million. Writes PREFIX.tsv and, with gnuplot, PREFIX.svg; prints a
table in Markdown: microseconds per material, and the peak memory of the largest process in MB.
"""
import argparse
import os
import shutil
import struct
import subprocess
import tempfile

import bench_head
from bench_head import TOOL

COUNTS = (100, 1000, 10000, 100000, 1000000)
BUILD_MOST = 10000
PARTS = 10
ROUNDS = 3  # of which the median counts; one where a run takes long
LONG = 20   # seconds


def run(command, before=lambda: None):
    """Wall seconds and peak memory in MB, of the median run."""
    results = []
    for _ in range(ROUNDS):
        before()
        results.append(bench_head.run(command)[::2])
        if results[-1][0] > LONG:
            break
    results.sort()
    return results[len(results) // 2]


def tables_write(folder, count):
    """Small MERL-like files: the k-th differs in one value."""
    os.makedirs(folder)
    for k in range(count):
        values = [60.0 + (i % 7) + (k if i == 0 else 0) / count for i in range(3 * 64)]
        with open("%s/m%07d.binary" % (folder, k), "wb") as file:
            file.write(struct.pack("<3i192d", 4, 4, 4, *values))


def archive_steps(scale, folder, count):
    """(name, command, how many materials it handles) for an archive of `count`."""
    whole, out = "%s/%d.bpk" % (folder, count), folder + "/out.bpk"
    subprocess.run([scale, whole, str(count)], check=True)
    parts = []
    for p in range(PARTS):
        parts.append("%s/%d-%d.bpk" % (folder, count, p))
        subprocess.run([scale, parts[-1], str(len(range(p, count, PARTS))), str(p), str(PARTS)], check=True)
    some = ["m%07d" % (n * count // 10) for n in range(10)]
    return [("list one name", [TOOL, "list", whole, some[5]], 1),
            ("list all", [TOOL, "list", whole], count),
            ("subset of 10", [TOOL, "subset", "-q", "-o", out, whole] + some, 10),
            ("merge of %d" % PARTS, [TOOL, "merge", "-q", "-o", out] + parts, count),
            ("verify", [TOOL, "verify", whole], count),
            ("recover", [TOOL, "recover", "-o", out, whole], count)]


def build_rows(folder, count):
    tables, out = "%s/in-%d" % (folder, count), "%s/built-%d.bpk" % (folder, count)
    tables_write(tables, count)
    build = [TOOL, "build", "-q", "--any-lattice", "--budget", "1000", "-o", out, tables]
    yield "build", run(build, lambda: os.path.exists(out) and os.remove(out)), count
    state = [0]

    def change_one():
        state[0] += 1
        with open(tables + "/m0000000.binary", "r+b") as file:
            file.seek(12)
            file.write(struct.pack("<d", 100.0 + state[0]))

    yield "update with one change", run(build[:2] + ["--update"] + build[2:], change_one), count
    shutil.rmtree(tables)


def plot(rows, out):
    if not shutil.which("gnuplot"):
        return
    names = list(dict.fromkeys(r[0] for r in rows))
    with tempfile.NamedTemporaryFile("w", suffix=".dat", delete=False) as data:
        for name in names:
            for n, count, seconds, memory, handled in rows:
                if n == name:
                    data.write("%d %.3f %.1f\n" % (count, 1e6 * seconds / handled, memory))
            data.write("\n\n")
    lines = ", ".join("'%s' index %d using 1:%%d with linespoints lw 2 title '%s'" % (data.name, n, name) for n, name in enumerate(names))
    script = ("set terminal svg size 1100,420 font 'sans,13' background 'white'; set output '%s'; set multiplot; set tmargin 1; "
              "set bmargin 4; set logscale xy; set format x '10^{%%T}'; set grid; set xlabel 'materials'; unset key; "
              "set lmargin at screen 0.09; set rmargin at screen 0.40; set ylabel 'microseconds for each material'; plot %s; "
              "set lmargin at screen 0.47; set rmargin at screen 0.78; set key outside right; set ylabel 'MB, largest process'; "
              "unset logscale y; set yrange [0:*]; plot %s" % (out, lines.replace("%d", "2"), lines.replace("%d", "3")))
    subprocess.run(["gnuplot", "-e", script], check=True)
    os.unlink(data.name)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--scale", default="build/bench/brdfpack-bench-scale")
    parser.add_argument("--most", type=int, default=COUNTS[-1])
    parser.add_argument("--out", default="build/bench/scale")
    parser.add_argument("folder", nargs="?")
    arguments = parser.parse_args()
    if arguments.folder:
        os.makedirs(arguments.folder, exist_ok=True)
    folder = tempfile.mkdtemp(dir=arguments.folder)
    rows = []
    try:
        for count in (c for c in COUNTS if c <= arguments.most):
            for name, command, handled in archive_steps(arguments.scale, folder, count):
                seconds, memory = run(command)
                rows.append((name, count, seconds, memory, handled))
            if count <= BUILD_MOST:
                rows += [(name, count, seconds, memory, handled) for name, (seconds, memory), handled in build_rows(folder, count)]
            for file in os.listdir(folder):
                if file.endswith(".bpk"):
                    os.unlink(os.path.join(folder, file))
    finally:
        shutil.rmtree(folder)
    os.makedirs(os.path.dirname(arguments.out) or ".", exist_ok=True)
    with open(arguments.out + ".tsv", "w") as file:
        file.write("command\tmaterials\tseconds\tmegabytes\tmicroseconds_each\n")
        for name, count, seconds, memory, handled in rows:
            file.write("%s\t%d\t%.4f\t%.1f\t%.2f\n" % (name, count, seconds, memory, 1e6 * seconds / handled))
    plot(rows, arguments.out + ".svg")
    print("machine %s; compiler %s; commit %s; medians of up to %d runs" % (
        bench_head.machine(), bench_head.text_of("cc", "--version"), bench_head.text_of("git", "describe", "--always", "--dirty"), ROUNDS))
    counts = [c for c in COUNTS if c <= arguments.most]
    print("\n| | " + " | ".join("{:,}".format(c) for c in counts) + " |\n|---|" + "--:|" * len(counts))
    table = {(name, count): (seconds, memory, handled) for name, count, seconds, memory, handled in rows}
    for name in dict.fromkeys(r[0] for r in rows):
        cells = []
        for count in counts:
            if (name, count) in table:
                seconds, memory, handled = table[name, count]
                cells.append("%.4g ms, %.0f MB" % (1e3 * seconds, memory) if handled < count else "%.2f us, %.0f MB" % (1e6 * seconds / handled, memory))
            else:
                cells.append("")
        print("| %s | %s |" % (name, " | ".join(cells)))


if __name__ == "__main__":
    main()
