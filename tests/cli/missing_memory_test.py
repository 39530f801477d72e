#!/usr/bin/env python3
"""Memory that is not there is told in one sentence with the number of balls.

usage: missing_memory_test.py EDMILL
"""
import pathlib
import resource

from trials import Trials, case, edmill

BALLS = 600_000


def small_memory():
    resource.setrlimit(resource.RLIMIT_AS, (200_000_000, 200_000_000))


with Trials() as t:
    text = case().replace("count = 12", f"count = {BALLS}").replace('"38 mm"', '"380 m"').replace('"57 mm"', '"570 m"')
    pathlib.Path("case.toml").write_text(text)
    for command in ("run case.toml --out out --quiet", "check case.toml", "certify case.toml --collisions 3 --out events.csv",
                    "prove case.toml --collisions 3 --out events.csv", "run case.toml --out out --quiet --precision float128"):
        done = edmill(*command.split(), preexec_fn=small_memory)
        t.refused(done, command, "case.toml: found too little memory", f"{BALLS} balls", code=1)
        t.no_partials(command)
    pathlib.Path("my.sweep.toml").write_text('[sweep]\ncase = "case.toml"\nreplicas = 1\n')
    done = edmill("sweep", "my.sweep.toml", "--jobs", "1", "--out", "study", "--quiet", preexec_fn=small_memory)
    t.check(done.returncode == 5, f"a sweep: {done.returncode} {done.stderr}")
    t.check(f"too little memory for {BALLS} balls" in pathlib.Path("study/runs.csv").read_text(), "the row of a sweep")
print(f"{t.checks} checks of missing memory")
