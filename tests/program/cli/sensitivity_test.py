#!/usr/bin/env python3
"""The derivative with respect to any number of a case is the difference of two runs divided by that
of the number, for numbers of every kind: of tables and lists, set by an option, zero, at an end of
their range, and those that place the balls or begin the run.

usage: PYTHONPATH=tests/support python3 sensitivity_test.py EDMILL [whole]
"""
import functools
import pathlib
import re
import sys
import tomllib
from decimal import Decimal, getcontext

from program import EXAMPLES, Trials, edmill, rows, sets

getcontext().prec = 60
EVERY = 1 if len(sys.argv) > 2 else 3  # of the keys of each case
EVENTS = 4
CASES = {
    name: re.sub("(?m)^start_time.*$", "", (EXAMPLES / f"{name}.toml").read_text())
    for name in ("demo", "planetary", "shaken_box", "vibrated_box", "materials",
                 "oscillating_table", "ward")
}
CASES["ends"] = """[run]
end_time = "1 s"
gravity = ["0 m/s2", "-9.81 m/s2", "0 m/s2"]
[mill]
type = "chain"
[[mill.joint]]
translate = "y"
swing = [{ amplitude = "5 mm", speed = "1500 rpm" }, { amplitude = "1 mm", speed = "3000 rpm", phase = "20 deg" }]
[vessel]
type = "box"
size = ["40 mm", "50 mm", "40 mm"]
[contact]
restitution = 1
friction = 0
[[ball]]
diameter = "10 mm"
position = ["0 mm", "-19 mm", "1 mm"]
velocity = ["10 cm/s", "0 m/s", "0 m/s"]
spin = ["0 rad/s", "3 rad/s", "0 rad/s"]
[[ball]]
diameter = "8 mm"
position = ["2 mm", "5 mm", "0 mm"]
"""
# Settings of whole tables go before the file's.
SET = {
    "demo": [[], ["contact={restitution=0.6, friction=0.1}", 'balls=[{count=10, diameter="6 mm"}]'],
             ["run.gravity='9.7 m/s2'"]],
    "ends": [[],
             [
                 "ball.0.position.1=\"-18 mm\"",
                 'mill.joint.0.swing.0={amplitude="4 mm", speed="1400 rpm"}'
             ]]
}
PLAIN = {"run.seed", "run.max_collisions", "run.dose_rate_precision"}


def numbers(node, path=""):
    """Keys of all numbers, with number and unit."""
    if isinstance(node, dict):
        for key, value in node.items():
            yield from numbers(value, f"{path}.{key}" if path else key)
    elif isinstance(node, list):
        for k, value in enumerate(node):
            yield from numbers(value, f"{path}.{k}")
    elif not isinstance(node, bool):
        found = re.fullmatch(r"([-+0-9.eE]+) *(.*)", str(node))
        if found and any(c.isdigit() for c in found[1]):
            yield path, Decimal(found[1]), found[2], isinstance(node, int)


def value_of(key, tables):
    for part in key.split("."):
        tables = tables[int(part) if isinstance(tables, list) else part]
    return tables


def with_settings(text, settings):
    tables = tomllib.loads(text)
    for setting in settings:
        key, value = setting.split("=", 1)
        *path, last = key.split(".")
        place = value_of(".".join(path), tables) if path else tables
        place[int(last) if isinstance(place, list) else last] = tomllib.loads("value = " +
                                                                              value)["value"]
    return tables


QUANTITIES = ("time", "approach_speed", "slip_speed", "milling_dose", "wall_work")


@functools.lru_cache(None)
def events(name, *settings):
    done = edmill("run", f"{name}.toml", "--quiet", "--out", "out", "--precision", "mpfr50",
                  *sets(*settings, f"run.max_collisions={EVENTS}", 'output=[{type="collisions"}]'))
    return rows("out/collisions.csv")[:EVENTS] if done.returncode == 0 else None


def compare(t, name, settings, key, value, unit):
    what = f"{name} {settings}: {key}"
    done = edmill("sensitivity", f"{name}.toml", "--by", key, "--events", EVENTS, "--out", "d.csv",
                  "--digits", "15", *sets(*settings))
    t.check(done.returncode == 0, f"{what}: {done.stderr}")
    found = rows("d.csv")
    step = max(abs(value), Decimal(1)) * Decimal("1e-17")
    with_number = lambda number: events(name, *settings, f'{key}="{number} {unit}"'
                                        if unit else f"{key}={number:f}")
    before, middle, after = with_number(value - step), events(name,
                                                              *settings), with_number(value + step)
    t.check(middle and (before or after), f"{what}: no run with other values")
    for quantity in QUANTITIES:
        slope = lambda a, b: [(Decimal(y[quantity]) - Decimal(x[quantity])) / step
                              for x, y in zip(a, b)] if a and b else None
        right, left = slope(middle, after), slope(before, middle)
        derivatives = [Decimal(row[f"d_{quantity}_0"]) for row in found]
        size = max(map(abs, (right or left) + derivatives))
        # A slip that begins has one on either side: the derivative is that to larger values.
        off = max(abs(a - b) for a, b in zip(right or left, derivatives))
        t.check(off <= Decimal("1e-9") * size + Decimal("1e-25"),
                f"{what}: {quantity}: {derivatives}, runs have {right or left}")


def begins_late(t):
    """Where a run begins from a file, the drive's period moves its start."""
    edmill("run", "planetary.toml", "--quiet", "--out", "first", "--set", 'run.end_time="0.31 s"',
           "--precision", "mpfr50", code=0)
    state = ['run.initial_state="first/final_state.csv"']
    for key, unit in (("mill.speed", "rpm"), ("mill.ratio", "")):
        compare(t, "planetary", state, key, Decimal(300) if unit else Decimal(-2), unit)


with Trials() as t:
    kept = 0
    for name, text in CASES.items():
        pathlib.Path(f"{name}.toml").write_text(text)
        for settings in SET.get(name, [[]]):
            for key, value, unit, whole in numbers(with_settings(text, settings)):
                if key.split(".")[0] in ("output", "audit",
                                         "powder") or key in ("run.end_time", "run.start_time",
                                                              "run.target_dose"):
                    continue
                kept += 1
                if key in PLAIN or key.endswith("count"):
                    done = edmill("sensitivity", f"{name}.toml", "--by", key, "--events", EVENTS)
                    t.refused(done, f"{name}: {key}", key, "a parameter that varies continuously")
                elif kept % EVERY == 0 or settings:
                    compare(t, name, settings, key, value, unit)
    begins_late(t)
    t.refused(
        edmill("sensitivity", "demo.toml", "--by", "contact.friction", "--events", "3", "--digits",
               "1000"), "digits", "--digits", "1000", "360")
print(f"{t.checks} checks of derivatives")
