#!/usr/bin/env python3
"""Where the time of a build goes, stage by stage, beside reading the same files: a Markdown table.

    BRDFPACK=path/to/brdfpack src/bench/bench_stages.py [--runs N] [--label TEXT] [--names FILE] FOLDER

FOLDER holds MERL files; without one that exists the demo materials are written there first. Every run reads all files
once (plain read, 128 KiB at a time), then packs them with each profile by one worker, and takes `cpu_seconds` from what
`build --json` says. Times are processor milliseconds per material: the median of the runs, then the mean over the
materials, so that the stages add up.
"""
import json
import os
import statistics
import subprocess
import tempfile
import time

import bench_head

PROFILES = ("spectral", "paper")


def seconds_to_read(path):
    block = bytearray(128 * 1024)
    start = time.process_time()
    with open(path, "rb", buffering=0) as file:
        while file.readinto(block):
            pass
    return time.process_time() - start


def stages_of_build(profile, files, output, any_lattice):
    """{stage: [seconds of each material]}, in the tool's order."""
    build = [bench_head.TOOL, "build", "-q", "--json", "-j1", "--profile", profile, "-o", output]
    lines = subprocess.run(build + bench_head.lattice_flags(any_lattice) + files, check=True, capture_output=True,
                           text=True).stdout.splitlines()
    materials = [m for m in map(json.loads, lines) if "cpu_seconds" in m]
    return {stage: [m["cpu_seconds"][stage] for m in materials] for stage in materials[0]["cpu_seconds"]}


def per_material(runs):
    """Milliseconds: the median of the runs for each material, then the mean over these."""
    return 1e3 * statistics.mean(statistics.median(times) for times in zip(*runs))


def main():
    options = bench_head.options_parser(3).parse_args()
    files = bench_head.materials(options.folder, options.names)
    reading, runs = [], {profile: [] for profile in PROFILES}
    with tempfile.TemporaryDirectory() as scratch:
        for _ in range(options.runs):
            reading.append([seconds_to_read(path) for path in files])
            for profile in PROFILES:
                runs[profile].append(stages_of_build(profile, files, os.path.join(scratch, "stages.bpk"),
                                                     options.any_lattice))

    read = per_material(reading)
    table = {p: {stage: per_material([run[stage] for run in runs[p]]) for stage in runs[p][0]} for p in PROFILES}
    stages = [s for s in table[PROFILES[0]] if s != "rest"] + ["rest"]
    bench_head.print_head("src/bench/bench_stages.py", files, options.label, options.runs, "    ")
    print("    reading    %.1f processor ms per file (`x reading` counts in these)\n" % read)
    print("| stage |" + "".join(" %s: ms | x reading | share |" % p for p in PROFILES))
    print("|---|" + "--:|--:|--:|" * len(PROFILES))
    for stage in stages + ["**sum**"]:
        cells = ""
        for p in PROFILES:
            whole = sum(table[p].values())
            ms = whole if stage == "**sum**" else table[p][stage]
            cells += " %.1f | %.1f | %.0f %% |" % (ms, ms / read, 100 * ms / whole)
        print("| %s |%s" % (stage, cells))


main()
