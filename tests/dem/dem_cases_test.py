#!/usr/bin/python3
"""The files of regression/reference/dem are those that make_cases.py writes, and a contact integrated step by step has their values."""
import importlib.util
import math
import pathlib
import re
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "regression/reference/dem"
failures = []


def check(good, text):
    if not good:
        failures.append(text)
        print("FAILED", text)


def read(file):
    """The part of YAML that these files use."""
    given, expected, section = {}, {}, None
    for line in file.read_text().splitlines():
        indent, (key, _, value) = len(line) - len(line.lstrip()), line.strip().partition(": ")
        if indent == 0:
            section = key.rstrip(":")
        elif section == "given":
            given[key] = float(value)
        elif indent == 2:
            name = key.rstrip(":")
            expected[name] = {}
        else:
            expected[name][key] = float(value) if re.fullmatch(r"[-+.\de]+", value) else value
    return given, expected


def contact(mass, radius, modulus, speed, steps=4000):
    """Largest overlap and force, duration and speed after, by leapfrog."""
    stiffness = 4 / 3 * modulus * math.sqrt(radius)
    step = 3 * (mass ** 2 / (radius * modulus ** 2 * speed)) ** 0.2 / steps
    x, v, time, deepest, strongest = 0.0, speed, 0.0, 0.0, 0.0
    while x >= 0 and time < 1:
        x += step * v / 2
        force = stiffness * max(x, 0.0) ** 1.5
        v -= step * force / mass
        x += step * v / 2
        time += step
        deepest, strongest = max(deepest, x), max(strongest, force)
    return {"largest_overlap": deepest, "largest_force": strongest, "duration": time, "speed_after": -v}


with tempfile.TemporaryDirectory() as folder:
    spec = importlib.util.spec_from_file_location("make_cases", FOLDER / "make_cases.py")
    make = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(make)
    files = {}
    for family in (make.chung_ooi_1, make.chung_ooi_2, make.chung_ooi_3, make.chung_ooi_4, make.mfix):
        for case in family():
            files[case.name + ".yaml"] = case.text()
check(files == {file.name: file.read_text() for file in FOLDER.glob("*.yaml")}, "the files are not those of make_cases.py")

for file in sorted(FOLDER.glob("chung_ooi_[12]_*.yaml")):
    given, expected = read(file)
    mass = given["density"] * 4 / 3 * math.pi * given["radius"] ** 3
    modulus = given["young"] / (1 - given["poisson"] ** 2)
    pair = "speed_of_each" in given
    found = contact(mass / 2, given["radius"] / 2, modulus / 2, 2 * given["speed_of_each"]) if pair else \
        contact(mass, given["radius"], modulus, given["speed"])
    found["speed_after"] /= 2 if pair else 1
    for name, entry in expected.items():
        off = abs(found[name] / entry["value"] - 1)
        check(off <= entry["relative_tolerance"], f"{file.name}: {name} {found[name]:.6g}, not {entry['value']:.6g}")

for file in sorted(FOLDER.glob("chung_ooi_4_*.yaml")):
    given, expected = read(file)
    for name, entry in expected.items():
        degrees = float(name.rsplit("_", 1)[1])
        normal, along = given["speed"] * math.cos(math.radians(degrees)), given["speed"] * math.sin(math.radians(degrees))
        change = given["friction"] * (1 + given["restitution"]) * normal
        spin = change * given["radius"] / (0.4 * given["radius"] ** 2)  # torque impulse over the moment of inertia, per mass
        check(along - change - given["radius"] * spin > 0, f"{file.name}: at {degrees} degrees the contact sticks")
        value = spin if name.startswith("spin") else 1 - change / along
        check(abs(value / entry["value"] - 1) < 1e-12, f"{file.name}: {name} {value}, not {entry['value']}")
print(f"{len(files)} files, {len(failures)} failed")
sys.exit(bool(failures))
