#!/usr/bin/env python3
"""Each command of the program does once what it is for: a small run of each, and a fact about its
result.

usage: PYTHONPATH=tests/support python3 commands_test.py EDMILL SMALL_DEM_DUMP
"""
import json
import os
import pathlib
import re
import resource
import subprocess
import sys

from program import EXAMPLES, Trials, case, edmill, results, rows, said, same, summary

SMALL_DEM = os.path.realpath(sys.argv[2])
BOX, TABLE = EXAMPLES / "vibrated_box.toml", EXAMPLES / "oscillating_table.toml"
STATES = ("--set", 'output=[{type="collisions", states=true}]')
SWEEP = '[sweep]\ncase = "case.toml"\n[sweep.grid]\n"contact.restitution" = [0.5, 0.6]\n'
OPTIMIZE = (
    '[optimize]\ncase = "case.toml"\nobjective = "milling_dose_rate"\nruns_max = 4\nreplicas_first = 2\nreplicas_max = 2\npoints = 2\n'
    'refinements = 0\n[[optimize.variable]]\nkey = "contact.restitution"\nlow = 0.4\nhigh = 0.6\n')


def usage(t):
    """The synopsis of the manual has every command with all its options, and no others."""
    page = (EXAMPLES.parent / "usage.md").read_text(encoding="utf-8")
    entries = re.split(r"\n(?=edmill )", re.search(r"```text\n(.*?)```", page, re.S)[1])
    for command in re.findall(r"(?m)^  ([a-z]+) {2,}", said("--help").split("Subcommands:")[1]):
        there = " ".join(entry for entry in entries
                         if command in re.match(r"edmill ([\w| ]*)", entry)[1].split()[::2])
        options = set(re.findall(r"(?m)^  (?:-\w,)?(--[\w-]+)", said(command,
                                                                     "--help"))) - {"--help"}
        t.check(there and options == set(re.findall(r"--[\w-]+", there)),
                f"the synopsis of {command}")


def new(t):
    text = said("new", "--balls", "12x6mm", "--powder", "4 g", "--time", "0.3 s")
    t.check("count = 12" in text, "the balls that are wished for")
    pathlib.Path("new.toml").write_text(text)
    t.check("new.toml is a valid case" in said("check", "new.toml"), "a new case is a case")


def machines(t):
    t.check("\nspex8000m " in said("machines"), "the SPEX 8000M")


def check(t):
    t.check("is a valid case" in said("check", "case.toml", "--draw", "mill.svg"), "a case")
    t.check("<svg" in pathlib.Path("mill.svg").read_text(), "a drawing")
    t.refused(edmill("check", "case.toml", "--set", "contact.restitution=2"), "a wrong number",
              "contact.restitution")


def run(t):
    for name, setting in (("run", "run.seed=5"), ("other", "run.seed=6")):
        said("run", "case.toml", "--quiet", "--out", name, "--set", setting, *STATES)
        found = summary(name)
        t.check(
            len(rows(f"{name}/collisions.csv")) == found["impacts_since_start"] > 100,
            "a line for each impact")
        t.check(found["end_reason"] == "end_time" and found["milling_dose"] > 0, "a run that ends")


def demo(t):
    said("demo", "--quiet", "--out", "demo")
    t.check(
        summary("demo")["end_reason"] == "end_time" and pathlib.Path("demo/report.html").exists(),
        "the demo and its report")


def resume(t):
    """A file size limit ends the run after its first checkpoints."""
    long = ("run", "long.toml", "--quiet")
    said(*long, "--out", "whole")
    edmill(*long, "--out", "parts", "--checkpoint", "0.1 s simulated",
           preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000)), code=1)
    t.check(os.path.exists("parts/checkpoint"), "a checkpoint is left")
    said("resume", "parts", "--quiet")
    t.check(
        same(results("parts"), results("whole")) == [], "a resumed run ends like one that was not")


def report(t):
    said("report", "run", "--quiet")
    said("report", "run", "other", "--quiet", "--out", "both.html")
    rate = f"{summary('run')['milling_dose_rate']:.2g}"
    for page in ("run/report.html", "both.html"):
        t.check(rate in pathlib.Path(page).read_text(), f"the rate {rate} in {page}")


def certify(t):
    said("certify", "case.toml", "--collisions", "5", "--out", "certified.csv")
    pairs = [[sorted((row["ball"], row["partner"])) for row in rows(file)[:5]]
             for file in ("certified.csv", "run/collisions.csv")]
    t.check(pairs[0] == pairs[1] and len(pairs[0]) == 5, f"the first impacts of a run: {pairs}")


def prove(t):
    said("prove", "case.toml", "--collisions", "3", "--out", "proven.csv", "--certificate",
         "certificate")
    for one, other in zip(rows("proven.csv"), rows("certified.csv")):
        t.check(
            abs(float(one["time"]) - float(other["time"])) < 1e-15,
            f"{one['time']} is proven, {other['time']} certified")
    said("prove", "--check", "certificate", "case.toml")
    t.check(
        edmill("prove", "--check", "certificate", "case.toml", "--set",
               "contact.restitution=0.6").returncode == 6, "of another case")


def sensitivity(t):
    said("sensitivity", "case.toml", "--events", "3", "--by", "contact.restitution", "--by",
         "initial.0.vy", "--out", "derivatives.csv")
    found = rows("derivatives.csv")
    t.check(
        len(found) == 3 and float(found[0]["d_time_0"]) == 0,
        "no restitution before the first impact")


def bifurcation(t):
    said("bifurcation", TABLE, "--over", "contact.restitution", "--from", "0.4", "--to", "0.6",
         "--steps", "3", "--skip", "0", "--keep", "1", "--out", "b.svg")
    t.check([float(row["value"]) for row in rows("b.csv")] == [0.4, 0.5, 0.6] and
            "<svg" in pathlib.Path("b.svg").read_text(), "three values")


def sweep(t):
    pathlib.Path("my.sweep.toml").write_text(SWEEP)
    said("sweep", "my.sweep.toml", "--quiet", "--out", "study")
    doses = [float(row["milling_dose_rate [W]"]) for row in rows("study/sweep.csv")]
    t.check(len(doses) == 2 and min(doses) > 0, f"dose rates of two points: {doses}")


def optimize(t):
    pathlib.Path("my.optimize.toml").write_text(OPTIMIZE)
    said("optimize", "my.optimize.toml", "--quiet", "--out", "optimum")
    t.check(
        len(rows("optimum/runs.csv")) == 4 and
        "<svg" in pathlib.Path("optimum/optimize.html").read_text(), "two replicas at two points")


def compare(t):
    said("compare", "run", "run", "--json", "same.json")
    agreeing = json.loads(pathlib.Path("same.json").read_text())["event_by_event"]["agreeing"]
    t.check(agreeing == summary("run")["impacts_since_start"], "a run agrees with itself")
    edmill("compare", "run", "other", "--json", "differ.json")
    t.check(
        json.loads(pathlib.Path("differ.json").read_text())["event_by_event"]["agreeing"] <
        agreeing, "and not with another")


def variables(t):
    t.check("milling_dose" in said("variables"), "the milling dose")


def audit(t):
    said("audit", "case.toml", "run")
    wrong = edmill("audit", "case.toml", "run", "--identify", "--set", "contact.restitution=0.6",
                   code=6)
    t.check("looks like   contact.restitution = 0.53" in wrong.stdout,
            f"another restitution: {wrong.stdout}")


def export(t):
    said("export", BOX, "--to", "lammps", "--out", "decks")
    t.check("timestep" in pathlib.Path("decks/deck.in").read_text(), "a deck")


def import_(t):
    for us in (50, 100):
        with open(f"{us}.dump", "wb") as dump:
            subprocess.run([SMALL_DEM, str(us), "0.5", "100", str(us)], stdout=dump, check=True)
        said("import", f"{us}.dump", "--case", BOX, "--timestep", f"{us // 50} us", "--out",
             f"{us}.csv")
        t.check(len(rows(f"{us}.csv")) > 50, "contacts")


def limit(t):
    done = edmill("limit", "50.csv", "100.csv", "--json", "limit.json")
    t.check(
        done.returncode in (0, 6, 7) and
        json.loads(pathlib.Path("limit.json").read_text())["limit"] > 0, f"a limit: {done.stderr}")


def manual(t):
    t.check(said("manual").startswith(".TH EDMILL 1"), "a manual page")


def completion(t):
    t.check("complete" in said("completion"), "a completion for bash")


def reference(t):
    t.check("`restitution`" in said("reference"), "the keys of cases")


COMMANDS = (new, machines, check, run, demo, resume, report, certify, prove, sensitivity,
            bifurcation, sweep, optimize, compare, variables, audit, export, import_, limit, manual,
            completion, reference)
with Trials() as t:
    pathlib.Path("case.toml").write_text(case(end="0.5 s"))
    pathlib.Path("long.toml").write_text(case("collisions", "events", "trends", end="2 s"))
    names = re.findall(r"^ +([a-z]+) ", said("--help").split("Subcommands:")[1], re.M)
    t.check(
        sorted(names) == sorted(command.__name__.rstrip("_") for command in COMMANDS),
        f"commands are {names}")
    usage(t)
    for command in COMMANDS:
        command(t)
print(f"{len(COMMANDS)} commands, {t.checks} checks")
