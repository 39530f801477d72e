#!/usr/bin/env python3
"""Certified sequences of edmill against plain_mill: the same events, every value to 25 digits.

usage: PYTHONPATH=tests/support python3 plain_mill_test.py EDMILL PLAIN_MILL [--digits N] [--events
    N]
"""
import argparse
import csv
import os
import subprocess
import sys
from decimal import Decimal

from program import EXAMPLES, Trials, edmill

PLAIN_MILL = os.path.realpath(sys.argv[2])
NAMES = ("index", "ball", "partner_kind", "partner")
VALUES = ("time", "approach_speed", "slip_speed", "milling_dose", "wall_work")
DEMO = "--rpm 1054 --restitution 0.53 --ball-diameter 0.00476".split()
THESIS = "--rpm 1054 --restitution 0.5 --ball-diameter 0.00952".split()
CASES = (  # name, case, changes, events, plain_mill's options
    ("one ball", "thesis_chapter4_ball.toml", [], 300, THESIS),
    ("three balls", "demo.toml", ["--set", "balls.0.count=3"], 300, DEMO),
    ("28 balls", "demo.toml", [], None, DEMO),
)


def table(lines):
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    for row in rows:
        row.update((name, Decimal(row[name])) for name in VALUES)
    return rows


def contents(rows, restitution):
    """What the sequence exercises; slow: left at the least separation speed."""
    count = {"caps": 0, "cylinder": 0, "ball": 0, "slow": 0}
    for row in rows:
        count["ball" if row["partner_kind"] == "ball" else "cylinder" if row["partner"] ==
              "2" else "caps"] += 1
        count["slow"] += Decimal(restitution) * row["approach_speed"] < Decimal("0.01")
    return ", ".join(f"{number} {name}" for name, number in count.items())


def compare(reference, rows, limit):
    """Events in common, events before the first value beyond the limit, worst difference of the
    events in common."""
    largest = {name: max(abs(row[name]) for row in reference) for name in VALUES}
    common, good, worst = 0, None, (Decimal(0), "")
    for wanted, row in zip(reference, rows):
        if any(wanted[name] != row[name] for name in NAMES):
            break
        off = max(
            (abs(wanted[name] - row[name]) / largest[name] if largest[name] else abs(row[name]),
             name) for name in VALUES)
        worst = max(worst, off)
        if off[0] > limit and good is None:
            good = common
        common += 1
    return common, common if good is None else good, worst


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("edmill")
    parser.add_argument("plain_mill")
    parser.add_argument("--digits", type=int, default=25)
    parser.add_argument("--events", type=int, default=1500, help="of the 28 balls")
    args = parser.parse_args()
    limit = Decimal(10) ** -args.digits
    failures = 0
    with Trials():
        for name, case, changes, events, options in CASES:
            events = events or args.events

            def plain(*more):
                command = [PLAIN_MILL, "out/final_state.csv", str(events), *options, *more]
                return table(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
                             .stdout.splitlines())

            # The balls fly freely for the first microsecond; its end is written with all digits.
            edmill("run", EXAMPLES / case, "--precision", "mpfr100", "--set",
                   'run.start_time="0 s"', "--set", 'run.end_time="1 us"', "--out", "out", *changes,
                   code=0)
            edmill("certify", EXAMPLES / case, "--collisions", events, "--digits", args.digits,
                   "--out", "reference.csv", *changes, code=0)
            with open("reference.csv", encoding="utf-8") as file:
                reference = table(file)
            if len(reference) != events:
                sys.exit(f"{name}: {len(reference)} certified events, not {events}")

            common, good, (worst, value) = compare(reference, plain(), limit)
            print(
                f"{name} ({contents(reference, options[3])}): {common} of {events} events the same, {good} of them to "
                f"{args.digits} digits, worst {worst:.1e} ({value})")
            if good < events:
                failures += 1
                if common < events:
                    print("  parted at", dict(reference[common]))
            common, good, (worst, value) = compare(reference, plain("--scalar", "float128"), limit)
            print(f"  float128: {common} events the same, {good} of them to {args.digits} digits")
            # The comparison can fail.
            good = compare(reference, plain("--friction", "0.41"), limit)[1]
            print(f"  with friction 0.41: {good} events")
            failures += good == events
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
