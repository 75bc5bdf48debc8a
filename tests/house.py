#!/usr/bin/env python3
"""The plan of the house, checked against src: which wing may include which, by which headers, and that the map is true.

    tests/house.py [FOLDER]        FOLDER holds src (default: the project's own)

Prints a line for each break and ends with 1 where there is one. Standard library only.
"""
import glob
import os
import re
import sys

# From the bottom up. A file may include headers of its own wing and of wings with a lower number.
RANK = {
    "": 0, "rgl": 0.5, "merl": 1, "model/math": 2, "model/robust": 3, "model/paper": 4, "model/spectral": 4, "model": 5, "model/table": 6, "model/sample": 7,
    "codec": 8, "codec/paper": 9, "codec/spectral": 9, "archive": 10, "render": 10, "tool": 12, "tool/build": 13, "tool/compare": 13, "tool/report_page": 13, "tool/export": 13,
    "tool/commands": 14, "bench": 15, "python": 15, "viewer": 16,
}
# The header by which neighbours enter a wing. What is not here is a set of tools, each header for itself.
DOOR = {
    "model/robust": "robust.h", "model/paper": "paper.h", "model/spectral": "spectral.h", "model/table": "table.h", "model/sample": "sample.h",
    "tool/build": "build.h", "tool/compare": "compare.h", "tool/report_page": "page.h", "tool/export": "export.h",
}
LOW = {"model/fit.h": 1.5}  # told to every wing of the model, so below them all; above what was measured
# Lists of what many files define under one kind of name.
LISTS = {"brdfpack.h", "tool/command.h", "bench/baseline.h"}
LINES_MOST = 450
COLUMNS_MOST = 130
WIDE = {"merl/normal_form.inc.h"}  # a table of strings


def without_comments(text):
    return re.sub(r'"(\\.|[^"\\\n])*"', '""', re.sub(r"/\*.*?\*/", "", text, flags=re.S))


def sources(src):
    for folder, inside, names in os.walk(src):
        if folder == os.path.join(src, "python"):
            inside[:] = [name for name in inside if name == "brdfpack"]  # without what a build leaves
        for name in sorted(names):
            if name.endswith((".c", ".h")):
                path = os.path.join(folder, name)
                with open(path, encoding="utf-8") as file:
                    yield os.path.relpath(path, src), file.read()


def resolve(path, target, files):
    """The file that a quoted include means: beside the file, else from src."""
    beside = os.path.normpath(os.path.join(os.path.dirname(path), target))
    return beside if beside in files else target if target in files else None


def rank(path):
    return LOW.get(path, RANK.get(os.path.dirname(path), 99))


def arrows_check(files):
    for path, text in files.items():
        for target in re.findall(r'^\s*#\s*include\s+"([^"]+)"', text, re.M):
            to = resolve(path, target, files)
            if to is None:
                continue  # made by the build
            here, there = os.path.dirname(path), os.path.dirname(to)
            if here == there:
                continue
            if rank(to) >= rank(path) and there != here:
                yield f"{path} includes {to}: against the arrows"
            # The two parts of a wing are one: codec/spectral is the coder of model/spectral, and may look into both.
            elif there in DOOR and os.path.basename(to) != DOOR[there]:
                yield f"{path} includes {to}: neighbours enter {there} by {DOOR[there]}"
            elif {here.split("/")[-1], there.split("/")[-1]} == {"paper", "spectral"}:
                yield f"{path} includes {to}: the profiles do not know each other"


def circles_check(files):
    seen, stack = {}, []

    def visit(path):
        seen[path] = 1
        stack.append(path)
        for target in re.findall(r'^\s*#\s*include\s+"([^"]+)"', files[path], re.M):
            to = resolve(path, target, files)
            if to is None:
                continue
            if seen.get(to) == 1:
                yield "a circle: " + " -> ".join(stack[stack.index(to):] + [to])
            elif to not in seen:
                yield from visit(to)
        stack.pop()
        seen[path] = 2

    for path in files:
        if path not in seen:
            yield from visit(path)


def declarations_check(files):
    function = re.compile(r"^(?!static|extern|typedef|#|\s|return|else|\})[A-Za-z_][\w \*]*?\b(\w+)\(([^;{}]*?)\)\s*([;{])", re.M)
    defined, declared = {}, {}
    for path, text in files.items():
        for name, _, end in function.findall(without_comments(text)):
            if end == "{" and path.endswith(".c"):
                defined[name] = path
            elif end == ";" and path.endswith(".h"):
                declared.setdefault(path, set()).add(name)
    for header, names in declared.items():
        stem = header[:-2]
        for name in sorted(names):
            file = defined.get(name, header)[:-2]
            if header not in LISTS and file != stem and not file.startswith(stem + "_"):
                yield f"{header} declares {name}, which {file}.c defines"


def circles_of_calls_check(files):
    """Two files of a wing that call each other's functions."""
    function = re.compile(r"^(?!static|extern|typedef|#|\s|return|else|\})[A-Za-z_][\w \*]*?\b(\w+)\(([^;{}]*?)\)\s*\{", re.M)
    texts = {path: without_comments(text) for path, text in files.items() if path.endswith(".c")}
    defined = {name: path for path, text in texts.items() for name, _ in function.findall(text)}
    calls = {path: {defined[word] for word in set(re.findall(r"\b(\w+)\(", text)) if word in defined} - {path} for path, text in texts.items()}
    for path, others in calls.items():
        for other in others:
            if path < other and path in calls[other]:
                yield f"{path} and {other} call each other"


def map_check(src, files):
    path = os.path.join(src, "README.md")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    for word in sorted(set(re.findall(r"`([\w./*-]+)`", text))):
        if "/" not in word and not re.search(r"\.(c|h|py|sh|md|tsv|1|3)$", word):
            continue
        if "NAME" in word or word.startswith("."):
            continue  # a pattern for what may come
        root = os.path.dirname(src)
        if glob.glob(os.path.join(root, word)) or glob.glob(os.path.join(src, word)) or glob.glob(os.path.join(src, "**", word), recursive=True):
            continue
        yield f"src/README.md names {word}, which is not there"
    for row in re.findall(r"^\|(.*)\|$", text, re.M):
        cells = row.split("|")
        if len(cells) != 4:
            continue  # not a step of the data's way: step, from -> to, functions, files
        bodies = "".join(files[path] for path in re.findall(r"`([\w./]+)`", cells[3]) if path in files)
        for function in re.findall(r"`(\w+)`", cells[2]):
            if not re.search(rf"^\w.*\b{function}\([^;]*?\)\s*\{{", bodies, re.M):
                yield f"src/README.md: {function} is defined in none of the files of its row"


def manual_check(src, files):
    """The manual's table of what each command replaces has a row for each."""
    with open(os.path.join(src, "tool/brdfpack.1"), encoding="utf-8") as file:
        table = file.read().split(".TS\n")[1].split(".TE\n")[0]
    for path in files:
        command = re.fullmatch(r"tool/commands/cmd_(\w+)\.c", path)
        if command and not re.search(rf"^{command[1]}\t", table, re.M):
            yield f"{path}: the manual's table of files that are written has no row for it"


def lengths_check(files):
    for path, text in files.items():
        lines = text.count("\n")
        if lines > LINES_MOST and path != "brdfpack.h":  # one page of documentation, whatever its length
            yield f"{path} has {lines} lines: more than one reason to change?"
        for number, line in enumerate(text.split("\n"), 1):  # clang-format leaves comments as they are
            if len(line.expandtabs(4)) > COLUMNS_MOST and path not in WIDE:
                yield f"{path}:{number}: wider than {COLUMNS_MOST} columns"


def main():
    src = os.path.join(sys.argv[1] if len(sys.argv) > 1 else os.path.join(os.path.dirname(__file__), ".."), "src")
    src = os.path.abspath(src)
    files = dict(sources(src))
    breaks = [f"src/{path}: a folder that the plan does not have" for path in files if os.path.dirname(path) not in RANK]
    for check in (arrows_check, circles_check, declarations_check, circles_of_calls_check, lengths_check):
        breaks += check(files)
    breaks += map_check(src, files)
    breaks += manual_check(src, files)
    for line in breaks:
        print(line)
    print(f"{len(files)} files, {len(breaks)} breaks of the plan")
    return 1 if breaks or len(files) < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
