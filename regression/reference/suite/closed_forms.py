#!/usr/bin/env python3
"""Exact events of the cases that have closed forms, in 40 digits, by Python's decimal numbers; edmill has no part in it.

usage: closed_forms.py FOLDER     writes <case>/events.csv and suite.json below FOLDER"""
import json
import pathlib
import re
import sys
import tomllib
from decimal import Decimal, getcontext

getcontext().prec = 50
PI = Decimal("3.14159265358979323846264338327950288419716939937510582")
HERE = pathlib.Path(__file__).resolve().parent
UNITS = {"m": 1, "mm": Decimal("0.001"), "m/s": 1, "s": 1, "m/s2": 1, "kg/m3": 1, "g/cm3": 1000}
COLUMNS = ["time", "approach_speed", "slip_speed", "milling_dose", "x", "y", "z", "vx_after", "vy_after", "vz_after",
           "wx_after", "wy_after", "wz_after"]


def number(text):
    value, unit = re.fullmatch(r"(\S+) (\S+)", text).groups()
    return Decimal(value) * UNITS[unit]


def vector(texts):
    return [number(t) for t in texts]


def case(name):
    return tomllib.loads((HERE / name / "case.toml").read_text(), parse_float=Decimal)


def mass(ball):
    return number(ball.get("density", "8 g/cm3")) * PI * number(ball["diameter"])**3 / 6


def bouncing_ball():
    """Falls for sqrt(2 h/g), and flies 2 e^k v/g between impacts k and k + 1."""
    c = case("bouncing_ball")
    ball, g, e = c["ball"][0], number(c["run"]["gravity"]), c["contact"]["restitution"]
    radius, floor = number(ball["diameter"]) / 2, -number(c["vessel"]["size"][1]) / 2
    height = vector(ball["position"])[1] - floor - radius
    time, speed = (2 * height / g).sqrt(), (2 * g * height).sqrt()
    for _ in range(12):
        yield [0, "wall", 0, time, speed, 0, mass(ball) * speed**2 * (1 - e * e) / 2, 0, floor + radius, 0, 0, e * speed,
               0, 0, 0, 0]
        speed *= e
        time += 2 * speed / g


def newtons_cradle():
    """Equal balls exchange their velocities; a wall turns the last one round."""
    c = case("newtons_cradle")
    balls, wall = c["ball"], number(c["vessel"]["size"][0]) / 2
    x = [vector(b["position"])[0] for b in balls]
    diameter, speed, time, moving = number(balls[0]["diameter"]), vector(balls[0]["velocity"])[0], Decimal(0), 0
    last, direction = len(balls) - 1, 1
    for _ in range(24):
        at_end = moving == (last if direction > 0 else 0)
        stop = direction * (wall - diameter / 2) if at_end else x[moving + direction] - direction * diameter
        time += abs(stop - x[moving]) / speed
        x[moving] = stop
        if at_end:
            direction = -direction
            yield [moving, "wall", 3 if direction > 0 else 2, time, speed, 0, 0, stop, 0, 0, direction * speed, 0, 0, 0, 0, 0]
        else:
            low, high = sorted((moving, moving + direction))
            gets = direction * speed if low != moving else Decimal(0)
            yield [low, "ball", high, time, speed, 0, 0, x[low], 0, 0, gets, 0, 0, 0, 0, 0]
            moving += direction


def oblique_impact():
    """(2.23), (2.24): the slip is stopped as far as friction and the least e_t allow; K = 1 + 1/J, J = 2/5."""
    c = case("oblique_impact")
    e, mu, beta = (Decimal(c["contact"][k]) for k in ("restitution", "friction", "min_tangential"))
    floor, stiffness = -number(c["vessel"]["size"][1]) / 2, 1 + Decimal(5) / 2
    for k, ball in enumerate(c["ball"]):
        radius, (x, y, z), (vx, vy, _) = number(ball["diameter"]) / 2, vector(ball["position"]), vector(ball["velocity"])
        time = (y - radius - floor) / -vy
        normal = (1 + e) * -vy                       # change of the normal velocity
        e_t = max(beta, 1 - mu * stiffness * normal / vx)
        tangential = (1 - e_t) * vx / stiffness      # change of the centre's tangential velocity
        spin = -tangential * Decimal(5) / 2 / radius
        dose = mass(ball) / 2 * ((1 - e * e) * vy * vy + (1 - e_t * e_t) * vx * vx / stiffness)
        yield [k, "wall", 0, time, -vy, vx, dose, x + vx * time, floor + radius, z, vx - tangential, -e * vy, 0, 0, 0, spin]


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    for make, columns, source in (
            (bouncing_ball, COLUMNS, "closed form; MFiX DEM02 with rigid contacts"),
            (newtons_cradle, COLUMNS[:4], "closed form"),  # the states are those of either ball
            (oblique_impact, COLUMNS, "closed form; MFiX DEM05, Chung and Ooi 2011, with rigid contacts")):
        folder = pathlib.Path(sys.argv[1]) / make.__name__
        folder.mkdir(parents=True, exist_ok=True)
        lines = [f"# {make.__name__}: {source}; 40 digits, SI, inertial frame",
                 ",".join(["index", "ball", "partner_kind", "partner", *columns])]
        rows = sorted(make(), key=lambda row: row[3])
        for index, row in enumerate(rows):
            cells = [f"{v:.39e}" if isinstance(v, Decimal) else str(v) for v in row[:3 + len(columns)]]
            lines.append(",".join([str(index), *cells]))
        (folder / "events.csv").write_text("\n".join(lines) + "\n")
        about = {"schema": 1, "name": make.__name__, "case": "case.toml", "events": "events.csv", "agree": len(rows),
                 "tolerance": 1e-9, "columns": columns, "source": source}
        (folder / "suite.json").write_text(json.dumps(about, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
