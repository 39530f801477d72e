#!/usr/bin/env python3
"""Runs with checkpoints and a report that are killed, interrupted and resumed end like an uninterrupted run; so do studies and
reports.

usage: kill_test.py EDMILL [KILLS]    of runs, 12 unless given, and a third of that of studies and of reports each
Moments are drawn with a fixed seed, but the machine's load decides what a moment hits.
"""
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

edmill = os.path.realpath(sys.argv[1])
kills_wanted = int(sys.argv[2]) if len(sys.argv) > 2 else 12
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

scratch = tempfile.mkdtemp(prefix="edmill-kill-")


def folder(name):
    """A run's folder, in which another run has left rows."""
    place = os.path.join(scratch, name)
    os.makedirs(place)
    with open(os.path.join(place, "all_runs.csv"), "w") as out:
        out.write("rows of another run\n")
    return place


def results(place):
    """Every file below `place` with its bytes, but the CPU times of the summary and the page."""
    found = {}
    for root, _, names in os.walk(place):
        for name in names:
            path = os.path.join(root, name)
            with open(path, "rb") as file:
                content = file.read()
            if name == "summary.json":
                summary = json.loads(content)
                for key in ("cpu_seconds", "collisions_per_cpu_second"):
                    del summary[key]
                content = json.dumps(summary).encode()
            if name == "report.html":
                content, times = re.subn(rb">[^<>]+ s for (?=[^<>]+ impacts<)", b">", content)
                check(times == 1, "the page shows the CPU time once")
            found[os.path.relpath(path, place)] = content
    return found


def check(good, what):
    if not good:
        print("failed:", what, "- files are in", scratch)
        sys.exit(1)


def check_same(place, expected, what):
    got = results(place)
    check(sorted(got) == sorted(expected), f"{what}: files {sorted(set(got) ^ set(expected))}")
    for name in expected:
        check(got[name] == expected[name], f"{what}: {name} differs")


def begin(place, interval):
    return [edmill, "run", "case.toml", "--quiet", "--report", "--out", place, "--checkpoint", interval]


def stopped_after(command, seconds, number):
    """Starts the program and sends it a signal; whether it was still running, and its exit code."""
    process = subprocess.Popen(command, cwd=scratch, stderr=subprocess.PIPE)
    try:
        process.wait(seconds)
        running = False
    except subprocess.TimeoutExpired:
        running = True
        process.send_signal(number)
    error = process.communicate()[1].decode()
    # Killed by the signal itself: it came while the initial state was being made.
    check(process.returncode in (0, -number, 128 + number) if number != signal.SIGKILL else
          process.returncode in (0, -number),
          f"exit code {process.returncode}: {error}")
    return running, process.returncode


def checkpoint(place):
    return os.path.join(place, "checkpoint")


def has_ended(place):
    """The run may have ended before the kill."""
    return os.path.exists(os.path.join(place, "summary.json")) and not os.path.exists(checkpoint(place))


with open(os.path.join(scratch, "case.toml"), "w") as out:
    out.write(CASE)

begun = time.monotonic()
reference = folder("reference")
subprocess.run([edmill, "run", "case.toml", "--quiet", "--report", "--out", reference], cwd=scratch, check=True)
whole = time.monotonic() - begun
expected = results(reference)
check(len(expected) > 30 and expected["all_runs.csv"].startswith(b"rows of another run\n"), "the reference run")

# Checkpoints do not change the results.
undisturbed = folder("undisturbed")
subprocess.run(begin(undisturbed, "0.05 s simulated"), cwd=scratch, check=True)
check_same(undisturbed, expected, "a run with checkpoints")

kills = ends = resumed_kills = 0
while kills < kills_wanted:
    place = folder(f"killed-{ends}")
    interval = rng.choice(["0.05 s simulated", "0.2 s simulated", "20 ms"])
    while True:
        goes_on = os.path.exists(checkpoint(place))
        command = [edmill, "resume", place, "--quiet"] if goes_on else begin(place, interval)
        running, code = stopped_after(command, whole * rng.uniform(0.02, 1.2), signal.SIGKILL)
        if running and code == -signal.SIGKILL:
            kills += 1
            resumed_kills += goes_on
        else:
            check(code == 0, f"exit code {code}")
        if has_ended(place):
            break
    check_same(place, expected, f"killed run {ends}")
    shutil.rmtree(place)
    ends += 1
check(resumed_kills > kills_wanted // 4, f"only {resumed_kills} of {kills} kills hit a resumed run")

interrupts = runs = 0
while interrupts < 6:
    number = [signal.SIGINT, signal.SIGTERM][runs % 2]
    place = folder(f"interrupted-{runs}")
    runs += 1
    command = begin(place, "0.4 s simulated")
    while True:
        running, code = stopped_after(command, whole * rng.uniform(0.1, 1.1), number)
        if code == 0:
            break
        if code == 128 + number and os.path.exists(os.path.join(place, "summary.json")):
            summary = json.loads(results(place)["summary.json"])
            check(summary["end_reason"] == "interrupted", summary["end_reason"])
            got = results(place)
            # Whole lines of the undisturbed run, up to the interrupt; nothing yet after another run's rows.
            check(len(got["collisions.csv"]) > 0 and expected["collisions.csv"].startswith(got["collisions.csv"]) and
                  got["collisions.csv"].endswith(b"\n"), "collisions.csv of an interrupted run")
            check(got["collisions.csv"].count(b"\n") == summary["impacts_since_start"] + 1, "rows of an interrupted run")
            check(got["all_runs.csv"] == b"rows of another run\n", "rows of an interrupted run after those of another")
            check({name for name in expected if "snapshot" not in name and not name.startswith("paraview/")} <= set(got),
                  f"missing after an interrupt: {set(expected) - set(got)}")
            interrupts += 1
        if os.path.exists(checkpoint(place)):
            command = [edmill, "resume", place, "--quiet"]
    check_same(place, expected, f"interrupted run {runs}")

# A study that is killed and started again gives the tables of one that was not.
with open(os.path.join(scratch, "study.sweep.toml"), "w") as out:
    out.write("""[sweep]
case = "case.toml"
replicas = 2
[sweep.grid]
"run.end_time" = ["0.4 s", "0.5 s"]
"contact.restitution" = [0.5, 0.6, 0.7]
""")


def study(place):
    return [edmill, "sweep", "study.sweep.toml", "--quiet", "--jobs", "2", "--out", place]


def tables(place):
    return {name: open(os.path.join(scratch, place, name), "rb").read() for name in ("sweep.csv", "runs.csv", "sweep.h5")}


begun_study = time.monotonic()
subprocess.run(study("whole"), cwd=scratch, check=True)
whole_study = time.monotonic() - begun_study
expected_tables = tables("whole")
study_kills = studies = 0
while study_kills < kills_wanted // 3:
    place = f"study-{studies}"
    while True:
        running, code = stopped_after(study(place), whole_study * rng.uniform(0.05, 1.1), signal.SIGKILL)
        study_kills += running and code == -signal.SIGKILL
        if not running:
            break
    check(tables(place) == expected_tables, f"the tables of killed study {studies}")
    shutil.rmtree(os.path.join(scratch, place))
    studies += 1

# A page is the old one or the new one, whole, whenever the program is killed.
page = os.path.join(reference, "report.html")
before = open(page, "rb").read()
report_kills = 0
while report_kills < kills_wanted // 3:
    running, code = stopped_after([edmill, "report", reference, "--quiet"], rng.uniform(0.0, 0.15), signal.SIGKILL)
    report_kills += running and code == -signal.SIGKILL
    check(open(page, "rb").read() == before, "the page after a kill")
check(subprocess.run([edmill, "report", reference, "--quiet"], cwd=scratch).returncode == 0, "the report after kills")
check(results(reference) == expected, "the files of the run after kills of its report")

shutil.rmtree(scratch)
print(f"{kills} kills in {ends} runs, {resumed_kills} of them during a resume, {interrupts} interrupts, "
      f"{study_kills} kills in {studies} studies, {report_kills} kills of reports: "
      f"all ended alike; {time.monotonic() - begun:.0f} s, one run takes {whole:.1f} s")
