"""The first events of each case: in double as hashes of the collision log, in mpfr50 as digits."""
import csv
import hashlib
import io
import pathlib
import subprocess
import tempfile
from decimal import Decimal

import tables

DOUBLE = "regression/ward/fixtures/events.double.csv"
MPFR50 = "regression/ward/fixtures/events.mpfr50.csv"
EVENTS, BLOCK, WIDE_EVENTS, DIGITS = 1000, 100, 200, 25
BODIES = ("index", "ball", "partner_kind", "partner")
VALUES = ("time", "approach_speed", "slip_speed", "milling_dose", "wall_work")
COLUMNS = ("case", "index", "time", "ball", "partner_kind", "partner", *VALUES[1:])


def collisions(root, edmill, case, count, precision="double"):
    """Lines of collisions.csv, its header first."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([
            str(edmill), "run",
            str(root / "regression/ward/cases" / f"{case.name}.toml"), "--quiet", "--out", folder,
            "--precision", precision, "--set", "run.start_time=0 s", "--set",
            f"run.max_collisions={count}", "--set", 'output=[{type="collisions"}]'
        ], check=True, stdout=subprocess.DEVNULL)
        return (pathlib.Path(folder) / "collisions.csv").read_text().splitlines()


def double_rows(root, edmill, case):
    """Hash of all events, then of each block of 100, with the last line of the block."""
    header, *lines = collisions(root, edmill, case, EVENTS)
    rows = [(case.name, f"0-{len(lines) - 1}",
             hashlib.sha256("\n".join([header, *lines, ""]).encode()).hexdigest(), "")]
    for k in range(0, len(lines), BLOCK):
        block = lines[k:k + BLOCK]
        hashed = hashlib.sha256("\n".join([*block, ""]).encode()).hexdigest()
        rows.append((case.name, f"{k}-{k + len(block) - 1}", hashed, block[-1]))
    return rows


def csv_text(header, rows):
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows([header, *rows])
    return text.getvalue()


def rounded(value):
    return f"{Decimal(value):.27e}"


def make(root, edmill):
    double, wide = [], []
    for case in tables.cases():
        double += double_rows(root, edmill, case)
        for row in csv.DictReader(collisions(root, edmill, case, WIDE_EVENTS, "mpfr50")):
            wide.append([case.name, row["index"]] +
                        [rounded(row[key]) if key in VALUES else row[key] for key in COLUMNS[2:]])
    return {
        DOUBLE: csv_text(("case", "events", "sha256", "last_event"), double),
        MPFR50: csv_text(COLUMNS, wide)
    }


def double_problems(root, edmill):
    wanted = {}
    for row in csv.reader(io.StringIO((root / DOUBLE).read_text())):
        wanted.setdefault(row[0], []).append(tuple(row))
    problems = []
    for case in tables.cases():
        found = double_rows(root, edmill, case)
        if found == wanted.get(case.name):
            continue
        first = next(
            (pair for pair in zip(wanted.get(case.name, [])[1:], found[1:]) if pair[0] != pair[1]),
            None)
        where = "in length"
        if first:
            where = f"first in events {first[0][1]}, whose last is\n    {first[1][3]}\n  not\n    {first[0][3]}"
        problems.append(f"{case.name}: events in double differ from {DOUBLE}, {where}")
    return problems


def mpfr50_problems(root, edmill):
    wanted = {}
    for row in csv.DictReader(io.StringIO((root / MPFR50).read_text())):
        wanted.setdefault(row["case"], []).append(row)
    problems = []
    for case in tables.cases():
        found = list(csv.DictReader(collisions(root, edmill, case, WIDE_EVENTS, "mpfr50")))
        problems += difference(case.name, wanted.get(case.name, []), found)
    return problems


def difference(name, wanted, found):
    """The first event that differs: bodies, or a value by more than 1e-25 of the largest of its
    kind."""
    if len(wanted) != len(found):
        return [f"{name}: {len(found)} events in mpfr50, not {len(wanted)}"]
    limits = {
        key: max(abs(Decimal(row[key])) for row in wanted) * Decimal(10) ** -DIGITS
        for key in VALUES
    }
    for a, b in zip(wanted, found):
        bad = [key for key in BODIES if a[key] != b[key]]
        bad += [key for key in VALUES if abs(Decimal(a[key]) - Decimal(b[key])) > limits[key]]
        if bad:
            values = ", ".join(f"{key} ({b[key]}, not {a[key]})" for key in bad)
            return [f"{name}: event {a['index']} in mpfr50 differs from {MPFR50} in {values}"]
    return []
