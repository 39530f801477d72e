"""Tables 5.1 to 5.6 of J. Barahona, Simulation and Optimization of Mechanical Alloying using the Event-Driven method,
University of Ottawa, 2011: the mill of Ward et al. (2005) with 24 charges. The only copy of these numbers."""
from collections import namedtuple

DIAMETERS = ("2.36", "3.16", "4.76", "9.52")  # [mm], table 5.1
CHARGE_RATIOS = ("2.5", "5", "10")
POWDERS = ("2", "5")  # [g]

# Table 5.2: numbers of balls, by powder and charge ratio, in the order of the diameters.
BALLS = {
    ("2", "2.5"): (91, 38, 11, 1), ("2", "5"): (182, 76, 22, 3), ("2", "10"): (363, 151, 44, 6),
    ("5", "2.5"): (227, 95, 28, 3), ("5", "5"): (454, 189, 55, 7), ("5", "10"): (908, 378, 111, 14),
}
# Table 5.3: normal restitution. Its last column is headed 9.92 mm, where 9.52 is meant.
RESTITUTION = {
    "2.5": ("0.56", "0.54", "0.53", "0.50"), "5": ("0.64", "0.60", "0.56", "0.52"), "10": ("0.80", "0.74", "0.64", "0.55"),
}
# Table 5.4, with the 30 s and 150 s of chapters 4 and 5.
COMMON = {
    "vessel": "38 mm x 57 mm", "friction": 0.4, "gravity": "9.8 m/s2", "speed": "1054 rpm", "arm": "10 cm", "angles": "15 deg",
}
# Table 5.5: inverse milling dose rate [s/J], by powder and charge ratio, in the order of the diameters.
INVERSE_DOSE_RATE = {
    ("2", "2.5"): (0.5344, 0.5425, 0.5770, 0.9670), ("2", "5"): (0.2752, 0.2722, 0.2812, 0.2931),
    ("2", "10"): (0.1647, 0.1538, 0.1452, 0.1428), ("5", "2.5"): (0.2064, 0.2061, 0.2123, 0.2869),
    ("5", "5"): (0.1101, 0.1072, 0.1078, 0.1184), ("5", "10"): (0.0684, 0.0625, 0.0572, 0.0606),
}
# Table 5.6: collisions per second, 5 g of powder, by number of balls. It leaves out 189 balls of 3.16 mm.
COLLISION_RATE = {
    227: 64366, 454: 126155, 908: 246846, 95: 28122, 378: 110817, 28: 8672, 55: 18273, 111: 38476, 3: 1158, 7: 2566, 14: 6488,
}

Case = namedtuple("Case", "name powder charge_ratio diameter count restitution thesis_inverse thesis_rate")


def cases():
    """The 24 cases, in the order of table 5.2."""
    for (powder, ratio), counts in BALLS.items():
        for k, diameter in enumerate(DIAMETERS):
            name = f"{powder}g_{ratio.replace('.', '_')}_{diameter.replace('.', '_')}mm"
            rate = COLLISION_RATE.get(counts[k]) if powder == "5" else None
            yield Case(name, powder, ratio, diameter, counts[k], RESTITUTION[ratio][k],
                       INVERSE_DOSE_RATE[powder, ratio][k], rate)
