#!/usr/bin/env python3
"""Claim 14: derivatives of runs. Against central differences of runs in 150 digits, and a ball on
an oscillating table, whose orbit of one period has multipliers in closed form.

usage: PYTHONPATH=tests/support python3 tangent.py EDMILL
"""
import math
import pathlib
import sys
import tempfile
import unittest
from decimal import Decimal, getcontext

from program import rows, said, sets

getcontext().prec = 160
QUANTITIES = ("time", "approach_speed", "slip_speed", "milling_dose", "wall_work")
STEP = Decimal(10) ** -50

SPEX = """
[run]
end_time = "9 s"
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
"""
PLANETARY = """
[run]
end_time = "9 s"
gravity = "9.81 m/s2"
[mill]
type = "planetary"
radius = "75 mm"
speed = "300 rpm"
ratio = -2
[vessel]
type = "rounded_cylinder"
diameter = "45 mm"
height = "40 mm"
edge_radius = "8 mm"
"""
PISTON = """
[run]
end_time = "9 s"
gravity = "9.8 m/s2"
[mill]
type = "vibratory"
amplitude = ["3 mm", "8 mm", "-2 mm"]
speed = "900 rpm"
[vessel]
type = "box"
size = ["33 mm", "57 mm", "36 mm"]
[[vessel.piston]]
wall = "wall_3"
distance = "6 mm"
swing = [{amplitude = "5 mm", speed = "2500 rpm", phase = "40 deg"}]
"""
BALLS = """
[[balls]]
count = 5
diameter = "9 mm"
density = "7.8 g/cm3"
"""
WALTON_BRAUN = """
[contact]
restitution = 0.8
friction = 0.2
min_tangential = -0.5
least_separation = "{least}"
"""
VISCOELASTIC = """
[contact]
model = "viscoelastic"
friction = 0.3
effective_modulus = "115 GPa"
dissipative_time = "0.1 us"
"""
YIELDING = """
[contact]
model = "elastic-plastic"
friction = 0.3
effective_modulus = "115 GPa"
yield_pressure = "2 GPa"
"""
BY_SLIP = """
[contact]
model = "restitution-by-slip"
restitution = 0.8
tangential_by_slip = [[0, -0.4], [1, 0.1], [4, 0.6]]
"""
OF_SPEX = {
    "contact.restitution": "0.8", "contact.friction": "0.2", "mill.speed": "1054 rpm",
    "mill.arm": "10 cm", "mill.theta_max": "15 deg", "vessel.diameter": "38 mm",
    "vessel.height": "57 mm", "run.gravity": "9.8 m/s2", "balls.0.density": "7.8 g/cm3",
    "balls.0.diameter": "9 mm"
}
OF_PLANETARY = {
    "contact.min_tangential": "-0.5", "mill.radius": "75 mm", "mill.ratio": "-2",
    "vessel.edge_radius": "8 mm", "mill.speed": "300 rpm"
}
OF_PISTON = {
    "vessel.piston.0.distance": "6 mm", "mill.speed": "900 rpm", "contact.restitution": "0.8",
    "vessel.piston.0.swing.0.amplitude": "5 mm"
}


def setting(key, number, unit):
    return f'{key}="{number} {unit}"' if unit else f"{key}={number}"


class Derivatives(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)

    def log(self, case, events, *settings):
        said("run", case, "--precision", "mpfr:150", "--out", self.folder / "run", "--quiet",
             *sets(f"run.max_collisions={events}", 'output=[{type="collisions"}]', *settings))
        return rows(self.folder / "run" / "collisions.csv")

    def case_from_state(self, text):
        """The case from a state after its 6th impact: numbers of the case do not move it, nor, in
        the first drive period, its instant."""
        first = self.folder / "first.toml"
        first.write_text(text + BALLS)
        self.log(first, 6)
        self.assertEqual(rows(self.folder / "run" / "final_state.csv")[0]["drive_period"], "0")
        (self.folder / "run" / "final_state.csv").rename(self.folder / "start.csv")
        case = self.folder / "case.toml"
        case.write_text(text.replace("[run]", '[run]\ninitial_state = "start.csv"', 1) + BALLS)
        return case

    def check(self, text, numbers, events=50):
        case = self.case_from_state(text)
        keys = list(numbers) + ["initial.1.x", "initial.3.vy", "initial.0.wz"]
        said("sensitivity", case, "--events", events, "--digits", 30, "--out",
             self.folder / "d.csv", "--quiet", *(word for key in keys for word in ("--by", key)))
        derivatives = rows(self.folder / "d.csv")
        branches = set()
        for k, key in enumerate(keys):
            up, down = (self.differing(case, key, numbers, events, sign) for sign in (1, -1))
            for name in QUANTITIES:
                exact = [
                    (Decimal(a[name]) - Decimal(b[name])) / (2 * STEP) for a, b in zip(up, down)
                ]
                found = [Decimal(row[f"d_{name}_{k}"]) for row in derivatives]
                largest = max(map(abs, exact))
                off = max(abs(a - b) for a, b in zip(exact, found))
                self.assertLessEqual(off, Decimal("1e-20") * largest, f"{key}, {name}")
            branches |= {row.get("partner_kind") for row in up}
        self.assertEqual(branches, {"wall", "ball"})
        print(f"{case.name}: {len(keys)} numbers, {events} events")

    def differing(self, case, key, numbers, events, sign):
        if key in numbers:
            number, _, unit = numbers[key].partition(" ")
            return self.log(case, events, setting(key, Decimal(number) + sign * STEP, unit))
        _, ball, coordinate = key.split(".")
        columns = {"x": "position_x", "vy": "velocity_y", "wz": "spin_z"}
        start = (self.folder / "start.csv").read_text()
        lines = [line.split(",") for line in start.splitlines()]
        place = [n for n, name in enumerate(lines[0]) if name.startswith(columns[coordinate])][0]
        lines[1 + int(ball)][place] = str(Decimal(lines[1 + int(ball)][place]) + sign * STEP)
        (self.folder / "start.csv").write_text("\n".join(",".join(line) for line in lines) + "\n")
        try:
            return self.log(case, events)
        finally:
            (self.folder / "start.csv").write_text(start)

    def test_spex(self):
        self.check(SPEX + WALTON_BRAUN.format(least="0.001 mm/s"), OF_SPEX)

    def test_spex_with_impacts_at_the_least_separation_speed(self):
        self.check(SPEX + WALTON_BRAUN.format(least="30 cm/s"), OF_SPEX)

    def test_planetary(self):
        self.check(PLANETARY + WALTON_BRAUN.format(least="1 cm/s"), OF_PLANETARY)

    def test_box_with_piston(self):
        self.check(PISTON + WALTON_BRAUN.format(least="1 cm/s"), OF_PISTON)


    def test_other_laws(self):
        self.check(SPEX + VISCOELASTIC,
                   {"contact.effective_modulus": "115 GPa", "contact.dissipative_time": "0.1 us"})
        self.check(SPEX + YIELDING, {"contact.yield_pressure": "2 GPa", "contact.friction": "0.3"})
        self.check(PLANETARY + BY_SLIP, {"contact.restitution": "0.8"})


class Table(unittest.TestCase):
    """A ball on a table A sin(w t) that it meets once a period T, at the phase p, with restitution
    e. There the table has the speed u = A w cos p = (g T / 2) (1 - e) / (1 + e) and the
    acceleration a = -A w^2 sin p. Instants t of successive impacts then differ, in motions nearby,
    by d'' = (1 + e^2 + (1 + e)^2 a / g) d' - e^2 d: the multipliers of the orbit are the roots of
    m^2 - (1 + e^2 + (1 + e)^2 a / g) m + e^2."""

    G = Decimal("9.8")
    T = Decimal("0.05")
    SIZE, RADIUS = Decimal("0.2"), Decimal("0.005")

    def derivatives(self, e, phase, events=12):
        pi = Decimal(
            "3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803482534211706798214808651"
        )
        g, t = self.G, self.T
        w = 2 * pi / t
        cosine, sine = cos(phase), sin(phase)
        u = g * t / 2 * (1 - e) / (1 + e)
        amplitude = u / (w * cosine)
        a = -amplitude * w * w * sine
        # At the top of its flight, half a period after an impact.
        height = -self.SIZE / 2 + self.RADIUS + amplitude * sine + g * t * t / 8
        start = phase / w + t / 2
        with tempfile.TemporaryDirectory() as place:
            case = pathlib.Path(place) / "table.toml"
            case.write_text(f"""
[run]
initial_time = "{start:.100f} s"
end_time = "9 s"
gravity = "{g} m/s2"
[mill]
type = "vibratory"
amplitude = [0, "{amplitude:.100f} m", 0]
speed = "1200 rpm"
[vessel]
type = "box"
size = ["{self.SIZE} m", "{self.SIZE} m", "{self.SIZE} m"]
[contact]
restitution = {e}
friction = 0
least_separation = "0 m/s"
[[ball]]
diameter = "{2 * self.RADIUS} m"
position = [0, "{height:.100f} m", 0]
""")
            said("sensitivity", case, "--by", "initial.0.vy", "--by", "initial.0.y", "--events",
                 events, "--digits", 30, "--out", case.with_suffix(".csv"), "--quiet")
            table = rows(case.with_suffix(".csv"))
        times = [Decimal(row["time"]) for row in table]
        for one, other in zip(times, times[1:]):
            self.assertAlmostEqual(float(other - one), float(t), delta=1e-12)  # the orbit
        trace = 1 + e * e + (1 + e) ** 2 * a / g
        return trace, [[Decimal(row[f"d_time_{k}"]) for row in table] for k in (0, 1)]

    def test_multipliers_in_closed_form(self):
        for e in map(Decimal, ("0.3", "0.5", "0.7", "0.9")):
            for phase in map(Decimal, ("0.05", "0.2", "0.4")):
                trace, both = self.derivatives(e, phase)
                for d in both:
                    for k in range(len(d) - 2):
                        expected = trace * d[k + 1] - e * e * d[k]
                        self.assertLessEqual(abs(d[k + 2] - expected),
                                             Decimal("1e-20") * max(map(abs, d)), (e, phase, k))

    def test_the_phase_at_which_the_period_doubles(self):
        """A multiplier is -1 where a = -2 g (1 + e^2) / (1 + e)^2: tan p = (2 / pi) (1 + e^2) / (1
        - e^2)."""
        for e in map(Decimal, ("0.3", "0.5", "0.7", "0.9")):
            phase = Decimal(repr(math.atan(2 / math.pi * float((1 + e * e) / (1 - e * e)))))
            trace, (d, _) = self.derivatives(e, phase)
            self.assertAlmostEqual(float(trace), -1 - float(e * e), delta=1e-12)
            # What is left when the other multiplier, -e^2, has died away changes its sign at each
            # impact.
            rest = [d[k + 1] + e * e * d[k] for k in range(len(d) - 1)]
            for one, other in zip(rest, rest[1:]):
                self.assertAlmostEqual(float(other / one), -1, delta=1e-9)
            print(f"e {e}: the period doubles at the phase {float(phase):.4f}")


def series(x, first):
    """sin from 1, cos from 0."""
    term = x if first else Decimal(1)
    total, k = term, first
    while abs(term) > Decimal("1e-150"):
        term *= -x * x / ((k + 1) * (k + 2))
        total += term
        k += 2
    return total


def sin(x):
    return series(x, 1)


def cos(x):
    return series(x, 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
