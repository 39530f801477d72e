#!/usr/bin/env python3
"""Writes docs/ward.md and its figures from the fixtures.

usage: make_page.py [--check]    --check writes nothing and fails when a file is not what it would
    write
"""
import csv
import json
import pathlib
import sys

import chapter_4
import fixture_log
import fixture_statistics as fixtures
import svg
import tables

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = pathlib.Path(
    __file__).resolve().parent / "page.md"  # the text, with {places} for tables and figures
VARIANTS = ROOT / "regression/ward/variants.csv"  # by variants.py
REVERSED = "always_reversed"
RULES = (  # method or variant, words
    (None, "edmill, the printed friction law"), (REVERSED, "edmill, e_t = -1 in all impacts"),
    ("inverted_ratio", "edmill, the ratio in (2.24) inverted"), ("t_c_5e-4",
                                                                 "second program, t_c 0.5 ms"),
    ("lossless_5e-4", "second program, impacts within 0.5 ms of the last lose nothing"),
    ("arm_9_cm", "edmill, arm 9 cm for 10 cm"), ("swings_13.5_deg",
                                                 "edmill, both swings 13.5 deg for 15 deg"),
    ("friction_0.2", "edmill, friction 0.2 for 0.4"), ("friction_0.8", "edmill, friction 0.8"),
    ("no_friction", "edmill, no friction"),
)
LAWS = ("thesis", "thesis"), ("as_it_is", "printed law"), (REVERSED, "e_t = -1"), ("inverted_ratio",
                                                                                   "ratio inverted")


def read(name):
    with open(ROOT / name, encoding="utf-8") as file:
        return list(csv.DictReader(file))


class Data:
    def __init__(self):
        self.cases = list(tables.cases())
        self.statistics = {row["case"]: row for row in read(fixtures.STATISTICS)}
        self.replicas = [
            row for row in read(fixtures.REPLICAS) if row["case"] == fixtures.SINGLE_BALL
        ]
        self.emulation = {(row["case"], row["method"]): row for row in read(fixtures.EMULATION)}
        self.emulation |= {(row["case"], row["variant"]): row for row in read(VARIANTS)}
        self.chapter_4 = {
            (row["law"], row["wall"]): row for row in read("regression/ward/chapter_4.csv")
        }

    def inverse(self, case, method=None):
        """@return mean and half width [s/J]"""
        row = self.emulation[case.name, method] if method else self.statistics[case.name]
        return float(row["inverse_milling_dose_rate"]), float(row["inverse_milling_dose_rate_ci95"])

    def rate(self, case, method=None):
        row = self.emulation[case.name, method] if method else self.statistics[case.name]
        return float(row["collision_rate_total"])

    def many(self):
        """All cases but the single ball."""
        return [case for case in self.cases if case.count > 1]


def table(head, rows):
    return "\n".join(
        "| " + " | ".join(map(str, row)) + " |" for row in [head, ["---"] * len(head), *rows])


def inverse_table(data):
    rows = []
    for case in data.cases:
        mean, half = data.inverse(case)
        row = [case.powder, case.charge_ratio, case.diameter, case.count, case.restitution]
        if case.count == 1:
            rows.append(row + ["see below", "", case.thesis_inverse, "", ""])
            continue
        rows.append(row + [
            f"{mean:.4f}", f"{100 * half / mean:.2f} %", case.thesis_inverse,
            f"{case.thesis_inverse / mean:.3f}",
            f"{case.thesis_inverse / data.inverse(case, REVERSED)[0]:.3f}"
        ])
    return table([
        "powder [g]", "charge ratio", "diameter [mm]", "balls", "e", "edmill [s/J]", "± 95 %",
        "thesis [s/J]", "thesis / edmill", "thesis / edmill with e_t = -1"
    ], rows)


def rate_table(data):
    rows = []
    for case in sorted((c for c in data.cases if c.powder == "5"), key=lambda c:
                       (float(c.diameter), c.count)):
        row = data.statistics[case.name]
        parts = [
            f"{float(row['collision_rate_' + name]):.0f}"
            for name in ("wall_0", "wall_1", "wall_2", "ball_ball", "total")
        ]
        lossy = data.rate(case, "t_c_5e-4")
        rows.append([
            case.diameter, case.count, *parts, f"{lossy:.0f}", case.thesis_rate or "not printed",
            f"{case.thesis_rate / lossy:.2f}" if case.thesis_rate else ""
        ])
    return table([
        "diameter [mm]", "balls", "cap 0", "cap 1", "cylinder", "ball-ball", "total",
        "second program, t_c 0.5 ms", "thesis", "thesis / second program"
    ], rows)


def log_table(data):
    return table(
        ["time [s]", "dose [J]", "work of the wall [J]", "largest by the printed law [J]"],
        [[f"{time:.4f}", f"{dose:.3e}", f"{work:.4f}", f"{chapter_4.largest_work(time, dose):.4f}"]
         for time, work, dose in chapter_4.LOG])


def chapter_4_table(data):
    rows = []
    for wall in chapter_4.WALLS:
        for law, words in LAWS:
            row = data.chapter_4[law, wall]
            rows.append([
                wall, words, *(row[f"from_{k}_m_s"] for k in chapter_4.SPEEDS[1:]),
                f"({row['dose']})"
            ])
    return table(["wall", "law", *(f"{k} to {k + 1} m/s" for k in chapter_4.SPEEDS[1:]), "dose"],
                 rows)


def single_table(data):
    return table(
        ["seed", "inverse dose rate [s/J]", "cap collisions/s", "cylinder collisions/s"], [[
            row["seed"], f"{float(row['inverse_milling_dose_rate']):.3g}",
            f"{float(row['collision_rate_wall_0']) + float(row['collision_rate_wall_1']):.1f}",
            f"{float(row['collision_rate_wall_2']):.0f}"
        ] for row in data.replicas])


def span(values, form):
    values = list(values)
    return f"{min(values):{form}} to {max(values):{form}}"


def ratios(data, cases, method=None):
    return span((case.thesis_inverse / data.inverse(case, method)[0] for case in cases), ".2f")


def percents(data, chosen):
    """How much the thesis's inverse dose rates exceed those with e_t = -1."""
    excess = [
        100 * (case.thesis_inverse / data.inverse(case, REVERSED)[0] - 1) for case in data.many()
        if chosen(case)
    ]
    return span(excess, ".1f") + " %"


def rule_table(data):
    """Each rule over all rows: thesis over computed, by diameter; and how many rows are within 3
    %."""
    rows = []
    for method, words in RULES:
        near = [
            case for case in data.many()
            if abs(case.thesis_inverse / data.inverse(case, method)[0] - 1) <= 0.03
        ]
        rows.append([
            words,
            *(ratios(data, [case for case in data.many() if case.diameter == diameter], method)
              for diameter in reversed(tables.DIAMETERS)), f"{len(near)} of {len(data.many())}"
        ])
    return table(
        ["rule", *(f"{diameter} mm" for diameter in reversed(tables.DIAMETERS)), "rows within 3 %"],
        rows)


def words(data):
    """What the text's places stand for."""
    with open(ROOT / fixture_log.LOG, encoding="utf-8") as file:
        entries = [json.loads(line) for line in file]
    source = next(entry for entry in reversed(entries) if "statistics" in entry)
    cpu = source["statistics"]["cpu_seconds"]
    return {
        "inverse_table": inverse_table(data), "rate_table": rate_table(data),
        "log_table": log_table(data), "chapter_4_table": chapter_4_table(data),
        "deviation": data.chapter_4[REVERSED, "cap 0"]
                     ["dose_deviation"], "seeds": len(chapter_4.SEEDS
                                                     ), "seconds": chapter_4.END - chapter_4.START,
        "reversed_9_52": percents(data, lambda case: case.diameter == "9.52"),
        "reversed_others": percents(data, lambda case: case.diameter != "9.52"),
        "reversed_single": f"{chapter_4.SECONDS / sum(float(data.chapter_4[REVERSED, wall]['dose']) for wall in chapter_4.WALLS):.3f} s/J",
        "single_table": single_table(data), "ratios": ratios(data, data.many()),
        "worst_interval": f"{max(100 * h / m for m, h in map(data.inverse, data.many())):.2f}",
        "closure": max(
            (data.statistics[case.name]["largest_energy_closure"] for case in data.many()),
            key=float), "rule_table": rule_table(data),
        "least_alike": f"{min(float(data.statistics[c.name]['replicas_alike_p']) for c in data.many()):.3f}",
        "date": source["date"], "commit": source["statistics"]
                                          ["commit"], "compiler": source["statistics"]
                                                                  ["compiler"], "cpu": f"{cpu} s",
    }


def ticks_of_inverse(powder):
    return (0.1, 0.2, 0.4, 0.6, 0.8, 1.0) if powder == "2" else (0.04, 0.06, 0.1, 0.2, 0.3)


def inverse_figure(data):
    """As figure 5.2 of the thesis: inverse dose rate by diameter."""
    panels = []
    for powder in tables.POWDERS:
        panel = svg.Panel(f"{powder} g of powder", "ball diameter [mm]",
                          "inverse milling dose rate [s/J]", (2, 4, 6, 8, 10),
                          ticks_of_inverse(powder), logarithmic=True)
        for k, ratio in enumerate(tables.CHARGE_RATIOS):
            cases = [
                case for case in data.cases if (case.powder, case.charge_ratio) == (powder, ratio)
            ]
            panel.add(
                f"edmill, charge ratio {ratio}",
                [(float(case.diameter), *data.inverse(case)) for case in cases if case.count > 1],
                k)
        for k, ratio in enumerate(tables.CHARGE_RATIOS):
            cases = [
                case for case in data.cases if (case.powder, case.charge_ratio) == (powder, ratio)
            ]
            panel.add(f"thesis, charge ratio {ratio}",
                      [(float(case.diameter), case.thesis_inverse, 0) for case in cases], k,
                      dashed=True)
        panels.append(panel)
    return svg.figure(panels)


def specific_figure(data):
    """As figure 5.3: specific milling dose rate by diameter."""
    panels = []
    for powder in tables.POWDERS:
        panel = svg.Panel(f"{powder} g of powder", "ball diameter [mm]",
                          "specific milling dose rate [W/g]", (2, 4, 6, 8, 10), (0, 1, 2, 3, 4, 5))
        for k, ratio in enumerate(tables.CHARGE_RATIOS):
            points, thesis = [], []
            for case in data.cases:
                if (case.powder, case.charge_ratio) != (powder, ratio):
                    continue
                mean, half = data.inverse(case)
                if case.count > 1:
                    points.append((float(case.diameter), 1 / mean / float(powder),
                                   half / mean ** 2 / float(powder)))
                thesis.append((float(case.diameter), 1 / case.thesis_inverse / float(powder), 0))
            panel.add(f"edmill, charge ratio {ratio}", points, k)
            panel.add(f"thesis, charge ratio {ratio}", thesis, k, dashed=True)
        panels.append(panel)
    return svg.figure(panels, 2)


def ratio_figure(data):
    """Thesis over edmill with the printed friction law and with e_t = -1, by restitution."""
    panels = []
    for method, title in ((None, "edmill"), (REVERSED, "edmill, e_t = -1")):
        panel = svg.Panel(title, "normal restitution", "inverse dose rate, thesis / computed",
                          (0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85),
                          (0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6))
        for k, diameter in enumerate(tables.DIAMETERS):
            cases = sorted((c for c in data.many() if c.diameter == diameter), key=lambda c:
                           (c.restitution, c.powder))
            points = []
            for case in cases:
                mean, half = data.inverse(case, method)
                points.append((float(case.restitution), case.thesis_inverse / mean,
                               case.thesis_inverse * half / mean ** 2))
            panel.add(f"{diameter} mm", points, k, joined=False)
        panels.append(panel)
    return svg.figure(panels, 4)


def files():
    """Text of every file, by place."""
    data = Data()
    docs = ROOT / "docs"
    return {docs / "ward.md": PAGE.read_text(encoding="utf-8").format(**words(data)),
            docs / "ward_inverse_dose_rate.svg": inverse_figure(data),
            docs / "ward_specific_dose_rate.svg": specific_figure(data),
            docs / "ward_ratio.svg": ratio_figure(data)}


def main():
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(__doc__.strip())
    made = files()
    if sys.argv[1:]:
        stale = [
            place for place, text in made.items()
            if not place.exists() or place.read_text(encoding="utf-8") != text
        ]
        for place in stale:
            print(f"{place.relative_to(ROOT)}: not what make_page.py makes", file=sys.stderr)
        sys.exit(1 if stale else 0)
    for place, text in made.items():
        place.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
