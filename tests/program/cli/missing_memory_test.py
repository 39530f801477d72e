#!/usr/bin/env python3
"""Memory that is not there is told in one sentence with the number of balls, wherever it runs out.

usage: PYTHONPATH=tests/support python3 missing_memory_test.py EDMILL [TRIALS [SEED]]
"""
import pathlib
import random
import resource
import sys

from program import Trials, case, edmill

BALLS = 20_000
TRIALS = int(sys.argv[2]) if len(sys.argv) > 2 else 1
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else 20261126
NEEDED = 40_000_000  # [bytes] more than any of the commands can do without, beside the program itself

COMMANDS = ("run case.toml --out out --quiet", "check case.toml",
            "certify case.toml --collisions 3 --out events.csv",
            "prove case.toml --collisions 3 --out events.csv",
            "run case.toml --out out --quiet --precision float128",
            "sweep my.sweep.toml --jobs 1 --out study --quiet")
SENTENCE = f"not enough memory for {BALLS} balls"


def limited(command, limit):
    return edmill(*command.split(),
                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))


def least_to_start():
    """Address space in which the program comes as far as its own code [bytes]"""
    low, high = 0, 1 << 30
    while high - low > 1_000_000:
        middle = (low + high) // 2
        if limited("--version", middle).returncode == 0:
            high = middle
        else:
            low = middle
    return high


with Trials() as t:
    text = case(end="1 us").replace("count = 12", f"count = {BALLS}")
    pathlib.Path("case.toml").write_text(
        text.replace('"38 mm"', '"3.8 m"').replace('"57 mm"', '"5.7 m"'))
    pathlib.Path("my.sweep.toml").write_text('[sweep]\ncase = "case.toml"\nreplicas = 1\n')
    print("seed", SEED)
    draws = random.Random(SEED)
    start = least_to_start(
    ) + 24_000_000  # the first structures of TBB and of Debian 13's UCX: they do not survive their lack
    short = dict.fromkeys(COMMANDS, 0)
    for command in COMMANDS:
        slow = command.split()[0] in ("certify", "prove")
        for _ in range(1 if slow else TRIALS):
            limit = start + draws.randrange(NEEDED)
            done = limited(command, limit)
            what = f"{command} with {limit} bytes"
            if done.returncode == 0:
                continue
            short[command] += 1
            if done.returncode == 5:  # a study: the run failed, the study goes on
                t.check(SENTENCE in pathlib.Path("study/runs.csv").read_text(), f"{what}: its row")
            elif "balls" in done.stderr:
                t.refused(done, what, SENTENCE, code=1)
            else:  # before the balls are known, or beside them
                t.refused(done, what, "not enough memory", code=1)
            t.no_partials(what)
    t.check(sum(short.values()) > 3, f"limits that are too small: {short}")
print(f"{t.checks} checks of missing memory")
print(short)
