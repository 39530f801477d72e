#!/usr/bin/python3
"""The files of regression/reference/dem are those that make_cases.py writes, and a contact
integrated step by step has their values."""
import importlib.util
import math
import pathlib
import re
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parents[3] / "regression/reference/dem"
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
    return {
        "largest_overlap": deepest, "largest_force": strongest, "duration": time, "speed_after": -v
    }


with tempfile.TemporaryDirectory() as folder:
    spec = importlib.util.spec_from_file_location("make_cases", FOLDER / "make_cases.py")
    make = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(make)
    files = {}
    for family in make.FAMILIES:
        for case in family():
            files[case.name + ".yaml"] = case.text()
check(files == {file.name: file.read_text() for file in FOLDER.glob("*.yaml")},
      "the files are not those of make_cases.py")

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
        check(off <= entry["relative_tolerance"],
              f"{file.name}: {name} {found[name]:.6g}, not {entry['value']:.6g}")

for file in sorted(FOLDER.glob("chung_ooi_4_*.yaml")):
    given, expected = read(file)
    for name, entry in expected.items():
        degrees = float(name.rsplit("_", 1)[1])
        normal, along = given["speed"] * math.cos(math.radians(degrees)), given["speed"] * math.sin(
            math.radians(degrees))
        change = given["friction"] * (1 + given["restitution"]) * normal
        spin = change * given["radius"] / (0.4 * given["radius"] ** 2
                                          )  # torque impulse over the moment of inertia, per mass
        check(along - change - given["radius"] * spin > 0,
              f"{file.name}: at {degrees} degrees the contact sticks")
        value = spin if name.startswith("spin") else 1 - change / along
        check(
            abs(value / entry["value"] - 1) < 1e-12,
            f"{file.name}: {name} {value}, not {entry['value']}")


def sliding(speed, along, spin, radius, friction, restitution, second_mass=math.inf,
            second_radius=1.0, second_spin=0.0, steps=20000):
    """Speeds and spin after a contact of a sphere of mass 1, integrated: a spring that is stiffer
    when it unloads, and Coulomb's friction. Positive slip is that of the sphere's surface along x;
    the other body has `second_mass` and, with the same sense of spin, rubs too."""
    stiffness = 1e6
    effective = 1 / (1 + 1 / second_mass)
    step = math.pi / 2 * math.sqrt(effective / stiffness) / steps
    x, v, deepest = 0.0, speed, 0.0  # overlap and its rate
    other_along, other_spin = 0.0, second_spin
    slips = True
    while True:
        x += v * step / 2
        if v > 0:
            deepest, force = x, stiffness * x
        else:
            force = stiffness / restitution ** 2 * (x - deepest * (1 - restitution ** 2))
        if force <= 0 and v <= 0:
            break
        v -= force / effective * step
        slip = along - radius * spin - other_along - second_radius * other_spin
        direction = math.copysign(1.0, slip)
        slips = slips and abs(slip) > 1e-9
        push = -direction * friction * force * step
        along += push
        spin -= push * radius / (0.4 * radius ** 2)
        other_along -= push / second_mass
        if second_mass < math.inf:
            other_spin -= push * second_radius / (0.4 * second_mass * second_radius ** 2)
        x += v * step / 2
    return {
        "tangential_speed_after": along, "spin_after": spin, "slips": slips,
        "normal_speed_after": -v
    }


def compare(file, found, suffix, expected):
    check(found["slips"], f"{file.name}: {suffix}: the contact sticks")
    for name, entry in expected.items():
        if name.endswith(suffix) and name.removesuffix(suffix) in found:
            value = found[name.removesuffix(suffix)]
            check(
                abs(value / entry["value"] - 1) <= 1e-3,
                f"{file.name}: {name} {value:.6g}, not {entry['value']:.6g}")


for file in sorted(FOLDER.glob("chung_ooi_5_*.yaml")):
    given, expected = read(file)
    for along in {name.rsplit("_", 1)[1] for name in expected}:
        compare(
            file,
            sliding(given["normal_speed"], float(along), 0.0, given["radius"], given["friction"],
                    given["restitution"]), "_" + along, expected)
for file in sorted(FOLDER.glob("chung_ooi_[678]_*.yaml")):
    given, expected = read(file)
    for spin in {name.rsplit("_", 1)[1] for name in expected}:
        more = {}
        if "_7_" in file.name:  # by symmetry, each sphere is as at a plane that its neighbour's surface moves
            more = dict(second_mass=1.0, second_radius=given["radius"], second_spin=float(spin))
        elif "second_radius" in given:
            more = dict(second_mass=given["second_mass_over_first"],
                        second_radius=given["second_radius"])
        approach = given["speed"] * (2 if "_7_" in file.name else 1)
        compare(
            file,
            sliding(approach, 0.0, float(spin), given["radius"], given["friction"],
                    given["restitution"], **more), "_" + spin, expected)
given, expected = read(FOLDER / "mohajeri_oblique.yaml")
compare(
    FOLDER / "mohajeri_oblique.yaml",
    sliding(given["normal_speed"], given["tangential_speed"], 0.0, given["radius"],
            given["friction"], given["restitution"]), "", expected)
given, expected = read(FOLDER / "mohajeri_rolling.yaml")
for time in (0.005, 0.01, 0.015):
    spin = given["spin"]
    for _ in range(1000):  # torque over the moment of inertia
        spin -= given["rolling_resistance"] * given["radius"] * given["gravity"] / (
            0.4 * given["radius"] ** 2) * time / 1000
    check(
        abs(spin / expected[f"spin_at_{time}"]["value"] - 1) < 1e-9,
        f"mohajeri_rolling: spin at {time} s")
given, expected = read(FOLDER / "mohajeri_pull_off.yaml")
# DMT: 2 pi w R*, with the work of adhesion w = 2 gamma and R* = R/2.
check(
    abs(2 * math.pi * 2 * given["surface_energy"] * given["radius"] / 2 /
        expected["pull_off_force"]["value"] - 1) < 1e-12, "pull-off force")
print(f"{len(files)} files, {len(failures)} failed")
sys.exit(bool(failures))
