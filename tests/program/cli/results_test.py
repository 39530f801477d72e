#!/usr/bin/env python3
"""The JSON and the tables of studies that users parse have the keys, the order and the numbers that
they had: regression fixtures in the folder `results`, made by the program itself at commit
94b38a97, `audit.json` again when
the audit gave up its own list of mistakes.

usage: PYTHONPATH=tests/support python3 results_test.py EDMILL SMALL_DEM_DUMP [--update]
--update makes the fixtures again. They are without times of the CPU, version, commit and
compiler."""
import difflib
import os
import pathlib
import re
import subprocess
import sys

from program import EXAMPLES, SOURCE, Trials, case, edmill

SMALL_DEM = os.path.realpath(sys.argv[2])
FIXTURES = SOURCE / "tests/program/cli/results"
BOX = EXAMPLES / "vibrated_box.toml"
CHANGING = re.compile(r'\s*"(version|commit|compiler|cpu_seconds|collisions_per_cpu_second)": .*')
LOG = ("--set", 'output=[{type="collisions", states=true}]')
POWDER = ("--set", 'powder.target_dose="2 kJ/g"', "--set", 'run.start_time="0.05 s"')
END = '[run]\nend_time = "66 ms"\ngravity = "9.81 m/s2"\n[mill]\ntype = "still"\n[vessel]\ndiameter = "7 mm"\nheight = "40 mm"\n'
CONTACT = '[contact]\nrestitution = 0.5\nfriction = 0.4\n'
CASES = {
    "powder": case(end="0.5 s"),
    # Three balls in a narrow cylinder whose end pushes them against the other one.
    "stall": f'{END}[[vessel.piston]]\nwall = "cap +y"\nspeed = "0.5 m/s"\n{CONTACT}[[balls]]\ncount = 3\ndiameter = "6 mm"\n',
    # A ball that comes to rest on the wall.
    "collapse": f'{END}{CONTACT}least_separation = "0 m/s"\n[[balls]]\ncount = 1\ndiameter = "6 mm"\n',
}
SWEEP = (
    '[sweep]\ncase = "powder.toml"\nreplicas = 2\n[sweep.grid]\n"contact.restitution" = [0.5, 0.6]\n"powder.target_dose" = ["2 kJ/g"]\n'
    '"run.end_time" = ["0.3 s"]\n')
OPTIMIZE = (
    '[optimize]\ncase = "powder.toml"\nobjective = "milling_dose_rate"\nruns_max = 4\nreplicas_first = 2\nreplicas_max = 2\npoints = 2\n'
    'refinements = 0\n[[optimize.variable]]\nkey = "contact.restitution"\nlow = 0.4\nhigh = 0.6\n')


def make():
    """Calls the program; returns what the fixtures hold, by their names."""
    for name, text in CASES.items():
        pathlib.Path(f"{name}.toml").write_text(text)
    runs = {
        "powder": ("powder.toml", *POWDER, *LOG), "powder_mpfr50":
            ("powder.toml", *POWDER, "--set", 'run.end_time="0.3 s"', "--precision", "mpfr50"),
        "other": ("powder.toml", "--set", "run.seed=6", *LOG), "stall": ("stall.toml",),
        "collapse": ("collapse.toml",)
    }
    found = {}
    for name, words in runs.items():
        table = edmill("run", *words, "--out", name, code={"stall": 8, "collapse": 3}.get(name,
                                                                                          0)).stdout
        found[f"{name}.json"] = pathlib.Path(name, "summary.json").read_text()
        found[f"{name}.txt"] = re.sub(r"  CPU time .*\n", "", table)
    edmill("compare", "powder", "other", "--json", "compare.json")
    edmill("audit", "powder.toml", "powder", "--set", "contact.restitution=0.6", "--identify",
           "--json", "audit.json", "--examples", "1", code=6)
    for us in (50, 100):
        with open(f"{us}.dump", "wb") as dump:
            subprocess.run([SMALL_DEM, str(us), "0.5", "100", str(us)], stdout=dump, check=True)
        edmill("import", f"{us}.dump", "--case", BOX, "--timestep", f"{us // 50} us", "--out",
               f"{us}.csv", code=0)
    edmill("audit", BOX, "50.csv", "--json", "contact_audit.json")
    edmill("compare", "50.csv", "100.csv", "--json", "contact_comparison.json")
    edmill("limit", "50.csv", "100.csv", "--json", "limit.json")
    for name in ("compare", "audit", "contact_audit", "contact_comparison", "limit"):
        found[f"{name}.json"] = pathlib.Path(f"{name}.json").read_text()
    for name, text in (("sweep", SWEEP), ("optimize", OPTIMIZE)):
        pathlib.Path(f"my.{name}.toml").write_text(text)
        edmill(name, f"my.{name}.toml", "--quiet", "--out", name, code=0)
        for table in (name, "runs"):
            found[f"{name}_{table}.csv"] = pathlib.Path(name, f"{table}.csv").read_text()
    return {
        name: "".join(line for line in text.replace(f"{SOURCE}/", "").splitlines(True)
                      if not CHANGING.match(line)) for name, text in found.items()
    }


with Trials(to_the_end=True) as t:
    for name, text in make().items():
        fixture = FIXTURES / name
        if "--update" in sys.argv:
            fixture.write_text(text)
        lines = difflib.unified_diff(fixture.read_text().splitlines(), text.splitlines(), name,
                                     "now", n=0, lineterm="")
        t.check(text == fixture.read_text(), "\n".join(list(lines)[:40]))
print(f"{t.checks} results are as they were")
