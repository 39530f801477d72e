"""Tables 5.1 to 5.6 of J. Barahona, Simulation and Optimization of Mechanical Alloying using the
Event-Driven method, University of Ottawa, 2011: the mill of Ward et al. (2005) with 24 charges.
Their numbers are in thesis.csv."""
import csv
import pathlib
from collections import namedtuple

with open(pathlib.Path(__file__).with_name("thesis.csv"), encoding="utf-8") as _file:
    _ROWS = list(csv.DictReader(line for line in _file if not line.startswith("#")))

DIAMETERS = tuple(dict.fromkeys(row["diameter [mm]"] for row in _ROWS))
CHARGE_RATIOS = tuple(dict.fromkeys(row["charge_ratio"] for row in _ROWS))
POWDERS = tuple(dict.fromkeys(row["powder [g]"] for row in _ROWS))

Case = namedtuple("Case",
                  "name powder charge_ratio diameter count restitution thesis_inverse thesis_rate")


def cases():
    """The 24 cases, in the order of table 5.2."""
    for row in _ROWS:
        powder, ratio, diameter = row["powder [g]"], row["charge_ratio"], row["diameter [mm]"]
        name = f"{powder}g_{ratio.replace('.', '_')}_{diameter.replace('.', '_')}mm"
        rate = row["collision_rate [1/s]"]
        yield Case(name, powder, ratio, diameter, int(row["balls"]), row["restitution"],
                   float(row["inverse_milling_dose_rate [s/J]"]), int(rate) if rate else None)
