#!/usr/bin/env python3
"""CPU time for a collision in other mills and vessels over that in the SPEX with its cylinder: 28
balls of 4.76 mm, e 0.53, mu 0.4.

usage: mill_costs.py EDMILL [--rounds 9] [--collisions 300000]

Every round runs all mills one after the other; the ratios are of one round, the table has their
medians and ranges."""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

DEMO = pathlib.Path(__file__).resolve().parent.parent.parent / "docs/examples/demo.toml"
SPEX = 'mill={type="spex8000", speed="1054 rpm"}'
PLANETARY = 'mill={type="planetary", radius="75 mm", speed="400 rpm", ratio=-2}'
VIBRATORY = 'mill={type="vibratory", amplitude=["3 mm", "11 mm", "-2 mm"], speed="900 rpm"}'
CYLINDER = 'vessel={type="cylinder", diameter="38 mm", height="57 mm"}'
BOX = 'vessel={type="box", size=["33 mm", "57 mm", "36 mm"]}'
CAPSULE = 'vessel={type="capsule", diameter="38 mm", height="57 mm"}'
ROUNDED = 'vessel={type="rounded_cylinder", diameter="38 mm", height="57 mm", edge_radius="6 mm"}'
SPHERE = 'vessel={type="sphere", diameter="48 mm"}'
PISTON = (
    'vessel={type="cylinder", diameter="38 mm", height="57 mm", piston=[{wall="cap +y", distance="4 mm", '
    'swing=[{amplitude="3 mm", speed="1500 rpm"}]}]}')
MILLS = {
    "SPEX, cylinder": (SPEX, CYLINDER),
    "SPEX, box": (SPEX, BOX),
    "SPEX, sphere": (SPEX, SPHERE),
    "SPEX, capsule": (SPEX, CAPSULE),
    "SPEX, rounded cylinder": (SPEX, ROUNDED),
    "SPEX, cylinder with a piston": (SPEX, PISTON),
    "planetary, cylinder": (PLANETARY, CYLINDER),
    "planetary, box": (PLANETARY, BOX),
    "vibratory, cylinder": (VIBRATORY, CYLINDER),
    "vibratory, box": (VIBRATORY, BOX),
}


def cost(edmill, settings, collisions, folder):
    """CPU time for a collision [s]."""
    given = [x for s in (*settings, "run.start_time=0 s", "run.end_time=1000 s",
                         f"run.max_collisions={collisions}") for x in ("--set", s)]
    subprocess.run([edmill, "run", DEMO, "--quiet", "--out", folder, *given], check=True,
                   stdout=subprocess.DEVNULL)
    return 1 / json.loads(
        (pathlib.Path(folder) / "summary.json").read_text())["collisions_per_cpu_second"]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("edmill")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--collisions", type=int, default=300000)
    given = parser.parse_args()
    ratios = {name: [] for name in MILLS}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(given.rounds):
            costs = {
                name: cost(given.edmill, settings, given.collisions, folder)
                for name, settings in MILLS.items()
            }
            for name, value in costs.items():
                ratios[name].append(value / costs["SPEX, cylinder"])
    print("| mill, vessel | CPU time for a collision, SPEX with cylinder 1 |\n|---|---|")
    for name, values in ratios.items():
        print(
            f"| {name} | {statistics.median(values):.2f} ({min(values):.2f} to {max(values):.2f}) |"
        )


if __name__ == "__main__":
    main()
