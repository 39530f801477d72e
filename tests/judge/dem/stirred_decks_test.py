#!/usr/bin/env python3
"""Decks of cases with bodies in the vessel, run by the DEM codes that are installed: balls leave
their flights at the walls and bodies of the case, no contact is missed, and the restitution at the
bodies is that of the case. Skipped without any of the codes.

usage: PYTHONPATH=tests/support python3 stirred_decks_test.py EDMILL
"""
import pathlib
import re
import shutil
import subprocess
import sys

from program import Trials, edmill, said

CODES = {
    "lammps": ("lmp", ["lmp", "-in",
                       "deck.in"]), "liggghts": ("liggghts", ["liggghts", "-in", "deck.in"]),
    "yade": ("yade", ["yade", "-n", "-x", "-j1", "deck.py"])
}
COMMON = """[contact]
restitution = 0.6
friction = 0.3
[[balls]]
count = {count}
diameter = "6 mm"
density = "8 g/cm3"
"""
RUN = '[run]\ngravity = "9.8 m/s2"\nend_time = "1 s"\n'
TANK = '[mill]\ntype = "chain"\njoint = [{ rotate = "y", angle = "45 deg" }]\n[vessel]\ndiameter = "60 mm"\nheight = "50 mm"\n'
ROTOR = """[[body]]
size = ["30 mm", "10 mm", "8 mm"]
rounding = "{rounding}"
on = "ground"
joint = [{{ translate = [0, "-16 mm", 0] }}, {{ rotate = "y", speed = "1500 rpm" }}]
[[body]]
type = "cylinder"
diameter = "12 mm"
height = "60 mm"
on = "ground"
joint = [{{ rotate = "y", speed = "1500 rpm" }}]
"""
CASES = {  # case, codes
    "tank": (RUN + TANK + ROTOR.format(rounding="0 mm") + COMMON.format(count=12), ("lammps", "liggghts", "yade")),
    "rounded": (RUN + TANK + ROTOR.format(rounding="2 mm") + COMMON.format(count=12), ("liggghts",)),
    "baffle": (RUN + '[mill]\ntype = "spex8000"\nspeed = "1054 rpm"\n[vessel]\ndiameter = "38 mm"\nheight = "57 mm"\n[[body]]\n'
               'size = ["10 mm", "40 mm", "2 mm"]\njoint = [{ translate = ["10 mm", 0, 0] }]\n' + COMMON.format(count=8), ("lammps", "liggghts")),
    "shaken": (RUN + '[mill]\ntype = "vibratory"\namplitude = [0, "4 mm", 0]\nspeed = "1500 rpm"\n[vessel]\ndiameter = "60 mm"\nheight = "50 mm"\n[[body]]\n'
               'size = ["30 mm", "10 mm", "8 mm"]\njoint = [{ translate = [0, "-16 mm", 0] }, { rotate = "y", speed = "900 rpm" }]\n'
               + COMMON.format(count=12), ("lammps", "liggghts")),
}

installed = {code for code, (program, _) in CODES.items() if shutil.which(program)}
if not installed:
    print("no DEM code is installed")
    sys.exit(77)
with Trials(to_the_end=True) as t:
    for name, (text, codes) in CASES.items():
        case = pathlib.Path(f"{name}.toml").absolute()
        case.write_text(text)
        for code in codes:
            if code not in installed:
                continue
            folder = pathlib.Path(f"{name}_{code}")
            said("export", case, "--to", code, "--out", folder, "--duration",
                 "0.3 s" if code != "yade" else "0.15 s", "--quiet")
            done = subprocess.run(CODES[code][1], cwd=folder, capture_output=True, text=True,
                                  check=False, timeout=1200)
            deck = folder / CODES[code][1][-1]
            t.check((folder / "deck.dump").exists(),
                    f"{name}, {code}: {done.stdout[-500:]} {done.stderr[-500:]}")
            said("import", folder / "deck.dump", "--case", case, "--deck", deck, "--out",
                 folder / "contacts.csv", "--quiet")
            found = edmill("audit", case, folder / "contacts.csv").stdout
            off, resolved = map(
                float,
                re.search(r"leave their flights (\S+) m from .* resolve (\S+) m", found).groups())
            print(
                f"{name}, {code}: balls leave their flights {off} m from walls and bodies, frames resolve {resolved} m"
            )
            t.check(off <= 2 * resolved,
                    f"{name}, {code}: walls are {off} m away, frames resolve {resolved} m")
            t.check(re.search(r"contacts missed at walls +0 ", found), f"{name}, {code}: {found}")
            for value, allowed in re.findall(
                    r"restitution at (?:body|walls).*? ([0-9.]+) \(.*?\) +0\.6 +([0-9.]+)", found):
                t.check(
                    abs(float(value) - 0.6) <= float(allowed),
                    f"{name}, {code}: restitution {value}")
            touched = [
                row for row in open(folder / "contacts.csv", encoding="utf-8")
                if row.split(",")[2:3] == ["wall"]
            ]
            t.check(len(touched) > 10, f"{name}, {code}: {len(touched)} contacts with walls")
print(f"{t.checks} checks, codes: {', '.join(sorted(installed))}")
