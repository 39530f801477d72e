#!/usr/bin/python3
"""Makes the YAML files beside it: published tests of DEM codes with the values that a right code
finds, from closed forms.

usage: make_cases.py [FOLDER]     this folder unless given
"""
import math
import pathlib
import sys


def sphere_mass(radius, density):
    return density * 4 / 3 * math.pi * radius ** 3


def hertz(mass, radius, modulus, speed):
    """Elastic contact: largest overlap, largest force, duration. mass, radius, modulus are the
    effective ones."""
    overlap = (15 * mass * speed ** 2 / (16 * math.sqrt(radius) * modulus)) ** 0.4
    force = 4 / 3 * modulus * math.sqrt(radius) * overlap ** 1.5
    # The integral of dx / sqrt(1 - x^2.5) from 0 to 1, twice: 4/5 sqrt(pi) gamma(2/5) /
    # gamma(9/10).
    duration = 0.8 * math.sqrt(math.pi) * math.gamma(0.4) / math.gamma(0.9) * overlap / speed
    return overlap, force, duration


class Case:
    def __init__(self, name, source, what):
        self.name, self.lines, self.quantities = name, [
            f"name: {name}", f"source: \"{source}\"", f"what: \"{what}\"", "licence: CC0-1.0",
            "units: SI"
        ], []

    def given(self, **values):
        self.lines.append("given:")
        self.lines += [f"  {key}: {value!r}" for key, value in values.items()]

    def expect(self, name, value, tolerance, finite=""):
        self.quantities.append((name, value, tolerance, finite))

    def text(self):
        lines = self.lines + ["expected:"]
        for name, value, tolerance, finite in self.quantities:
            lines += [
                f"  {name}:", f"    value: {float(format(value, '.15g'))!r}",
                f"    relative_tolerance: {tolerance!r}"
            ]
            if finite:
                lines.append(f"    contact_time: \"{finite}\"")
        return "\n".join(lines) + "\n"


ELASTIC = "closed form of Hertz's contact: holds at any stiffness; a time step of a hundredth of the duration is off by less than the tolerance"
OTHERS = "Chung and Ooi, Granular Matter 13 (2011) 643, test {}; numbers as in PySPH's examples"
CHUNG = "Chung and Ooi, Granular Matter 13 (2011) 643, test {}; numbers as in YADE's examples of 2023"


def chung_ooi_1():
    for material, young, poisson, density in (("glass", 4.8e10, 0.20, 2800.0), ("limestone", 2.0e10,
                                                                                0.25, 2500.0)):
        radius, speed = 0.010, 10.0
        case = Case(f"chung_ooi_1_{material}", CHUNG.format(1),
                    "two equal spheres meet head-on, elastic")
        case.given(radius=radius, density=density, young=young, poisson=poisson,
                   speed_of_each=speed)
        overlap, force, duration = hertz(
            sphere_mass(radius, density) / 2, radius / 2, young / (2 * (1 - poisson ** 2)),
            2 * speed)
        case.expect("largest_overlap", overlap, 1e-3, ELASTIC)
        case.expect("largest_force", force, 1e-3, ELASTIC)
        case.expect("duration", duration, 1e-2, ELASTIC)
        case.expect("speed_after", speed, 1e-3, "as for impacts without duration")
        yield case


def chung_ooi_2():
    for material, young, poisson, density in (("aluminium_alloy", 7.0e10, 0.30, 2699.0),
                                              ("magnesium_alloy", 4.0e10, 0.35, 1800.0)):
        radius, speed = 0.1, 0.2
        case = Case(f"chung_ooi_2_{material}", CHUNG.format(2),
                    "a sphere meets a rigid plane head-on, elastic")
        case.given(radius=radius, density=density, young=young, poisson=poisson, speed=speed)
        overlap, force, duration = hertz(sphere_mass(radius, density), radius,
                                         young / (1 - poisson ** 2), speed)
        case.expect("largest_overlap", overlap, 1e-3, ELASTIC)
        case.expect("largest_force", force, 1e-3, ELASTIC)
        case.expect("duration", duration, 1e-2, ELASTIC)
        case.expect("speed_after", speed, 1e-3, "as for impacts without duration")
        yield case


def chung_ooi_3():
    for material, young, poisson, density in (("aluminium_oxide", 3.8e11, 0.23, 4000.0),
                                              ("cast_iron", 1.0e11, 0.25, 7000.0)):
        case = Case(f"chung_ooi_3_{material}", CHUNG.format(3),
                    "a sphere meets a rigid plane head-on with five restitutions")
        case.given(radius=0.0025, density=density, young=young, poisson=poisson, speed=3.9)
        for restitution in (0.2, 0.4, 0.6, 0.8, 1.0):
            case.expect(
                f"speed_after_{restitution}", restitution * 3.9, 5e-3,
                "exact where the damping is that of this restitution, whether or not the contact attracts while it ends"
            )
        yield case


def chung_ooi_4():
    for restitution in (0.98, 1.0):
        radius, speed, friction = 0.0025, 3.9, 0.092
        case = Case(f"chung_ooi_4_{restitution}", CHUNG.format(4),
                    "a sphere meets a rigid plane at angles from its normal and slides throughout")
        case.given(radius=radius, density=4000.0, young=3.8e11, poisson=0.23, speed=speed,
                   friction=friction, restitution=restitution)
        for degrees in (50, 60, 70, 80, 85):
            normal, along = speed * math.cos(math.radians(degrees)), speed * math.sin(
                math.radians(degrees))
            impulse = friction * (1 + restitution) * normal
            case.expect(
                f"spin_after_{degrees}", 2.5 * impulse / radius, 1e-2,
                "of a contact that slides throughout; below 50 degrees an elastic one sticks for a part of its duration"
            )
            case.expect(f"tangential_restitution_{degrees}", (along - impulse) / along, 1e-2,
                        "the same")
        yield case


SLIDES = "of a contact that slides throughout: no matter how long it lasts; the tolerance is for the steps at its begin and end"
PLANE = {"aluminium_alloy": (2700.0, 7.0e10, 0.33), "nylon": (1000.0, 2.5e9, 0.4)}
METALS = {"aluminium_alloy": (2700.0, 7.0e10, 0.33), "copper": (8900.0, 1.2e11, 0.35)}


def chung_ooi_5():
    normal, friction, restitution, radius = 5.0, 0.3, 1.0, 1.0e-5
    case = Case(
        "chung_ooi_5_steel",
        "Chung and Ooi, Granular Matter 13 (2011) 643, test 5; the speeds are chosen here so that contacts slide throughout",
        "a sphere without spin meets a rigid plane with one normal and several tangential speeds, elastic"
    )
    case.given(radius=radius, density=7850.0, young=2.08e11, poisson=0.3, normal_speed=normal,
               friction=friction, restitution=restitution)
    change = friction * (1 + restitution) * normal
    for along in (12.0, 15.0, 20.0, 30.0):
        case.expect(f"tangential_speed_after_{along}", along - change, 1e-2, SLIDES)
        case.expect(f"spin_after_{along}", 2.5 * change / radius, 1e-2, SLIDES)
    yield case


def spun(source, what, name, material, spins, second_mass=None, second_radius=None):
    """Impact of a sphere that spins: what friction gives it while it slides throughout, by its
    share of the impulse."""
    density, young, poisson = material
    radius, speed, friction, restitution = 0.1, 0.2, 0.4, 0.5
    case = Case(name, source, what)
    given = dict(radius=radius, density=density, young=young, poisson=poisson, speed=speed,
                 friction=friction, restitution=restitution)
    share = 1.0
    if second_mass is not None:
        given.update(second_radius=second_radius, second_mass_over_first=second_mass)
        share = second_mass / (1 + second_mass)
    case.given(**given)
    change = friction * (1 + restitution) * speed * share
    for spin in spins:
        case.expect(f"tangential_speed_after_{spin}", change, 1e-2, SLIDES)
        case.expect(f"spin_after_{spin}", spin - 2.5 * change / radius, 1e-2, SLIDES)
    return case


def chung_ooi_6():
    for material, values in PLANE.items():
        yield spun(OTHERS.format(6), "a spinning sphere meets a rigid plane head-on",
                   f"chung_ooi_6_{material}", values, (5.0, 7.0, 9.0, 12.0, 22.0))


def chung_ooi_7():
    for material, values in METALS.items():
        yield spun(
            OTHERS.format(7),
            "two equal spheres with the same speed meet head-on, both with this spin about the same axis and in the same sense",
            f"chung_ooi_7_{material}", values, (5.0, 7.0, 9.0, 12.0, 22.0))


def chung_ooi_8():
    for material, values in PLANE.items():
        yield spun(
            OTHERS.format(8),
            "a spinning sphere meets one at rest that is five times as large and a thousand times as dense, nearly a plane",
            f"chung_ooi_8_{material}", values, (5.0, 7.0, 9.0, 12.0, 22.0), second_mass=125000.0,
            second_radius=0.5)


def mohajeri():
    source = "after Mohajeri et al., Powder Technology 447 (2024); numbers as in LAMMPS's unittest/granular of 2026"
    radius, resistance, gravity, spin = 0.0025, 0.05, 1.0, 1.0
    case = Case(
        "mohajeri_rolling", source,
        "a ball turns on a plane without slip forces and is stopped by rolling resistance, a torque of resistance x radius x weight"
    )
    case.given(radius=radius, density=2700.0, rolling_resistance=resistance, gravity=gravity,
               spin=spin)
    rate = 2.5 * resistance * gravity / radius
    for time in (0.005, 0.01, 0.015):
        case.expect(
            f"spin_at_{time}", spin - rate * time, 1e-2,
            "of a resistance that has reached its limit; a rolling spring needs its own time to do so"
        )
    case.expect("end_of_motion", spin / rate, 1e-2, "the same")
    yield case
    radius, energy = 0.01, 0.1
    case = Case(
        "mohajeri_pull_off", source,
        "the force that separates two equal spheres that just touch, by Derjaguin, Muller and Toporov (DMT)"
    )
    case.given(radius=radius, surface_energy=energy)
    case.expect(
        "pull_off_force", 4 * math.pi * energy * radius / 2, 1e-3,
        "at rest: holds at any stiffness; the work of adhesion is twice the surface energy")
    yield case
    friction, restitution, normal, along = 0.3, 0.8, 0.5, 2.0
    case = Case("mohajeri_oblique",
                "after Mohajeri et al., Powder Technology 447 (2024); numbers chosen here",
                "a sphere without spin meets a plane and slides throughout")
    case.given(radius=0.005, density=2500.0, normal_speed=normal, tangential_speed=along,
               friction=friction, restitution=restitution)
    change = friction * (1 + restitution) * normal
    case.expect("normal_speed_after", restitution * normal, 5e-3,
                "where the damping is that of this restitution")
    case.expect("tangential_speed_after", along - change, 1e-2, SLIDES)
    case.expect("spin_after", 2.5 * change / 0.005, 1e-2, SLIDES)
    yield case


def mfix():
    case = Case(
        "mfix_dem02", "MFiX verification and validation manual, DEM02",
        "a particle falls from rest and bounces: height of its centre above contact after each bounce"
    )
    height, radius = 0.5, 0.1
    case.given(height_of_centre=height, radius=radius, gravity=9.81)
    for restitution in (0.6, 0.7, 0.8, 0.9, 1.0):
        for bounce in (1, 2, 3):
            case.expect(
                f"height_{restitution}_{bounce}", (height - radius) * restitution ** (2 * bounce),
                1e-3,
                "lower by about g v duration / 2 over g for each bounce: tends to this as the stiffness grows"
            )
    yield case
    case = Case("mfix_dem04", "MFiX verification and validation manual, DEM04",
                "a ball slips on a rough floor until it rolls")
    speed = 1.0
    case.given(speed=speed, radius=0.0005, gravity=9.81)
    case.expect("speed_of_rolling", 5 / 7 * speed, 1e-3, "no matter how long contacts last")
    for friction in (0.2, 0.4, 0.6, 0.8, 1.0):
        case.expect(f"end_of_slip_{friction}", 2 * speed / (7 * friction * 9.81), 1e-2,
                    "to within a few contact times")
    yield case


FAMILIES = (chung_ooi_1, chung_ooi_2, chung_ooi_3, chung_ooi_4, chung_ooi_5, chung_ooi_6,
            chung_ooi_7, chung_ooi_8, mohajeri, mfix)

if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
    for family in FAMILIES:
        for case in family():
            (folder / f"{case.name}.yaml").write_text(case.text())
