#!/usr/bin/env python3
"""A run over the folder of an earlier one leaves what it would have left in an empty folder, and
the user's files. One that fails leaves everything as it was.

usage: PYTHONPATH=tests/support python3 left_behind_test.py EDMILL [TRIALS]    random pairs of cases
    (default: 12)
"""
import pathlib
import random
import resource
import shutil
import signal
import sys
import time

from program import OUTPUTS, Trials, case, edmill, results, same, start

trials = int(sys.argv[2]) if len(sys.argv) > 2 else 12
seed = 20110101
rng = random.Random(seed)
RECORD = ".edmill-files"
USERS = {
    "notes.txt": b"mine", "report/mine.csv": b"1,2", "paraview/view.pvsm": b"<x/>",
    "tables/own/a.csv": b"3", "sweep.csv": b"x"
}


def draw():
    """A case, and how it is run."""
    outputs = rng.sample(sorted(OUTPUTS), rng.randint(0, 5))
    return case(*outputs, end=rng.choice(["0.1 s", "0.06 s"])), rng.choice([[], [], ["--report"]])


def run(place, text, options):
    pathlib.Path("case.toml").write_text(text)
    edmill("run", "case.toml", "--quiet", "--out", place, *options, code=0)


def add_users_files(place):
    for name, content in USERS.items():
        path = pathlib.Path(place) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def one_after_the_other(t, trial):
    first, second = draw(), draw()
    what = f"trial {trial} of seed {seed}"
    run("both", *first)
    if rng.random() < 0.3:  # a page that was made later is one of edmill's files, too
        t.check(edmill("report", "both", "--quiet").returncode == 0, f"{what}: report")
    add_users_files("both")
    run("both", *second)
    run("alone", *second)
    expected, found = results("alone"), results("both")
    t.check(all(found.get(name) == content for name, content in USERS.items()),
            f"{what}: files of the user")
    found = {name: content for name, content in found.items() if name not in USERS}
    t.check(same(found, expected) == [], f"{what}: {same(found, expected)}")
    recorded = set(expected[RECORD].decode().splitlines()[1:])
    t.check(recorded == expected.keys() - {RECORD},
            f"{what}: the record: {recorded ^ expected.keys()}")
    for place in ("both", "alone"):
        shutil.rmtree(place)


def failures(t):
    """What can end a run before its results are in place, each over the folder of an earlier
    run."""
    run("old", case("collisions", "events", "paraview", "snapshot"), ["--report"])
    before = results("old")
    text = case("collisions", "spectra", "trends", "paraview", "milling_dose", end="2 s")
    pathlib.Path("case.toml").write_text(text)

    def small_files(size):
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    def as_before(what):
        t.no_partials(what)
        t.check(same(results("old"), before) == [], f"{what}: {same(results('old'), before)}")

    out = ["--quiet", "--out", "old"]
    t.check(
        edmill("run", "case.toml", *out, "--set", "balls.0.count=0").returncode == 2, "a bad case")
    as_before("a bad case")
    t.check(
        edmill("run", "case.toml", *out, "--set", "balls.0.count=4000").returncode == 2, "no room")
    as_before("no room for the balls")
    for size in (1, 100, 1500, 5000, 20000, 100000):
        done = edmill("run", "case.toml", *out, preexec_fn=lambda: small_files(size))
        t.refused(done, f"files of {size} bytes", "file size limit", code=1)
        as_before(f"files of {size} bytes")
    # Room for some of its files, not for all: the last ones are the tables that are written at the
    # end.
    fresh = [
        f'output=[{{type="spectra"}},{{type="trends",interval="1 ms",columns=[{{variable="milling_dose",statistics=["sum"]}}]}}]'
    ]
    done = edmill("run", "case.toml", *out, "--set", *fresh, preexec_fn=lambda: small_files(30000))
    t.refused(done, "the second output does not fit", "file size limit", code=1)
    as_before("the second output does not fit")
    for kill in (signal.SIGKILL, signal.SIGTERM):
        pathlib.Path("case.toml").write_text(
            text.replace('end_time = "2 s"', 'end_time = "1000 s"', 1))
        earlier = set(pathlib.Path("old").glob("*.partial-*"))
        process = start("run", "case.toml", *out)
        while not set(pathlib.Path("old").glob("*.partial-*")) - earlier:
            time.sleep(0.002)
        if kill == signal.SIGKILL:
            process.send_signal(kill)
            process.wait()
            found = {
                name: content for name, content in results("old").items() if ".partial-" not in name
            }
            t.check(same(found, before) == [], f"killed: {same(found, before)}")
            pathlib.Path("case.toml").write_text(text)
            t.check(
                edmill("run", "case.toml", *out, "--set", "balls.0.count=4000").returncode == 2,
                "no room")
        else:  # it has results, which are put in place
            time.sleep(0.3)
            process.send_signal(kill)
            t.check(process.wait() == 128 + kill, "exit code after SIGTERM")
            t.no_partials("interrupted")
            t.check("report.html" not in results("old") and "events.h5" not in results("old"),
                    "files of the older run")


def foreign(t):
    """A file of the user with a name that a run or a study needs, and the folder of a study, are
    refused."""
    pathlib.Path("case.toml").write_text(case("collisions"))
    sweep = '[sweep]\ncase = "case.toml"\n[sweep.grid]\n"contact.restitution" = [0.5, 2, 0.6]\n'
    pathlib.Path("my.sweep.toml").write_text(sweep)
    commands = {("run", "case.toml"): ("case.toml", "summary.json", "final_state.csv"),
                ("run", "case.toml", "--seeds", "2"): ("seeds.csv", "runs.csv", "seeds.html"),
                ("sweep", "my.sweep.toml"):
                    ("sweep.csv", "runs.csv", "sweep.h5", "sweep_log.csv", "sweep.html")}
    for command, names in commands.items():
        for name in names:
            place = pathlib.Path("foreign")
            place.mkdir()
            (place / name).write_text("mine")
            t.refused(edmill(*command, "--quiet", "--out", place), f"{command} over {name}",
                      place / name, "has not written")
            t.check({p.name: p.read_text() for p in place.iterdir()} == {name: "mine"},
                    f"{command}: {name} is as it was")
            shutil.rmtree(place)
    done = edmill("sweep", "my.sweep.toml", "--out", "foreign")
    t.check(
        done.returncode == 5 and
        '1 run failed: --set contact.restitution=2: key \'contact.restitution\': found "2"'
        in done.stdout, f"why a run failed: {done.stdout} {done.stderr}")
    before = results("foreign")
    t.refused(edmill("run", "case.toml", "--quiet", "--out", "foreign"), "a run over a sweep",
              "foreign", "sweep")
    t.check(same(results("foreign"), before) == [], "the sweep is as it was")
    t.refused(edmill("report", "foreign"), "the page of a sweep", "foreign/sweep.html")
    t.refused(edmill("sweep", "case.toml"), "a sweep of a case", "found a case file", "edmill run")
    t.check(
        edmill("run", "case.toml", "--quiet", "--out", ".", "--set",
               "run.seed = 2").returncode == 2, "over the case itself")


with Trials() as t:
    foreign(t)
    for trial in range(trials):
        one_after_the_other(t, trial)
    failures(t)
print(
    f"{trials} pairs of runs, seed {seed}, {t.checks} checks: nothing of an earlier run stays beside a later one"
)
