#!/usr/bin/env python3
"""CPU time of a run in Python, with its events as a NumPy array, over that of `edmill run` with the
same log in HDF5.

usage: PYTHONPATH=build/ci/python python_costs.py EDMILL [--rounds 9] [--collisions 1000000]

The demo case. Each process is measured whole, its start and its imports included; every round runs
one after the other, and the ratios are of one round."""
import argparse
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

DEMO = pathlib.Path(__file__).resolve().parents[2] / "docs/examples/demo.toml"
PROGRAM = """
import sys, edmill
run = edmill.run(edmill.Case(sys.argv[1], sys.argv[2:]))
print(len(run.events))
"""


def cpu_seconds(*command):
    """CPU time of a process [s], and what it printed."""
    before = os.times()
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    after = os.times()
    return after.children_user - before.children_user + after.children_system - before.children_system, printed


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("edmill")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--collisions", type=int, default=1000000)
    given = parser.parse_args()
    settings = [
        "run.start_time=0 s", "run.end_time=1000 s", f"run.max_collisions={given.collisions}"
    ]
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        case = pathlib.Path(folder) / "case.toml"
        case.write_text(DEMO.read_text() + '[[output]]\ntype = "events"\n')
        for _ in range(given.rounds):
            line, _ = cpu_seconds(given.edmill, "run", case, "--quiet", "--out",
                                  pathlib.Path(folder) / "run",
                                  *(x for s in settings for x in ("--set", s)))
            python, events = cpu_seconds(sys.executable, "-c", PROGRAM, DEMO, *settings)
            ratios.append(python / line)
    print(
        f"{int(events)} impacts in Python over the command line: CPU time {statistics.median(ratios):.3f} "
        f"({min(ratios):.3f} to {max(ratios):.3f}) in {given.rounds} rounds")


if __name__ == "__main__":
    main()
