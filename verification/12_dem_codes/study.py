#!/usr/bin/python3
"""Writes docs/dem_study.md: edmill, LAMMPS, LIGGGHTS and YADE on three cases: values at a contact
time, processor time for a dose rate within 1 %, and what a code cannot express.

usage: study.py EDMILL [PAGE]     some twenty minutes of one core
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import dem_codes
from dem_codes import CASE, PLANETARY, PROGRAMS, SOURCE, SPEX, audit, edmill, export, own_folder, simulate

#: Case, its text, and the time simulated by edmill, LAMMPS, LIGGGHTS and YADE [s].
CASES = {
    "vibrated box, 5 balls": (CASE.read_text(), 400, {"lammps": 4, "liggghts": 4, "yade": 0.5}),
    "SPEX, 7 balls": (SPEX, 200, {"lammps": 2, "liggghts": 1, "yade": 0.1}),
    "planetary jar, 12 balls": (PLANETARY, 100, {"lammps": 2, "liggghts": 1, "yade": 0.1})
}
CONTACT_TIME = "100 us"
NAMES = {"lammps": "LAMMPS", "liggghts": "LIGGGHTS", "yade": "YADE"}
LAW = '[contact]\nrestitution = 0.6\nfriction = 0.3\n'
BALL = '[[balls]]\ncount = 3\ndiameter = "6 mm"\n'
SHAKEN = '[mill]\ntype = "vibratory"\namplitude = ["3 mm", "11 mm", "0 mm"]\nspeed = "1800 rpm"\n'
CYLINDER = '[vessel]\ndiameter = "38 mm"\nheight = "57 mm"\n'
#: What a case asks of a code.
FEATURES = {
    "cylinder, shaken along straight lines": SHAKEN + CYLINDER + LAW + BALL,
    "sphere": SHAKEN + '[vessel]\ntype = "sphere"\ndiameter = "48 mm"\n' + LAW + BALL,
    "capsule": SHAKEN + '[vessel]\ntype = "capsule"\ndiameter = "38 mm"\nheight = "57 mm"\n' + LAW +
               BALL,
    "cylinder with rounded edges":
        SHAKEN +
        '[vessel]\ntype = "rounded_cylinder"\ndiameter = "38 mm"\nheight = "57 mm"\nedge_radius = "5 mm"\n'
        + LAW + BALL, "SPEX, nested rotations": SPEX, "planetary jar": PLANETARY,
    "drum": '[mill]\ntype = "drum"\nspeed = "60 rpm"\n' + CYLINDER + LAW + BALL,
    "restitution that depends on the speed":
        SHAKEN + CYLINDER +
        '[contact]\nmodel = "viscoelastic"\nfriction = 0.3\ndissipative_time = "1 us"\neffective_modulus = "100 GPa"\n'
        + BALL,
}


def of_edmill(name, case, seconds):
    """Processor time of a run for a simulated second [s]."""
    before = os.times()
    done = edmill("run", case, "--quiet", "--out", name, f"--set=run.end_time=\"{seconds} s\"",
                  '--set=output=[{type="collisions"}]')
    if done.returncode:
        sys.exit(done.stderr)
    after = os.times()
    return (after.children_user - before.children_user) / seconds


def rates(run, log):
    """Dose rates of a run and a log with their intervals, by `edmill compare`; none where the log
    has no time after the case's start_time."""
    pathlib.Path("rates.json").unlink(missing_ok=True)
    if edmill("compare", run, log, "--json", "rates.json", "--quiet").returncode not in (0, 6):
        return None
    return json.load(open("rates.json"))


def value(found, name):
    judged = found["values"].get(name)
    return f"{judged['found']:.4f}" if judged else "few contacts"


def rows_of(title, text, durations):
    """One case in all codes."""
    case = pathlib.Path(re.sub(r"\W.*", "", title) + ".toml")
    case.write_text(text)
    own_seconds, by_code = durations
    own_cpu = of_edmill("own", case, own_seconds)
    rows, needed = [], None
    for code in PRESENT:
        name = f"{case.stem}_{code}"
        log, cpu = simulate(
            export(code, name, "--duration", f"{by_code[code]} s", "--contact-time", CONTACT_TIME,
                   case=case), name, case)
        result, found = audit(log, case)
        both = rates("own", log)
        if needed is None:
            # The interval shrinks with the root of the time; the motion, not the code, decides how
            # fast.
            half_width = both["a"]["milling_dose_rate_half_width"] / both["a"]["milling_dose_rate"]
            needed = (both["a"]["until"] - both["a"]["from"]) * (half_width / 0.01) ** 2
            rows.append(
                f"| edmill | {own_seconds} s | exact | exact | {both['a']['milling_dose_rate']:.2f} W ± {half_width:.1%} | "
                f"{own_cpu:.3g} s | {own_cpu * needed:.3g} s |")
        cpu /= by_code[code]
        ratio = f"{1 + both['difference']:.3f} ± {both['half_width']:.3f} of it" if both and both[
            "half_width"] < 0.2 else "too short"
        rows.append(
            f"| {NAMES[code]} | {by_code[code]} s | {value(found, 'restitution at walls')} | {value(found, 'friction at walls')} | "
            f"{ratio} | {cpu:.3g} s | {cpu * needed:.3g} s |")
        print(f"{title}: {NAMES[code]} ends the audit with {result}", flush=True)
    expected = re.search(r"restitution = ([\d.]+)",
                         text)[1], re.search(r"friction = ([\d.]+)", text)[1]
    return [
        f"## {title[0].upper() + title[1:]}", "",
        f"Restitution {expected[0]}, friction {expected[1]}. A dose rate within 1 % takes {needed:.0f} s of the mill's time.",
        "",
        "| code | simulated | restitution at walls | friction at walls | dose rate | processor time for 1 s | for 1 % of the dose rate |",
        "|---|---|---|---|---|---|---|", *rows, ""
    ]


def answer(text, code):
    """What a code makes of a case: "yes", with the notes of the deck, or why not."""
    case = pathlib.Path("feature.toml")
    case.write_text(text if "[run]" in
                    text else '[run]\nend_time = "1 s"\ngravity = "9.81 m/s2"\n' + text)
    done = edmill("export", case, "--to", code, "--name", "feature")
    if done.returncode == 0:
        notes = [line[6:] for line in done.stdout.splitlines() if line.startswith("note: ")]
        return "; ".join(["yes", *notes])
    return "no: " + re.sub(r"^.*?feature\.toml[:0-9]*:? *", "", done.stderr.strip().splitlines()[0])


def page():
    versions = ", ".join(
        f"{NAMES[code]} {subprocess.run(['dpkg-query', '-W', '-f', '${Version}', code], capture_output=True, text=True).stdout}"
        for code in PRESENT)
    lines = [
        "# DEM codes and edmill, side by side", "",
        "Three cases in edmill and in the DEM codes of Debian, by decks of `edmill export`; values are those of `edmill audit`, dose rates those of",
        "`edmill compare`. This page is written by", "",
        "    python3 verification/12_dem_codes/study.py build/release/edmill docs/dem_study.md", "",
        f"Versions: {versions}.",
        f"Contacts last {CONTACT_TIME} at 1 m/s, with 50 steps in each. All runs used one core, beside other work, so that processor times are accurate",
        "within a factor of two. Dose rates count from 0.5 s on, when the charge has forgotten its start. `edmill limit` shows how contacts of this duration change a dose rate (for LAMMPS in the vibrated box see",
        "[DEM codes](dem.md)); here the change is within the intervals.", ""
    ]
    for title, (text, own, by_code) in CASES.items():
        lines += rows_of(title, text, (own, by_code))
    lines += [
        "## What a code can express", "",
        "The table shows the answers of `edmill export`, case by case; edmill can simulate all of them.",
        "", "| case | " + " | ".join(NAMES[code] for code in PRESENT) + " |",
        "|---" * (len(PRESENT) + 1) + "|"
    ]
    for feature, text in FEATURES.items():
        lines.append(f"| {feature} | " + " | ".join(answer(text, code) for code in PRESENT) + " |")
    lines += [
        "",
        "No deck has moving pistons, laws that differ between pairs of materials, or hollow balls. An event-driven run has no forces, overlaps or",
        "durations of contacts, and takes contacts of several balls one pair after the other: for dense beds at rest a DEM code is the tool.",
        ""
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    dem_codes.EDMILL = str(pathlib.Path(sys.argv[1]).resolve())
    target = pathlib.Path(
        sys.argv[2]).resolve() if len(sys.argv) > 2 else SOURCE / "docs/dem_study.md"
    PRESENT = [code for code, program in PROGRAMS.items() if shutil.which(program)]
    with own_folder():
        text = page()
    target.write_text(text)
