#!/usr/bin/env python3
"""Faults that a build survives: faults.py BRDFPACK SHIM [--long] [--kills FOLDER]. SHIM is fault_shim.c as a library.

--kills: only the kills, of builds of the MERL files of FOLDER.

Builds of small materials are killed, interrupted, starved of disk and memory, and have their calls fail. After
each, the output must be the old archive or the new one, whole; the exit code 0 with the new one alone, another with the old; and after
the next build, which goes on from the journal or begins anew, nothing else may lie in the folder; before it, only after a failure, a journal. The commands that
read archives have their calls fail too, with the same demands on the files they write. Prints one line per kind of fault.
"""
import importlib.util
import json
import os
import random
import re
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
JOURNAL = re.compile(r"\.brdfpack-[0-9a-f]{8}-journal")

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
        self.turns = self.journals = 0
        os.mkdir(self.out)
        if not inputs:
            os.mkdir(self.inputs)
            for n in range(4):
                fixtures.write("%s/material-%d.binary" % (self.inputs, n), fixtures.table(n + 1))
            self.add_extracted(folder)
        self.run([self.inputs + "/" + min(os.listdir(self.inputs))])
        self.old = read(self.target)
        self.run([self.inputs])
        self.new = read(self.target)
        self.reset()

    def add_extracted(self, folder):
        """An input that carries its record. Fitted anew it would give another archive, so that would not go unnoticed."""
        measured, extracted = folder + "/other.binary", self.inputs + "/other.binary"
        fixtures.write(measured, fixtures.table(5, (16, 16, 24)), (16, 16, 24))
        self.run([measured], ["--budget", "12000"])  # which the cells below the horizon have room for
        subprocess.run([TOOL, "extract", "--force", "-C", folder, "--plain", self.target], check=True)
        subprocess.run([TOOL, "extract", "-C", self.inputs, self.target], check=True)
        report = subprocess.run(self.command([extracted]) + ["--json"], check=True, stdout=subprocess.PIPE).stdout
        kept = read(self.target)
        self.run([measured])  # by now the plain one
        if json.loads(report.splitlines()[-1])["kept"] != 1 or read(self.target) == kept:
            fault("the extracted input does not carry its record, or it makes no difference")

    def command(self, inputs=None):
        return [TOOL, "build", "--any-lattice", "--strict", "-q", "-j2", "-o", self.target] + (inputs or [self.inputs])

    def run(self, inputs=None, options=()):
        subprocess.run(self.command(inputs) + list(options), check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=60)

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
        if code > 0 and now != self.old:
            fault("%s: exit code %d, but it was written" % (what, code))
        left = [name for name in os.listdir(self.out) if code == 0 or not JOURNAL.fullmatch(name)]
        if code >= 0 and left != ["out.bpk"]:
            fault("%s: it leaves %s" % (what, left))
        self.journals += len(os.listdir(self.out)) > len(left)
        self.turns += 1
        try:
            self.run(options=["--update"] if self.turns % 2 else [])
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


def signal_send(kind, build):
    """Whether it met the build running, and for a worker one that was at work. The workers there were."""
    workers = children(build.pid)
    if build.poll() is not None:
        return False, workers
    try:
        if kind == "SIGKILL to the parent":
            build.kill()
        elif kind == "SIGTERM":
            build.terminate()
        elif kind == "SIGINT to all":
            os.killpg(build.pid, signal.SIGINT)
        else:
            worker = random.choice([pid for pid in workers if alive(pid)])
            os.kill(worker, signal.SIGKILL)
    except (ProcessLookupError, IndexError):
        return False, workers
    return True, workers


def kill_once(place, kind, delay):
    """One build that is sent a signal. Whether that met it, and its exit code."""
    build = subprocess.Popen(place.command(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    time.sleep(delay)
    met, workers = signal_send(kind, build)
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
    place.check("%s, exit %d" % (kind, code), code)
    return met and (code == -signal.SIGKILL or kind != "SIGKILL to the parent"), code


def kills(place, unit):
    """So many of SIGTERM and SIGINT and twice as many of each SIGKILL that met a running build; others are repeated."""
    duration = 60.0
    for _ in range(5):
        start = time.time()
        place.run()
        duration = min(duration, time.time() - start)
        place.reset()
    for kind, wanted in ("SIGKILL to the parent", 2 * unit), ("SIGKILL to a worker", 2 * unit), ("SIGTERM", unit), ("SIGINT to all", unit):
        turns, codes = 0, {}
        while sum(codes.values()) < wanted and turns < 10 * wanted:
            met, code = kill_once(place, kind, random.random() * duration)
            turns += 1
            if met:
                codes[code] = codes.get(code, 0) + 1
        if sum(codes.values()) < wanted:
            fault("%s: only %d of %d met the build" % (kind, sum(codes.values()), turns))
        print("%s: %d of %d met the build, exit codes of these %s" % (kind, sum(codes.values()), turns, codes), flush=True)


def full_disk(place):
    def limit(size):
        def apply():
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        return apply
    sizes = range(0, len(place.new) + 700, 101 if LONG else 701)
    for size in sizes:
        code = subprocess.run(place.command(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=limit(size),
                              timeout=60).returncode
        if code == 0 and size < len(place.new):
            fault("a disk with %d bytes left: exit code 0" % size)
        place.check("a disk with %d bytes left" % size, code)
    if not place.journals:
        fault("no build left a journal, whatever ended it")
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
    # records that are ready before their turn wait in a second file
    cases = ["size=%d" % (page * (pages[0] + n)) for n in range(2 * pages[1] + 3)] + ["size=1m,nr_inodes=2"]
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


def shimmed(command, kind, at, always, what):
    """Exit code and output of a command whose calls of this kind fail; None, None when it hangs."""
    environment = dict(os.environ, LD_PRELOAD=SHIM, FAULT_CALL=kind, FAULT_AT=str(at))
    if always:
        environment["FAULT_ALWAYS"] = "1"
    try:
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment, timeout=60)
    except subprocess.TimeoutExpired:
        fault(what + ": it hangs")
        return None, None
    if result.returncode < 0:
        fault("%s: it dies of signal %d" % (what, -result.returncode))
    return result.returncode, result.stdout


def failing_calls(name, command, check, enough=12):
    """The n-th call of each kind fails, for n = 1, 2, ... until the command no longer meets the fault so many times in a row."""
    for kind in "write", "read", "sync", "rename", "open", "alloc":
        at, last, passed, failed = 1, 1, 0, 0
        while passed < (enough if kind == "alloc" else 6) and at < 100000:
            for always in (False,) if kind == "alloc" else (False, True):
                what = "%s: %s call %d fails%s" % (name, kind, at, " and all after it" if always else "")
                code, output = shimmed(command, kind, at, always, what)
                if code is None:
                    continue
                failed += code != 0
                passed = passed + 1 if code == 0 else 0
                check(what, kind, code, output)
            last = at
            at += 1 if LONG or kind != "alloc" or at <= 20 else 1 + at // 5
        print("%s, failing %s: calls 1 to %d, %d failed as they should" % (name, kind, last, failed), flush=True)


class Command:
    """A command that reads archives and may write files into a folder, over older ones."""

    def __init__(self, name, words, out):
        self.command, self.out, self.name = [TOOL] + words, out, name
        self.printed = subprocess.run(self.command, stdout=subprocess.PIPE, check=True).stdout
        self.new = self.files()

    def files(self):
        return {name: read(self.out + "/" + name) for name in os.listdir(self.out)}

    def reset(self, old):
        """The folder as it was: the same files, with this in them."""
        for name in os.listdir(self.out):
            if name not in self.new:
                os.remove(self.out + "/" + name)
        for name in self.new:
            with open(self.out + "/" + name, "wb") as file:
                file.write(old)

    def fail_calls(self, old):
        def check(what, kind, code, output):
            now = self.files()
            if code == 0 and (output != self.printed or now != self.new):
                fault(what + ": exit code 0 and another output")
            if set(now) != set(self.new):
                fault("%s: there are %s" % (what, sorted(now)))
            for name in set(now) & set(self.new):
                if now[name] not in (old, self.new[name]) and not (code != 0 and self.saves_less(kind, name)):
                    fault("%s: %s is neither the old file nor the new one" % (what, name))
                if code > 0 and len(self.new) == 1 and now[name] == self.new[name] != old and self.name != "recover":
                    fault("%s: exit code %d, but %s was written" % (what, code, name))
            self.reset(old)
        self.reset(old)
        failing_calls(self.name, self.command, check)

    def saves_less(self, kind, name):
        """recover takes what it cannot read for damage and saves the rest."""
        return self.name == "recover" and kind == "read" and subprocess.run(
            [TOOL, "verify", "--deep", self.out + "/" + name], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0


def failing_commands(place, folder):
    """Commands that read archives: with a failing call they fail, or print and write what they print and write otherwise."""
    out, whole, first, rest = (folder + "/" + name for name in ("written", "whole.bpk", "first.bpk", "rest.bpk"))
    for path, data in (whole, place.new), (first, place.old):
        with open(path, "wb") as file:
            file.write(data)
    subprocess.run([TOOL, "subset", "-q", "-o", rest, whole, "material-1", "other"], check=True)
    archive = out + "/out.bpk"
    commands = {"list": ["list", "--json", whole], "verify": ["verify", "--deep", whole], "extract": ["extract", "--force", "-C", out, whole],
                "extract, json": ["extract", "--force", "--format", "json", "-C", out, whole],
                "subset": ["subset", "-o", archive, whole, "material-2", "other"], "merge": ["merge", "-o", archive, first, rest],
                "recover": ["recover", "-o", archive, whole], "render": ["render", "--force", "--size", "12", "-o", out + "/o.png", whole, "other"],
                "show": ["show", "--force", "-o", out + "/o.svg", whole, "material-0"]}
    for name, words in commands.items():
        shutil.rmtree(out, ignore_errors=True)
        os.mkdir(out)
        Command(name, words, out).fail_calls(place.old)


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
        codes = [build.returncode for build in builds]
        if any(codes) or os.listdir(place.out) != ["out.bpk"]:
            fault("two builds: exit codes %s, files %s" % (codes, os.listdir(place.out)))
    print("two builds at once: %d turns, %d reads meanwhile" % (turns, reads), flush=True)
    place.reset()


def recovery(folder):
    """Materials without damage that recover saves: 50 materials, random holes of 4 KiB."""
    dims, base = (16, 16, 24), None
    random.seed(2)  # how many numbers the kills took is chance
    os.mkdir(folder + "/fifty")
    for n in range(50):
        if n % 10 == 0:
            base = fixtures.table(1 + n // 10, dims)
        planes = [[v if v < 0 else v * (0.7 + 0.6 * random.random()) for v in plane] for plane in base]
        fixtures.write("%s/fifty/m%02d.binary" % (folder, n), planes, dims)
    whole = folder + "/fifty.bpk"
    subprocess.run([TOOL, "build", "--any-lattice", "-q", "-o", whole, folder + "/fifty"], check=True, stdout=subprocess.DEVNULL)
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
            subprocess.run([TOOL, "recover", "-o", folder + "/saved.bpk", folder + "/holes.bpk"], stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
            out = read(folder + "/saved.bpk") if os.path.exists(folder + "/saved.bpk") else b""
            intact += len(left)
            saved += sum(record in out for record in left)
        if saved != intact:
            fault("recover saved %d of %d undamaged materials" % (saved, intact))
        print("recover: %d holes of 4 KiB in %d bytes of 50 materials: %d of %d undamaged materials saved" %
              (holes, len(data), saved, intact), flush=True)


with tempfile.TemporaryDirectory(prefix="brdfpack-faults-") as scratch:
    here = Place(scratch, KILLS)
    kills(here, 50 if LONG or KILLS else 7)
    if not KILLS:
        full_disk(here)
        full_tmpfs(here)
        two_builds(here, 20 if LONG else 4)
        # some allocations are not needed for success, several in a row
        failing_calls("build", here.command(), lambda what, kind, code, output: here.check(what, code), 60 if LONG else 12)
        failing_commands(here, scratch)
        recovery(scratch)
print("%d faults" % len(failures))
sys.exit(1 if failures else 0)
