"""brdfpack._native: the public header, as it is, and a few functions for NumPy's arrays (strided.h)."""
import os
import re

from cffi import FFI

HERE = os.path.dirname(os.path.abspath(__file__))
CARRIED = os.path.join(HERE, "tree", "src")  # in a source distribution (setup.py)
SRC = CARRIED if os.path.isdir(CARRIED) else os.path.dirname(HERE)


def declarations(path):
    """A header's declarations in the words that cffi knows: no comments, no conditions, constants left to the compiler."""
    with open(path, encoding="utf-8") as file:
        text = re.sub(r"/\*.*?\*/", "", file.read(), flags=re.S)
    constants = re.findall(r"^#define (BP_\w+) [0-9(].*$", text, re.M)
    text = text.replace("BP_NAME_BYTES_MAX + 1", "256")
    text = re.sub(r"^#.*$", "", text, flags=re.M).replace('extern "C" {\n', "", 1).replace("BP_API ", "")
    text = re.sub(r"^}$", "", text, count=0, flags=re.M)
    return "".join(f"#define {name} ...\n" for name in constants) + text


ffi = FFI()
ffi.cdef(declarations(os.path.join(SRC, "brdfpack.h")))
ffi.cdef(declarations(os.path.join(HERE, "strided.h")))
ffi.cdef('extern "Python" int tell_python(void *user, double share);')
ffi.set_source("brdfpack._native", '#include "brdfpack.h"\n#include "strided.h"\n', include_dirs=[SRC, HERE], libraries=["z", "m"],
               extra_compile_args=["-std=c17", "-O2"], extra_link_args=["-Wl,--gc-sections"])
