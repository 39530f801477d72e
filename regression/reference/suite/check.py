#!/usr/bin/env python3
"""Checks the output of any code against the cases of this suite; needs Python alone. CC0 1.0.

usage: check.py CASE FILE [OPTIONS]    one case: a log or statistics
       check.py FOLDER [OPTIONS]       all cases that FOLDER has files for
       OPTIONS: [--tolerance T] [--factor F] [--junit OUT.xml]

CASE is a case of the suite by its name or folder, or a DEM case (.yaml). FILE is a log, CSV with a
line for each impact, or statistics: CSV with the header name,value[,uncertainty], or JSON, {"name":
value} or {"name": [value, uncertainty]}. FOLDER has CASE.csv (log), CASE.statistics.csv or
CASE.statistics.json, and for a DEM case CASE.csv (statistics).

Of a log, the columns that both have are compared, relative to the largest magnitude of a column,
with the tolerance of the case (default) or T. A value of statistics agrees if it differs by no more
than the tolerance of the case and F (default: 3) combined standard uncertainties. Exit code: 0 all
agree, 1 one differs, 2 a file cannot be read."""
import argparse
import csv
import json
import math
import pathlib
import re
import sys
from xml.sax.saxutils import quoteattr

HERE = pathlib.Path(__file__).resolve().parent
SUITE = HERE / "suite" if (
    HERE / "suite").is_dir() else HERE  # in the archive the script is above the cases
DEM = SUITE.parent / "dem"


def rows_of(file):
    with open(file, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(line for line in stream if not line.startswith("#")))


def suite_of(folder):
    case = json.loads((folder / "suite.json").read_text(encoding="utf-8"))
    if case["schema"] != 2:
        raise ValueError(f"schema {case['schema']}, this script reads 2")
    return case


def bodies(row):
    ball, partner = int(row["ball"]), int(row["partner"])
    if row["partner_kind"] == "ball":
        ball, partner = sorted((ball, partner))
    return row["partner_kind"], ball, partner


def check_log(folder, file, tolerance):
    """@return a line for each thing that was compared: whether it agrees, and what was seen"""
    case, found = suite_of(folder), rows_of(file)
    if "events" not in case:
        raise ValueError(f"{case['name']} has statistics alone")
    expected, count = rows_of(folder / case["events"]), case["agree"]
    tolerance = case["tolerance"] if tolerance is None else tolerance
    needed = ["time", "ball", "partner_kind", "partner"]
    if missing := [name for name in needed if found and name not in found[0]]:
        raise ValueError(f"{file} has no column {', '.join(missing)}")
    names = [n for n in case["columns"] if n in expected[0] and found and n in found[0]]
    scale = {n: max(abs(float(row[n])) for row in expected[:count]) or 1.0 for n in names}
    for k in range(count):
        if k >= len(found):
            return [(False, f"the log ends after {k} of {count} events")]
        if bodies(expected[k]) != bodies(found[k]):
            return [(
                False,
                f"event {k}: found {bodies(found[k])}, expected {bodies(expected[k])} at {expected[k]['time']} s"
            )]
        for n in names:
            error = abs(float(found[k][n]) - float(expected[k][n])) / scale[n]
            if not error <= tolerance:
                return [(
                    False,
                    f"event {k}: {n} is {found[k][n]}, expected {expected[k][n]}, a difference of {error:.2g} of {scale[n]:.3g}"
                )]
    return [(True, f"{count} events agree to {tolerance:g} in {', '.join(names)}")]


def values_in(file):
    """Name to value and standard uncertainty."""
    if pathlib.Path(file).suffix == ".json":
        with open(file, encoding="utf-8") as stream:
            pairs = {k: v if isinstance(v, list) else [v] for k, v in json.load(stream).items()}
    else:
        pairs = {row["name"]: [row["value"], row.get("uncertainty") or 0] for row in rows_of(file)}
    return {k: (float(v[0]), float(v[1]) if len(v) > 1 else 0.0) for k, v in pairs.items()}


def expected_statistics(place):
    """Name to value, standard uncertainty, tolerance and unit: of a folder of the suite, or of a
    DEM case."""
    if place.suffix != ".yaml":
        columns = ("value", "standard_uncertainty", "tolerance")
        return {
            row["name"]: (*(float(row[k]) for k in columns), row["unit"])
            for row in rows_of(place / suite_of(place)["statistics"])
        }
    text = place.read_text(encoding="utf-8").split("\nexpected:\n")[1]
    parts = re.findall(r"^  (\w+):\n    value: (\S+)\n    relative_tolerance: (\S+)", text, re.M)
    return {
        name: (float(value), 0.0, abs(float(value)) * float(relative), "SI")
        for name, value, relative in parts
    }


def check_statistics(place, file, factor):
    expected, found = expected_statistics(place), values_in(file)
    if not found or not found.keys() <= expected.keys():
        raise ValueError(
            f"expected some of {', '.join(expected)}; found {', '.join(found) or 'none'}")
    lines = []
    for name, (value, uncertainty) in found.items():
        want, error, tolerance, unit = expected[name]
        combined = math.hypot(error, uncertainty)
        lines.append((
            abs(value - want) <= tolerance + factor * combined,
            f"{name}: {value:.10g}, expected {want:.10g} {unit}; difference {value - want:.2g}, combined uncertainty "
            f"{combined:.2g}, tolerance {tolerance:.2g}"))
    return lines


def is_log(file):
    if file.suffix == ".json":
        return False
    with open(file, encoding="utf-8") as stream:
        header = next((line for line in stream if not line.startswith("#")), "")
    return "value" not in header.strip().split(",")


def work_in(folder):
    """The cases of the suite for which a folder has a file."""
    cases = {place.parent.name: place.parent for place in SUITE.glob("*/suite.json")
            } | {place.stem: place for place in DEM.glob("*.yaml")}
    for name, case in sorted(cases.items()):
        for ending in (".csv", ".statistics.csv", ".statistics.json"):
            if (file := folder / (name + ending)).exists():
                yield name, case, file


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("place", type=pathlib.Path)
    parser.add_argument("file", nargs="?", type=pathlib.Path)
    parser.add_argument("--tolerance", type=float)
    parser.add_argument("--factor", type=float, default=3.0)
    parser.add_argument("--junit")
    a = parser.parse_args()
    if a.file and not a.place.exists():
        a.place = next(
            (place for place in (SUITE / a.place, DEM / f"{a.place}.yaml") if place.exists()),
            a.place)
    work = [(a.place.stem, a.place, a.file)] if a.file else list(work_in(a.place))
    if not work:
        print(f"{a.place}: no file of a case, such as spex_28.csv", file=sys.stderr)
        return 2
    differ, broken, elements = 0, 0, []
    for name, case, file in work:
        try:
            lines = check_log(case, file, a.tolerance) if is_log(file) else check_statistics(
                case, file, a.factor)
        except (OSError, KeyError, ValueError, IndexError, TypeError) as error:
            print(f"{name}: {type(error).__name__}: {error}", file=sys.stderr)
            broken += 1
            elements.append(
                f'<testcase classname="suite" name={quoteattr(name)}><error message={quoteattr(str(error))}/></testcase>'
            )
            continue
        for agrees, text in lines:
            differ += not agrees
            print(f"{'agrees ' if agrees else 'DIFFERS'} {name}: {text}")
            failure = "/>" if agrees else f"><failure message={quoteattr(text)}/></testcase>"
            elements.append(
                f'<testcase classname="suite" name={quoteattr(name + " " + text.split(":")[0])}{failure}'
            )
    print(f"{len(elements) - differ - broken} of {len(elements)} agree")
    if a.junit:
        pathlib.Path(a.junit).write_text(
            f'<?xml version="1.0" encoding="UTF-8"?>\n<testsuite name="suite" tests="{len(elements)}" '
            f'failures="{differ}" errors="{broken}">\n  ' + "\n  ".join(elements) +
            "\n</testsuite>\n", encoding="utf-8")
    return 2 if broken else 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
