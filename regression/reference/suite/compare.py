#!/usr/bin/env python3
"""Compares the collision log of any code with a case of the suite; needs Python alone. CC0 1.0.

usage: compare.py CASE LOG.csv [TOLERANCE]

CASE is a folder of the suite. Both files are CSV with a header; columns that both have are compared, relative to the
largest magnitude of a column. Exit code: 0 they agree, 1 they differ, 2 a file cannot be read."""
import csv
import json
import pathlib
import sys


def rows_of(file):
    with open(file, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(line for line in stream if not line.startswith("#")))


def bodies(row):
    ball, partner = int(row["ball"]), int(row["partner"])
    if row["partner_kind"] == "ball":
        ball, partner = sorted((ball, partner))
    return row["partner_kind"], ball, partner


def main():
    if len(sys.argv) not in (3, 4):
        print(__doc__, file=sys.stderr)
        return 2
    folder = pathlib.Path(sys.argv[1])
    try:
        case = json.loads((folder / "suite.json").read_text(encoding="utf-8"))
        if case["schema"] != 2:
            raise ValueError(f"schema {case['schema']}, this script reads 2")
        if "events" not in case:
            raise ValueError(f"{case['name']} has statistics alone: compare_statistics.py reads them")
        expected, found = rows_of(folder / case["events"]), rows_of(sys.argv[2])
        tolerance = float(sys.argv[3]) if len(sys.argv) == 4 else case["tolerance"]
        count = case["agree"]
        needed = ["time", "ball", "partner_kind", "partner"]
        if missing := [name for name in needed if found and name not in found[0]]:
            raise ValueError(f"{sys.argv[2]} has no column {', '.join(missing)}")
        names = [n for n in case["columns"] if n in expected[0] and found and n in found[0]]
        scale = {n: max(abs(float(row[n])) for row in expected[:count]) or 1.0 for n in names}
        for k in range(count):
            if k >= len(found):
                print(f"the log ends after {k} of {count} events")
                return 1
            if bodies(expected[k]) != bodies(found[k]):
                print(f"event {k}: found {bodies(found[k])}, expected {bodies(expected[k])} at {expected[k]['time']} s")
                return 1
            for n in names:
                error = abs(float(found[k][n]) - float(expected[k][n])) / scale[n]
                if not error <= tolerance:
                    print(f"event {k}: {n} is {found[k][n]}, expected {expected[k][n]}, off by {error:.2g} of {scale[n]:.3g}")
                    return 1
    except (OSError, KeyError, ValueError, IndexError) as error:
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        return 2
    print(f"{case['name']}: {count} events agree to {tolerance:g} in {', '.join(names)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
