"""Builds the package over the project's C sources, which lie beside this folder: pip install ./src/python in a checkout."""
import glob
import os
import re

from setuptools import setup
from setuptools.command.build_ext import build_ext

HERE = os.path.dirname(os.path.abspath(__file__))
SRC = os.path.dirname(HERE)
WINGS = ("", "merl", "model", "model/*", "codec", "codec/*", "archive")
FLAGS = ["-std=c17", "-O3", "-D_GNU_SOURCE", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math", "-fvisibility=hidden",
         "-ffunction-sections", "-fdata-sections"]


def tool_only():
    """What the Makefile leaves to the tool: sources that want libraries of their own."""
    with open(os.path.join(os.path.dirname(SRC), "Makefile"), encoding="utf-8") as makefile:
        text = re.search(r"^TOOL_ONLY *:= *((?:.*\\\n)*.*)", makefile.read(), re.M).group(1)
    return {os.path.basename(name) for name in re.findall(r"[\w/]+\.c", text)}


def library_sources():
    left = tool_only()
    found = (path for wing in WINGS for path in glob.glob(os.path.join(SRC, wing, "*.c")))
    return sorted(path for path in found if os.path.basename(path) not in left)


def version():
    with open(os.path.join(SRC, "brdfpack.h"), encoding="utf-8") as header:
        return re.search(r'^#define BP_VERSION "([^"]+)"', header.read(), re.M).group(1)


class build_library_too(build_ext):
    """The C library's objects first: some files have flags of their own, which an extension's list of sources cannot say."""

    def build_extension(self, ext):
        objects = []
        for path in library_sources() + [os.path.join(HERE, "strided.c")]:
            flags = FLAGS + (["-mavx2"] if path.endswith("_avx2.c") else [])
            objects += self.compiler.compile([path], output_dir=self.build_temp, include_dirs=[SRC], extra_postargs=flags)
        ext.extra_objects = objects
        ext.depends = objects  # or a second build in the same folder would keep the first one's extension
        super().build_extension(ext)


setup(version=version(), cffi_modules=["build_native.py:ffi"], cmdclass={"build_ext": build_library_too})
