#!/usr/bin/env python3
"""Figures of docs/mills.md that published ones stand beside: impact speeds in the SPEX, energies
and friction's part in a planetary mill.

usage: peers.py EDMILL

Needs python3-h5py and python3-numpy."""
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy

EXAMPLES = pathlib.Path(__file__).resolve().parent.parent / "examples"


def impacts(edmill, case, settings):
    """All variables of each impact, by name."""
    with tempfile.TemporaryDirectory() as folder:
        given = [*settings, 'output=[{type="iterations", file="iterations.h5"}]']
        command = [edmill, "run", EXAMPLES / case, "--quiet", "--out", folder]
        subprocess.run(command + [text for setting in given for text in ("--set", setting)],
                       check=True)
        with h5py.File(pathlib.Path(folder) / "iterations.h5") as file:
            found = {}
            file.visititems(
                lambda name, item: found.update({name.split("/")[-1].split(" ")[0]: item[()]})
                if isinstance(item, h5py.Dataset) else None)
            return found


def by_dose(values, dose, shares):
    """Values below which impacts have these shares of the whole dose."""
    order = numpy.argsort(values)
    reached = numpy.cumsum(dose[order]) / dose.sum()
    return [values[order][numpy.searchsorted(reached, share)] for share in shares]


def show(title, found, mass):
    dose, speed = found["milling_dose"], found["contact_normal_speed_before"]
    low, middle, high = by_dose(speed, dose, (0.1, 0.5, 0.9))
    energy = by_dose(dose, dose, (0.1, 0.5, 0.9))
    ball_energy = 0.5 * mass * found["relative_speed_before"]**2
    kinetic = by_dose(ball_energy, dose, (0.1, 0.5, 0.9))
    print(f"{title}: {len(dose)} impacts")
    print(
        f"  speed of approach that 10, 50, 90 % of the dose lie below: {low:.2f}, {middle:.2f}, {high:.2f} m/s"
    )
    print(
        f"  dose of an impact, the same: {energy[0] * 1e3:.3g}, {energy[1] * 1e3:.3g}, {energy[2] * 1e3:.3g} mJ"
    )
    print(
        f"  m v^2/2 of a ball before, the same: {kinetic[0] * 1e3:.3g}, {kinetic[1] * 1e3:.3g}, {kinetic[2] * 1e3:.3g} mJ"
    )
    print(
        f"  part of the dose that friction dissipates: {found['dose_tangential'].sum() / dose.sum():.3f}"
    )


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    edmill = sys.argv[1]
    ball = lambda diameter: 7800 * numpy.pi * diameter**3 / 6
    show("SPEX, 28 balls of 4.76 mm", impacts(edmill, "demo.toml", ["run.end_time=\"5 s\""]),
         ball(0.00476))
    for rpm, friction in ((300, 0.3), (500, 0.3), (300, 0.75), (300, 1.5)):
        show(
            f"planetary mill, disc at {rpm} rpm, 20 balls of 8 mm, friction {friction}",
            impacts(edmill, "planetary.toml", [
                f'mill.speed="{rpm} rpm"', f"contact.friction={friction}", 'run.start_time="0.5 s"',
                'run.end_time="1.5 s"'
            ]), ball(0.008))
    return 0


if __name__ == "__main__":
    sys.exit(main())
