#!/usr/bin/env python3
"""The effect of finite time resolution on the dose rate, by stepped/stepped_mill.cpp: all cases
with exact search, with a collapse time of 0.5 ms and with impacts within 0.5 ms of the last that
lose nothing; four cases of the 5 g sample also with other collapse times, with edmill's rule (a
control), with losses of quick impacts left out, and with stepped search.

usage: emulation.py STEPPED_MILL FOLDER [JOBS] > emulation.csv    FOLDER keeps what is done
"""
import concurrent.futures
import csv
import io
import json
import pathlib
import subprocess
import sys

import intervals
import tables
import ward_runs

SOURCE = pathlib.Path(__file__).resolve().parent / "stepped" / "stepped_mill.cpp"

COUNTS = (7, 28, 95, 227)
NINE_PERIODS = 9 * 60 / 1054  # of the drive [s]
CONTROL = "--search exact --collapse-time 0 --least-separation 0.01"  # the rule of edmill's cases
COLLAPSE_TIME_OF_ALL = "5e-4"
METHODS = (  # method of emulation.csv, options of stepped_mill
    ("control", CONTROL),
    *((f"t_c_{time}", f"--search exact --collapse-time {time}")
      for time in ("1e-4", "3e-4", COLLAPSE_TIME_OF_ALL, "1e-3", "2e-3")),
    ("passed_through", "--search exact --collapse-time 0 --ignore 5e-4"),
    ("lossless_5e-4", "--search exact --collapse-time 1e-4 --smooth-time 5e-4"),
    ("lossless_1e-3", "--search exact --collapse-time 1e-4 --smooth-time 1e-3"),
    ("stepped", "--search stepped --collapse-time 0"),
    ("stepped_put_back", "--search stepped --collapse-time 0 --put-back 1"),
)
OF_ALL = f"t_c_{COLLAPSE_TIME_OF_ALL}", "lossless_5e-4"
NOT_OF_MANY_BALLS = ("passed_through", "lossless_1e-3", "stepped")  # the program is slow


def times_of(case):
    """Start, end and batch of a run's statistics [s]: the mean over many balls settles quickly, and
    they cost more. Short runs are whole drive periods long, since where in a period they end would
    show."""
    if case.count < 20:
        return 1, 21, 0.5
    if case.count < 60:
        return 1, 1 + 10 * NINE_PERIODS, NINE_PERIODS
    return 0.5, 0.5 + (6 if case.count < 400 else 3) * NINE_PERIODS, NINE_PERIODS


def stepped(program, case, options):
    start, end, batch = map(str, times_of(case))
    command = [
        program, "--balls",
        str(case.count), "--diameter-mm", case.diameter, "--restitution", case.restitution,
        "--start", start, "--end", end, "--batch", batch, *options.split()
    ]
    table = csv.DictReader(
        io.StringIO(subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True).stdout))
    rows = [{key: float(value) for key, value in row.items()} for row in table]
    return ([row["milling_dose"] for row in rows],
            [row["wall_0"] + row["wall_1"] + row["wall_2"] + row["ball_ball"] for row in rows])


def row(case, method, batch, doses, impacts):
    rate = sum(doses) / len(doses) / batch
    half = intervals.half_width([dose / batch for dose in doses])
    return [case.name, case.count, method, f"{1 / rate:.5g}", f"{half / rate**2:.2g}",
            f"{sum(impacts) / len(impacts) / batch:.6g}"]


def plan():
    """All pairs of case and method: (case, method, options)."""
    for case in sorted(tables.cases(), key=lambda case: case.count):
        detailed = case.powder == "5" and case.count in COUNTS
        for method, options in METHODS:
            if method in OF_ALL or (
                    detailed and (case.count < 60 or method not in NOT_OF_MANY_BALLS)):
                yield case, method, options


def study(stepped_mill, folder, jobs=1):
    """Does what is not in FOLDER/emulation.jsonl yet. @return text of emulation.csv"""
    source = ward_runs.sha256(SOURCE)
    cache = pathlib.Path(folder) / "emulation.jsonl"
    cache.parent.mkdir(parents=True, exist_ok=True)
    known = {}
    for line in cache.read_text().splitlines() if cache.exists() else ():
        entry = json.loads(line)
        if entry["source"] == source:
            known[entry["key"]] = entry["row"]
    runs = [(f"{case.name} {case.count} {case.restitution} {method} {options} {times_of(case)}",
             case, method, options) for case, method, options in plan()]
    waiting = [run for run in runs if run[0] not in known]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        done = {pool.submit(stepped, stepped_mill, case, options): (key, case, method)
                for key, case, method, options in waiting}
        for work in concurrent.futures.as_completed(done):
            key, case, method = done[work]
            known[key] = row(case, method, times_of(case)[2], *work.result())
            with open(cache, "a", encoding="utf-8") as file:
                file.write(json.dumps({"key": key, "source": source, "row": known[key]}) + "\n")
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([
        "case", "balls", "method", "inverse_milling_dose_rate", "inverse_milling_dose_rate_ci95",
        "collision_rate_total"
    ])
    writer.writerows(known[run[0]] for run in runs)
    return out.getvalue()


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__.strip())
    print(study(sys.argv[1], sys.argv[2], int((sys.argv[3:] or ["1"])[0])), end="")
