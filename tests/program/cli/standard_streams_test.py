#!/usr/bin/env python3
"""Standard streams that are full or closed, and pipes that nobody reads: exit codes, messages and
files.

usage: PYTHONPATH=tests/support python3 standard_streams_test.py EDMILL
"""
import os
import pathlib

from program import Trials, case, edmill, results, same, shell

PRINTING = [
    "--help", "--version", "run --help", "check case.toml", "reference", "manual", "completion",
    "variables", "compare done done", "audit case.toml done", "run case.toml --out out",
    "report done", "sweep my.sweep.toml --out study",
    "certify case.toml --collisions 3 --out events.csv", "prove case.toml --collisions 3",
    "demo --out demo", "run case.toml --out out --shadow float128"
]
FAILING = {
    "run absent.toml": 2, "check": 2, "nothing": 2, "compare done absent": 2, "resume done": 2,
    "report absent": 2, "prove tangent.toml --collisions 1": 4, "run case.toml --out /proc/x": 2,
    "compare done done --quiet --json /dev/full": 1
}
# The path touches the cap at its highest point: no enclosure decides it.
TANGENT = """[run]
end_time = "1 s"
gravity = ["-8", "0", "0"]
[mill]
type = "still"
[vessel]
diameter = "1 m"
height = "1 m"
[contact]
restitution = 1
friction = 0
[[ball]]
diameter = "0.25 m"
position = [0.37493896484375, "0", "0"]
velocity = ["0.03125", "0", "0"]
"""


def output(t):
    for command in PRINTING:
        if command.startswith("demo") and os.path.exists("demo"):
            continue
        plain = shell(f"edmill {command}")
        t.check(plain.returncode == 0 and plain.stdout and not plain.stderr,
                f"{command}: {plain.stderr}")
        for place, words in ((">/dev/full", "No space left"), (">&-", "it is closed"),
                             ("<&- >&-", "it is closed")):
            done = shell(f"edmill {command} {place}")
            t.refused(done, f"{command} {place}", "standard output could not be written", words,
                      code=1)
            t.no_partials(f"{command} {place}")
        # Nobody reads: quiet, as others end.
        done = shell(f"edmill {command} | true; exit ${{PIPESTATUS[0]}}")
        t.check(done.returncode in (141, 0) and not done.stderr,
                f"{command} into a closed pipe: {done.returncode} {done.stderr!r}")
        done = shell(f"edmill {command} | head -n 1; exit ${{PIPESTATUS[0]}}")
        t.check(done.returncode in (141, 0) and not done.stderr and done.stdout.count("\n") == 1,
                f"{command} | head: {done.returncode} {done.stderr!r}")
    for command in ("run case.toml --out out", "report done", "compare done done",
                    "certify case.toml --collisions 3 --out events.csv"):
        t.check(
            shell(f"edmill {command} --quiet >&-").returncode == 0, f"{command}: nothing to print")


def errors(t):
    for command, code in FAILING.items():
        plain = shell(f"edmill {command}")
        t.check(plain.returncode == code and plain.stderr,
                f"{command}: exit code {plain.returncode} {plain.stderr}")
        for place in ("2>/dev/full", "2>&-", ">&- 2>&-", "<&- >&- 2>&-", "2> >(true)"):
            done = shell(f"edmill {command} {place}")
            t.check(done.returncode == code, f"{command} {place}: exit code {done.returncode}")
            t.no_partials(f"{command} {place}")


def results_are_on_disk(t):
    edmill("run", "case.toml", "--out", "out", "--quiet")
    expected = results("out")
    for place in (">/dev/full", ">&-", "| true", "| head -n 1 >/dev/null", "<&- >&- 2>&-", "2>&-"):
        shell(f"edmill run case.toml --out out {place}")
        t.check(
            same(results("out"), expected) == [],
            f"results {place}: {same(results('out'), expected)}")
        shell(f"edmill certify case.toml --collisions 3 --out out/events.csv {place}")
        t.check(pathlib.Path("out/events.csv").stat().st_size > 100, f"certified events {place}")
        os.remove("out/events.csv")
    # Where SIGPIPE is ignored from the start it is an error like any other.
    done = shell("trap '' PIPE; edmill reference | true; exit ${PIPESTATUS[0]}")
    t.check(done.returncode == 1 and "Broken pipe" in done.stderr,
            f"an ignored SIGPIPE: {done.returncode} {done.stderr}")


def descriptors(t):
    """No file gets the number of a closed standard stream, and with it messages."""
    names = ("collisions", "events", "trends", "paraview", "milling_dose")
    pathlib.Path("outputs.toml").write_text(case(*names))
    edmill("run", "outputs.toml", "--out", "expected", "--quiet")
    for place in ("<&-", ">&-", "2>&-", "<&- >&-", "<&- 2>&-", ">&- 2>&-", "<&- >&- 2>&-"):
        shell(f"edmill run outputs.toml --out closed {place}")
        t.check(same(results("closed"), results("expected")) == [], f"files of a run with {place}")
    done = shell("edmill check - <&-")
    t.refused(done, "a closed standard input", "-: no readable file")


with Trials() as t:
    pathlib.Path("case.toml").write_text(case("collisions"))
    pathlib.Path("tangent.toml").write_text(TANGENT)
    pathlib.Path("my.sweep.toml").write_text('[sweep]\ncase = "case.toml"\nreplicas = 2\n')
    t.check(edmill("run", "case.toml", "--quiet", "--out", "done").returncode == 0, "the case runs")
    output(t)
    errors(t)
    results_are_on_disk(t)
    descriptors(t)
print(f"{t.checks} checks of standard streams")
