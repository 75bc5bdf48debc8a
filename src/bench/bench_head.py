"""What every benchmark prints on top: machine, compiler, commit, command and data."""
import argparse
import glob
import os
import platform
import subprocess
import sys
import time

TOOL = os.environ.get("BRDFPACK", "build/brdfpack")


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


def materials(folder, names=None):
    """The MERL files of a folder, all or those whose stems stand in a file; the demo set is written where there is no such folder."""
    if not os.path.isdir(folder):
        subprocess.run([TOOL, "synth", folder], check=True)
    files = sorted(glob.glob(os.path.join(folder, "*.binary")))
    if names:
        wanted = {line.split("\t")[0].strip() for line in open(names)}
        files = [f for f in files if os.path.basename(f)[:-len(".binary")] in wanted]
    if not files:
        sys.exit("%s: no *.binary files%s" % (folder, " of those names" if names else ""))
    return files


def run(command):
    """Wall seconds, processor seconds of all its processes, peak memory in MB of the largest (no less than this program's own, whose copy
    it begins as)."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit("%s: exit code %d" % (" ".join(command[:4]), process.returncode))
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def options_parser(runs):
    """What all scripts over a folder of materials are told; `runs` unless told otherwise."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=runs)
    parser.add_argument("--label", default="demo set")
    parser.add_argument("--names", help="only the materials that this file lists")
    parser.add_argument("--any-lattice", action="store_true", help="tables of other extents than MERL's (for tests)")
    parser.add_argument("folder")
    return parser


def lattice_flags(any_lattice):
    return ["--any-lattice"] if any_lattice else []


def print_head(script, files, label, runs, prefix="# "):
    for key, value in (
            ("machine", "%s, %d usable cores, load %.1f" % (machine(), len(os.sched_getaffinity(0)), os.getloadavg()[0])),
            ("compiler", text_of("cc", "--version")),
            ("commit", text_of("git", "describe", "--always", "--dirty")),
            ("command", "%s %s" % (script, " ".join(sys.argv[1:]))),
            ("data", "%d files of %s, %.0f MB; medians of %d runs" % (len(files), label, sum(map(os.path.getsize, files)) / 1e6, runs))):
        print("%s%-10s %s" % (prefix, key, value))
