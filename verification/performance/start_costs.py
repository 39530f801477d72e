#!/usr/bin/env python3
"""Impacts per CPU second from the start of a run on, where balls at rest share the ends of their
wall searches: four impacts a ball.

usage: start_costs.py EDMILL [COUNT...]
"""
import pathlib
import resource
import subprocess
import sys
import tempfile

CASE = """[run]
end_time = "100 s"
gravity = "9.81 m/s2"
[mill]
type = "spex8000"
speed = "300 rpm"
[vessel]
diameter = "300 mm"
height = "300 mm"
[contact]
restitution = 0.7
friction = 0.3
[[balls]]
count = 1
diameter = "3 mm"
gap_ball = "0.05 mm"
gap_wall = "0.05 mm"
"""


def cpu_time(program, folder, balls, collisions):
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([
        program, "run", f"{folder}/case.toml", "--quiet", "--out", f"{folder}/out", "--set",
        f"balls.0.count={balls}", "--set", f"run.max_collisions={collisions}"
    ], check=True)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


program = str(pathlib.Path(sys.argv[1]).resolve())
with tempfile.TemporaryDirectory() as folder:
    pathlib.Path(folder, "case.toml").write_text(CASE)
    for balls in map(int, sys.argv[2:] or (3000, 10000, 30000, 100000)):
        loop = cpu_time(program, folder, balls, 4 * balls) - cpu_time(program, folder, balls, 1)
        print(f"{balls:7d} balls: {4 * balls / loop:9.0f} impacts per CPU second")
