#!/usr/bin/env python3
"""`edmill audit --identify` on logs of plain_mill, which shares no code with edmill, with mistakes
planted in its equations, in some of its impacts, and in the columns of its log: each is named with
its value, and nothing else is.

usage: PYTHONPATH=tests/support python3 faults_test.py EDMILL PLAIN_MILL [--every K] [--thin K]
    [--clean N]     K: one in K faults, for a quick run
"""
import argparse
import csv
import json
import os
import pathlib
import random
import subprocess
import sys

from program import Trials, edmill, rows, sets

PLAIN_MILL = os.path.realpath(sys.argv[2])
CASE = '''[run]
end_time = "100 s"
gravity = "9.8 m/s2"
seed = {}
[mill]
type = "spex8000"
speed = "1054 rpm"
[vessel]
type = "cylinder"
diameter = "38 mm"
height = "57 mm"
[contact]
restitution = 0.53
friction = 0.4
min_tangential = -0.8
least_separation = "10 mm/s"
[[balls]]
count = 8
diameter = "6 mm"
density = "8 g/cm3"
'''
PLAIN = "--scalar float128 --rpm 1054 --restitution 0.53 --ball-diameter 0.006 --min-tangential -0.8 --states 1".split(
)
#: Terms of plain_mill by the names of edmill.
NAMES = {
    "torque": "torque of the friction", "torque_of_partner": "torque of the friction",
    "friction_impulse": "impulse of the friction",
    "friction_on_velocity": "change of the velocity by the friction",
    "arm": "lever arm R in the velocity of the contact point",
    "wall_velocity": "velocity of the wall", "wall_delay": "delay of the wall's velocity",
    "c_in_limit": "c - 1 in the limit of sliding",
    "c_in_impulse": "c - 1 in the impulse of the friction", "share": "share M/m of the impulse",
    "gravity": "gravity in flights", "gravity_in_places": "gravity in the places of flights",
    "gravity_in_velocities": "gravity in the velocities of flights",
    "dose": "dose, column milling_dose", "spin_in_dose": "energy of the spin in the dose",
    "work_in_dose": "work of the wall in the dose", "supply_in_dose": "supplied energy in the dose",
    "wall_work": "work of the wall, column wall_work", "approach_speed": "column approach_speed",
    "slip_speed": "column slip_speed", "restitution": "contact.restitution",
    "contact_gap": "gap at which bodies meet",
    "gamma_phase": "mill, phase of joint 2, a swing about x",
    "constant_e_t": 'contact, law "constant": restitution_tangential',
    "friction": "contact.friction", "least_separation": "contact.least_separation",
    "min_tangential": "contact.min_tangential"
}
PLACES = {
    "all": "", "wall0": ", at the cap at -y", "wall1": ", at the cap at +y",
    "wall2": ", at the cylinder", "ball": ", between balls", "wall": ", with walls",
    "slide": ", where contacts slide", "ball0": ", in impacts of ball 0",
    "ball3": ", in impacts of ball 3"
}
FAULTS = [
    line.split() for line in '''
torque -1 all|torque 0 all|torque 2 all|torque -1 wall0|torque -1 wall2|torque 2 ball|torque -1 wall|torque -1 ball3|torque 0 slide
torque_of_partner -1 ball|torque_of_partner 0 ball|friction_impulse 2 ball|friction_impulse 0 all|friction_impulse -1 all
friction_impulse 0.5 wall|friction_on_velocity -1 all|friction_on_velocity 0 wall2|arm 0 all|arm -1 all|arm 2 all|arm 0 ball
wall_velocity 0 all|wall_velocity -1 all|wall_velocity 0 wall0|wall_velocity 1.05 all|wall_delay 1e-4 all|wall_delay -5e-5 all
c_in_limit 0 all|c_in_impulse 0.5 all|c_in_impulse 2 wall|share 2 ball|restitution 0.6 all|restitution 0.6 wall0|restitution 0.7 ball
restitution 0.5 ball3|restitution 0 all|restitution 1 wall|friction 0.3 all|friction 0.8 wall2|friction 0 all|friction 0.1 wall1
least_separation 0.02 all|least_separation 0 all|least_separation 0.1 ball|min_tangential -1 all|min_tangential 0 wall|gravity 0 all
gravity 0 ball0|gravity 2 all|gravity -1 all|gravity_in_places 0 all|gravity_in_velocities 0 all|gravity_in_places 2 ball0|dose 2 all
dose 0.5 ball|spin_in_dose 0 all|work_in_dose 0 wall|supply_in_dose 0 all|wall_work -1 all|wall_work 0.5 wall2|approach_speed -1 all
approach_speed 2 ball|slip_speed 0.5 all|contact_gap 5e-5 wall1|contact_gap -3e-5 wall2|contact_gap 2e-5 ball|contact_gap -1e-4 wall0
gamma_phase 0.05 all|gamma_phase 1.5707963 all|constant_e_t 0.3 all|constant_e_t -0.5 ball|constant_e_t 0.5 wall'''
    .strip().replace("\n", "|").split("|")
]
PAIRS = [
    line.split() for line in '''
torque,dose -1,2 all,all|restitution,friction 0.6,0.3 all,all|torque,restitution 2,0.6 all,all|gravity,wall_work 0,-1 all,all
friction_impulse,slip_speed 2,0.5 ball,all|restitution,gravity 0.6,2 wall0,all|arm,dose 0,0.5 all,ball|torque,torque -1,2 wall0,ball
restitution,friction 0.7,0.2 ball,wall|wall_delay,friction 1e-4,0.3 all,all|restitution,arm 0.6,2 wall,all
friction,torque_of_partner 0.3,-1 all,ball|dose,slip_speed 2,0.5 ball,all|gravity_in_velocities,restitution 0,0.5 all,ball
c_in_limit,approach_speed 0,2 all,all|least_separation,wall_work 0.02,-1 all,all|torque,friction_impulse 0,2 all,wall
supply_in_dose,arm 0,-1 all,all|friction,friction 0.3,0.2 wall2,ball|gravity,torque 2,-1 ball0,all
contact_gap,restitution 5e-5,0.6 wall1,all|gamma_phase,friction 0.05,0.3 all,all|constant_e_t,dose 0.3,2 all,ball
contact_gap,wall_work 2e-5,-1 ball,all|constant_e_t,gravity 0.3,0 ball,all'''.strip().replace(
        "\n", "|").split("|")
]
THREES = [
    line.split() for line in '''
torque,dose,approach_speed -1,2,2 all,all,all|restitution,friction,wall_work 0.6,0.3,-1 all,all,all
arm,gravity,slip_speed 0,2,0.5 all,all,all|restitution,friction,dose 0.7,0.2,0.5 ball,wall,all'''.
    strip().replace("\n", "|").split("|")
]
#: The same in other words: both hold of such a log.
SAME = {
    "friction 0 all": "impulse of the friction", "wall_velocity 0 all": "a wall at rest",
    "contact_gap -3e-5 wall2": "vessel.diameter",
    "wall_velocity -1 all": "the wall's velocity with the opposite sign"
}
failures = []


def key_of(term, place):
    """The name that edmill gives to a fault."""
    name = NAMES[term]
    if name.startswith("contact") and place in ("ball", "wall"):
        return name.replace("contact", f"contact.ball_{place}", 1)
    if term == "torque_of_partner":
        return name + ", on the partner"
    if term.startswith("gravity") and place.startswith("ball"):
        return f"{name}, on ball {place[4:]}"
    if term in ("work_in_dose", "wall_work") and place == "wall":
        return name  # walls alone do work
    return name + PLACES[place]


def start(seed):
    """A case and the states of its balls after a microsecond, in which nothing happens."""
    pathlib.Path("case.toml").write_text(CASE.format(seed))
    edmill("run", "case.toml", "--precision", "mpfr100", "--quiet", "--out", "start",
           *sets('run.start_time="0 s"', 'run.end_time="1 us"'), code=0)


def log(fault="none", value="1", place="all", events=1500):
    done = subprocess.run([
        PLAIN_MILL, "start/final_state.csv",
        str(events), *PLAIN, "--fault", fault, "--fault-value", value, "--where", place
    ], capture_output=True, text=True, check=True)
    pathlib.Path("log.csv").write_text(done.stdout)
    return rows("log.csv")


def write(lines):
    with open("log.csv", "w", newline="") as out:
        writer = csv.DictWriter(out, lines[0])
        writer.writeheader()
        writer.writerows(lines)


def identified(*options):
    done = edmill("audit", "case.toml", "log.csv", *options, "--quiet", "--json", "found.json")
    if done.returncode not in (0, 6):
        sys.exit(done.stderr)
    return json.loads(pathlib.Path("found.json").read_text()).get(
        "identified", {"causes": {}, "time_stepping": {}})


def causes_found():
    """The causes, and what is said of the first."""
    causes = identified("--identify")["causes"]
    return causes, causes["1"]["text"] if causes else "no cause"


def check(good, name, text):
    print(f"{'ok     ' if good else 'FAILED '} {name}: {text}", flush=True)
    if not good:
        failures.append(name)


def named(causes, wanted):
    """Whether the first cause is what is wanted, {key: value}, each value within its interval, or
    the log cannot tell it from that."""
    if not causes:
        return False
    first = causes["1"]
    if set(first["values"]) == set(wanted):
        return all(
            abs(first["values"][key]["value"] - value) <= first["values"][key]["half_width"]
            for key, value in wanted.items())
    return any(all(key in text for key in wanted) for text in first["alike"].values())


#: A number of the case that says the same as a term, or half of what a number of both kinds of
#contact says.
INSTEAD = {
    "gravity in flights": ("run.gravity", 9.8),
    "contact.friction": ("contact.ball_ball.friction", 1),
    "c - 1 in the limit of sliding": ("contact.friction", None)
}


def false_names(wanted):
    """Of the single causes that the audit names without a search for several those that are not
    wanted, {key: value}."""
    values = dict(wanted)
    for key, value in wanted.items():
        other, factor = INSTEAD.get(key, (key, 1))
        values[other] = None if factor is None else factor * value

    def is_wanted(cause):
        return all(key in values and (
            values[key] is None or abs(found["value"] - values[key]) <= found["half_width"] + 1e-12)
                   for key, found in cause["values"].items())

    return [
        cause["text"] for cause in identified()["causes"].values()
        if cause["mistakes"] or not is_wanted(cause)
    ]


def columns(rows, change):
    """A log with other columns: change(vector's name, its three numbers) of each vector."""
    changed = [dict(row) for row in rows]
    for row in changed:
        for body in ("", "partner_"):
            if row[body + "x"] == "":
                continue
            for name, keys in {
                    "place": [body + a for a in "xyz"], **{
                        f"{q} {when}": [f"{body}{q}{a}_{when}" for a in "xyz"] for q in "vw" for when in ("before", "after")
                    }
            }.items():
                for key, number in zip(keys, change(name, [float(row[key]) for key in keys])):
                    row[key] = repr(number)
    return changed


def without(rows, gone):
    return [{key: value for key, value in row.items() if not gone(key)} for row in rows]


SUMS = ("approach_speed", "slip_speed", "milling_dose", "wall_work")
#: Logs that begin late or have few columns.
THIN = {
    "late": lambda rows: rows[2 * len(rows) // 5:],
    "states alone": lambda rows: without(rows, lambda key: key in SUMS),
    "the ball alone": lambda rows: without(
        rows, lambda key: key.startswith("partner_") and key != "partner_kind")
}
#: What such a log cannot show: terms of columns that it lacks, and what concerns pairs of balls
#where only one is known.
OF_SUMS = {
    "dose", "spin_in_dose", "work_in_dose", "supply_in_dose", "wall_work", "approach_speed",
    "slip_speed"
}


def is_hidden(term, place, thin):
    return (thin == "states alone" and term in OF_SUMS) or (thin == "the ball alone" and
                                                            (place == "ball" or term in OF_SUMS))


COLUMNS = {
    "y and z exchanged, z reversed":
        (lambda name, v: [v[0], v[2], -v[1]], "the log's vectors: x, -z, y"),
    "velocities with y and z exchanged":
        (lambda name, v: [v[0], v[2], v[1]]
         if name[0] == "v" else v, "the log's velocities: x, z, y"), "spins reversed":
             (lambda name, v: [-a for a in v]
              if name[0] == "w" else v, "the log's spins: -x, -y, -z"),
    "places with x reversed": (lambda name, v: [-v[0], v[1], v[2]]
                               if name == "place" else v, "the log's positions: -x, y, z"),
    "places in mm": (lambda name, v: [1e3 * a for a in v]
                     if name == "place" else v, "the log's positions: in mm")
}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("edmill")
    parser.add_argument("plain_mill")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--thin", type=int, default=1,
                        help="one in so many of the logs that begin late or have few columns")
    parser.add_argument("--clean", type=int, default=2,
                        help="logs without a fault, and as many that are rounded")
    args = parser.parse_args()
    start(1)
    for term, value, place in FAULTS[::args.every]:
        log(term, value, place)
        causes, text = causes_found()
        other = SAME.get(f"{term} {value} {place}")
        good = named(causes, {key_of(term, place): float(value)}) or (other is not None and
                                                                      other in text)
        check(good, f"{term} {value} {place}", text)
    for k, (term, value, place) in list(enumerate(FAULTS))[::args.thin]:
        thin = list(THIN)[k % len(THIN)]
        write(THIN[thin](log(term, value, place)))
        causes, text = causes_found()
        # A log in which nothing happens elsewhere says nothing of where a fault is.
        keys = {key_of(term, place), NAMES[term]}
        good = any(named(causes, {key: float(value)}) for key in keys) or SAME.get(
            f"{term} {value} {place}", "?") in text
        check(good or (not causes and is_hidden(term, place, thin)),
              f"{thin}: {term} {value} {place}", text)
    for terms, values, places in (PAIRS + THREES if args.every == 1 else PAIRS[::2 * args.every]):
        log(terms, values, places)
        causes, text = causes_found()
        wanted = {
            key_of(*pair): float(value)
            for value, *pair in zip(values.split(","), terms.split(","), places.split(","))
        }
        check(named(causes, wanted), f"{terms} {values} {places}", text)
        check(not (false := false_names(wanted)), f"{terms} {values} {places}, one by one",
              "; ".join(false) or "no false name")
    lines = log()
    for fault, (change, wanted) in COLUMNS.items():
        write(columns(lines, change))
        text = causes_found()[1]
        check(text.startswith(wanted), fault, text)
    numbers = random.Random(20261126)
    print("seed of the rounding and of the times: 20261126")
    for off in (1e-8, 1e-6)[: 2 if args.every == 1 else 1]:
        write([{**row, "time": repr(float(row["time"]) + numbers.gauss(0, off))} for row in lines])
        found = identified("--identify")
        jitter = found["time_stepping"].get("jitter", 0)
        check(not found["causes"] and abs(jitter / off - 1) < 0.15, f"times off by {off} s",
              f"{jitter} s")
    for seed in range(2, 2 + args.clean):
        start(seed)
        lines = log()
        causes, text = causes_found()
        check(not causes, f"clean, seed {seed}", text)
        digits = numbers.choice([6, 8, 10, 12])
        write([{
            key: f"{float(value):.{digits}g}"
            if value and key not in ("index", "ball", "partner", "partner_kind") else value
            for key, value in row.items()
        } for row in lines])
        causes, text = causes_found()
        check(not causes, f"rounded to {digits} digits, seed {seed}", text)
    print(f"{len(failures)} failed")
    if failures:
        sys.exit(1)


if __name__ == "__main__":
    with Trials():
        main()
