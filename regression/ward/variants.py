#!/usr/bin/env python3
"""The dose rates of all cases of table 5.5 but the single ball, with one thing changed in each:
other numbers of the mill and the contacts, other friction laws, and of the second program
(stepped/stepped_mill.cpp) the rule that impacts within 0.5 ms of the last one lose nothing. What
could explain the thesis's numbers?

usage: variants.py EDMILL STEPPED_MILL FOLDER > variants.csv    half an hour of one core; FOLDER
    keeps edmill's runs
"""
import csv
import pathlib
import subprocess
import sys

import emulation
import tables

ROOT = pathlib.Path(__file__).resolve().parents[2]
FRICTION, COMPLIANCE = 0.4, 3.5  # of the cases: mu, and 1 + 1/J of a solid ball


def inverted_ratio(case):
    """e_t = max(-1, 1 - mu (1 + 1/J) (1 + e) |g_t| / |g_n|): (2.24) with the ratio of the speeds
    inverted."""
    ratio = 2 / (FRICTION * COMPLIANCE *
                 (1 + float(case.restitution)))  # of slip to approach, where e_t is -1
    return {
        "contact.model": "restitution-by-slip", "contact.tangential_by_slip": [[0, 1], [ratio, -1],
                                                                               [1e9, -1]]
    }


VARIANTS = {  # variant of variants.csv, settings over the case
    "as_it_is": lambda case: {},
    "arm_9_cm": lambda case: {"mill.arm": "9 cm"},
    "swings_13.5_deg": lambda case: {"mill.theta_max": "13.5 deg", "mill.gamma_max": "13.5 deg"},
    "friction_0.2": lambda case: {"contact.friction": 0.2},
    "friction_0.8": lambda case: {"contact.friction": 0.8},
    "no_friction": lambda case: {"contact.friction": 0},
    "always_reversed": lambda case: {"contact.model": "constant", "contact.restitution_tangential": -1},
    "inverted_ratio": inverted_ratio,
}
LOSSLESS = "lossless_5e-4"


def settings_of(variant, case):
    return VARIANTS[variant](case)


def times_of(case):
    """Start and end of the statistics [s], whole drive periods: the mean over many balls settles
    quickly, and they cost more."""
    period, start, periods = 60 / 1054, 1, 360 if case.count < 60 else 90 if case.count < 200 else 36
    return {"run.start_time": f"{start} s", "run.end_time": f"{start + periods * period} s"}


def value(setting):
    return f'"{setting}"' if isinstance(setting, str) else setting


def sweep(case):
    points = "".join("[[sweep.point]]\nname = \"{}\"\nset = {{ {} }}\n".format(
        name, ", ".join(f'"{key}" = {value(setting)}'
                        for key, setting in {**times_of(case), **settings_of(name, case)}.items()))
                     for name in VARIANTS)
    return f'[sweep]\ncase = "{ROOT}/regression/ward/cases/{case.name}.toml"\n{points}'


def main(edmill, stepped_mill, folder):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow([
        "case", "balls", "variant", "inverse_milling_dose_rate", "inverse_milling_dose_rate_ci95",
        "collision_rate_total"
    ])
    for case in sorted(tables.cases(), key=lambda case: case.count):
        if case.count == 1:
            continue
        file, done = folder / f"{case.name}.sweep.toml", folder / case.name
        file.write_text(sweep(case))
        subprocess.run([edmill, "sweep", file, "--out", done, "--quiet"], check=True)
        for row in csv.DictReader(open(done / "sweep.csv")):
            out.writerow([
                case.name, case.count, row["name"],
                f"{float(row['inverse_milling_dose_rate [s/J]']):.5g}",
                f"{float(row['inverse_milling_dose_rate_ci95 [s/J]']):.2g}",
                f"{float(row['collision_rate_total [1/s]']):.6g}"
            ])
        out.writerow(
            emulation.row(case, LOSSLESS,
                          emulation.times_of(case)[2],
                          *emulation.stepped(stepped_mill, case,
                                             dict(emulation.METHODS)[LOSSLESS])))
        sys.stdout.flush()


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__.strip())
    main(*sys.argv[1:])
