#!/usr/bin/python3
"""A DEM code that is right agrees with the case, and each of a table of mistakes differs, by its
name.

usage: PYTHONPATH=tests/support python3 mistakes_test.py EDMILL SPRING_DEM [--all]
       --all: contact times of 20 to 300 us; else a part of the table, once
"""
import json
import os
import subprocess
import sys

from program import EXAMPLES, Trials, edmill

DEM = os.path.realpath(sys.argv[2])
ALL = "--all" in sys.argv
CASE = EXAMPLES / "vibrated_box.toml"

WALLS, PAIRS, SPINS = "at walls", "between balls", "spin change over the torque's at walls"
#: Where frames do not resolve the places of the walls, their velocities show the mistake.
AMPLITUDE = "factor of mill.amplitude velocity of the walls over the case's"
#: What is wrong, and the value or cause that names it, or one of two.
MISTAKES = {
    "restitution=0.62": f"restitution {WALLS}", "restitution=0.58": f"restitution {PAIRS}",
    "restitution=0.9": f"restitution {WALLS}", "restitution=0.3": f"restitution {WALLS}",
    "attraction=1": f"restitution {WALLS}", "restitution_of_pairs=0.62": f"restitution {PAIRS}",
    "restitution_of_pairs=0.57": f"restitution {PAIRS}",
    "restitution_of_walls=0.57": f"restitution {WALLS}",
    "restitution_of_walls=0.65": f"restitution {WALLS}", "other_wall=5": "restitution at wall +z",
    "other_wall=0": "restitution at wall -x",
    "other_wall=3 restitution_of_other_wall=0.55": "restitution at wall +y",
    "friction_of_walls=0.36": f"friction {WALLS}", "friction_of_walls=0.5": f"friction {WALLS}",
    "friction=0.2": f"friction {WALLS}", "friction=0": f"stopping friction {WALLS}",
    "friction_of_pairs=0.6 duration=3": f"friction {PAIRS}", "torque=0.5": SPINS, "torque=0": SPINS,
    "torque=1.2": SPINS, "inertia=1.25": SPINS, "inertia=0.5": SPINS, "spin_sign=-1": SPINS,
    "spin_unit=57.29577951": SPINS, "spin_unit=0.1591549431": SPINS,
    "wall_velocity=0": "velocity of the walls over the case's",
    "wall_velocity=-1": "velocity of the walls over the case's",
    "amplitude=2": "factor of mill.amplitude", "amplitude=1.05": AMPLITUDE,
    "amplitude_y=0.9": "mill.amplitude.y", "amplitude=1.02": AMPLITUDE, "amplitude=0.97": AMPLITUDE,
    "amplitude_y=1.03": "mill.amplitude.y velocity over the case's at wall +y",
    "speed=1.01": "mill.speed", "speed=2": "mill.speed", "phase=1": "phase of the drive",
    "phase=-0.2": "phase of the drive", "phase_y=1": "phase of mill.amplitude along y",
    "phase_y=0.3": "phase of mill.amplitude along y", "gravity=0": "gravity along Y",
    "gravity=-1": "gravity along Y", "gravity=0.95": "gravity along Y",
    "gravity_axis=2": "gravity along Z", "radius=0.97": "diameter over the case's",
    "radius=1.03": "diameter over the case's", "radius=0.97 with_sizes=0": "balls.0.diameter",
    "radius=1.03 with_sizes=0": "balls.0.diameter", "density=0.9": "density over the case's",
    "density=1.1": "density over the case's", "size_x=1.02": "vessel.size.x",
    "size_y=0.98": "vessel.size.y", "size_z=1.02": "vessel.size.z",
    "missing_wall=0": f"contacts missed {WALLS}", "missing_wall=3": f"contacts missed {WALLS}",
    "missing_wall=4": f"contacts missed {WALLS}", "periodic_axis=0": "jumps of balls",
    "periodic_axis=1": "jumps of balls", "periodic_axis=2": "jumps of balls",
    "no_pairs=1": f"contacts missed {PAIRS}", "missing_share=0.3": f"contacts missed {PAIRS}",
    "mass_of_pairs=2": f"restitution {PAIRS}", "mass_of_pairs=0.5": f"restitution {PAIRS}",
    "length_unit=1000": "diameter over the case's", "length_unit=100": "diameter over the case's",
    "exchanged_axes=1": "gravity along Z", "scaled=1": "displacements over those by velocities",
    "other_ball=2": "restitution of ball 2 at walls",
    "other_ball=0 restitution_of_other_ball=0.52": "restitution of ball 0 at walls",
    "restitution_by_speed=0.1": "restitution of fast contacts at walls",
    "mixed_restitution=0.03": "spread of the restitution at walls",
    "radius_of_last=0.9": "diameter over the case's",
    "density_of_last=0.8": "density over the case's",
}
#: What differs as well: friction goes on while bodies attract each other; spins have another sign
#in a mirror.
BESIDE = {"attraction=1": {"friction"}, "exchanged_axes=1": {"spin"}}
#: Laws of codes that are right.
RIGHT = ({}, {"restitution": 0.3}, {"restitution": 0.85, "friction": 0.1})
#: Balls of two sizes.
SIZES = (
    "--set",
    'balls=[{count=3, diameter="8 mm", density="8 g/cm3"}, {count=2, diameter="6 mm", density="8 g/cm3"}]'
)
#: Contact times [us] and seeds.
RUNS = ((20, 1), (50, 2), (100, 3), (200, 1), (200, 2), (300, 2), (300, 3)) if ALL else ((100, 1),)


def judged(options, time, seed, case=(), reading=()):
    """The exit code and the document of an audit; the code and message of an import that is
    refused."""
    with open("frames.dump", "wb") as out:
        subprocess.run([DEM, f"contact_time={time}e-6", f"seed={seed}", *options], stdout=out,
                       check=True)
    done = edmill("import", "frames.dump", "--case", CASE, "--timestep", f"{time / 50} us", "--out",
                  "contacts.csv", "--quiet", *case, *reading)
    if done.returncode:
        return done.returncode, done.stderr
    done = edmill("audit", CASE, "contacts.csv", "--json", "audit.json", *case)
    return done.returncode, json.load(open("audit.json"))


def differing(document):
    names = [name for name, value in document["values"].items() if not value["agrees"]]
    return names + list(document["causes"])[:1]


with Trials(to_the_end=True) as t:
    for time, seed in RUNS:
        for law in RIGHT if ALL else RIGHT[:1]:
            options = [f"{name}={value}" for name, value in law.items()]
            case = [
                word for name, value in law.items() for word in ("--set", f"contact.{name}={value}")
            ]
            code, document = judged(options, time, seed, case)
            t.check(code == 0,
                    f"right, {law}, {time} us, seed {seed}: {code}, {differing(document)}")
        code, document = judged(["digits=6", "every=5", "with_sizes=0"], time, seed)
        t.check(
            code == 0,
            f"right, six digits, {time} us, seed {seed}: {code}, {document if code == 2 else differing(document)}"
        )
        for options, case in ((["hertz=1"], ()), (["small_balls=2"], SIZES),
                              (["hertz=1", "small_balls=2"], SIZES)):
            code, document = judged(options, time, seed, case)
            t.check(
                code == 0,
                f"right, {options}, {time} us, seed {seed}: {code}, {document if code == 2 else differing(document)}"
            )
        for options, reading in ((["turned_axes=1", "shift_x=0.02"], ("--axes", "x z -y", "--shift",
                                                                      "-20 mm", "0 mm", "0 mm")),
                                 (["length_unit=1000"], ("--units", "mm"))):
            code, document = judged(options, time, seed, reading=reading)
            t.check(
                code == 0,
                f"right, {options}, {time} us, seed {seed}: {code}, {document if code == 2 else differing(document)}"
            )
        for k, (mistake, name) in enumerate(MISTAKES.items()):
            if not ALL and k % 7 != 1:
                continue
            code, document = judged(mistake.split(), time, seed)
            what = f"{mistake}, {time} us, seed {seed}"
            t.check(code == 6, f"{what}: {code}, {document if code == 2 else differing(document)}")
            if code != 6:
                continue
            found = differing(document)
            t.check(any(one in name for one in [*found, *document["causes"]]),
                    f"{what}: {found}, not {name}")
            # Parts of the contacts and pairs differ as all of them do.
            kinds = {name.split()[0], "friction", "stopping"} if "friction" in name else {
                name.split()[0], "factor", "mill.amplitude.y", "velocity"
            } if "amplitude" in mistake else {name.split()[0]}
            kinds |= {"density", "gravity", "diameter", "contacts", "jumps", "displacements"}
            if "restitution" in name:
                kinds |= {"restitution", "spread"}
            kinds |= BESIDE.get(mistake, set())
            t.check({other.split()[0] for other in found} <= kinds, f"{what}: {found}")
print(f"{t.checks} checks of right and wrong DEM codes")
