"""Theory of the case elastic_gas, in Python's decimal numbers; edmill has no part in it."""
from decimal import Decimal

from closed_forms import PI, case, mass, number, vector


def elastic_gas():
    """Name of a quantity to its value and whether it is exact.

    Velocities are uniform on the sphere of constant energy wherever the balls are, so all means of
    them are exact for any N, and so is the virial. The force on the walls is an approximation, and
    the virial gives the rates from it. It has Carnahan and Starling's pressure p(n) of the bulk;
    the walls' surface tension by scaled particle theory, but with its true third coefficient,
    149/35 in place of 4; the edges to n^3; and, since N is fixed, a term in 1/N. Monte Carlo
    integration of the third cluster integral, 1e8 triples, gave 0.1894 of the edges and 0.8754 ±
    0.0001 for 149 pi^2/1680 = 0.8753."""
    c = case("elastic_gas")
    ball, count = c["balls"][0], sum(b["count"] for b in c["balls"])
    sigma, u, m = number(ball["diameter"]), abs(vector(ball["velocity"])[0]), mass(ball)
    side, kT = number(c["vessel"]["size"][0]) - sigma, m * u * u  # of the cube of the centres
    degrees = 3 * count
    ratio = 2 / PI.sqrt()  # Gamma(D/2)/Gamma((D + 1)/2), of D = 2
    for d in range(2, degrees, 2):
        ratio *= Decimal(d) / (d + 1)
    largest = u * Decimal(degrees).sqrt()  # speed of a ball that has all energy
    component = largest * ratio / PI.sqrt()                              # mean of |v_x|
    at_wall = u * u / component

    def eta(n):
        return PI * n * sigma**3 / 6

    def pressure(n):
        h = eta(n)
        return n * kT * (1 + h + h**2 - h**3) / (1 - h)**3

    def tension(n):
        h = eta(n)
        return -9 * kT / (2 * PI * sigma**2) * h**2 * ((1 + h) / (1 - h)**3 + Decimal(9) / 35 * h)

    def edge(n):
        return kT * sigma**5 * n**2 * (1 / Decimal(15) - Decimal("0.1894") * n * sigma**3)

    def slope(f, n, step=Decimal("1e-15")):
        return (f(n * (1 + step)) - f(n * (1 - step))) / (2 * n * step)

    def balls_in_box(n):
        adsorbed = 6 * side**2 * slope(tension, n) + 12 * side * slope(edge, n)  # by d mu = dp/n
        return n * side**3 - adsorbed * n / slope(pressure, n)

    n = count / side**3
    for _ in range(60):
        n *= count / balls_in_box(n)
    force = pressure(n) * side**2 - 4 * side * tension(n) - 4 * edge(n)
    step = n / 10**9
    curvature = (pressure(n + step) - 2 * pressure(n) + pressure(n - step)) / step**2
    force -= curvature * side ** 2 * n * kT / slope(
        pressure, n) / side ** 3 / 2  # mean over N less than at the mean of N
    virial = 3 * force * side - degrees * kT  # sigma times the balls' impulses per time
    approach = Decimal(2).sqrt() * at_wall
    return {
        "kinetic_energy": (degrees * kT / 2, "exact"),
        "mean_speed": (largest * ratio * 2 / PI.sqrt(), "exact"),
        "wall_approach_speed": (at_wall, "exact"), "pair_approach_speed": (approach, "exact"),
        "wall_share_above_1": (power(1 - 1 / largest**2, degrees - 1), "exact"),
        "pair_share_above_1": (power(1 - 1 / (2 * largest**2), degrees - 1), "exact"),
        "virial_ratio": (Decimal(1), "exact"),
        "wall_force": (force, "approximation"), "pressure": (force / side**2, "approximation"),
        "wall_rate": (6 * force / (2 * m * at_wall), "approximation"),
        "pair_rate": (virial / (sigma * m * approach), "approximation")}


def power(x, twice):
    """x^(twice/2)"""
    return x**(twice // 2) * (x.sqrt() if twice % 2 else 1)
