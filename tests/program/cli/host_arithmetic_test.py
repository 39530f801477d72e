#!/usr/bin/env python3
"""A host that rounds otherwise, flushes subnormal numbers or traps gets the same files from each
command.

usage: PYTHONPATH=tests/support python3 host_arithmetic_test.py EDMILL HOST_ARITHMETIC    a library
    that sets the mode before the program runs
"""
import hashlib
import os
import pathlib
import re
import sys

from program import EXAMPLES, SOURCE, Trials, edmill

library = os.path.realpath(sys.argv[2])
DEMO = EXAMPLES / "demo.toml"
THREE = SOURCE / "regression/reference/three_balls.toml"
COMMANDS = {
    "run": ["run", DEMO, "--quiet", "--set", "run.end_time=0.7 s", "--out", "out"],
    "run in 50 digits": [
        "run", DEMO, "--quiet", "--set", "run.end_time=0.52 s", "--set", "run.precision=mpfr50",
        "--out", "out"
    ], "digits": [
        "run", THREE, "--quiet", "--digits", "12", "--set", "run.end_time=0.3 s", "--out", "out"
    ], "prove": ["prove", THREE, "--collisions", "20", "--out", "proof.csv"],
    "certify": ["certify", THREE, "--collisions", "20", "--out",
                "certified.csv"], "audit": ["audit", THREE, "log/collisions.csv"],
}


def said(name, mode):
    """Digest of all that a command writes and prints, without the times that it took."""
    place = pathlib.Path(re.sub(r"\W", "_", f"{name}-{mode}"))
    place.mkdir()
    if name == "audit":
        (place / "log").symlink_to(pathlib.Path("log").resolve())
    done = edmill(*COMMANDS[name], cwd=place, env=dict(os.environ, LD_PRELOAD=library,
                                                       HOST_ARITHMETIC=mode))
    digest = hashlib.sha256()
    for path in sorted(place.rglob("*")):
        if path.is_file():
            digest.update(path.name.encode() +
                          re.sub(rb'.*cpu_second.*|\([0-9.]+ s\)', b"", path.read_bytes()))
    digest.update(re.sub(r".*CPU time.*|[0-9.]+ s\)", "", done.stdout).encode())
    return done.returncode, digest.hexdigest(), done.stderr


with Trials() as t:
    edmill("run", THREE, "--quiet", "--out", "log", "--set", "run.end_time=0.3 s", "--set",
           'output=[{type="collisions", states=true}]', code=0)
    for name in COMMANDS:
        expected = said(name, "nearest")
        t.check(expected[0] == 0, f"{name}: ends with {expected[0]}: {expected[2]}")
        for mode in ("up", "down", "zero", "flush", "traps"):
            found = said(name, mode)
            t.check(found == expected, f"{name}, {mode}: {found} and not {expected}")
