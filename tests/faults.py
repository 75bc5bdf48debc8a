#!/usr/bin/env python3
"""Faults that a build survives: faults.py BRDFPACK SHIM [--long] [--kills FOLDER]. SHIM is fault_shim.c as a library.

--kills: only kills, 200 of them, of builds of the MERL files of FOLDER.

Builds of small materials are killed, interrupted, starved of disk and memory, and have their calls fail. After
each, the output must be the old archive or the new one, whole; the exit code 0 only with the new one; and after
the next build nothing else may lie in the folder. Prints one line per kind of fault.
"""
import importlib.util
import math
import os
import random
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
TOOL, SHIM = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
LONG = "--long" in sys.argv
KILLS = os.path.abspath(sys.argv[sys.argv.index("--kills") + 1]) if "--kills" in sys.argv else None
random.seed(1)
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it, and so would every build
failures = []

spec = importlib.util.spec_from_file_location("fixtures", HERE + "/cli/fixtures.py")
fixtures = importlib.util.module_from_spec(spec)
spec.loader.exec_module(fixtures)


def fault(text):
    failures.append(text)
    print("FAULT: " + text, flush=True)


def read(path):
    with open(path, "rb") as file:
        return file.read()


class Place:
    """A folder with inputs, small ones unless there are others, and an output folder that holds an older archive."""

    def __init__(self, folder, inputs=None):
        self.out = folder + "/out"
        self.inputs = inputs or folder + "/in"
        self.target = self.out + "/out.bpk"
        os.mkdir(self.out)
        if not inputs:
            os.mkdir(self.inputs)
            for n in range(4):
                fixtures.write("%s/material-%d.binary" % (self.inputs, n), fixtures.table(n + 1))
        self.run([self.inputs + "/" + min(os.listdir(self.inputs))])
        self.old = read(self.target)
        self.run([self.inputs])
        self.new = read(self.target)
        self.reset()

    def command(self, inputs=None):
        return [TOOL, "build", "--any-lattice", "--strict", "-q", "-j2", "-o", self.target] + (inputs or [self.inputs])

    def run(self, inputs=None):
        subprocess.run(self.command(inputs), check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=60)

    def reset(self):
        with open(self.target, "wb") as file:
            file.write(self.old)

    def check(self, what, code):
        """After a build with a fault that ended with this code (negative: by a signal)."""
        now = read(self.target) if os.path.exists(self.target) else None
        if now not in (self.old, self.new):
            fault(what + ": the output is neither the old archive nor the new one")
        if code == 0 and now != self.new:
            fault(what + ": exit code 0 without the new archive")
        try:
            self.run()
        except subprocess.SubprocessError as problem:
            fault("%s: the next build fails: %s" % (what, problem))
        if os.listdir(self.out) != ["out.bpk"] or read(self.target) != self.new:
            fault("%s: after the next build there are %s" % (what, os.listdir(self.out)))
            shutil.rmtree(self.out)
            os.mkdir(self.out)
        self.reset()


def children(pid):
    try:
        return [int(word) for word in read("/proc/%d/task/%d/children" % (pid, pid)).split()]
    except OSError:
        return []


def alive(pid):
    try:
        return read("/proc/%d/stat" % pid).split(b")")[-1].split()[0] != b"Z"
    except OSError:
        return False


def kills(place, count):
    duration = 60.0
    for _ in range(5):
        start = time.time()
        subprocess.run(place.command(), check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        duration = min(duration, time.time() - start)
        place.reset()
    codes = {}
    for turn in range(count):
        kind = ("SIGKILL to the parent", "SIGKILL to a worker", "SIGTERM", "SIGINT to all")[turn % 4]
        build = subprocess.Popen(place.command(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        time.sleep(random.random() * duration)
        workers = children(build.pid)
        if kind == "SIGKILL to the parent":
            build.kill()
        elif kind == "SIGTERM":
            build.terminate()
        elif kind == "SIGINT to all":
            try:
                os.killpg(build.pid, signal.SIGINT)
            except ProcessLookupError:
                pass
        elif workers:
            try:
                os.kill(random.choice(workers), signal.SIGKILL)
            except ProcessLookupError:
                pass
        try:
            code = build.wait(timeout=30)
        except subprocess.TimeoutExpired:
            fault(kind + ": the build hangs")
            build.kill()
            code = build.wait()
        deadline = time.time() + 30
        while any(alive(pid) for pid in workers) and time.time() < deadline:
            time.sleep(0.01)
        if any(alive(pid) for pid in workers):
            fault(kind + ": a worker stays")
        codes.setdefault(kind, {}).setdefault(code, 0)
        codes[kind][code] += 1
        place.check("%s, turn %d, exit %d" % (kind, turn, code), code)
    for kind in codes:
        print("%s: %d turns, exit codes %s" % (kind, sum(codes[kind].values()), codes[kind]), flush=True)


def full_disk(place):
    def limit(size):
        def apply():
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        return apply
    sizes = range(0, len(place.new) + 700, 101 if LONG else 701)
    for size in sizes:
        code = subprocess.run(place.command(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=limit(size), timeout=60).returncode
        if code == 0 and size < len(place.new):
            fault("a disk with %d bytes left: exit code 0" % size)
        place.check("a disk with %d bytes left" % size, code)
    print("full disk: %d sizes up to %d bytes" % (len(sizes), max(sizes)), flush=True)


def full_tmpfs(place):
    """A real file system without room: pages for the old archive and so many more, or no inode for another file."""
    def mount(options):
        return subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", place.out], stderr=subprocess.DEVNULL).returncode == 0
    if os.geteuid() != 0 or not mount("size=1m"):
        print("full tmpfs: not run, mounting is not allowed", flush=True)
        return
    subprocess.run(["umount", place.out], check=True)
    page, failed = 4096, 0
    pages = [-(-len(data) // page) for data in (place.old, place.new)]
    cases = ["size=%d" % (page * (pages[0] + n)) for n in range(pages[1] + 3)] + ["size=1m,nr_inodes=2"]
    for options in cases:
        if not mount(options):
            fault("cannot mount with " + options)
            continue
        try:
            place.reset()
            code = subprocess.run(place.command(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=60).returncode
            failed += code != 0
            subprocess.run(["mount", "-o", "remount,size=1m,nr_inodes=100", place.out], check=True)
            place.check("a tmpfs with " + options, code)
        finally:
            subprocess.run(["umount", place.out], check=True)
    if not 0 < failed < len(cases):
        fault("full tmpfs: %d of %d builds failed" % (failed, len(cases)))
    print("full tmpfs: %d sizes and no inode left, %d builds failed as they should" % (len(cases) - 1, failed), flush=True)


def shimmed(command, kind, at, always=False):
    environment = dict(os.environ, LD_PRELOAD=SHIM, FAULT_CALL=kind, FAULT_AT=str(at))
    if always:
        environment["FAULT_ALWAYS"] = "1"
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment, timeout=60)


def failing_calls(place):
    """The n-th call of each kind fails, for n = 1, 2, ... until a build no longer meets the fault several times in a row."""
    for kind in "write", "read", "sync", "rename", "open", "alloc":
        at, passed, failed, step = 1, 0, 0, 1
        enough = 60 if kind == "alloc" and LONG else 12  # some allocations are not needed for success, several in a row
        while passed < enough and at < 100000:
            for always in (False,) if kind == "alloc" else (False, True):
                what = "%s call %d fails%s" % (kind, at, " and all after it" if always else "")
                try:
                    code = shimmed(place.command(), kind, at, always).returncode
                except subprocess.TimeoutExpired:
                    fault(what + ": the build hangs")
                    continue
                if code < 0:
                    fault("%s: the build dies of signal %d" % (what, -code))
                failed += code != 0
                passed = passed + 1 if code == 0 else 0
                place.check(what, code)
            if kind == "alloc" and not LONG and at > 40:
                step = 1 + at // 10
            at += step
        print("failing %s: calls 1 to %d, %d builds failed as they should" % (kind, at - step, failed), flush=True)


def failing_reads(place, folder):
    """Commands that read: with a failing call they fail, or print what they print otherwise."""
    commands = {"list": ["list", "--json", place.target], "verify": ["verify", "--deep", place.target],
                "extract": ["extract", "-C", folder + "/x", place.target], "recover": ["recover", "-o", folder + "/r.bpk", place.target]}
    for name, words in commands.items():
        wanted = subprocess.run([TOOL] + words, stdout=subprocess.PIPE, check=True).stdout
        for kind in "read", "alloc":
            at, passed, failed = 1, 0, 0
            while passed < 12 and at < 100000:
                result = shimmed([TOOL] + words, kind, at)
                if result.returncode < 0:
                    fault("%s: %s call %d fails: signal %d" % (name, kind, at, -result.returncode))
                if result.returncode == 0 and result.stdout != wanted:
                    fault("%s: %s call %d fails: exit code 0 and another output" % (name, kind, at))
                failed += result.returncode != 0
                passed = passed + 1 if result.returncode == 0 else 0
                at += 1 if LONG or at < 40 else 1 + at // 10
            print("%s, failing %s: up to call %d, %d failed" % (name, kind, at, failed), flush=True)


def two_builds(place, turns):
    first, second = [place.inputs + "/material-0.binary", place.inputs + "/material-1.binary"], [place.inputs]
    place.run(first)
    contents = {read(place.target)}
    place.run(second)
    contents.add(read(place.target))
    reads = 0
    for turn in range(turns):
        builds = [subprocess.Popen(place.command(inputs), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for inputs in (first, second)]
        while any(build.poll() is None for build in builds):
            if read(place.target) not in contents:
                fault("a reader during two builds saw a mix")
            if subprocess.run([TOOL, "verify", place.target], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode != 0:
                fault("verify failed during two builds")
            reads += 1
        if any(build.returncode != 0 for build in builds) or os.listdir(place.out) != ["out.bpk"]:
            fault("two builds: exit codes %s, files %s" % ([build.returncode for build in builds], os.listdir(place.out)))
    print("two builds at once: %d turns, %d reads meanwhile" % (turns, reads), flush=True)
    place.reset()


def recovery(folder):
    """Materials without damage that recover saves: 50 materials, random holes of 4 KiB."""
    dims, base = (16, 16, 24), None
    os.mkdir(folder + "/fifty")
    for n in range(50):
        if n % 10 == 0:
            base = fixtures.table(1 + n // 10, dims)
        planes = [[v if v < 0 else v * (0.7 + 0.6 * random.random()) for v in plane] for plane in base]
        fixtures.write("%s/fifty/m%02d.binary" % (folder, n), planes, dims)
    whole = folder + "/fifty.bpk"
    subprocess.run([TOOL, "build", "--any-lattice", "-q", "--profile", "default", "-o", whole, folder + "/fifty"], check=True, stdout=subprocess.DEVNULL)
    data = read(whole)
    records, at = [], 64
    while data[at:at + 8] == b"\x8bREC\r\n\x1a\n":
        length = struct.unpack_from("<I", data, at + 12)[0]
        records.append(data[at:at + length])
        at += length
    for holes in 1, 10, 100:
        intact, saved = 0, 0
        for turn in range(20 if LONG else 5):
            damaged = bytearray(data)
            for _ in range(holes):
                hole = random.randrange(len(data) - 4096)
                damaged[hole:hole + 4096] = random.randbytes(4096) if turn % 2 else bytes(4096)
            with open(folder + "/holes.bpk", "wb") as file:
                file.write(damaged)
            if subprocess.run([TOOL, "verify", folder + "/holes.bpk"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode != 1:
                fault("verify did not notice %d holes" % holes)
            left, at = [], 64
            for record in records:
                if damaged[at:at + len(record)] == record:
                    left.append(record)
                at += len(record)
            if os.path.exists(folder + "/saved.bpk"):
                os.remove(folder + "/saved.bpk")
            subprocess.run([TOOL, "recover", "-o", folder + "/saved.bpk", folder + "/holes.bpk"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            out = read(folder + "/saved.bpk") if os.path.exists(folder + "/saved.bpk") else b""
            intact += len(left)
            saved += sum(record in out for record in left)
        if saved != intact:
            fault("recover saved %d of %d undamaged materials" % (saved, intact))
        print("recover: %d holes of 4 KiB in %d bytes of 50 materials: %d of %d undamaged materials saved" % (holes, len(data), saved, intact), flush=True)


with tempfile.TemporaryDirectory(prefix="brdfpack-faults-") as scratch:
    here = Place(scratch, KILLS)
    kills(here, 200 if LONG or KILLS else 40)
    if not KILLS:
        full_disk(here)
        full_tmpfs(here)
        two_builds(here, 20 if LONG else 4)
        failing_calls(here)
        failing_reads(here, scratch)
        recovery(scratch)
print("%d faults" % len(failures))
sys.exit(1 if failures else 0)
