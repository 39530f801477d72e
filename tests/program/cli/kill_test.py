#!/usr/bin/env python3
"""Runs with checkpoints and a report that are killed, interrupted and resumed end like an
uninterrupted run; so do studies and reports.

usage: PYTHONPATH=tests/support python3 kill_test.py EDMILL [KILLS]    of runs (default: 6), and a
    third of that of studies and of reports each
Moments are drawn with a fixed seed, but the machine's load decides what a moment hits.
"""
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

from program import Trials, edmill, results, same, start, summary

kills_wanted = int(sys.argv[2]) if len(sys.argv) > 2 else 6
rng = random.Random(20110101)

CASE = """
[run]
start_time = "0.3 s"
end_time = "2.5 s"
gravity = "9.8 m/s2"
[mill]
speed = "1054 rpm"
[vessel]
diameter = "38 mm"
height = "57 mm"
[powder]
mass = "5 g"
[contact]
restitution = 0.53
friction = 0.4
[[balls]]
count = 28
diameter = "4.76 mm"
[[output]]
type = "collisions"
states = true
[[output]]
type = "collisions"
file = "all_runs.csv"
append = true
only = { ball = 3 }
[[output]]
type = "events"
[[output]]
type = "events"
file = "states.h5"
folder = "deeper/still"
states = true
only = { ball_ball = true }
[[output]]
type = "milling_dose"
[[output]]
type = "statistics"
start_time = "0.4 s"
columns = [{ variable = "milling_dose", statistics = ["sum", "average", "minimum", "maximum", "rate"] }]
[[output]]
type = "frequency"
variable = "relative_normal_speed_before"
low = "0 m/s"
high = "5 m/s"
intervals = 20
wall_details = true
[[output]]
type = "trends"
interval = "0.1 s"
columns = [{ variable = "milling_dose", statistics = ["sum", "average"] }]
[[output]]
type = "trends"
file = "trends_accumulated.csv"
interval = "0.1 s"
accumulated = true
columns = [{ variable = "wall_work", statistics = ["sum"] }]
[[output]]
type = "trends_instant"
interval = "0.05 s"
columns = [{ variable = "time" }, { variable = "ball" }]
[[output]]
type = "trends_balls"
interval = "0.1 s"
columns = [{ variable = "speed", statistics = ["average", "maximum"], with_ball = true }]
[[output]]
type = "trace"
ball = 5
[[output]]
type = "iterations"
start_collision = 20000
collisions = 500
[[output]]
type = "snapshot"
start_collision = 10000
collisions = 3
contact_point = { radius = "1 mm" }
[[output]]
type = "animation"
start_time = "1 s"
end_time = "1.05 s"
speed = 0.01
contact_point = { radius = "1 mm" }
[[output]]
type = "paraview"
interval = "0.2 s"
[[output]]
type = "spectra"
[[output]]
type = "spectra"
file = "speeds.h5"
of = "speed"
[[output]]
type = "rates_above"
[[output]]
type = "vessel_load"
interval = "0.1 s"
[[output]]
type = "coverage"
[[output]]
type = "bodies"
[[output]]
type = "trends"
file = "trends.h5"
interval = "0.05 s"
columns = [{ variable = "milling_dose", statistics = ["rate"] }]
"""


def folder(name):
    """A run's folder, in which another run has left rows."""
    os.mkdir(name)
    pathlib.Path(name, "all_runs.csv").write_text("rows of another run\n")
    return name


def check_same(place, what, interrupted=False):
    found = results(place, without=())
    # An interrupt while a run at its end seeks what decides the dose rate leaves that out.
    left_out = (".edmill-files", "check.txt",
                "report.html") if interrupted and not is_there(place, "check.txt") else ()
    differences = [name for name in same(found, expected) if name not in left_out]
    t.check(differences == [], f"{what}: {differences}")


def begin(place, interval):
    return ["run", "case.toml", "--quiet", "--report", "--out", place, "--checkpoint", interval]


def stopped_after(arguments, seconds, number):
    """Starts the program and sends it a signal; whether it was still running, and its exit code."""
    process = start(*arguments, stderr=subprocess.PIPE, text=True)
    try:
        process.wait(seconds)
        running = False
    except subprocess.TimeoutExpired:
        running = True
        process.send_signal(number)
    error = process.communicate()[1]
    # Killed by the signal itself: it came while the initial state was being made.
    t.check(
        process.returncode in ((0, -number) if number == signal.SIGKILL else
                               (0, -number, 128 + number)),
        f"exit code {process.returncode}: {error}")
    return running, process.returncode


def is_there(place, name):
    return os.path.exists(os.path.join(place, name))


def kills_of_runs():
    kills = ends = resumed_kills = 0
    while kills < kills_wanted:
        place = folder(f"killed-{ends}")
        interval = rng.choice(["0.05 s simulated", "0.2 s simulated", "20 ms"])
        while True:
            goes_on = is_there(place, "checkpoint")
            arguments = ["resume", place, "--quiet"] if goes_on else begin(place, interval)
            running, code = stopped_after(arguments, whole * rng.uniform(0.02, 1.2), signal.SIGKILL)
            if running and code == -signal.SIGKILL:
                kills += 1
                resumed_kills += goes_on
            else:
                t.check(code == 0, f"exit code {code}")
            # The run may have ended before the kill.
            if is_there(place, "summary.json") and not is_there(place, "checkpoint"):
                break
        check_same(place, f"killed run {ends}")
        shutil.rmtree(place)
        ends += 1
    t.check(resumed_kills > kills_wanted // 4,
            f"only {resumed_kills} of {kills} kills hit a resumed run")
    print(f"{kills} kills in {ends} runs, {resumed_kills} of them during a resume: all ended alike")


def interrupts_of_runs():
    interrupts = runs = 0
    while interrupts < max(4, kills_wanted // 2):
        number = [signal.SIGINT, signal.SIGTERM][runs % 2]
        place = folder(f"interrupted-{runs}")
        runs += 1
        arguments = begin(place, "0.4 s simulated")
        while True:
            running, code = stopped_after(arguments, whole * rng.uniform(0.1, 1.1), number)
            if code == 0:
                break
            if code == 128 + number and is_there(place, "summary.json"):
                said, found = summary(place), results(place, without=())
                t.check(said["end_reason"] == "interrupted", said["end_reason"])
                # Whole lines of the undisturbed run, up to the interrupt; nothing yet after another
                # run's rows.
                log = found["collisions.csv"]
                t.check(
                    len(log) > 0 and expected["collisions.csv"].startswith(log) and
                    log.endswith(b"\n"), "collisions.csv of an interrupted run")
                t.check(
                    log.count(b"\n") == said["impacts_since_start"] + 1,
                    "rows of an interrupted run")
                t.check(found["all_runs.csv"] == b"rows of another run\n",
                        "rows of an interrupted run after those of another")
                later = "snapshot", "paraview/", "check.txt"  # what decides the dose rate is for runs that reach their end
                t.check({name for name in expected if not name.startswith(later)} <= set(found),
                        f"missing after an interrupt: {set(expected) - set(found)}")
                interrupts += 1
            if is_there(place, "checkpoint"):
                arguments = ["resume", place, "--quiet"]
        check_same(place, f"interrupted run {runs}", interrupted=True)
    print(f"{interrupts} interrupts in {runs} runs")


def kills_of_studies():
    """A study that is killed and started again gives the tables of one that was not."""
    pathlib.Path("study.sweep.toml").write_text("""[sweep]
case = "case.toml"
replicas = 2
[sweep.grid]
"run.end_time" = ["0.4 s", "0.5 s"]
"contact.restitution" = [0.5, 0.6, 0.7]
""")

    def study(place):
        return ["sweep", "study.sweep.toml", "--quiet", "--jobs", "2", "--out", place]

    def tables(place):
        return {
            name: pathlib.Path(place, name).read_bytes()
            for name in ("sweep.csv", "runs.csv", "sweep.h5")
        }

    begun = time.monotonic()
    edmill(*study("whole"), code=0)
    seconds = time.monotonic() - begun
    expected_tables = tables("whole")
    kills = studies = 0
    while kills < kills_wanted // 3:
        place = f"study-{studies}"
        running = True
        while running:
            running, code = stopped_after(study(place), seconds * rng.uniform(0.05, 1.1),
                                          signal.SIGKILL)
            kills += running and code == -signal.SIGKILL
        t.check(tables(place) == expected_tables, f"the tables of killed study {studies}")
        shutil.rmtree(place)
        studies += 1
    print(f"{kills} kills in {studies} studies")


def kills_of_reports():
    """A page is the old one or the new one, whole, whenever the program is killed."""
    page = pathlib.Path("reference/report.html")
    before = page.read_bytes()
    kills = 0
    while kills < kills_wanted // 3:
        running, code = stopped_after(["report", "reference", "--quiet"], rng.uniform(0.0, 0.15),
                                      signal.SIGKILL)
        kills += running and code == -signal.SIGKILL
        t.check(page.read_bytes() == before, "the page after a kill")
    edmill("report", "reference", "--quiet", code=0)
    check_same("reference", "the files of the run after kills of its report")
    print(f"{kills} kills of reports")


with Trials() as t:
    pathlib.Path("case.toml").write_text(CASE)
    begun = time.monotonic()
    edmill("run", "case.toml", "--quiet", "--report", "--out", folder("reference"), code=0)
    whole = time.monotonic() - begun
    expected = results("reference", without=())
    t.check(
        len(expected) > 30 and expected["all_runs.csv"].startswith(b"rows of another run\n"),
        "the reference run")
    # Checkpoints do not change the results.
    edmill(*begin(folder("undisturbed"), "0.05 s simulated"), code=0)
    check_same("undisturbed", "a run with checkpoints")
    for part in (kills_of_runs, interrupts_of_runs, kills_of_studies, kills_of_reports):
        part()
    print(f"one run takes {whole:.1f} s")
