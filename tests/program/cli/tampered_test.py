#!/usr/bin/env python3
"""A resumed run ends as if nothing had happened, or is refused: whatever was done to the files that
it goes on from.

usage: PYTHONPATH=tests/support python3 tampered_test.py EDMILL [TRIALS]    (default: 16)
"""
import os
import pathlib
import random
import shutil
import signal
import sys
import time

from program import Trials, case, edmill, results, same, start

trials = int(sys.argv[2]) if len(sys.argv) > 2 else 16
seed = 20110101
rng = random.Random(seed)
OUTPUTS = ("collisions", "events", "trends", "spectra", "paraview", "milling_dose", "vessel_load",
           "animation")
OTHERS = "rows of another run\n"
APPENDED = '[[output]]\ntype = "collisions"\nfile = "all.csv"\nappend = true\n'


def files_of(place):
    """Files that hold what the run has written: all but the checkpoint and those of no use to
    it."""
    return [
        p for p in sorted(pathlib.Path(place).rglob("*"))
        if p.is_file() and not p.is_symlink() and p.stat().st_size > 0 and p.name not in (
            "checkpoint", "summary.json", "case.toml", "final_state.csv", ".edmill-files")
    ]


def flip(file, at):
    content = bytearray(file.read_bytes())
    content[at] ^= 1 << rng.randrange(8)
    file.write_bytes(content)


def tamper(place, other):
    """Does one thing to one file, or two. @return what was done"""
    files = files_of(place)
    file = rng.choice(files)
    size = file.stat().st_size
    how = rng.choice([
        "flip", "flip", "truncate", "empty", "remove", "extend", "swap", "of another run",
        "a line less", "checkpoint"
    ])
    if how == "flip":
        flip(file, rng.randrange(size))
    elif how == "truncate":
        os.truncate(file, rng.randrange(size))
    elif how == "empty":
        os.truncate(file, 0)
    elif how == "remove":
        file.unlink()
    elif how == "extend":
        with open(file, "ab") as out:
            out.write(b"7,7,7\n" * rng.randint(1, 1000))
    elif how == "swap":
        second = rng.choice(files)
        content = file.read_bytes()
        file.write_bytes(second.read_bytes())
        second.write_bytes(content)
        how += f" with {second}"
    elif how == "of another run":
        stem = file.name.split(".partial-")[0]
        found = [p for p in files_of(other) if p.name.split(".partial-")[0] == stem]
        if found:
            file.write_bytes(found[0].read_bytes())
    elif how == "a line less":
        lines = file.read_bytes().split(b"\n")
        del lines[rng.randrange(len(lines))]
        file.write_bytes(b"\n".join(lines))
    else:  # the checkpoint of another run, with the same name of the temporary files or without
        shutil.copy(pathlib.Path(other) / "checkpoint", pathlib.Path(place) / "checkpoint")
    return f"{how}: {file}"


def unfinished(place, killed, run_seed):
    """A run that was killed after a checkpoint, or interrupted."""
    os.makedirs(place)
    pathlib.Path(place, "all.csv").write_text(OTHERS)
    process = start("run", "case.toml", "--quiet", "--out", place, "--checkpoint",
                    "0.1 s simulated", "--set", f"run.seed={run_seed}")
    # Until a checkpoint covers some blocks of rows in events.h5, however slow the machine is.
    while not any(p.stat().st_size > 200_000 for p in pathlib.Path(place).glob("events.h5*")):
        assert process.poll() is None, "the run ended before"
        time.sleep(0.002)
    begun = time.time_ns()
    while not os.path.exists(
            f"{place}/checkpoint") or os.stat(f"{place}/checkpoint").st_mtime_ns < begun:
        assert process.poll() is None, "the run ended before"
        time.sleep(0.002)
    time.sleep(rng.uniform(0.05, 0.3))
    process.send_signal(signal.SIGKILL if killed else signal.SIGTERM)
    process.wait()
    return os.path.exists(f"{place}/checkpoint")


with Trials() as t:
    pathlib.Path("case.toml").write_text(case(*OUTPUTS, end="6 s") + APPENDED)
    os.makedirs("whole")
    pathlib.Path("whole/all.csv").write_text(OTHERS)
    t.check(
        edmill("run", "case.toml", "--quiet", "--out", "whole", "--set",
               "run.seed=5").returncode == 0, "the whole run")
    expected = results("whole")
    kinds = {}
    for killed in (True, False):
        t.check(
            unfinished(f"left-{killed}", killed, 5) and unfinished(f"other-{killed}", killed, 6),
            "unfinished runs")
        shutil.copytree(f"left-{killed}", "untouched", symlinks=True)
        t.check(
            edmill("resume", "untouched", "--quiet").returncode == 0, "an untouched run resumes")
        t.check(
            same(results("untouched"), expected) == [],
            f"an untouched run: {same(results('untouched'), expected)}")
        shutil.rmtree("untouched")
        for trial in range(trials // 2):
            what = f"{'killed' if killed else 'interrupted'}, trial {trial} of seed {seed}"
            shutil.copytree(f"left-{killed}", "run", symlinks=True)
            done = tamper("run", f"other-{killed}")
            before = results("run") if os.path.exists("run/summary.json") else None
            resumed = edmill("resume", "run", "--quiet")
            kind = done.split(":")[0].split(" with")[0]
            kinds.setdefault(kind, [0, 0])[resumed.returncode != 0] += 1
            if resumed.returncode == 0:
                found = results("run")
                if "all.csv" in done:  # rows of others are not its own
                    found.pop("all.csv", None)
                differing = [
                    name for name in same(found, expected) if name != "all.csv" or name in found
                ]
                t.check(differing == [], f"{what}: {done}: other results in {differing}")
            else:
                t.refused(resumed, f"{what}: {done}", "run/")
                t.check(before is None or same(results("run"), before) == [],
                        f"{what}: {done}: a refusal changes files")
            shutil.rmtree("run")
    t.check(
        kinds.get("remove", [0, 1])[1] > 0 and
        sum(refused for _, refused in kinds.values()) > trials // 4,
        f"what was done mattered: {kinds}")
    # A byte of what the last checkpoint covers, wherever it is: the beginning is covered.
    for name in ("collisions.csv", "events.h5", "trends.csv", "paraview"):
        for killed in (True, False):
            shutil.copytree(f"left-{killed}", "run", symlinks=True)
            file = [p for p in files_of("run") if name in str(p)][0]
            if name == "events.h5":  # of a block, after the names and the units
                flip(file, 60_000)
            else:
                flip(file, rng.randrange(min(200, file.stat().st_size)))
            t.refused(edmill("resume", "run", "--quiet"), f"a bit of {file}, killed {killed}", name)
            shutil.rmtree("run")
print(f"{trials} trials, seed {seed}; done and refused: {kinds}")
