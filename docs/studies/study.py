#!/usr/bin/env python3
"""A study of docs/mills.md: runs its sweep, prints the table and draws the plot.

usage: study.py ends|planetary|drum|stirrer|law EDMILL [--out FOLDER]

The sweep's folder keeps finished runs, so that a second call draws at once."""
import argparse
import csv
import math
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent / "regression" / "ward"))
from svg import Panel, figure  # noqa: E402

CRITICAL_RPM = math.sqrt(9.81 / 0.045) * 30 / math.pi  # of drum.toml
# Each study has the column with the abscissa, its factor, its label, and its ticks.
STUDIES = {
    "ends": ("name", 1, "radius of the edges [mm]", range(0, 21, 5)), "planetary":
        ("mill.ratio", -1,
         "k = -ratio: speed of the jar seen from the disc, reversed, over the disc's", (1, 2, 3, 4,
                                                                                        5)),
    "drum": ("mill.speed", 100 / CRITICAL_RPM, "speed in % of the critical one", range(0, 121, 20)),
    "stirrer": ("body.0.joint.1.speed", 1, "speed of the bar [rpm]", range(0, 1201, 300)), "law":
        ("mill.speed", 1, "speed of the drive [rpm]", range(600, 1401, 200)),
}
# Studies with several curves have a column that tells them apart, and its label.
CURVES = {"law": ("name", "law"), "planetary": ("contact.friction", "friction")}
QUANTITIES = (("milling_dose_rate", 1, "milling dose rate [W]"),
              ("impact_rate_total", 1e-3, "impacts [1/ms]"),
              ("dose_per_impact", 1e6, "milling dose of an impact [\u00b5J]"))


def values(row, quantity):
    """Mean and half width of its interval."""
    if quantity != "dose_per_impact":
        return float(row[quantity]), float(row[quantity + "_ci95"])
    dose, half = values(row, "milling_dose_rate")
    impacts, other = values(row, "impact_rate_total")
    return dose / impacts, dose / impacts * math.hypot(half / dose, other / impacts)


def ticks(highest):
    step = 10 ** math.floor(math.log10(highest / 2))
    while highest / step > 6:
        step *= 2 if str(step)[0] != "2" else 2.5
    return [step * k for k in range(math.ceil(highest / step) + 1)]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", choices=STUDIES)
    parser.add_argument("edmill")
    parser.add_argument("--out", default=None,
                        help="folder of the sweep; the study's name by default")
    given = parser.parse_args()
    folder = pathlib.Path(given.out or given.study)
    done = subprocess.run(
        [given.edmill, "sweep", HERE / f"{given.study}.sweep.toml", "--out", folder], check=False)
    if done.returncode:
        return done.returncode
    with open(folder / "sweep.csv", encoding="utf-8") as file:
        names, *rows = csv.reader(file)
    names = [name.split(" [")[0] for name in names]  # without the units
    rows = [dict(zip(names, row)) for row in rows]
    column, factor, label, x_ticks = STUDIES[given.study]
    curve, curve_label = CURVES.get(given.study, ("", ""))
    groups = {}
    for row in rows:
        x = float(row[column].split()[0]) * factor
        group = row[curve] if curve else ""
        groups.setdefault(group, []).append((x, row))
    print(f"| {label} |" + (f" {curve_label} |" if curve else "") +
          "".join(f" {q[2]} |" for q in QUANTITIES))
    print("|---" * (len(QUANTITIES) + 1 + bool(curve)) + "|")
    panels = []
    for quantity, scale, title in QUANTITIES:
        series = {name: [(x, *(scale * v for v in values(row, quantity))) for x, row in points]
                  for name, points in groups.items()}
        highest = max(y + half for points in series.values() for _, y, half in points)
        panel = Panel(title, label, title, list(x_ticks), ticks(highest))
        for colour, (name, points) in enumerate(series.items()):
            panel.add((name if curve == "name" else f"{curve_label} {name}") if curve else title,
                      points, colour)
        panels.append(panel)
    for name, points in groups.items():
        for x, row in points:
            cells = [
                f"{scale * values(row, q)[0]:.4g} ± {scale * values(row, q)[1]:.2g}"
                for q, scale, _ in QUANTITIES
            ]
            print(f"| {x:.4g} |" + (f" {name} |" if name else "") +
                  "".join(f" {c} |" for c in cells))
    target = folder / f"{given.study}.svg"
    target.write_text(figure(panels), encoding="utf-8")
    print(f"drawn to {target}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
