#!/usr/bin/env python3
"""Random mills with bodies inside the vessel: certified sequences of edmill against plain_bodies,
the same events and every value to 31 digits.

usage: PYTHONPATH=tests/support python3 plain_bodies_test.py EDMILL PLAIN_BODIES [MILLS] [SEED]
    [EVENTS]
"""
import os
import pathlib
import random
import subprocess
import sys
from decimal import Decimal

from plain_mill_test import compare, table
from program import Trials, edmill

PLAIN = os.path.realpath(sys.argv[2])
mills, seed, events = (
    int(text) for text in sys.argv[3:6] + ["6", "20261201", "150"][len(sys.argv[3:6]):])
rng = random.Random(seed)
DIGITS = 31
AXES = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}


class Joint:
    """A joint as both programs read it, and the largest speed that it gives to any point (6 cm away
    at most from the axis)."""

    def __init__(self, turns, axis, angle=0, speed=0, shift=(0, 0, 0), swing=None):
        number = lambda values: "[" + ", ".join(f'"{value} mm"' for value in values) + "]"
        toml = [
            f'rotate = "{axis}"' if turns else
            f'translate = {number(shift)}' if not swing and not speed else f'translate = "{axis}"'
        ]
        metres = " ".join(str(Decimal(str(value)) / 1000) for value in shift)
        lines = [
            f"rotate {AXES[axis]} {angle} {speed}"
            if turns else f"translate {metres} {AXES[axis]} {Decimal(speed) / 1000}"
        ]
        self.fastest = abs(speed) * (0.105 * 0.12 if turns else 0.001)
        if turns and angle:
            toml.append(f'angle = "{angle} deg"')
        if speed:
            toml.append(f'speed = "{speed} {"rpm" if turns else "mm/s"}"')
        if swing:
            amplitude, rpm, phase = swing
            toml.append(
                f'swing = [{{ amplitude = "{amplitude} {"deg" if turns else "mm"}", speed = "{rpm} rpm", phase = "{phase} deg" }}]'
            )
            lines.append(
                f"swing {amplitude if turns else Decimal(str(amplitude)) / 1000} {rpm} {phase}")
            self.fastest += amplitude * rpm * (0.105 * 0.0175 * 0.12 if turns else 0.105 * 0.001)
        self.toml, self.lines = "{ " + ", ".join(toml) + " }", lines


def swing_of(turns):
    return rng.choice([3, 8, 15]) if turns else rng.choice([1, 2.5]), rng.choice(
        [600, 900]), rng.choice([0, 30, 90])


def vessel_joints():
    kind = rng.choice(["still", "shaken", "turning", "rocking"])
    if kind == "still":
        return [Joint(True, "z", angle=rng.choice([20, 45]))]
    if kind == "shaken":
        return [Joint(False, "y", swing=swing_of(False)), Joint(True, "x", angle=15)]
    if kind == "turning":
        return [Joint(True, rng.choice("xz"), speed=rng.choice([60, -150]))]
    return [
        Joint(False, "x", shift=(40, 0, 0)),
        Joint(True, rng.choice("xyz"), swing=swing_of(True)),
        Joint(True, "y", speed=90)
    ]


def body():
    """Keys of a case, lines of the plain program, joints."""
    joints = []
    if rng.random() < 0.7:
        joints.append(Joint(True, rng.choice("xyz"), speed=rng.choice([120, 300, 600, -450])))
    joints.append(Joint(False, "x", shift=[round(rng.uniform(-9, 9), 1) for _ in range(3)]))
    if rng.random() < 0.5:
        turns = rng.random() < 0.6
        joints.append(Joint(turns, rng.choice("xyz"), swing=swing_of(turns)))
    if rng.random() < 0.5:
        joints.append(Joint(True, rng.choice("xyz"), angle=rng.randint(-80, 80)))
    if rng.random() < 0.5:
        size = [rng.choice([0, 3, 6, 14, 24]) for _ in range(3)]
        size = size if any(size) else [12, 0, 0]
        keys = 'size = ["{} mm", "{} mm", "{} mm"]'.format(*size)
    else:
        size = [rng.choice([4, 8, 20]), rng.choice([0, 3, 12, 24])]
        keys = 'type = "cylinder"\ndiameter = "{} mm"\nheight = "{} mm"'.format(*size)
    rounding = Decimal(min(size)) / 2 * Decimal(rng.choice(["0", "0.5", "1"]))
    half = [(Decimal(s) / 2 - rounding) / 1000
            for s in (size if len(size) == 3 else (size[0], size[1], size[0]))]
    kind = "round" if len(size) == 2 and half[0] > 0 else "box"
    return f'{keys}\nrounding = "{rounding} mm"', f"{kind} {half[0]} {half[1]} {half[2]} {rounding / 1000}", joints


def random_mill():
    """The case and the file of the plain program."""
    frame = vessel_joints()
    diameter, restitution, friction = rng.choice([4, 5,
                                                  7]), rng.choice(["0.4", "0.6",
                                                                   "0.9"]), rng.choice(["0", "0.3"])
    case = [
        '[run]\nend_time = "10 s"\ngravity = "9.81 m/s2"\n' +
        f"seed = {rng.randint(1, 999)}\n[mill]\ntype = \"chain\"",
        "joint = [" + ", ".join(joint.toml for joint in frame) + "]", "[vessel]"
    ]
    plain = ["frame"] + [line for joint in frame for line in joint.lines]
    if rng.random() < 0.5:
        case.append('diameter = "50 mm"\nheight = "46 mm"')
        plain += ["plane 0 -1 0 0.023", "plane 0 1 0 0.023", "cylinder 0.025"]
    else:
        case.append('type = "box"\nsize = ["44 mm", "50 mm", "40 mm"]')
        plain += [
            f"plane {axis} {size}"
            for axis, size in (("-1 0 0", "0.022"), ("1 0 0", "0.022"), ("0 -1 0", "0.025"),
                               ("0 1 0", "0.025"), ("0 0 -1", "0.020"), ("0 0 1", "0.020"))
        ]
    fastest = sum(joint.fastest for joint in frame)
    for _ in range(rng.choice([1, 2, 3])):
        keys, solid, joints = body()
        # A vessel that is carried away or turned far would leave a body on the ground outside.
        on_ground = frame[0].lines[0].startswith(
            "rotate") and not frame[0].fastest and rng.random() < 0.6
        case.append(f'[[body]]\n{keys}\non = "{"ground" if on_ground else "vessel"}"\njoint = [' +
                    ", ".join(j.toml for j in joints) + "]")
        plain += ["frame"] + [
            line for joint in ([] if on_ground else frame) + joints for line in joint.lines
        ] + [solid]
        fastest += sum(joint.fastest for joint in joints)
    case.append(
        f'[contact]\nrestitution = {restitution}\nfriction = {friction}\nleast_separation = "1 cm/s"\n[[balls]]\n'
        f'count = {rng.choice([2, 6, 15])}\ndiameter = "{diameter} mm"\ndensity = "8 g/cm3"')
    plain += [
        "gravity 9.81", f"radius {Decimal(diameter) / 2000}", "density 8000", "inertia 0.4",
        f"restitution {restitution}", f"friction {friction}", "least_separation 0.01",
        f"fastest {fastest:.4f}"
    ]
    return "\n".join(case) + "\n", "\n".join(plain) + "\n"


with Trials() as t:
    total = 0
    for trial in range(mills):
        case, plain = random_mill()
        pathlib.Path("case.toml").write_text(case)
        pathlib.Path("mill.txt").write_text(plain)
        edmill("run", "case.toml", "--precision", "mpfr100", "--set", 'run.end_time="1 us"',
               "--out", "out", code=0)
        done = edmill("certify", "case.toml", "--collisions", events, "--digits", DIGITS, "--out",
                      "reference.csv")
        if done.returncode == 8:  # its balls come to rest between a body and a wall
            print(f"mill {trial}: stalled")
            continue
        t.check(done.returncode == 0, f"mill {trial} of seed {seed}: {done.stderr}\n{case}")
        with open("reference.csv", encoding="utf-8") as file:
            reference = table(file)

        def tried(text):
            pathlib.Path("tried.txt").write_text(text)
            rows = subprocess.run([PLAIN, "tried.txt", "out/final_state.csv",
                                   str(events)], check=True, stdout=subprocess.PIPE, text=True)
            return compare(reference, table(rows.stdout.splitlines()), Decimal(10) ** -DIGITS)

        common, good, (worst, value) = tried(plain)
        with_bodies = sum(row["partner_kind"] == "wall" and int(row["partner"]) >=
                          (6 if "plane 1 0 0" in plain else 3) for row in reference)
        print(
            f"mill {trial}: {common} of {events} events the same, {good} to {DIGITS} digits, {with_bodies} with bodies, "
            f"worst {worst:.1e} ({value})", flush=True)
        t.check(good == events,
                f"mill {trial} of seed {seed}: {good} of {events} events agree\n{case}\n{plain}")
        total += with_bodies
        if trial == 0:  # the comparison can fail
            t.check(
                tried(plain.replace("gravity 9.81", "gravity 9.8100000001"))[1] < events,
                "another gravity")
    t.check(total > 10 * mills, f"{total} impacts with bodies")
print(f"{mills} mills, seed {seed}: {total} impacts with bodies, all values to {DIGITS} digits")
