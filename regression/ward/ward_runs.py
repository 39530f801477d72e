#!/usr/bin/env python3
"""Runs the 24 cases in replicas over seeds; each run leaves OUT/<case>-<seed>.json. Runs that are
there already, of the same case by a program with the same core, are kept, so it can be stopped and
started again.

usage: ward_runs.py WARD_BATCHES --out OUT [--jobs N] [--short]    --short: 3 seeds, 1 s to 5.1 s,
    of the cases below 60 balls
"""
import argparse
import concurrent.futures
import functools
import hashlib
import json
import math
import os
import pathlib
import subprocess
import sys

import tables

CASES = pathlib.Path(__file__).resolve().parent / "cases"


def plan(case, short=False):
    """Seeds, start, end and batch of a case's runs [s]. The thesis leaves out 30 s of 150 s. Many
    balls are steady within half a second (thesis, chapter 5), and their mean settles quickly: short
    runs are enough."""
    if short:
        return range(1, 4 if case.count < 60 else 1), 1, 5.1, 0.512334
    if case.count < 60:
        return range(1, 6), 30, 150, 2
    if case.count < 400:
        return range(1, 4), 5, 17, 2
    return range(
        1, 4
    ), 1, 5.1, 1.0246679  # 18 drive periods: batches so short would show where in a period they begin


def sha256(place):
    return hashlib.sha256(pathlib.Path(place).read_bytes()).hexdigest()


def run(program, case, seed, times, place):
    start, end, batch = times
    case_file = CASES / f"{case.name}.toml"
    case_sha256 = sha256(case_file)
    command = [program, str(case_file), "--batch", str(batch)]
    for key, value in (("run.seed", seed), ("run.start_time", f"{start} s"), ("run.end_time",
                                                                              f"{end} s")):
        command += ["--set", f"{key}={value}"]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if done.returncode:
        raise RuntimeError(f"{place.stem}: exit code {done.returncode}")
    temporary = place.with_suffix(".tmp")
    temporary.write_text(
        json.dumps({"case_sha256": case_sha256, **json.loads(done.stdout)}, indent=1))
    os.replace(temporary, place)


@functools.lru_cache(None)
def same_core(commit, other):
    """Whether two commits have the same sources of the core."""
    if commit == other:
        return True
    return subprocess.run(
        ["git", "-C",
         str(CASES), "diff", "--quiet", commit, other, "--", ":/include", ":/src"],
        stderr=subprocess.DEVNULL).returncode == 0


def commit_of(program):
    version = subprocess.run([program, "--version"], stdout=subprocess.PIPE, text=True,
                             check=True).stdout
    return version.split()[-1]


def known(place, case, commit, times):
    """Whether the run of this case file by this program is there."""
    if not place.exists():
        return False
    record = json.loads(place.read_text())
    found = record["start_time"], record["end_time"], record["batch_length"]
    return (record["case_sha256"] == sha256(CASES / f"{case.name}.toml") and
            same_core(record["commit"], commit) and
            all(math.isclose(a, b) for a, b in zip(found, times)))


def run_all(program, folder, jobs=1, short=False, quiet=False):
    """Does every run that is not known, fewest balls first."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    commit = commit_of(program)
    waiting = []
    for case in sorted(tables.cases(), key=lambda case: case.count):
        seeds, *times = plan(case, short)
        for seed in seeds:
            place = folder / f"{case.name}-{seed}.json"
            if not known(place, case, commit, times):
                waiting.append((program, case, seed, times, place))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for k, (work, done) in enumerate([(w, pool.submit(run, *w)) for w in waiting], 1):
            done.result()
            if not quiet:
                print(f"{k} of {len(waiting)}: {work[-1].name}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="WARD_BATCHES")
    parser.add_argument("--out", required=True)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--short", action="store_true")
    args = parser.parse_args()
    try:
        run_all(args.program, args.out, args.jobs, args.short)
    except RuntimeError as error:
        sys.exit(f"ward_runs.py: {error}")


if __name__ == "__main__":
    main()
