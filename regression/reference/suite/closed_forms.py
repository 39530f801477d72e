#!/usr/bin/env python3
"""Exact events and limits of cases with closed forms, in 40 digits, by Python's decimal numbers;
edmill has no part in it.

usage: closed_forms.py FOLDER     writes events.csv, statistics.csv and suite.json of these cases
    below FOLDER"""
import json
import pathlib
import re
import sys
import tomllib
from decimal import Decimal, getcontext

getcontext().prec = 50
PI = Decimal("3.14159265358979323846264338327950288419716939937510582")
HERE = pathlib.Path(__file__).resolve().parent
UNITS = {
    "m": 1, "mm": Decimal("0.001"), "m/s": 1, "mm/s": Decimal("0.001"), "s": 1, "m/s2": 1,
    "rad/s": 1, "kg/m3": 1, "g/cm3": 1000
}
COLUMNS = [
    "time", "approach_speed", "slip_speed", "milling_dose", "x", "y", "z", "vx_after", "vy_after",
    "vz_after", "wx_after", "wy_after", "wz_after"
]
SCHEMA = 2  # of suite.json
STATISTICS = [
    "name", "unit", "value", "standard_uncertainty", "ci95", "replicas", "tolerance", "theory",
    "theory_is", "meaning"
]  # columns of statistics.csv
K = Decimal(7) / 2  # 1 + 1/J of a solid ball at a wall, J = 2/5


def number(text):
    value, unit = re.fullmatch(r"(\S+) (\S+)", text).groups()
    return Decimal(value) * UNITS[unit]


def vector(texts):
    return [number(t) for t in texts]


def case(name):
    return tomllib.loads((HERE / name / "case.toml").read_text(), parse_float=Decimal)


def mass(ball):
    return number(ball.get("density", "8 g/cm3")) * PI * number(ball["diameter"])**3 / 6


def stopped_slip(contact, normal, slip):
    """(2.24): e_t and the change of the centre's speed along the slip; `normal` is the change of
    the normal speed."""
    mu, beta = Decimal(contact["friction"]), Decimal(contact["min_tangential"])
    e_t = max(beta, 1 - mu * K * normal / abs(slip)) if slip else beta
    return e_t, -(1 - e_t) * slip / K


def bouncing_ball():
    """Falls for sqrt(2 h/g), and flies 2 e^k v/g between impacts k and k + 1."""
    c = case("bouncing_ball")
    ball, g, e = c["ball"][0], number(c["run"]["gravity"]), c["contact"]["restitution"]
    radius, floor = number(ball["diameter"]) / 2, -number(c["vessel"]["size"][0]) / 2
    height = vector(ball["position"])[1] - floor - radius
    time, speed = (2 * height / g).sqrt(), (2 * g * height).sqrt()
    for _ in range(12):
        yield [
            0, "wall", 0, time, speed, 0,
            mass(ball) * speed ** 2 * (1 - e * e) / 2, 0, floor + radius, 0, 0, e * speed, 0, 0, 0,
            0
        ]
        speed *= e
        time += 2 * speed / g


def newtons_cradle():
    """Equal balls exchange their velocities; a wall turns the last one round."""
    c = case("newtons_cradle")
    balls, wall = c["ball"], number(c["vessel"]["size"][0]) / 2
    x = [vector(b["position"])[0] for b in balls]
    diameter, speed, time, moving = number(balls[0]["diameter"]), vector(
        balls[0]["velocity"])[0], Decimal(0), 0
    last, direction = len(balls) - 1, 1
    for _ in range(24):
        at_end = moving == (last if direction > 0 else 0)
        stop = direction * (wall - diameter / 2) if at_end else x[moving +
                                                                  direction] - direction * diameter
        time += abs(stop - x[moving]) / speed
        x[moving] = stop
        if at_end:
            direction = -direction
            yield [moving, "wall", 3 if direction > 0 else 2, time, speed, 0, 0]
        else:
            low, high = sorted((moving, moving + direction))
            yield [low, "ball", high, time, speed, 0, 0]
            moving += direction


def oblique_impact():
    """(2.23), (2.24): the slip is stopped as far as friction and the least e_t allow."""
    c = case("oblique_impact")
    e, floor = Decimal(c["contact"]["restitution"]), -number(c["vessel"]["size"][0]) / 2
    for k, ball in enumerate(c["ball"]):
        radius, (x, y, z), (vx, vy, _) = number(ball["diameter"]) / 2, vector(
            ball["position"]), vector(ball["velocity"])
        time = (y - radius - floor) / -vy
        e_t, change = stopped_slip(c["contact"], (1 + e) * -vy, vx)
        spin = change * Decimal(5) / 2 / radius
        dose = mass(ball) / 2 * ((1 - e * e) * vy * vy + (1 - e_t * e_t) * vx * vx / K)
        yield [
            k, "wall", 0, time, -vy, vx, dose, x + vx * time, floor + radius, z, vx + change,
            -e * vy, 0, 0, 0, spin
        ]


def slipping():
    """What slipping_particle has: case, radius, the centre's height at the floor, v0, g, mu, and
    its normal speed there."""
    c = case("slipping_particle")
    ball, g = c["ball"][0], number(c["run"]["gravity"])
    radius = number(ball["diameter"]) / 2
    low = radius - number(c["vessel"]["size"][0]) / 2
    v_s = (2 * g * (vector(ball["position"])[1] - low)).sqrt()
    return c, radius, low, vector(ball["velocity"])[0], g, Decimal(c["contact"]["friction"]), v_s


def slipping_particle():
    """Elastic hops of 2 v_s/g; in each impact friction takes mu 2 v_s from the speed until the slip
    is stopped."""
    c, radius, low, speed, g, _, v_s = slipping()
    x, _, z = vector(c["ball"][0]["position"])
    time, flight, slip, spin = Decimal(0), v_s / g, speed, Decimal(0)
    for _ in range(60):
        time, x = time + flight, x + speed * flight
        e_t, change = stopped_slip(c["contact"], 2 * v_s, slip)
        dose = mass(c["ball"][0]) / 2 * (1 - e_t * e_t) * slip * slip / K
        speed, spin = speed + change, spin + change * Decimal(5) / 2 / radius
        yield [0, "wall", 0, time, v_s, slip, dose, x, low, z, speed, v_s, 0, 0, 0, spin]
        slip, flight = e_t * slip, 2 * v_s / g


def slipping_particle_limits():
    """Sliding and rolling in lasting contact, the limit v_s -> 0; friction acts in portions of one
    hop, 2 v_s/g."""
    c, radius, _, v, g, mu, v_s = slipping()
    m, hop = mass(c["ball"][0]), 2 * v_s / g
    return [
        ("slip_end_time", "s", 2 * v / (7 * mu * g), hop,
         "when the ball begins to roll: 2 v0/(7 mu g); tolerance one hop 2 v_s/g"),
        ("slip_distance", "m", 12 * v * v / (49 * mu * g), 5 * v / 7 * hop,
         "its way until then: 12 v0^2/(49 mu g); tolerance one hop of rolling"),
        ("rolling_speed", "m/s", 5 * v / 7, mu * v_s, "when it rolls: 5/7 v0; tolerance mu v_s"),
        ("rolling_spin", "rad/s", 5 * v / (7 * radius), Decimal(5) / 2 * mu * v_s / radius,
         "when it rolls: 5/7 v0/R; tolerance 5/2 mu v_s/R"),
        ("dissipated_energy", "J", m * v * v / 7, Decimal(7) / 4 * m * (mu * v_s)**2,
         "by friction: m v0^2/7; tolerance 7/4 m (mu v_s)^2")]


def stacked_particles():
    """Both balls fall alike and so approach each other at a constant speed; floor and ceiling are
    met on parabolas."""
    c = case("stacked_particles")
    g, e, top = number(
        c["run"]["gravity"]), c["contact"]["restitution"], number(c["vessel"]["size"][0]) / 2
    radius = [number(b["diameter"]) / 2 for b in c["ball"]]
    m = [mass(b) for b in c["ball"]]
    y, v = ([vector(b[key])[1] for b in c["ball"]] for key in ("position", "velocity"))
    time, effective = Decimal(0), m[0] * m[1] / (m[0] + m[1])
    for _ in range(50):
        rise = v[1]**2 - 2 * g * (top - radius[1] - y[1])
        meetings = [((v[0] + (v[0]**2 + 2 * g * (y[0] + top - radius[0])).sqrt()) / g, "floor")]
        if v[1] > 0 and rise >= 0:
            meetings.append(((v[1] - rise.sqrt()) / g, "ceiling"))
        if v[0] > v[1]:
            meetings.append(((y[1] - y[0] - radius[0] - radius[1]) / (v[0] - v[1]), "ball"))
        step, what = min(meetings)
        time += step
        y = [place + speed * step - g * step * step / 2 for place, speed in zip(y, v)]
        v = [speed - g * step for speed in v]
        if what == "ball":
            approach = v[0] - v[1]
            y[1] = y[0] + radius[0] + radius[1]
            for k, sign in ((0, -1), (1, 1)):
                v[k] += sign * (1 + e) * approach * effective / m[k]
            yield [0, "ball", 1, time, approach, 0, effective / 2 * (1 - e * e) * approach**2]
        else:
            k = 0 if what == "floor" else 1
            approach = abs(v[k])
            y[k], v[k] = (radius[0] - top, e * approach) if what == "floor" else (top - radius[1],
                                                                                  -e * approach)
            yield [k, "wall", k, time, approach, 0, m[k] / 2 * (1 - e * e) * approach**2]


def stacked_particles_limits():
    """Mean forces over 50 s from the start: weights, but for the momentum that the balls can have
    at the end by their energy and, at the start, the upper ball's own; both balls together have
    none."""
    c = case("stacked_particles")
    g, top, duration = number(c["run"]["gravity"]), number(c["vessel"]["size"][0]) / 2, 50
    radius, m = number(c["ball"][0]["diameter"]) / 2, [mass(b) for b in c["ball"]]
    y, v = ([vector(b[key])[1] for b in c["ball"]] for key in ("position", "velocity"))
    energy = sum(m[k] * (v[k]**2 / 2 + g * (y[k] - ((1 + 2 * k) * radius - top))) for k in (0, 1))
    start, both = m[1] * v[1], m[0] + m[1]
    return [("floor_less_ceiling_force", "N", both * g, (2 * both * energy).sqrt() / duration,
             "mean normal force on the floor less that on the ceiling over 50 s: (m1 + m2) g"),
            ("ball_less_ceiling_force", "N", m[1] * g,
             (start + (2 * m[1] * energy).sqrt()) / duration, "the same between the balls: m2 g")]


def rolling_drum():
    """Without gravity a ball flies along chords, which end at equal angles: its normal speed stays
    the same. Friction acts on the slip against the wall's speed w R_v."""
    c = case("rolling_drum")
    w, wall = number(c["mill"]["speed"]), number(c["vessel"]["diameter"]) / 2
    rows = []
    for k, ball in enumerate(c["ball"]):
        radius, (x, y, z), (vx, vy, _) = number(ball["diameter"]) / 2, vector(
            ball["position"]), vector(ball["velocity"])
        orbit, m, time = wall - radius, mass(ball), Decimal(0)
        spin = vector(ball["spin"])[2] if "spin" in ball else Decimal(0)
        for _ in range(80):
            along, speed = x * vx + y * vy, vx * vx + vy * vy
            step = (-along + (along * along + speed *
                              (orbit * orbit - x * x - y * y)).sqrt()) / speed
            time, x, y = time + step, x + vx * step, y + vy * step
            n, t = (-x / orbit, -y / orbit), (-y / orbit, x / orbit
                                             )  # inward, and the way that the wall moves
            approach, across = -(vx * n[0] + vy * n[1]), vx * t[0] + vy * t[1]
            slip = across + spin * radius - w * wall
            slip = slip if abs(slip) > Decimal("1e-45") else Decimal(0)  # rounding
            e_t, change = stopped_slip(c["contact"], 2 * approach, slip)
            vx, vy = (2 * approach * n[i] + change * t[i] + u for i, u in ((0, vx), (1, vy)))
            spin += change * Decimal(5) / 2 / radius
            rows.append([
                k, "wall", 2, time, approach,
                abs(slip), m / 2 * (1 - e_t * e_t) * slip * slip / K, m * w * wall * change, x, y,
                z, vx, vy, 0, 0, 0, spin
            ])
    return sorted(rows, key=lambda row: row[3])[:80]


def drum_detachment_limits():
    """Rolling on a wall of constant speed the ball has 7/10 v^2 + g l (1 - cos psi) per mass, seen
    from the axis; it leaves where v^2/l + g cos psi = 0. The force per mass falls like j t, and the
    flight begins up to t0 = sqrt(8 v_s/(3 j)) before that or t0/2 after it. In a hop of up to 3/2
    t0 gravity makes g sin(psi) 3/2 t0 of slip, half of it on either side of rolling, of which 2/7
    are in the speed."""
    c = case("drum_detachment")
    ball, g, v_s = c["ball"][0], number(c["run"]["gravity"]), number(
        c["contact"]["least_separation"])
    v, orbit = vector(
        ball["velocity"])[0], (number(c["vessel"]["diameter"]) - number(ball["diameter"])) / 2
    cosine = (10 - 7 * v * v / (orbit * g)) / 17
    sine, speed = (1 - cosine**2).sqrt(), (-g * orbit * cosine).sqrt()
    fall = Decimal(17) / 7 * g * sine * speed / orbit
    early = Decimal("1.1") * (8 * v_s / (3 * fall)).sqrt()               # 10 % for the next order
    angle = speed / orbit * early
    return [(
        "detachment_angle", "deg", arc_cosine(cosine) * 180 / PI, angle * 180 / PI,
        "of the last contact before the flight; from the lowest place: cos psi = (10 - 7 v0^2/(g l))/17"
    ),
            ("detachment_speed", "m/s", speed, Decimal("6.5") / 7 * g * sine * early,
             "of the centre there: (-g l cos psi)^(1/2)"),
            ("highest_point", "m", -orbit * cosine * (1 + sine ** 2 / 2),
             Decimal("3.5") / 7 * orbit * sine ** 3 * angle,
             "of the centre in the flight; above the axis: -l cos psi (1 + sin(psi)^2/2)")]


def arc_cosine(x):
    """By halving the angle until the series of the sine's inverse is short."""
    halvings = 30
    for _ in range(halvings):
        x = ((1 + x) / 2).sqrt()
    s = (1 - x * x).sqrt()
    return (s + s**3 / 6 + 3 * s**5 / 40 + 15 * s**7 / 336) * 2**halvings


def write_statistics(file, about, rows):
    """Rows have the columns of STATISTICS; numbers are texts."""
    lines = [
        *(f"# {line}" for line in about), ",".join(STATISTICS), *(",".join(row) for row in rows)
    ]
    file.write_text("\n".join(lines) + "\n")


CASES = ((bouncing_ball, COLUMNS, None, "closed form; MFiX DEM02 with rigid contacts",
          "a ball falls on a floor and bounces"),
         # between balls the states in a log are those of either ball
         (newtons_cradle, COLUMNS[:4], None, "closed form",
          "five balls in a row between two walls, elastic"
         ), (oblique_impact, COLUMNS, None,
             "closed form; MFiX DEM05, Chung and Ooi 2011, with rigid contacts",
             "eight balls strike a floor at 8 to 88 degrees to it, sliding and sticking"),
         (slipping_particle, COLUMNS, slipping_particle_limits,
          "closed form; MFiX DEM04 with rigid contacts",
          "a ball slides along a rough floor until it rolls"),
         (stacked_particles, COLUMNS[:4], stacked_particles_limits,
          "closed form; after MFiX DEM03, with rigid contacts",
          "two balls of different density, one above the other, between a floor and a ceiling"),
         (rolling_drum, [*COLUMNS[:4], "wall_work", *COLUMNS[4:]], None, "closed form",
          "three balls in a turning drum without gravity are carried along until they roll"),
         ("drum_detachment", [], drum_detachment_limits, "closed form",
          "a ball rolls up a turning drum and leaves its wall"))


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    for make, columns, limits, source, description in CASES:
        name = make if isinstance(make, str) else make.__name__
        folder = pathlib.Path(sys.argv[1]) / name
        folder.mkdir(parents=True, exist_ok=True)
        about = {
            "schema": SCHEMA, "name": name, "description": description, "licence": "CC0-1.0",
            "source": source, "case": "case.toml"
        }
        if columns:
            rows = list(make())
            lines = [f"# {name}: {source}; 40 digits, SI, inertial frame",
                     ",".join(["index", "ball", "partner_kind", "partner", *columns])]
            for index, row in enumerate(sorted(rows, key=lambda row: row[3])):
                cells = [
                    f"{v:.39e}" if isinstance(v, Decimal) and v else "0" if v == 0 else str(v)
                    for v in row
                ]
                lines.append(",".join([str(index), *cells]))
            (folder / "events.csv").write_text("\n".join(lines) + "\n")
            about |= {
                "events": "events.csv", "agree": len(rows), "tolerance": 1e-9, "columns": columns
            }
        if limits:
            what = f"{name}: {source}, of lasting contact; schema 1, SI but for angles, CC0 1.0"
            write_statistics(folder / "statistics.csv", [what], [[
                label, unit, f"{float(value):.16e}", "0", "0", "", f"{float(tolerance):.3e}",
                f"{float(value):.16e}", "exact", meaning
            ] for label, unit, value, tolerance, meaning in limits()])
            about["statistics"] = "statistics.csv"
        (folder / "suite.json").write_text(json.dumps(about, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
