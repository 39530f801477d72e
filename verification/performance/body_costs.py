#!/usr/bin/env python3
"""CPU time for a collision with bodies inside the vessel over that without: eight bars in a shaken
cylinder; and the growth of the cost from 400 to 4000 balls around a rotor with four blades.

usage: body_costs.py EDMILL [--rounds 5]

The ratios are of one round each, the tables have their medians and ranges."""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import tempfile

SHAKEN = """[run]
gravity = "9.8 m/s2"
end_time = "{time} s"
[mill]
type = "vibratory"
amplitude = [0, "5 mm", 0]
speed = "1800 rpm"
[vessel]
diameter = "80 mm"
height = "60 mm"
{bodies}
[contact]
restitution = 0.6
friction = 0.4
[[balls]]
count = {count}
diameter = "6 mm"
"""
BARS = """[[body]]
size = ["20 mm", "6 mm", "6 mm"]
rounding = "{rounding} mm"
joint = [{{ translate = [0, "{y} mm", 0] }}, {{ rotate = "y", speed = "{rpm} rpm" }}, {{ translate = ["18 mm", 0, 0] }}]
repeat = 4
"""
ROTOR = """[run]
gravity = ["-9.81 m/s2", 0, 0]
end_time = "{time} s"
[mill]
type = "chain"
joint = [{{ rotate = "y", angle = "45 deg" }}]
[vessel]
diameter = "{D:.3f} mm"
height = "{H:.3f} mm"
[[body]]
type = "cylinder"
diameter = "{shaft:.3f} mm"
height = "{H:.3f} mm"
joint = [{{ rotate = "y", speed = "{rpm:.3f} rpm" }}]
[[body]]
size = ["{width:.3f} mm", "{height:.3f} mm", "{thick:.3f} mm"]
joint = [{{ rotate = "y", speed = "{rpm:.3f} rpm" }}, {{ translate = ["{place:.3f} mm", 0, 0] }}]
repeat = 4
[contact]
restitution = 0.9
friction = 0.2
[[balls]]
count = {count}
diameter = "5 mm"
"""


def cost(edmill, text, folder):
    """CPU time for a collision [s]."""
    case = pathlib.Path(folder) / "case.toml"
    case.write_text(text)
    subprocess.run([edmill, "run", case, "--quiet", "--out", f"{folder}/out"], check=True,
                   stdout=subprocess.DEVNULL)
    return 1 / json.loads(
        (pathlib.Path(folder) / "out/summary.json").read_text())["collisions_per_cpu_second"]


def shaken(count, bodies=""):
    return SHAKEN.format(time=6 if count < 100 else 2, count=count, bodies=bodies)


def rotor(count, fill):
    """The vessel and all of the rotor grow with the volume of the balls; the tips of the blades
    keep their speed."""
    diameter = (count * math.pi / 6 * 5 ** 3 / fill * 4 / math.pi / 1.2) ** (1 / 3)
    return ROTOR.format(time=0.5 if count < 1000 else 0.2, D=diameter, H=1.2 * diameter,
                        shaft=0.12 * diameter, rpm=36000 / diameter, width=0.25 * diameter,
                        height=1.08 * diameter, thick=0.04 * diameter, place=0.2 * diameter,
                        count=count)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("edmill")
    parser.add_argument("--rounds", type=int, default=5)
    given = parser.parse_args()
    bars, growth = {}, {}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(given.rounds):
            for count in (28, 60, 200):
                empty = cost(given.edmill, shaken(count), folder)
                for rounding, rpm in ((0, 0.001), (0, 300), (2, 300)):
                    bodies = BARS.format(rounding=rounding, y=-12, rpm=rpm) + BARS.format(
                        rounding=rounding, y=10, rpm=-rpm)
                    name = f"{count} balls | {'sharp' if rounding == 0 else 'rounded'}, {'at rest' if rpm < 1 else 'turning'}"
                    bars.setdefault(name, []).append(
                        cost(given.edmill, shaken(count, bodies), folder) / empty)
            for fill in (0.06, 0.12, 0.25):
                growth.setdefault(f"{100 * fill:.0f} %", []).append(
                    cost(given.edmill, rotor(4000, fill), folder) /
                    cost(given.edmill, rotor(400, fill), folder))
    for title, table in (
        ("| charge | eight bars | CPU time for a collision, without bars 1 |\n|---|---|---|", bars),
        ("| part of the volume that balls fill | 4000 over 400 balls |\n|---|---|", growth)):
        print(title)
        for name, values in table.items():
            print(
                f"| {name} | {statistics.median(values):.2f} ({min(values):.2f} to {max(values):.2f}) |"
            )


if __name__ == "__main__":
    main()
