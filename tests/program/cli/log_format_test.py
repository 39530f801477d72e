#!/usr/bin/env python3
"""docs/log-format.md: `edmill check` accepts the examples and what edmill writes, its description
is that of the schema, the page lists the columns of the program, and each fault of a log is named
with its line. Then ro-crate-metadata.json of a run.

usage: PYTHONPATH=tests/support python3 log_format_test.py EDMILL
"""
import json
import os
import random
import re

import jsonschema
from program import SOURCE, Trials, case, edmill

DOCS = SOURCE / "docs"
SCHEMA = json.loads((DOCS / "log-format.schema.json").read_text())
HEADER = "time,ball,partner_kind,partner,approach_speed,vx_before,vy_before,vz_before"


def described(t, log):
    done = edmill("check", str(log), "--json", "log.json")
    t.check(done.returncode == 0, f"{log}: {done.stderr}")
    found = json.loads(open("log.json").read())
    jsonschema.validate(found, SCHEMA)
    return found


def rows(rng, count=30):
    times = sorted(rng.uniform(0, 1) for _ in range(count))
    return [[
        f"{time:.17g}",
        str(rng.randrange(5)), *rng.choice([("wall", str(rng.randrange(3))),
                                            ("ball", str(5 + rng.randrange(5)))]),
        f"{rng.uniform(0, 3):.17g}", *(f"{rng.gauss(0, 1):.17g}" for _ in range(3))
    ] for time in times]


def text_of(table, header=HEADER):
    return "\n".join([header, *map(",".join, table)]) + "\n"


def set_field(column, value):
    return lambda table, k: table[k].__setitem__(column, value)


# What is done to row k, and what the message must have beside the line.
FAULTS = {
    "a word as time": (set_field(0, "soon"), "expected a number"),
    "a time that is not finite": (set_field(0, "inf"), "not finite"),
    "no time": (set_field(0, ""), "expected a number"),
    "an earlier time": (set_field(0, "-1"), "before that of an earlier line"),
    "a ball below zero": (set_field(1, "-4"), "ball -4"),
    "a ball with a point": (set_field(1, "1.5"), "expected the number of a ball"),
    "an unknown kind": (set_field(2, "rod"), "expected ball or wall"),
    "no partner": (set_field(3, ""), "expected the number of a ball or a wall"),
    "a velocity that is no number": (set_field(5, "nan"), "nan in column vx_before"),
    "a field too many": (lambda table, k: table[k].append("1"), "found 9 fields, expected 8"),
}


def check_faults(t, rng):
    for name, (spoil, words) in FAULTS.items():
        table = rows(rng)
        k = rng.randrange(3, len(table))
        spoil(table, k)
        open("bad.csv", "w").write(text_of(table))
        done = edmill("check", "bad.csv")
        t.check(done.returncode == 2 and f"bad.csv:{k + 2}" in done.stderr and words in done.stderr,
                f"{name}, line {k + 2}: {done.stderr}")
    # Two faults at once are both named.
    table = rows(rng)
    FAULTS["a word as time"][0](table, 4)
    FAULTS["an earlier time"][0](table, 9)
    open("bad.csv", "w").write(text_of(table))
    done = edmill("check", "bad.csv")
    t.check("bad.csv:6" in done.stderr and "bad.csv:11" in done.stderr,
            f"two faults: {done.stderr}")
    for missing in ("time", "ball", "partner"):
        open("bad.csv", "w").write(text_of(rows(rng), HEADER.replace(missing + ",", "other,", 1)))
        done = edmill("check", "bad.csv")
        t.check(done.returncode == 2 and f"'{missing}'" in done.stderr,
                f"no column {missing}: {done.stderr}")
    open("bad.csv", "w").write("# collision log 2\n" + text_of(rows(rng)))
    t.check("version 2" in edmill("check", "bad.csv").stderr, "another version")


def check_recognition(t, rng):
    """Tables and cases are distinguished by their first line, whatever separates the columns."""
    table = rows(rng)
    for separator in ",;\t":
        open("log", "w").write(text_of(table).replace(",", separator))
        found = described(t, "log")
        t.check(
            found["rows"] == len(table) and found["skipped"] == [] and len(found["columns"]) == 8,
            f"separator {separator!r}: {found}")
    open("log",
         "w").write(text_of([row + ["7"] for row in table], HEADER + ',"impulse [N s], total"'))
    t.check(
        described(t, "log")["skipped"] == ["impulse [N s], total"],
        "a quoted name of a further column")
    for first in ("[run] # a case, and not a log; really", "# a, comment\n\n[run]",
                  "run.seed = 1 # one, two", "run = { seed = 1, end_time = \"1 s\" }"):
        open("case", "w").write(first + "\n")
        t.check("column" not in edmill("check", "case").stderr,
                f"a case that begins with {first!r}")


def check_crate(t):
    open("case.toml", "w").write(case("collisions", "spectra", "milling_dose", "paraview"))
    os.environ["SOURCE_DATE_EPOCH"] = "1300000000"
    for folder in ("one", "two"):
        t.check(edmill("run", "case.toml", "--quiet", "--out", folder).returncode == 0, "a run")
    text = open("one/ro-crate-metadata.json").read()
    t.check(text == open("two/ro-crate-metadata.json").read(), "two runs have the same description")
    entities = {entity["@id"]: entity for entity in json.loads(text)["@graph"]}
    t.check(entities["./"]["datePublished"] == "2011-03-13", "the date")
    listed = {part["@id"] for part in entities["./"]["hasPart"]}
    there = {
        str(os.path.relpath(os.path.join(folder, name), "one"))
        for folder, _, names in os.walk("one") for name in names
    }
    t.check(listed == there - {".edmill-files", "ro-crate-metadata.json"},
            f"files that are listed or there alone: {listed ^ there}")
    t.check(
        all(entities[name]["@type"] == "File" and "encodingFormat" in entities[name]
            for name in listed), "each has its kind")
    for entity in entities.values():  # no reference without its entity
        for value in entity.values():
            for one in value if isinstance(value, list) else [value]:
                t.check(
                    not isinstance(one, dict) or one["@id"] in entities or
                    one["@id"].startswith("https:"), f"no entity {one}")


def main():
    seed = 20261130
    print("seed", seed)
    rng = random.Random(seed)
    with Trials() as t:
        for log in sorted((DOCS / "examples/logs").glob("*.csv")):
            described(t, log)
        for log in sorted((SOURCE / "regression/reference").glob("**/*events.csv")):
            t.check(described(t, log)["rows"] > 7, f"{log} has rows")
        check_crate(t)
        own = described(t, "one/collisions.csv")
        columns = [column["name"] for column in own["columns"]]
        t.check(own["balls"] == 12 and own["walls"] == 3 and own["skipped"] == [],
                f"edmill's own log: {own}")
        page = (DOCS / "log-format.md").read_text()
        named = [
            name for row in re.findall(r"^\| (`.*?) \|", page, re.M)
            for name in re.findall(r"`(\w+)`", row)
        ]
        without = {
            name for name in columns
            if not name.endswith("_after") and not re.match("partner_[vwxyz]", name)
        } - set(named)
        t.check(not without, f"columns that the page lacks: {without}")
        done = edmill("check", "one/final_state.csv")
        t.check(done.returncode == 2 and "no column 'partner'" in done.stderr,
                "a table that is no log")
        t.check(
            edmill("check", "case.toml").stdout.startswith("case.toml is a valid case"), "a case")
        check_faults(t, rng)
        check_recognition(t, rng)
        print(t.checks, "checks")


if __name__ == "__main__":
    main()
