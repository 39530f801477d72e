#!/usr/bin/env python3
"""Claim 14: the Lyapunov exponents of a gas of hard spheres, elastic and smooth, between flat
walls, which stretch nothing. By kinetic theory the sum of the positive ones over the collisions of
balls grows with the logarithm of the density n: a collision stretches two directions by the free
path over the diameter, so that per ball and collision of a ball it is -ln n + a constant in the
dilute limit. The largest one is that of kinetic_theory.py, at the density that the centres of the
balls have between the walls.

usage: PYTHONPATH=tests/support python3 hard_spheres.py EDMILL
"""
import csv
import json
import math
import pathlib
import random
import statistics
import sys
import tempfile

from kinetic_theory import largest_exponent
from program import edmill

BALLS, DIAMETER, SEEDS = 32, 0.004, 4
STUDENT = 3.182  # of three degrees of freedom, 95 %
CASE = """[run]
end_time = "{end} s"
[mill]
type = "still"
[vessel]
type = "box"
size = ["{edge} m", "{edge} m", "{edge} m"]
[contact]
restitution = 1
friction = 0
least_separation = "1e-6 m/s"
[[output]]
type = "lyapunov"
exponents = {exponents}
start_time = "{start} s"
"""
BALL = """[[ball]]
diameter = "{diameter} m"
position = ["{x[0]} m", "{x[1]} m", "{x[2]} m"]
velocity = ["{v[0]} m/s", "{v[1]} m/s", "{v[2]} m/s"]
"""


def case(density, end, seed):
    """Balls on a lattice with normal velocities; all exponents that are not negative, spins
    aside."""
    draws = random.Random(seed)
    edge = (BALLS * DIAMETER**3 / density) ** (1 / 3)
    side = math.ceil(BALLS ** (1 / 3))
    cell = (edge - DIAMETER) / side
    places = [(i, j, k) for i in range(side) for j in range(side) for k in range(side)]
    draws.shuffle(places)
    text = CASE.format(end=end, start=end / 10, edge=edge, exponents=3 * BALLS)
    for place in places[:BALLS]:
        text += BALL.format(diameter=DIAMETER,
                            x=[-edge / 2 + DIAMETER / 2 + (c + 0.5) * cell for c in place],
                            v=[draws.gauss(0, 1) for _ in range(3)])
    return text


def of_a_run(folder, density, end, seed):
    """Of the exponents: the sum, per ball, and the largest; over the collisions of a ball with
    others in a second."""
    (folder / "case.toml").write_text(case(density, end, seed))
    edmill("run", "case.toml", "--out", "out", "--quiet", cwd=folder, code=0)
    with open(folder / "out/lyapunov.csv") as file:
        exponents = [
            float(row["per_second [1/s]"])
            for row in csv.DictReader(line for line in file if not line.startswith("#"))
        ]
    pairs = json.loads((folder / "out/summary.json").read_text())["collisions"]["ball_ball"]
    rate = 2 * pairs / BALLS / end
    return sum(x for x in exponents if x > 0) / BALLS / rate, exponents[0] / rate


def mean(values):
    return statistics.mean(values), STUDENT * statistics.stdev(values) / math.sqrt(len(values))


def expected_largest(density):
    edge = (BALLS / density) ** (1 / 3)  # in diameters
    return mean([
        largest_exponent(BALLS, BALLS / (edge - 1) ** 3, 40000, seed)
        for seed in range(1, SEEDS + 1)
    ])


sums, faults = {}, []
with tempfile.TemporaryDirectory() as name:
    for density, end in ((1e-2, 60), (1e-3, 600)):
        found = [of_a_run(pathlib.Path(name), density, end, seed) for seed in range(1, SEEDS + 1)]
        sums[density] = mean([of_all for of_all, _ in found])
        largest, expected = mean([one for _, one in found]), expected_largest(density)
        print(
            f"density {density:g}: sum over collisions {sums[density][0]:.4f} +- {sums[density][1]:.4f}, "
            f"largest {largest[0]:.2f} +- {largest[1]:.2f}, by kinetic theory {expected[0]:.2f} +- {expected[1]:.2f}",
            flush=True)
        if abs(largest[0] - expected[0]) > math.hypot(largest[1], expected[1]):
            faults.append(f"the largest exponent at {density:g} is not that of kinetic theory")
slope = (sums[1e-3][0] - sums[1e-2][0]) / math.log(10)
half = math.hypot(sums[1e-3][1], sums[1e-2][1]) / math.log(10)
print(f"growth with -ln n: {slope:.4f} +- {half:.4f}, by kinetic theory 1")
if half > 0.02:
    sys.exit(f"failed: an interval of {half:.3f}, expected 0.02 or less")
if abs(slope - 1) > half + 0.01:  # terms of the order of the larger density
    faults.append("the growth is not 1")
if faults:
    sys.exit("failed: " + "; ".join(faults))
