#!/usr/bin/python3
"""Writes docs/codes.md: which code passes which test. The codes are those of Debian (LAMMPS,
LIGGGHTS, YADE, as far as they are installed), edmill, and plain_mill, the second event-driven
program of verification/plain.

usage: codes.py EDMILL PLAIN_MILL [PAGE]     some ten minutes of one core
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

import dem_codes
import study
from dem_codes import CASE, PROGRAMS, SOURCE, audit, edmill, export, own_folder, simulate

SUITE = SOURCE / "regression/reference/suite"
EVENTS = [
    "bouncing_ball", "newtons_cradle", "oblique_impact", "slipping_particle", "stacked_particles",
    "rolling_drum", "spex_1", "spex_3", "spex_28", "planetary", "box", "stirred"
]
PLAIN = {"spex_1": ("one_ball", "--rpm 1054 --restitution 0.5 --ball-diameter 0.00952"),
         "spex_3": ("three_balls", "--rpm 1054 --restitution 0.53 --ball-diameter 0.00476"),
         "spex_28": ("balls_28", "--rpm 1054 --restitution 0.53 --ball-diameter 0.00476")}
DURATIONS = {"lammps": 10, "liggghts": 10, "yade": 1}  # of the vibrated box [s]
rows = []


def add(code, version, test, deck, verdict, value, begin):
    minutes = (time.time() - begin) / 60
    rows.append(
        f"| {code} | {version} | {test} | {deck} | {verdict} | {value} | {f'{minutes:.1f}' if minutes >= 0.1 else 'below 0.1'} |"
    )
    print(rows[-1], flush=True)


def case_of(name):
    about = json.loads((SUITE / name / "suite.json").read_text())
    return (SUITE / name / about["case"]).resolve(), about


def check(name, log):
    """@return whether the log agrees with the events of a case, and in how many"""
    done = subprocess.run([sys.executable, SUITE / "check.py", SUITE / name, log],
                          capture_output=True, text=True)
    case, about = case_of(name)
    return done.returncode == 0, f"{about['agree']} events to {about['tolerance']:g}" if done.returncode == 0 else done.stdout.splitlines(
    )[0]


def of_edmill(version):
    begin, agreed = time.time(), []
    for name in EVENTS:
        case, about = case_of(name)
        edmill("run", case, "--quiet", "--out", name, "--set",
               'output=[{type="collisions",states=true}]', "--set",
               f"run.max_collisions={about['agree'] + 5}")
        agreed.append(check(name, f"{name}/collisions.csv")[0])
    add("edmill", version, "event sequences of the suite", "the case files",
        "agrees" if all(agreed) else "differs", f"{sum(agreed)} of {len(agreed)} cases", begin)
    begin = time.time()
    edmill("run", CASE, "--quiet", "--out", "own", "--set", 'run.end_time="401 s"')
    code = edmill("audit", CASE, "own", "--quiet").returncode
    add("edmill", version, "audit, vibrated box", "the case file",
        "agrees" if code == 0 else "differs", "every impact and flight of 400 s", begin)


def of_plain_mill(version):
    for name, (case, options) in PLAIN.items():
        begin = time.time()
        file, about = SOURCE / f"regression/reference/{case}.toml", case_of(name)[1]
        edmill("run", file, "--quiet", "--precision", "mpfr100", "--out", "start", "--set",
               'run.end_time="1 us"')
        done = subprocess.run(
            [PLAIN_MILL, "start/final_state.csv",
             str(about["agree"]), *options.split()], capture_output=True, text=True, check=True)
        pathlib.Path("plain.csv").write_text(done.stdout)
        good, text = check(name, "plain.csv")
        add("plain_mill", version, f"event sequence `{name}`", "options of the program",
            "agrees" if good else "differs", text, begin)


def of_dem_code(code, version):
    begin = time.time()
    log, _ = simulate(
        export(code, code, "--duration", f"{DURATIONS[code]} s", "--contact-time", "50 us"), code)
    exit_code, found = audit(log)
    verdict = {0: "agrees", 6: "differs"}.get(exit_code, "too short")
    values = ", ".join(f"{name} {found['values'][name]['found']:.4f}"
                       for name in ("restitution at walls", "friction at walls")
                       if name in found["values"])
    add(study.NAMES[code], version, "audit, vibrated box",
        f"`edmill export --to {code}`, {DURATIONS[code]} s", verdict, values, begin)
    both = study.rates("own", log)
    if both:
        agrees = abs(both["difference"]) <= both["half_width"]
        add(study.NAMES[code], version, "dose rate over edmill's", "the same, contacts of 50 us",
            "agrees" if agrees else "differs",
            f"{1 + both['difference']:.3f} ± {both['half_width']:.3f}", time.time())


def package_version(code):
    return subprocess.run(["dpkg-query", "-W", "-f", "${Version}", code], capture_output=True,
                          text=True).stdout


def page():
    version = edmill("--version").stdout.split()[1]
    of_edmill(version)
    of_plain_mill(version)
    for code in (code for code, program in PROGRAMS.items() if shutil.which(program)):
        of_dem_code(code, package_version(code))
    return "\n".join([
        "# Codes by tests", "",
        "Which code passes which test, with the values found. This page is written by", "",
        "    python3 verification/12_dem_codes/codes.py build/ci/edmill build/ci/verification/plain/plain_mill docs/codes.md",
        "",
        "The event sequences are those of [the suite](../regression/reference/suite/README.md), which a code",
        "with time steps cannot follow. The vibrated box is",
        "`docs/examples/vibrated_box.toml`; its restitution is 0.6, its friction 0.4. An audit of a DEM code",
        "measures these from contacts ([DEM codes](dem.md)). Contacts that last change a dose rate by a few",
        "per cent, which `edmill limit` removes. To see your own code in such a table, write",
        "[a log](log-format.md) and run the same commands.", "",
        "| code | version | test | deck | verdict | value | minutes |",
        "|---|---|---|---|---|---|---|", *rows, ""
    ])


if __name__ == "__main__":
    dem_codes.EDMILL = str(pathlib.Path(sys.argv[1]).resolve())
    PLAIN_MILL = str(pathlib.Path(sys.argv[2]).resolve())
    target = pathlib.Path(sys.argv[3]).resolve() if len(sys.argv) > 3 else SOURCE / "docs/codes.md"
    with own_folder():
        text = page()
    target.write_text(text)
