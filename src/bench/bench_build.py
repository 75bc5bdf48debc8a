#!/usr/bin/env python3
"""Times build, extract, list and verify beside reading the same files with cat.

    BRDFPACK=path/to/brdfpack src/bench/bench_build.py [--runs N] [--label TEXT] FOLDER

FOLDER holds MERL files; without one that exists the demo materials are written there first. Every run does
all commands once, cat first, so that a disturbance of the machine meets all of them; the table has the medians,
the ratio to cat of the same run, and the largest process's peak memory (at least Python's own 15 MB, from
which each is started).
"""
import argparse
import glob
import os
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

TOOL = os.environ.get("BRDFPACK", "build/brdfpack")


def run(command):
    """Wall seconds, processor seconds of all its processes, peak memory in MB of the largest."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit("%s: exit code %d" % (" ".join(command[:3]), process.returncode))
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def text_of(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True).stdout.split("\n")[0]
    except OSError:
        return "unknown"


def machine():
    for line in open("/proc/cpuinfo"):
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor()


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


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--label", default="demo set")
    parser.add_argument("--profile", default=None)
    parser.add_argument("folder")
    options = parser.parse_args()

    if not os.path.isdir(options.folder):
        subprocess.run([TOOL, "synth", options.folder], check=True)
    files = sorted(glob.glob(os.path.join(options.folder, "*.binary")))
    if not files:
        sys.exit("%s: no *.binary files" % options.folder)
    count = len(files)
    scratch = tempfile.mkdtemp(dir=os.path.dirname(os.path.abspath(options.folder)))
    try:
        archive = os.path.join(scratch, "bench.bpk")
        out = os.path.join(scratch, "out")
        build = [TOOL, "build", "-q"] + (["--profile", options.profile] if options.profile else [])
        commands = [
            ("cat", ["cat"] + files, count),
            ("build -j1", build + ["-j1", "-o", archive] + files, count),
            ("build -j2", build + ["-j2", "-o", archive] + files, count),
            ("extract", [TOOL, "extract", "-C", out, archive], count),
            ("list", [TOOL, "list", archive], count),
            ("list of 100", [TOOL, "list", hundred_archive(scratch)], 100),
            ("verify", [TOOL, "verify", archive], count),
            ("verify --deep", [TOOL, "verify", "--deep", archive], count),
        ]
        results = {name: [] for name, _, _ in commands}
        for _ in range(options.runs):
            for name, command, _ in commands:
                results[name].append(run(command))

        print("# machine    %s, %d usable cores, load %.1f" % (machine(), len(os.sched_getaffinity(0)), os.getloadavg()[0]))
        print("# compiler   %s" % text_of("cc", "--version"))
        print("# commit     %s" % text_of("git", "describe", "--always", "--dirty"))
        print("# command    src/bench/bench_build.py %s" % " ".join(sys.argv[1:]))
        print("# data       %d files of %s, %.0f MB; medians of %d runs" %
              (count, options.label, sum(map(os.path.getsize, files)) / 1e6, options.runs))
        print("%-14s %12s %14s %14s %12s %9s" % ("command", "seconds", "s/material", "cpu s/material", "times cat", "peak MB"))
        for name, _, number in commands:
            wall, cpu, peak = (statistics.median(column) for column in zip(*results[name]))
            ratio = statistics.median(r[0] / c[0] for r, c in zip(results[name], results["cat"]))
            times = "" if name == "list of 100" else "%.2f" % ratio
            print("%-14s %12.4f %14.5f %14.5f %12s %9.1f" % (name, wall, wall / number, cpu / number, times, peak))
        scaling = statistics.median(a[0] / b[0] for a, b in zip(results["build -j1"], results["build -j2"]))
        print("# -j2 is %.2f times as fast as -j1; %d bytes per material" % (scaling, os.path.getsize(archive) / count))
    finally:
        shutil.rmtree(scratch)


main()
