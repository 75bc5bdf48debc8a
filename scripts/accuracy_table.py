#!/usr/bin/env python3
"""Packs a folder of measured materials under several budgets and prints tables of `brdfpack compare`, in Markdown.

    scripts/accuracy_table.py [--brdfpack PROGRAM] [--peers TSV] [--names FILE] [--genuine FOLDER] CLEAN [NOISY]

CLEAN holds MERL files without noise. NOISY, where given, holds the same materials with noise: they are packed, and
what is decoded is compared with CLEAN, the truth. --names FILE: these materials (one per line) get a row each beside
the figures of tthresh from --peers (src/bench/peers-nine.tsv), the others one row in all. --genuine FOLDER: a further table, of
MERL files made of genuine measurements of the RGL database, beside tthresh's figures where --genuine-peers has them. Standard library only.
"""
import argparse
import csv
import json
import os
import statistics
import subprocess
import tempfile


def compare(arguments, scratch, source, truth, names, *options):
    """One row per name: packs `source` and compares with `truth`."""
    archive = os.path.join(scratch, "archive.bpk")
    files = [os.path.join(source, name + ".binary") for name in names]
    subprocess.run([arguments.brdfpack, "build", "-q", "-o", archive, *options, *files], check=True)
    text = subprocess.run([arguments.brdfpack, "compare", "--json", archive, truth, *names], check=True,
                          capture_output=True, text=True).stdout
    rows = [json.loads(line) for line in text.splitlines()]
    return {row["name"]: row for row in rows if "name" in row}


def psnr(row, light):
    return row["psnr_" + light]


def mean(rows, figure):
    return statistics.mean(figure(row) for row in rows.values())


def peers_read(path):
    with open(path, encoding="utf-8") as file:
        return {(row["name"], row["input"]): row for row in csv.DictReader(file, delimiter="\t") if row["codec"] == "tthresh"}


def genuine_table(arguments, scratch):
    """The block "genuine (RGL)": what was measured, not made."""
    folder = arguments.genuine
    names = sorted(name[:-7] for name in os.listdir(folder) if name.endswith(".binary"))
    with open(arguments.genuine_peers, encoding="utf-8") as file:
        peers = {row["name"]: row for row in csv.DictReader(file, delimiter="\t")}
    full = compare(arguments, scratch, folder, folder, names)
    small = compare(arguments, scratch, folder, folder, names, "--budget", "16000")
    paper = compare(arguments, scratch, folder, folder, names, "--profile", "paper")
    print("\n| genuine (RGL) | tthresh: key / env / log RMSE | spectral: key / env / log RMSE (seen) | 16,000 bytes: key | paper: key |")
    print("|---|---|---|--:|--:|")
    rows = []
    for name in names:
        peer = peers.get(name)
        row = full[name]
        rows.append([psnr(row, "key"), psnr(row, "env"), row["log_rmse"], row["seen_log_rmse"], psnr(small[name], "key"), psnr(paper[name], "key")])
        print("| %s | %s | %.2f / %.2f / %.5f (%.5f) | %.2f | %.2f |" % (
            name, "%s / %s / %s" % (peer["psnr_key"], peer["psnr_env"], peer["logrmse"]) if peer else "", *rows[-1]))
    print("| **mean** | | %.2f / %.2f / %.5f (%.5f) | %.2f | %.2f |" % tuple(statistics.mean(column) for column in zip(*rows)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--brdfpack", default="build/brdfpack")
    parser.add_argument("--peers", default="src/bench/peers-nine.tsv")
    parser.add_argument("--names", default="manifests/paper-nine.txt")
    parser.add_argument("--genuine")
    parser.add_argument("--genuine-peers", default="src/bench/peers-genuine.tsv")
    parser.add_argument("clean")
    parser.add_argument("noisy", nargs="?")
    arguments = parser.parse_args()
    with open(arguments.names, encoding="utf-8") as file:
        nine = [line.strip() for line in file if line.strip() and not line.startswith("#")]
    others = sorted(name[:-7] for name in os.listdir(arguments.clean) if name.endswith(".binary") and name[:-7] not in nine)
    peers = peers_read(arguments.peers)

    with tempfile.TemporaryDirectory() as scratch:
        def run(source, names, *options):
            return compare(arguments, scratch, source, arguments.clean, names, *options)

        full, small = run(arguments.clean, nine), run(arguments.clean, nine, "--budget", "40000")
        paper = run(arguments.clean, nine, "--profile", "paper")
        noisy = run(arguments.noisy, nine) if arguments.noisy else {}
        print("| material | tthresh: key / env / log RMSE | spectral: key / env / log RMSE (seen) | 40,000 bytes: key / env |"
              " paper: key | noisy: tthresh / spectral |")
        print("|---|---|---|---|--:|---|")

        def line(name, peer, row, less, old, noise):
            print("| %s | %.2f / %.2f / %.5f | %.2f / %.2f / %.5f (%.5f) | %.2f / %.2f | %.2f | %s |" % (
                name, *peer, *row, *less, old, "%.2f / %.2f" % noise if noise else ""))

        table = []
        for name in nine:
            clean_peer, noisy_peer = peers[name, "clean"], peers[name, "noisy"]
            table.append((tuple(float(clean_peer[key]) for key in ("psnr_key", "psnr_env", "logrmse")),
                          (psnr(full[name], "key"), psnr(full[name], "env"), full[name]["log_rmse"], full[name]["seen_log_rmse"]),
                          (psnr(small[name], "key"), psnr(small[name], "env")), psnr(paper[name], "key"),
                          (float(noisy_peer["psnr_key_vs_truth"]), psnr(noisy[name], "key")) if noisy else None))
            line(name, *table[-1])

        def average(column):
            values = [row[column] for row in table]
            if values[0] is None or isinstance(values[0], float):
                return None if values[0] is None else statistics.mean(values)
            return tuple(statistics.mean(value) for value in zip(*values))

        line("**mean**", *(average(column) for column in range(5)))

        print("\n| materials | budget | PSNR key: mean, worst | PSNR env: mean, worst | seen log RMSE: mean, worst |"
              " dE ITP key: mean, worst |")
        print("|---|--:|---|---|---|---|")

        def summary(what, budget, rows):
            print("| %s | %s | %.2f, %.2f | %.2f, %.2f | %.5f, %.5f | %.4f, %.4f |" % (
                what, budget, mean(rows, lambda row: psnr(row, "key")), min(psnr(row, "key") for row in rows.values()),
                mean(rows, lambda row: psnr(row, "env")), min(psnr(row, "env") for row in rows.values()),
                mean(rows, lambda row: row["seen_log_rmse"]), max(row["seen_log_rmse"] for row in rows.values()),
                mean(rows, lambda row: row["delta_itp_key"]), max(row["delta_itp_key"] for row in rows.values())))

        for budget in (4096, 16384):
            summary("these", "{:,}".format(budget), run(arguments.clean, nine, "--budget", str(budget)))
        summary("these", "40,000", small)
        summary("these", "60,400", full)
        if others:
            summary("%d others" % len(others), "60,400", run(arguments.clean, others))
        if noisy:
            summary("these, noisy, against the truth", "60,400", noisy)
            if others:
                summary("%d others, noisy, against the truth" % len(others), "60,400", run(arguments.noisy, others))
        if arguments.genuine:
            genuine_table(arguments, scratch)


if __name__ == "__main__":
    main()
