#!/usr/bin/env python3
"""A run that is killed before any of its changes to names of files, and once more while it is
resumed, ends like one that was not.

usage: PYTHONPATH=tests/support python3 kill_steps_test.py EDMILL DIES_AT    the library that kills
"""
import os
import pathlib
import random
import shutil
import signal
import sys

from program import Trials, case, edmill, results, same

DIES_AT = os.path.realpath(sys.argv[2])
seed = 20110101
rng = random.Random(seed)
RUN = ["run", "case.toml", "--quiet", "--report", "--checkpoint", "0.03 s simulated"]


def killed(step, *arguments):
    """Whether the program was killed before this step; without a kill it must succeed."""
    done = edmill(*arguments, env=dict(os.environ, LD_PRELOAD=DIES_AT, DIES_AT=str(step)))
    t.check(done.returncode in (0, -signal.SIGKILL),
            f"step {step}, seed {seed}: {arguments}: {done.returncode}, {done.stderr}")
    return done.returncode != 0


def folder(name):
    """A folder in which another run has left rows."""
    shutil.rmtree(name, ignore_errors=True)
    os.mkdir(name)
    pathlib.Path(name, "all.csv").write_text("rows of another run\n")
    return name


def go_on(place):
    """What a user runs next: nothing after a run that has ended."""
    if os.path.exists(f"{place}/checkpoint"):
        return ["resume", place, "--quiet"]
    return None if os.path.exists(f"{place}/summary.json") else [*RUN, "--out", place]


with Trials() as t:
    pathlib.Path("case.toml").write_text(
        case("collisions", "events", "trends", "paraview", "snapshot", "spectra") +
        '[[output]]\ntype = "collisions"\nfile = "all.csv"\nappend = true\nonly = { ball = 3 }\n')
    t.check(edmill(*RUN, "--out", folder("whole")).returncode == 0, "the run that is not killed")
    expected = results("whole")
    step = 1
    while killed(step, *RUN, "--out", folder("once")):
        while (command := go_on("once")) and killed(rng.randint(1, 150), *command):
            pass
        t.check(
            same(results("once"), expected) == [],
            f"step {step}, seed {seed}: {same(results('once'), expected)}")
        t.no_partials(f"step {step}, seed {seed}", "once")
        step += 1
    # A run of this case changes 37 names; files that were moved into place are not removed once
    # more.
    t.check(step > 30, f"only {step - 1} steps")
    print(f"{step - 1} steps: each run ended like one that was not killed")
