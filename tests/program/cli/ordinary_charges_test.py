#!/usr/bin/env python3
"""Charges as people have them, of 1 to 60 balls in twelve motions and six vessels: each run comes
to its end, and a rule orders few of its impacts.

usage: PYTHONPATH=tests/support python3 ordinary_charges_test.py EDMILL [COUNT]
"""
import pathlib
import random
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

from program import Trials, edmill, summary

COUNT = int(sys.argv[2]) if len(sys.argv) > 2 else 24
SEED = 20261128

MOTIONS = [
    'type = "spex8000"\nspeed = "{rpm} rpm"', 'type = "spex_2d"\nspeed = "{rpm} rpm"',
    'type = "vibratory"\namplitude = ["{mm} mm", "0 mm", "0 mm"]\nspeed = "{rpm} rpm"',
    'type = "vibratory"\namplitude = ["0 mm", "{mm} mm", "0 mm"]\nspeed = "{rpm} rpm"',
    'type = "vibratory"\namplitude = ["0 mm", "0 mm", "{mm} mm"]\nspeed = "{rpm} rpm"',
    'type = "vibratory"\namplitude = ["{mm} mm", "0 mm", "0 mm"]\namplitude_quarter = ["0 mm", "{mm} mm", "0 mm"]\nspeed = "{rpm} rpm"',
    'type = "planetary"\nradius = "70 mm"\nspeed = "{slow} rpm"\nratio = -2',
    'type = "planetary"\nradius = "60 mm"\nspeed = "{slow} rpm"\nratio = 1.5',
    'type = "drum"\nspeed = "{slow} rpm"', 'type = "still"',
    'type = "chain"\n[[mill.joint]]\nrotate = "z"\nangle = "400 deg"\nswing = [{{amplitude = "20 deg", speed = "{rpm} rpm"}}]',
    'type = "chain"\n[[mill.joint]]\nrotate = [1, 2, 2]\nspeed = "{slow} rpm"\n[[mill.joint]]\ntranslate = "y"\n'
    'swing = [{{amplitude = "{mm} mm", speed = "{rpm} rpm", phase = "90 deg"}}]',
]
PRISM = ", ".join('{at = ["%g mm", "%g mm", "%g mm"]}' % (x, y, z) for y in (-25, 25)
                  for x, z in ((30, 0), (-20, 27), (-20, -27)))
VESSELS = [
    'type = "cylinder"\ndiameter = "40 mm"\nheight = "55 mm"',
    'type = "box"\nsize = ["40 mm", "45 mm", "40 mm"]', 'type = "sphere"\ndiameter = "46 mm"',
    'type = "capsule"\ndiameter = "40 mm"\nheight = "60 mm"',
    'type = "rounded_cylinder"\ndiameter = "42 mm"\nheight = "55 mm"\nedge_radius = "8 mm"',
    f'type = "polyhedron"\nvertex = [{PRISM}]'
]


def charge(number, numbers):
    mill = MOTIONS[number % len(MOTIONS)].format(rpm=numbers.randint(600, 1900),
                                                 slow=numbers.randint(60, 400),
                                                 mm=numbers.choice([1, 2, 4.5]))
    text = f'''[run]
end_time = "{numbers.choice([0.3, 0.5])} s"
gravity = "9.81 m/s2"
seed = {numbers.randint(1, 9999)}
[mill]
{mill}
[vessel]
{VESSELS[number // len(MOTIONS) % len(VESSELS)]}
[contact]
restitution = {numbers.choice([0, 0.1, 0.3, 0.5, 0.7, 0.9])}
friction = {numbers.choice([0, 0.1, 0.4])}
'''
    left = numbers.choice([1, 2, 3, 8, 20, 44, 60])
    while left > 0:
        count = left if numbers.random() < 0.6 else numbers.randint(1, left)
        widest = 9 if count < 5 else 6 if count < 21 else 4
        speed = numbers.choice(["", 'random_speed = "1 m/s"\n'])
        text += f'[[balls]]\ncount = {count}\ndiameter = "{numbers.uniform(1.4, widest):.2f} mm"\ngap_ball = "0.1 mm"\ngap_wall = "0.1 mm"\n{speed}'
        left -= count
    return text


def run(number):
    place = pathlib.Path(f"charge-{number}")
    place.with_suffix(".toml").write_text(charge(number, random.Random(SEED + number)))
    begin = time.monotonic()
    try:
        done = edmill("run", place.with_suffix(".toml"), "--quiet", "--out", place, timeout=300)
    except subprocess.TimeoutExpired:
        return number, None, "no end after 300 s", 0, 0, 300
    found = summary(place) if (place / "summary.json").exists() else {}
    return (number, done.returncode, done.stderr, found.get("simultaneous_contacts", 0),
            found.get("impacts_since_start", 0), time.monotonic() - begin)


with Trials() as t:
    print(f"seed {SEED}")
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(run, range(COUNT)))
    impacts, by_rule = sum(r[4] for r in results), sum(r[3] for r in results)
    largest = max(results, key=lambda r: r[3] / max(r[4], 1))
    slowest = max(results, key=lambda r: r[5])
    print(
        f"{COUNT} charges, {impacts} impacts, {by_rule} by rule ({100 * by_rule / impacts:.3g} %), at most "
        f"{100 * largest[3] / max(largest[4], 1):.3g} % in charge {largest[0]}; slowest charge {slowest[0]}, {slowest[5]:.1f} s; exit codes "
        f"{ {code: sum(r[1] == code for r in results) for code in sorted({r[1] for r in results}, key=str)} }"
    )
    for number, code, error, *_ in results:
        # 8: bodies that nothing separates, which is no fault of the program
        t.check(code in (0, 8), f"charge {number}: exit code {code}: {error[:300]}")
    t.check(by_rule < 0.01 * impacts, f"{by_rule} of {impacts} impacts by rule")
