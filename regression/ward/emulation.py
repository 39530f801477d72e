#!/usr/bin/env python3
"""What finite resolution in time does to the dose rate: all cases in edmill with larger collapse times, and four cases of the
5 g sample in stepped/stepped_mill.cpp with exact search (a control) and with stepped ones.

usage: emulation.py WARD_BATCHES STEPPED_MILL FOLDER > emulation.csv    FOLDER keeps what is done
"""
import csv
import io
import json
import pathlib
import subprocess
import sys

import intervals
import tables
import ward_runs
from ward_runs import CASES

SOURCE = pathlib.Path(__file__).resolve().parent / "stepped" / "stepped_mill.cpp"

COUNTS = (7, 28, 95, 227)
NINE_PERIODS = 9 * 60 / 1054  # of the drive [s]
COLLAPSE_TIMES = ("1e-4", "3e-4", "5e-4", "1e-3", "2e-3")
COLLAPSE_TIMES_OF_ALL = ("5e-4",)
STEPPED = (  # method of emulation.csv, options of stepped_mill
    ("control", "--search exact --collapse-time 1e-4"),
    ("passed_through", "--search exact --collapse-time 0 --ignore 5e-4"),
    ("lossless_5e-4", "--search exact --collapse-time 1e-4 --smooth-time 5e-4"),
    ("lossless_1e-3", "--search exact --collapse-time 1e-4 --smooth-time 1e-3"),
    ("stepped", "--search stepped --collapse-time 0"),
    ("stepped_put_back", "--search stepped --collapse-time 0 --put-back 1"),
)
OF_MANY_BALLS = ("control", "lossless_5e-4", "stepped_put_back")  # the plain program is slow


def times_of(case, function):
    """Start, end and batch of a run's statistics [s]: many balls settle their own mean and cost more, in the plain program above
    all. Short runs are whole drive periods long, since where in a period they end would show."""
    if case.count < (20 if function is stepped else 60):
        return 1, 21, 0.5
    if function is stepped:
        return (1, 1 + 10 * NINE_PERIODS, NINE_PERIODS) if case.count < 60 else (0.5, 0.5 + 3 * NINE_PERIODS, NINE_PERIODS)
    return 1, 1 + (10 if case.count < 200 else 4) * NINE_PERIODS, NINE_PERIODS


def edmill(program, case, collapse_time):
    """@return milling dose and impacts in batches"""
    start, end, batch = times_of(case, edmill)
    command = [program, str(CASES / f"{case.name}.toml"), "--batch", str(batch)]
    for setting in (f"run.start_time={start} s", f"run.end_time={end} s",
                    f"contact.collapse_time={collapse_time} s"):
        command += ["--set", setting]
    batches = json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True).stdout)["batches"]
    columns = [[float(value) for value in text.split()] for text in batches.values()]
    return columns[0], [sum(row) for row in zip(*columns[1:])]


def stepped(program, case, options):
    start, end, batch = map(str, times_of(case, stepped))
    command = [program, "--balls", str(case.count), "--diameter-mm", case.diameter, "--restitution", case.restitution,
               "--start", start, "--end", end, "--batch", batch, *options.split()]
    table = csv.DictReader(io.StringIO(subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True).stdout))
    rows = [{key: float(value) for key, value in row.items()} for row in table]
    return ([row["milling_dose"] for row in rows],
            [row["wall_0"] + row["wall_1"] + row["wall_2"] + row["ball_ball"] for row in rows])


def row(case, method, batch, doses, impacts):
    rate = sum(doses) / len(doses) / batch
    half = intervals.half_width([dose / batch for dose in doses])
    return [case.name, case.count, method, f"{1 / rate:.5g}", f"{half / rate**2:.2g}",
            f"{sum(impacts) / len(impacts) / batch:.6g}"]


def plan():
    """All pairs of case and method, with the function that does them: (case, method, function, its last argument)."""
    for case in sorted(tables.cases(), key=lambda case: case.count):
        detailed = case.powder == "5" and case.count in COUNTS
        for collapse_time in COLLAPSE_TIMES if detailed else COLLAPSE_TIMES_OF_ALL:
            yield case, f"edmill_t_c_{collapse_time}", edmill, collapse_time
        for method, options in STEPPED if detailed else ():
            if case.count < 60 or method in OF_MANY_BALLS:
                yield case, method, stepped, options


def study(ward_batches, stepped_mill, folder):
    """Does what is not in FOLDER/emulation.jsonl yet. @return text of emulation.csv"""
    commit, source = ward_runs.commit_of(ward_batches), ward_runs.sha256(SOURCE)
    cache = pathlib.Path(folder) / "emulation.jsonl"
    cache.parent.mkdir(parents=True, exist_ok=True)
    known = {}
    for line in cache.read_text().splitlines() if cache.exists() else ():
        entry = json.loads(line)
        if entry["source"] == source and ward_runs.same_core(entry["commit"], commit):
            known[entry["key"]] = entry["row"]
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["case", "balls", "method", "inverse_milling_dose_rate", "inverse_milling_dose_rate_ci95",
                     "collision_rate_total"])
    for case, method, function, how in plan():
        key = f"{case.name} {method} {how} {times_of(case, function)[1]} {ward_runs.sha256(CASES / f'{case.name}.toml')}"
        if key not in known:
            program = ward_batches if function is edmill else stepped_mill
            known[key] = row(case, method, times_of(case, function)[2], *function(program, case, how))
            with open(cache, "a", encoding="utf-8") as file:
                file.write(json.dumps({"key": key, "commit": commit, "source": source, "row": known[key]}) + "\n")
        writer.writerow(known[key])
    return out.getvalue()


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__.strip())
    print(study(*sys.argv[1:]), end="")
