#!/usr/bin/env python3
"""Writes the 24 cases of tables.py: regression/ward/cases/*.toml, and docs/examples/ward.sweep.toml
over ward.toml.

usage: make_cases.py [--check]    --check writes nothing and fails when a file is not what it would
    write
"""
import pathlib
import sys

import tables

ROOT = pathlib.Path(__file__).resolve().parents[2]
CASES = ROOT / "regression" / "ward" / "cases"
EXAMPLES = ROOT / "docs" / "examples"

CASE = """\
# {count} balls of {diameter} mm with {powder} g of powder, charge ratio {charge_ratio}: tables 5.1 to 5.4 of the thesis.
# Made by regression/ward/make_cases.py.
[run]
start_time = "30 s"
end_time = "150 s"
seed = 1
gravity = "9.8 m/s2"

[mill]
type = "spex8000"
speed = "1054 rpm"
arm = "10 cm"
theta_max = "15 deg"
gamma_max = "15 deg"

[vessel]
type = "cylinder"
diameter = "38 mm"
height = "57 mm"

[powder]
mass = "{powder} g"

[contact]
model = "walton-braun"
restitution = {restitution}
friction = 0.4
least_separation = "1 cm/s"

[[balls]]
count = {count}
diameter = "{diameter} mm"
density = "8 g/cm3"
gap_ball = "0.2 mm"          # 908 balls have to find a place
"""
SWEEP_HEAD = """\
# The 24 cases of the thesis's tables 5.1 to 5.4: 2 g and 5 g of powder, three charge ratios, four diameters.
# The numbers of balls are the thesis's; "charge_ratio" in place of "balls.0.count" gives the same.
# Made by regression/ward/make_cases.py.
#
#     edmill sweep docs/examples/ward.sweep.toml
[sweep]
case = "ward.toml"
replicas = 1
"""
SWEEP_POINT = """\
[[sweep.point]]
name = "{powder} g, {charge_ratio}, {diameter} mm"
set = {{ "powder.mass" = "{powder} g", "balls.0.diameter" = "{diameter} mm", "balls.0.count" = {count}, \
"contact.restitution" = {restitution} }}
"""


def files():
    """Text of every file, by place."""
    made = {CASES / f"{case.name}.toml": CASE.format(**case._asdict()) for case in tables.cases()}
    sweep, group = SWEEP_HEAD, None
    for case in tables.cases():
        if group != (case.powder, case.charge_ratio):
            group = case.powder, case.charge_ratio
            sweep += f"\n# {case.powder} g of powder, charge ratio {case.charge_ratio}\n"
        sweep += SWEEP_POINT.format(**case._asdict())
    made[EXAMPLES / "ward.sweep.toml"] = sweep
    # What all cases share is the 28 balls' case under another heading.
    shared = made[CASES / "5g_2_5_4_76mm.toml"].split("\n", 2)[2]
    made[EXAMPLES / "ward.toml"] = (
        "# The mill of Ward et al. (2005) as the thesis runs it in chapter 5: what all cases of tables 5.1 to 5.4 share.\n"
        "# ward.sweep.toml sets the powder, the balls and the restitution. Made by regression/ward/make_cases.py.\n"
        + shared)
    return made


def main():
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(__doc__.strip())
    made = files()
    if sys.argv[1:]:
        stale = [
            place for place, text in made.items() if not place.exists() or place.read_text() != text
        ]
        stale += sorted(set(CASES.glob("*")) - set(made))
        for place in stale:
            print(f"{place.relative_to(ROOT)}: not what make_cases.py makes", file=sys.stderr)
        sys.exit(1 if stale else 0)
    CASES.mkdir(exist_ok=True)
    for place, text in made.items():
        place.write_text(text)


if __name__ == "__main__":
    main()
