#!/usr/bin/env python3
"""Tables of format-spec/RENDERERS.md and RESULTS.md, made anew: renderers_table.py [--tool TOOL] [--rgl FOLDER [TABLES]] [--merl FOLDER NAME...]

Prints Markdown. First, of the demo set, or with --merl of these materials of a folder of MERL files: each packed in 60,400 bytes, extracted as
`.bsdf`, and that in Mitsuba 3's own `measured` (tests/mitsuba_files.py, in the virtual environment of scripts/mitsuba_venv.sh with the package): a sphere
under the point lights, albedo at 0.1, 0.8 and 1.3 radians, Mitsuba's chi-square test at 0.02, 0.7 and 1.2; and packed again from the `.bsdf`,
against the MERL file. With --rgl instead: spheres of the records of published files, and, where there is a folder with MERL files of the
same names made from them by another program, of these files' records; and the former against Mitsuba (tests/mitsuba_measured.py), at 60,400 bytes and at 400,000.
"""
import argparse
import glob
import json
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def run(*command):
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command[:3])} ... ended with {done.returncode}\n{done.stdout[-2000:]}")
    return done.stdout


def compared(tool, archive, measured, lights):
    """{name: [PSNR in dB, for each of lights]}"""
    psnr = {}
    for light in lights:
        for line in run(tool, "compare", "--json", f"--light={light}", archive, measured).splitlines():
            row = json.loads(line)
            if "name" in row:
                psnr.setdefault(row["name"], []).append(row[f"psnr_{light}"])
    return psnr


def python_with_mitsuba(scratch):
    """The virtual environment's interpreter, with the package of this source in it."""
    run(os.path.join(ROOT, "scripts/mitsuba_venv.sh"))
    venv = os.path.join(ROOT, "build/mitsuba-venv/bin")
    run("cp", "-r", os.path.join(ROOT, "Makefile"), os.path.join(ROOT, "src"), scratch)
    pip = f"{venv}/python", "-m", "pip", "--disable-pip-version-check", "-q", "install"
    run(*pip, "cffi")
    run(*pip, "--force-reinstall", "--no-deps", f"{scratch}/src/python")
    newest = sorted(glob.glob("/usr/lib/*/libLLVM-1[5-9].so") + glob.glob("/usr/lib/*/libLLVM-[2-9]?.so"))
    if newest:
        os.environ["DRJIT_LIBLLVM_PATH"] = newest[-1]
    return f"{venv}/python"


def exported(tool, python, scratch, measured, names):
    archive, again, folder = (os.path.join(scratch, name) for name in ("a.bpk", "b.bpk", "files"))
    run(tool, "build", "-q", "-o", archive, *(os.path.join(measured, name + ".binary") for name in names))
    run(tool, "extract", "--format", "bsdf", "-C", folder, archive)
    run(tool, "build", "-q", "-o", again, folder)
    back = compared(tool, again, measured, ["key"])
    print("| material | bytes | dB | albedo off by, % | chi-square | and back, key, dB |\n|---|--:|--:|---|---|--:|")
    for name in names:
        told = run(python, os.path.join(ROOT, "tests/mitsuba_files.py"), "llvm_ad_rgb", tool, archive, folder, name)
        decibels = re.search(r"sphere .*: ([\d.]+) dB", told)[1]
        albedo = ", ".join(re.findall(r"off by ([\d.]+) %", told))
        tests = ", ".join(word if points == "32" else f"{word} ({points})" for word, points in re.findall(r": (passed|rejected) with (\d+)", told))
        tests = "passed" if tests == "passed, passed, passed" else tests
        size = os.path.getsize(os.path.join(folder, name + ".bsdf"))
        print(f"| {name} | {size:,} | {decibels} | {albedo} | {tests} | {back[name][0]:.1f} |", flush=True)
    print(f"\nAnd back: {sum(back[name][0] for name in names) / len(names):.1f} dB in the mean, {min(back[name][0] for name in names):.1f} at worst.")


def published(tool, python, scratch, folder, tables=None):
    columns = ["from .bsdf"] + ["from the table"] * bool(tables)
    psnr = []
    for n, measured in enumerate((folder, tables)[:len(columns)]):
        archive = os.path.join(scratch, f"rgl{n}.bpk")
        run(tool, "build", "-q", "-o", archive, *sorted(glob.glob(os.path.join(measured, "*_rgb." + ("binary" if n else "bsdf")))))
        psnr.append(compared(tool, archive, measured, ["key", "env"]))
    told = run(python, os.path.join(ROOT, "tests/mitsuba_measured.py"), tool, folder, scratch)
    columns += ["one direction", "mean of both", "directions apart", "400,000 bytes"]
    print("| genuine (RGL) |", " | ".join(columns), "|\n|" + "---|" * (1 + len(columns)))
    for name in sorted(psnr[0]):
        numbers = [float(x) for x in re.findall(r"([\d.]+)%", re.search(rf"^{name} .*$", told, re.M)[0])]
        apart = [f"{median:.2f} % / {far:.1f} %" for median, far in zip(numbers[::2], numbers[1::2])]
        print(f"| {name.removesuffix('_rgb')} |", " | ".join([f"{p[name][0]:.2f} / {p[name][1]:.2f}" for p in psnr] + apart), "|")
    means = [" / ".join(f"{sum(both[n] for both in p.values()) / len(p):.2f}" for n in range(2)) for p in psnr]
    print("| **mean** |", " | ".join(means), "|" + " |" * 4)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tool", default=os.path.join(ROOT, "build/brdfpack"))
    parser.add_argument("--rgl", nargs="+", metavar=("FOLDER", "TABLES"))
    parser.add_argument("--merl", nargs="+", metavar=("FOLDER", "NAME"))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        python = python_with_mitsuba(scratch)
        if options.rgl:
            published(options.tool, python, scratch, *options.rgl[:2])
        elif options.merl:
            exported(options.tool, python, scratch, options.merl[0], options.merl[1:])
        else:
            folder = os.path.join(scratch, "demo")
            run(options.tool, "synth", folder)
            names = sorted(name[:-len(".binary")] for name in os.listdir(folder) if name.endswith(".binary"))
            exported(options.tool, python, scratch, folder, names)


if __name__ == "__main__":
    main()
