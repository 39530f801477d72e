#!/usr/bin/env python3
"""What finite resolution in time does to the dose rate: four cases of the 5 g sample in edmill with larger collapse times,
and in stepped/stepped_mill.cpp with exact search (a control) and with stepped ones.

usage: emulation.py WARD_BATCHES STEPPED_MILL > emulation.csv
"""
import csv
import io
import json
import subprocess
import sys

import intervals
import tables
from ward_runs import CASES

COUNTS = (7, 28, 95, 227)
START, BATCH = 1, 0.5
COLLAPSE_TIMES = ("1e-4", "3e-4", "5e-4", "1e-3", "2e-3")
STEPPED = (  # method of emulation.csv, options of stepped_mill
    ("control", "--search exact --collapse-time 1e-4"),
    ("passed_through", "--search exact --collapse-time 0 --ignore 5e-4"),
    ("lossless_5e-4", "--search exact --collapse-time 1e-4 --smooth-time 5e-4"),
    ("lossless_1e-3", "--search exact --collapse-time 1e-4 --smooth-time 1e-3"),
    ("stepped", "--search stepped --collapse-time 0"),
    ("stepped_put_back", "--search stepped --collapse-time 0 --put-back 1"),
)


def end_of(case):
    """Of a run [s]: many balls settle their own mean and cost more."""
    return START + (20 if case.count < 60 else 5 if case.count < 200 else 3)


def edmill(program, case, collapse_time):
    """@return milling dose and impacts in batches"""
    command = [program, str(CASES / f"{case.name}.toml"), "--batch", str(BATCH)]
    for setting in (f"run.start_time={START} s", f"run.end_time={end_of(case)} s",
                    f"contact.collapse_time={collapse_time} s"):
        command += ["--set", setting]
    batches = json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True).stdout)["batches"]
    columns = [[float(value) for value in text.split()] for text in batches.values()]
    return columns[0], [sum(row) for row in zip(*columns[1:])]


def stepped(program, case, options):
    command = [program, "--balls", str(case.count), "--diameter-mm", case.diameter, "--restitution", case.restitution,
               "--start", str(START), "--end", str(end_of(case)), "--batch", str(BATCH), *options.split()]
    table = csv.DictReader(io.StringIO(subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True).stdout))
    rows = [{key: float(value) for key, value in row.items()} for row in table]
    return ([row["milling_dose"] for row in rows],
            [row["wall_0"] + row["wall_1"] + row["wall_2"] + row["ball_ball"] for row in rows])


def row(case, method, doses, impacts):
    rate = sum(doses) / len(doses) / BATCH
    half = intervals.half_width([dose / BATCH for dose in doses])
    return [case.name, case.count, method, f"{1 / rate:.5g}", f"{half / rate**2:.2g}",
            f"{sum(impacts) / len(impacts) / BATCH:.6g}"]


def study(ward_batches, stepped_mill):
    """@return text of emulation.csv"""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["case", "balls", "method", "inverse_milling_dose_rate", "inverse_milling_dose_rate_ci95",
                     "collision_rate_total"])
    cases = [case for case in tables.cases() if case.powder == "5" and case.count in COUNTS]
    for case in sorted(cases, key=lambda case: case.count):
        for collapse_time in COLLAPSE_TIMES:
            writer.writerow(row(case, f"edmill_t_c_{collapse_time}", *edmill(ward_batches, case, collapse_time)))
        for method, options in STEPPED:
            writer.writerow(row(case, method, *stepped(stepped_mill, case, options)))
    return out.getvalue()


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    print(study(*sys.argv[1:]), end="")
