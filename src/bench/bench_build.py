#!/usr/bin/env python3
"""Times build, extract, list and verify beside reading the same files with cat.

    BRDFPACK=path/to/brdfpack src/bench/bench_build.py [--runs N] [--label TEXT] [--names FILE] [--profile NAME] [--cold] FOLDER

FOLDER holds MERL files; without one that exists the demo materials are written there first. Every run does
all commands once, cat first, so that a disturbance of the machine meets all of them; the table has the medians,
the ratio to cat of the same run, and the largest process's peak memory (at least Python's own 15 MB, from
which each is started). The files are in the page cache; with --cold reading and building by two workers are timed
once more with the files dropped from it before, each against the other.
"""
import glob
import os
import shutil
import statistics
import subprocess
import tempfile

import bench_head
from bench_head import TOOL, run

GOAL, COLD_GOAL = 20, 5  # times reading the files once, by two workers: from the page cache, and from storage


def drop_from_cache(files):
    """A hint that Linux follows where nobody else has the file open; not on a file system in memory."""
    for path in files:
        fd = os.open(path, os.O_RDONLY)
        os.posix_fadvise(fd, 0, 0, os.POSIX_FADV_DONTNEED)
        os.close(fd)


def hundred_archive(scratch):
    """An archive of 100 small records: list's time depends on their number, not on their size."""
    folder = os.path.join(scratch, "hundred")
    subprocess.run([TOOL, "synth", "--lattice", "6x6x8", folder + "-in"], check=True)
    source = sorted(glob.glob(folder + "-in/*.binary"))[0]
    os.mkdir(folder)
    for i in range(100):
        os.link(source, "%s/material-%03d.binary" % (folder, i))
    subprocess.run([TOOL, "build", "-q", "--any-lattice", "-o", folder + ".bpk", folder], check=True)
    return folder + ".bpk"


def ratio_of(runs, others):
    """The median over runs of the ratio of wall-clock times."""
    return statistics.median(a[0] / b[0] for a, b in zip(runs, others))


def main():
    parser = bench_head.options_parser(5)
    parser.add_argument("--profile", default=None)
    parser.add_argument("--cold", action="store_true", help="also with the files dropped from the page cache")
    options = parser.parse_args()

    files = bench_head.materials(options.folder, options.names)
    count = len(files)
    scratch = tempfile.mkdtemp(dir=os.path.dirname(os.path.abspath(options.folder)))
    try:
        archive = os.path.join(scratch, "bench.bpk")
        out = os.path.join(scratch, "out")
        build = [TOOL, "build", "-q"] + (["--profile", options.profile] if options.profile else []) + bench_head.lattice_flags(options.any_lattice)
        commands = [
            ("cat", ["cat"] + files, count),
            ("build -j1", build + ["-j1", "-o", archive] + files, count),
            ("build -j2", build + ["-j2", "-o", archive] + files, count),
            ("extract", [TOOL, "extract", "--force", "-C", out, archive], count),
            ("list", [TOOL, "list", archive], count),
            ("list of 100", [TOOL, "list", hundred_archive(scratch)], 100),
            ("verify", [TOOL, "verify", archive], count),
            ("verify --deep", [TOOL, "verify", "--deep", archive], count),
        ]
        if options.cold:
            commands += [("cold cat", ["cat"] + files, count), ("cold build -j2", build + ["-j2", "-o", archive] + files, count)]
        results = {name: [] for name, _, _ in commands}
        for _ in range(options.runs):
            for name, command, _ in commands:
                if name.startswith("cold"):
                    drop_from_cache(files)
                results[name].append(run(command))

        bench_head.print_head("src/bench/bench_build.py", files, options.label, options.runs)
        print("%-14s %12s %14s %14s %12s %9s" % ("command", "seconds", "s/material", "cpu s/material", "times cat", "peak MB"))
        for name, _, number in commands:
            wall, cpu, peak = (statistics.median(column) for column in zip(*results[name]))
            ratio = ratio_of(results[name], results["cold cat" if name.startswith("cold") else "cat"])
            times = "" if name == "list of 100" else "%.2f" % ratio
            print("%-14s %12.4f %14.5f %14.5f %12s %9.1f" % (name, wall, wall / number, cpu / number, times, peak))
        scaling = ratio_of(results["build -j1"], results["build -j2"])
        print("# build -j2 of the %d files takes %.1f times as long as reading them once with cat; the goal is at most %d" %
              (count, ratio_of(results["build -j2"], results["cat"]), GOAL))
        if options.cold:
            print("# with the files not in the page cache %.1f times; the goal is at most %d" % (ratio_of(results["cold build -j2"], results["cold cat"]), COLD_GOAL))
        print("# -j2 is %.2f times as fast as -j1; %d bytes per material" % (scaling, os.path.getsize(archive) / count))
    finally:
        shutil.rmtree(scratch)


main()
