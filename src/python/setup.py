"""Builds the package over the project's C sources: beside this folder in a checkout, within it in a source distribution."""
import glob
import os
import re
import shutil

from setuptools import setup
from setuptools.command.build_ext import build_ext
from setuptools.command.sdist import sdist

HERE = os.path.dirname(os.path.abspath(__file__))
CARRIED = os.path.join(HERE, "tree")  # what sdist takes along: the Makefile and the library's sources, as in a checkout
SRC = os.path.join(CARRIED, "src") if os.path.isdir(CARRIED) else os.path.dirname(HERE)
WINGS = ("", "rgl", "merl", "model", "model/*", "codec", "codec/*", "archive")
# of files that end so, as the Makefile has them
WIDE = {"_avx2.c": ["-mavx2"],
        "_avx512.c": ["-mavx512f", "-mavx512bw", "-mavx512dq", "-mavx512vl", "-mprefer-vector-width=512"]}
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
            flags = FLAGS + next((WIDE[end] for end in WIDE if path.endswith(end)), [])
            objects += self.compiler.compile([path], output_dir=self.build_temp, include_dirs=[SRC], extra_postargs=flags)
        ext.extra_objects = objects
        ext.depends = objects  # or a second build in the same folder would keep the first one's extension
        super().build_extension(ext)


class sdist_with_sources(sdist):
    """The C library's sources too, which a checkout has outside of this folder."""

    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        root = os.path.dirname(SRC)
        wanted = [os.path.join(root, "Makefile")] + [path for wing in WINGS for path in glob.glob(os.path.join(SRC, wing, "*.[ch]"))]
        own = [os.path.join(HERE, name) for name in ("build_native.py", "strided.c", "strided.h")]
        for path, to in [(p, os.path.join("tree", os.path.relpath(p, root))) for p in wanted] + [(p, os.path.basename(p)) for p in own]:
            os.makedirs(os.path.dirname(os.path.join(base_dir, to)), exist_ok=True)
            shutil.copyfile(path, os.path.join(base_dir, to))


setup(version=version(), cffi_modules=["build_native.py:ffi"], cmdclass={"build_ext": build_library_too, "sdist": sdist_with_sources})
