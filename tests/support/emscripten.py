"""Builds a target of cmake/CoreAlone.cmake by Emscripten, as page_test.py and package_test.py need it."""
import csv
import os
import subprocess

from program import SOURCE

TOOLCHAIN = "/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake"


def build(folder, target):
    subprocess.run(["cmake", "-S", SOURCE, "-B", folder, "-G", "Ninja", "-DEDMILL_CORE_ALONE=ON", "-DCMAKE_BUILD_TYPE=None",
                    "-DCMAKE_CXX_FLAGS=-DNDEBUG -O2", f"-DCMAKE_TOOLCHAIN_FILE={TOOLCHAIN}"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder, "--target", target], check=True, stdout=subprocess.DEVNULL,
                   env=dict(os.environ, NODE_PATH="/usr/share/nodejs"))


def published(name):
    """The digest of a log that every machine makes."""
    for row in csv.reader((SOURCE / "regression/reference/bits.tsv").read_text().splitlines(), delimiter="\t", quoting=csv.QUOTE_NONE):
        if row[0] == name and row[2] == "double":
            return row[4]
    raise KeyError(name)
