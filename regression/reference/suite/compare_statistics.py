#!/usr/bin/env python3
"""Compares statistics that any code found with a case of the suite; needs Python alone. CC0 1.0.

usage: compare_statistics.py CASE FOUND [FACTOR]

CASE is a folder of the suite. FOUND is CSV with the header name,value[,uncertainty], or JSON, {"name": value, ...} or
{"name": [value, uncertainty], ...}; uncertainties are standard ones, of the mean. A value agrees if it differs by no more
than the case's tolerance and FACTOR (3 unless given) combined standard uncertainties. Exit code: 0 all agree, 1 one
differs, 2 a file cannot be read."""
import csv
import json
import math
import pathlib
import sys


def rows_of(file):
    with open(file, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(line for line in stream if not line.startswith("#")))


def found_in(file):
    """Name to value and standard uncertainty."""
    if file.endswith(".json"):
        with open(file, encoding="utf-8") as stream:
            pairs = {k: v if isinstance(v, list) else [v] for k, v in json.load(stream).items()}
    else:
        pairs = {row["name"]: [row["value"], row.get("uncertainty") or 0] for row in rows_of(file)}
    return {k: (float(v[0]), float(v[1]) if len(v) > 1 else 0.0) for k, v in pairs.items()}


def main():
    if len(sys.argv) not in (3, 4):
        print(__doc__, file=sys.stderr)
        return 2
    folder, factor = pathlib.Path(sys.argv[1]), float(sys.argv[3]) if len(sys.argv) == 4 else 3.0
    try:
        case = json.loads((folder / "suite.json").read_text(encoding="utf-8"))
        if case["schema"] != 2:
            raise ValueError(f"schema {case['schema']}, this script reads 2")
        expected = {row["name"]: row for row in rows_of(folder / case["statistics"])}
        found = found_in(sys.argv[2])
        if not found or not found.keys() <= expected.keys():
            raise ValueError(f"expected some of {', '.join(expected)}; found {', '.join(found) or 'none'}")
        differ = 0
        for name, (value, uncertainty) in found.items():
            want, error, tolerance = (float(expected[name][k]) for k in ("value", "standard_uncertainty", "tolerance"))
            agrees = abs(value - want) <= tolerance + factor * (combined := math.hypot(error, uncertainty))
            differ += not agrees
            print(f"{'agrees ' if agrees else 'DIFFERS'} {name}: {value:.10g}, expected {want:.10g} {expected[name]['unit']}; "
                  f"off by {value - want:.2g}, combined uncertainty {combined:.2g}, tolerance {tolerance:.2g}")
    except (OSError, KeyError, ValueError, TypeError) as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return 2
    print(f"{case['name']}: {len(found) - differ} of {len(found)} agree within {factor:g} standard uncertainties")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
