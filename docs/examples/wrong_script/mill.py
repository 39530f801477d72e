#!/usr/bin/env python3
"""Three balls in the SPEX 8000, in small time steps, with five mistakes; docs/reference-data.md
audits it.

usage: mill.py LOG.csv [--fix NAME ...] [--step 1e-5] [--end 0.2]
"""
import argparse
from math import cos, hypot, pi, sin, sqrt

MISTAKES = ("euler", "restitution", "masses", "dose", "spin")
options = argparse.ArgumentParser()
options.add_argument("log")
options.add_argument("--fix", action="append", choices=MISTAKES + ("all",), default=[])
options.add_argument("--step", type=float, default=1e-5)
options.add_argument("--end", type=float, default=0.2)
options = options.parse_args()


def wrong(name):
    return name not in options.fix and "all" not in options.fix


ARM, SWING, OMEGA = 0.1, pi / 12, 1054 * 2 * pi / 60
RADIUS, HALF_HEIGHT = 0.019, 0.0285
RESTITUTION, FRICTION, INERTIA, DENSITY = 0.53, 0.4, 0.4, 8000
GRAVITY = (0, -9.8, 0)


def add(a, b, factor=1):
    return tuple(p + factor * q for p, q in zip(a, b))


def times(a, factor):
    return tuple(p * factor for p in a)


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


class Ball:
    def __init__(self, number, diameter, position):
        self.number, self.radius, self.x = number, diameter / 2, position
        self.v = self.w = (0, 0, 0)
        self.mass = DENSITY * 4 / 3 * pi * self.radius**3


BALLS = [Ball(1, 0.00952, (-0.026, 0.0966, 0.0)), Ball(2, 0.00476, (-0.026, 0.0966, 0.01)),
         Ball(3, 0.00476, (-0.026, 0.0966, -0.01))]


class Vessel:
    """Axes, centre and angular velocities at a time."""

    def __init__(self, t):
        theta, gamma = SWING * cos(OMEGA * t) + pi / 2, SWING * sin(OMEGA * t)
        s, c, sg, cg = sin(theta), cos(theta), sin(gamma), cos(gamma)
        self.x, self.y, self.z = (c, s, 0), (-s * cg, c * cg, sg), (s * sg, -c * sg, cg)
        self.centre = (ARM * c, ARM * s, 0)
        self.about_z = (0, 0, -SWING * OMEGA * sin(OMEGA * t))
        self.about_x = times(self.x, SWING * OMEGA * cos(OMEGA * t))

    def velocity(self, point):
        return add(cross(self.about_z, point), cross(self.about_x, add(point, self.centre, -1)))

    def contacts(self, ball):
        """Walls that the ball overlaps: number and normal."""
        d = add(ball.x, self.centre, -1)
        x, y, z = dot(d, self.x), dot(d, self.y), dot(d, self.z)
        if HALF_HEIGHT + y < ball.radius:
            yield -1, self.y
        if HALF_HEIGHT - y < ball.radius:
            yield -2, times(self.y, -1)
        if hypot(x, z) > RADIUS - ball.radius:
            yield -3, times(add(times(self.x, x), times(self.z, z)), -1 / hypot(x, z))


def collide(t, one, two, partner, normal, wall_velocity, log):
    """An impact of ball `one` with ball `two`, or with a wall when that is None."""
    arm = times(normal, -one.radius)
    g = add(add(one.v, cross(one.w, arm)), wall_velocity, -1)
    bodies = [one]
    if two:
        g = add(g, add(two.v, cross(two.w, times(normal, two.radius))), -1)
        bodies.append(two)
    g_n = dot(g, normal)
    if g_n >= 0:
        return
    mass = one.mass * two.mass / (one.mass + two.mass) if two else one.mass
    e_n = 0.6 if wrong("restitution") and not two else RESTITUTION
    slip = add(g, normal, -g_n)
    slip_speed, compliance = sqrt(dot(slip, slip)), 1 + 1 / INERTIA
    e_t = max(-1, 1 - FRICTION *
              (1 + e_n) * compliance * -g_n / slip_speed) if slip_speed > 0 else 1
    along, across = times(normal, -(1 + e_n) * g_n), times(slip, -(1 - e_t) / compliance)
    before = [(b.x, b.v, b.w) for b in bodies]
    kinetic = sum(b.mass * dot(b.v, b.v) / 2 for b in bodies)
    for b, side in zip(bodies, (1, -1)):
        share = side * (0.5 if two and wrong("masses") else mass / b.mass)
        b.v = add(add(b.v, along, share), across, share)
        b.w = add(b.w, cross(times(normal, -1), across), abs(share) / (b.radius * INERTIA))
    if wrong("dose"):  # forgets that the wall does work, and the spin
        dose = kinetic - sum(b.mass * dot(b.v, b.v) / 2 for b in bodies)
    else:
        dose = mass / 2 * ((1 - e_n**2) * g_n**2 + (1 - e_t**2) / compliance * slip_speed**2)
    row = [1000 * t, one.number, partner, -g_n, dose]
    for body, (x, v, w) in zip(bodies, before):
        row += [*x, *v, *w, *body.v, *body.w]
    row += [""] * (35 - len(row))  # a wall has no state
    log.write(",".join(str(value) for value in row) + "\n")
    if wrong("spin") and two:
        two.w = (0, 0, 0)  # forgets the partner's spin once the impact is over


def main(log):
    names = [
        f"{v}{axis}{when}"
        for v, when in (("r", ""), ("v", "0"), ("w", "0"), ("v", "1"), ("w", "1")) for axis in "xyz"
    ]
    log.write(",".join(["t [ms]", "i", "j", "vn", "loss"] + names + ["j_" + n for n in names]) +
              "\n")
    dt = options.step
    for step in range(1, round(options.end / dt) + 1):
        for b in BALLS:
            if wrong("euler"):
                b.x = add(b.x, b.v, dt)
            else:
                b.x = add(add(b.x, b.v, dt), GRAVITY, dt * dt / 2)
            b.v = add(b.v, GRAVITY, dt)
        t = step * dt
        vessel = Vessel(t)
        for k, one in enumerate(BALLS):
            for wall, normal in vessel.contacts(one):
                point = add(one.x, normal, -one.radius)
                collide(t, one, None, wall, normal, vessel.velocity(point), log)
            for two in BALLS[k + 1:]:
                apart = add(one.x, two.x, -1)
                distance = sqrt(dot(apart, apart))
                if distance < one.radius + two.radius:
                    collide(t, one, two, two.number, times(apart, 1 / distance), (0, 0, 0), log)


with open(options.log, "w") as out:
    main(out)
