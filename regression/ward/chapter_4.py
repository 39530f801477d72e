#!/usr/bin/env python3
"""Chapter 4 of the thesis: one ball of 9.52 mm for 120 s. Dose and impacts by wall and approach
speed, by the thesis and by edmill with three friction laws.

usage: chapter_4.py EDMILL > chapter_4.csv    half a minute of one core
"""
import csv
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

import tables
import variants

SECONDS = 120
SPEEDS = range(7)  # classes of 1 m/s
WALLS = "cap 0", "cap 1", "cylinder"
# Sections 4.3.3 to 4.3.5: dose in all, and by wall the impacts, their mean dose, and those from 0
# to 1 m/s, ..., from 5 to 6 m/s.
DOSE = 124.1
THESIS = (("cap 0", 4579, 0.010, (1765, 523, 275, 434, 844, 276)),
          ("cap 1", 4286, 0.011, (1809, 493, 243, 394, 857, 306)),
          ("cylinder", 46694, 0.001, (41209, 2831, 1072, 376, 100, 9)))
# Section 4.3.7: time [s], work of the wall [J], dose [J] of five impacts with the cylinder that
# follow each other.
LOG = ((30.0003, 0.0030, 1.427e-05), (30.0009, -0.0024, 2.283e-05), (30.0020, 0.0058, 1.592e-05),
       (30.0027, -0.0048, 2.564e-05), (30.0039, 0.0094, 1.946e-05))
LAWS = "as_it_is", "always_reversed", "inverted_ratio"
SEEDS = range(1, 81)
START, END = 1, 4  # [s]; later the printed law may have captured the ball (theory.md, section 6)

MASS = 8000 * math.pi / 6 * 0.00952**3
RESTITUTION, FRICTION = 0.5, 0.4


def largest_work(time, dose):
    """Of an impact of this dose with the cylinder, by the printed laws (2.23) and (2.24): the
    wall's largest speed times the largest impulse. The approach loses no more than the dose, and
    the tangential impulse is at most mu times the normal one. [J]"""
    turns, swing = 1054 / 60 * time, math.radians(15)
    theta_rate = 2 * math.pi * 1054 / 60 * swing * abs(math.sin(2 * math.pi * turns))
    gamma_rate = 2 * math.pi * 1054 / 60 * swing * abs(math.cos(2 * math.pi * turns))
    speed = theta_rate * math.hypot(0.1 + 0.019, 0.0285) + gamma_rate * math.hypot(0.019, 0.0285)
    approach = math.sqrt(2 * dose / (MASS * (1 - RESTITUTION**2)))
    return MASS * (1 + RESTITUTION) * approach * math.hypot(1, FRICTION) * speed


def run(edmill, case, law, seed, folder):
    settings = {
        "run.seed": seed, "run.start_time": f"{START} s", "run.end_time": f"{END} s",
        **variants.settings_of(law, case)
    }
    text = (variants.ROOT / f"regression/ward/cases/{case.name}.toml").read_text(encoding="utf-8")
    file = folder / "case.toml"
    file.write_text(
        text +
        '\n[[output]]\ntype = "frequency"\nvariable = "relative_normal_speed_before"\nlow = "0 m/s"\nhigh = "7 m/s"\nintervals = 7\n'
        f'wall_details = true\nstart_time = "{START} s"\n', encoding="utf-8")
    out = folder / f"{law}_{seed}"
    subprocess.run([
        edmill, "run", file, "--quiet", "--out", out,
        *(f"--set={key}={variants.value(one)}" for key, one in settings.items())
    ], check=True)
    with open(out / "frequency.csv", encoding="utf-8") as table:
        next(table)  # its title
        return json.loads(
            (out / "summary.json").read_text(encoding="utf-8")), list(csv.DictReader(table))


def main(edmill):
    case = next(case for case in tables.cases() if case.count == 1)
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(
        ["law", "wall", "dose", "dose_deviation", "impacts", *(f"from_{k}_m_s" for k in SPEEDS)])
    of_caps = sum(impacts * dose for _, impacts, dose, _ in THESIS[:2])
    for wall, impacts, dose, speeds in THESIS:
        out.writerow([
            "thesis", wall, f"{impacts * dose if wall != 'cylinder' else DOSE - of_caps:.3g}", "",
            impacts, *speeds, ""
        ])
    factor = SECONDS / (END - START) / len(SEEDS)
    for law in LAWS:
        with tempfile.TemporaryDirectory() as folder:
            done = [run(edmill, case, law, seed, pathlib.Path(folder)) for seed in SEEDS]
        for k, wall in enumerate(WALLS):
            doses = [summary["milling_dose_by_partner"][f"wall_{k}"] for summary, _ in done]
            impacts = sum(summary["collisions"][f"wall_{k}"] for summary, _ in done)
            speeds = [sum(int(table[j][f"wall_{k}"]) for _, table in done) for j in SPEEDS]
            deviation = statistics.stdev(doses) * math.sqrt(SECONDS /
                                                            (END - START))  # of a record of 120 s
            out.writerow([
                law, wall, f"{factor * sum(doses):.3g}", f"{deviation:.2g}",
                round(factor * impacts), *(round(factor * number) for number in speeds)
            ])


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    main(sys.argv[1])
