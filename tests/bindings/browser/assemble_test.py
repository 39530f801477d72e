#!/usr/bin/env python3
"""The page is assembled from the files that it names, here with nothing for an engine; and the
wheel finds the source.

usage: PYTHONPATH=tests/support python3 assemble_test.py EDMILL
"""
import pathlib
import subprocess
import sys

from program import SOURCE, Trials

SCRIPTS = SOURCE / "cmake"

with Trials() as t:
    for kind in (".js", ".wasm"):
        pathlib.Path("engine" + kind).write_text("")
    subprocess.run([sys.executable, SCRIPTS / "assemble_page.py", "engine", "page.html"],
                   check=True)
    page = pathlib.Path("page.html").read_text(encoding="utf-8")
    t.check("{{" not in page, "a part of the page that nobody gives")
    t.check("SPEX 8000, 28 balls" in page and "spex8000" in page, "the cases of the page")
    found = subprocess.run(
        [sys.executable, "-c", "import wheel_of_cmake; print(wheel_of_cmake.ROOT)"], cwd=SCRIPTS,
        capture_output=True, text=True, check=True).stdout.strip()
    t.check(pathlib.Path(found) == SOURCE, f"the source by the wheel: {found}")
