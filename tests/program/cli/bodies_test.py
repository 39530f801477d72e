#!/usr/bin/env python3
"""Bodies inside the vessel: what is refused, outputs and derivatives, judges, random mills with
bodies of all kinds, and the same events in three scalars.

usage: PYTHONPATH=tests/support python3 bodies_test.py EDMILL [MILLS] [SEED] [CHARGES]
"""
import collections
import csv
import pathlib
import random
import sys
from decimal import Decimal

from program import EXAMPLES, SOURCE, Trials, edmill, said, summary

REFERENCE = SOURCE / "regression/reference/stirred.toml"
mills = int(sys.argv[2]) if len(sys.argv) > 2 else 12
seed = int(sys.argv[3]) if len(sys.argv) > 3 else 20261130
charges = int(sys.argv[4]) if len(sys.argv) > 4 else 1  # of each mill
rng = random.Random(seed)
reasons = collections.Counter()  # why the runs ended

CASE = """[run]
end_time = "{end}"
gravity = "9.81 m/s2"
seed = {seed}
[mill]
{mill}
[vessel]
{vessel}
{bodies}
[contact]
restitution = {restitution}
friction = {friction}
[[balls]]
count = {count}
diameter = "{diameter} mm"
"""
TANK = dict(end="0.1 s", seed=1,
            mill='type = "chain"\njoint = [{ rotate = "y", angle = "45 deg" }]',
            vessel='type = "cylinder"\ndiameter = "60 mm"\nheight = "60 mm"', restitution=0.6,
            friction=0.3, count=5, diameter=4)

REFUSED = {  # bodies, and words of the one message
    'size = ["0 mm", "0 mm", "0 mm"]': "a body without size",
    'size = ["-1 mm", "2 mm", "2 mm"]': "a negative length",
    'rounding = "1 mm"': "'body.0.size': missing",
    'type = "cylinder"\ndiameter = "5 mm"': "'body.0.height': missing",
    'type = "cylinder"\nsize = ["5 mm", "5 mm", "5 mm"]\ndiameter = "5 mm"\nheight = "5 mm"': "a key of the other type",
    'size = ["6 mm", "6 mm", "4 mm"]\nrounding = "3 mm"': "at most half of each size",
    'type = "cone"\nsize = ["6 mm", "6 mm", "4 mm"]': "expected one of",
    'size = ["6 mm", "6 mm", "4 mm"]\njoint = [{ translate = ["80 mm", 0, 0] }]': "body 0 outside of the vessel at 0 s",
    'size = ["6 mm", "6 mm", "4 mm"]\njoint = [{ translate = "x", speed = "2 m/s" }]': "body 0 outside of the vessel at 0.0",
    'size = ["200 mm", "200 mm", "200 mm"]': "no room for a ball between the bodies",
    'size = ["6 mm", "6 mm", "4 mm"]\nrepeat = 3': "copies without a rotating joint",
    'size = ["6 mm", "6 mm", "4 mm"]\nrepeat = 24\njoint = [{ rotate = "y" }]\n[[body]]\nsize = ["6 mm", "6 mm", "4 mm"]\nrepeat = 24\n'
    'joint = [{ rotate = "y" }]': "walls and bodies, expected at most",
    'size = ["6 mm", "6 mm", "4 mm"]\nname = "pin"\n[[body]]\nsize = ["6 mm", "6 mm", "4 mm"]\nname = "pin"': "no other body has",
    'size = ["6 mm", "6 mm", "4 mm"]\nname = "cap +y"': "no wall has",
    'size = ["6 mm", "6 mm", "4 mm"]\nmaterial = "rubber"': "'body.0.material'",
    'size = ["6 mm", "6 mm", "4 mm"]\nonn = "ground"': "expected 'on'",
    'size = ["10 mm", "10 mm", "10 mm"]\n[[ball]]\ndiameter = "4 mm"\nposition = [0, 0, 0]': "overlapping body 0",
}


def refusals(t):
    for body, words in REFUSED.items():
        pathlib.Path("case.toml").write_text(CASE.format(bodies="[[body]]\n" + body, **TANK))
        t.refused(edmill("check", "case.toml"), repr(body), words)


def table(file):
    """Rows of a file, without the units of its columns."""
    lines = [
        row for row in csv.reader(line for line in open(file, encoding="utf-8")
                                  if not line.startswith("#"))
    ]
    return [dict(zip((name.split(" [")[0] for name in lines[0]), row)) for row in lines[1:]]


def outputs(t):
    """Maps hold all the dose of a body; derivatives by a body's numbers are those of runs beside
    it."""
    text = REFERENCE.read_text().replace('end_time = "10 s"', 'end_time = "0.15 s"')
    for kind, keys in (("coverage", ""), ("bodies", ""),
                       ("treatment", "share_per_impact = 0.001\n"), ("lyapunov", "")):
        text += f'[[output]]\ntype = "{kind}"\n{keys}'
    pathlib.Path("maps.toml").write_text(text)
    said("run", "maps.toml", "--quiet", "--out", "maps")
    dose, area = collections.Counter(), collections.Counter()
    for row in table("maps/coverage.csv"):
        dose[row["wall"]] += float(row["dose"])
        area[row["wall"]] += float(row["area"])
    for row in table("maps/bodies.csv"):
        if row["kind"] == "wall":
            wall = row["body"]
            t.check(
                abs(dose[wall] - 2 * float(row["dose"])) <= 1e-9 * dose[wall],
                f"dose of wall {wall}: {dose[wall]}, {row}")
            t.check(
                abs(area[wall] - float(row["area"])) <= 1e-9 * area[wall],
                f"area of wall {wall}: {area[wall]}, {row}")
    t.check(
        len(table("maps/treatment.csv")) == 12 and
        float(table("maps/lyapunov.csv")[0]["per_second"]) > 0, "treatment and exponents")
    events, step = 60, Decimal("1e-12")
    keys = {
        "body.1.rounding": (2, "mm", Decimal(1)), "body.1.joint.1.speed": (600, "rpm", Decimal(1))
    }
    said("sensitivity", REFERENCE, "--events", events,
         *(word for key in keys for word in ("--by", key)), "--out", "rates.csv")
    rates = table("rates.csv")

    def times(*changes):
        said("certify", REFERENCE, "--collisions", events, "--digits", 30, "--out", "events.csv",
             *changes)
        return [Decimal(row["time"]) for row in table("events.csv")]
    base = times()
    for number, (key, (value, unit, _)) in enumerate(keys.items()):
        other = times("--set", f'{key}="{value + step} {unit}"')
        for k in range(events):
            expected, found = (other[k] - base[k]) / step, Decimal(rates[k][f"d_time_{number}"])
            t.check(
                abs(found - expected) <= Decimal("1e-6") * abs(expected) + Decimal("1e-15"),
                f"{key}, event {k}: {found}, not {expected}")


def judges(t):
    """A log of a case with bodies is clean; that of another body names it; one without its impacts
    misses them."""
    text = (EXAMPLES / "stirred.toml").read_text().replace("count = 150", "count = 60").replace(
        'end_time = "3 s"', 'end_time = "0.7 s"')
    pathlib.Path("stirred.toml").write_text(text +
                                            '[[output]]\ntype = "collisions"\nstates = true\n')
    said("run", "stirred.toml", "--quiet", "--out", "right")
    t.check("verdict: clean" in edmill("audit", "stirred.toml", "right").stdout, "a clean log")
    for change, name in (('body.1.joint.1.speed="606 rpm"', "body.1.joint.1.speed = 606 "),
                         ('body.1.rounding="1.9 mm"', "body.1.rounding = 1.9 "),
                         ('body.0.diameter="12.4 mm"', "body.0.diameter = 12.4 ")):
        said("run", "stirred.toml", "--quiet", "--out", "wrong", "--set", change)
        found = edmill("audit", "stirred.toml", "wrong", "--identify").stdout
        t.check("looks like   " + name in found, f"{change}: {found[-900:]}")
    rows = [
        line for line in open("right/collisions.csv", encoding="utf-8") if not line.startswith("#")
    ]
    place = rows[0].split(",").index("partner")
    kept = [row for row in rows if row.split(",")[place - 1:place + 1] != ["wall", "5"]]
    t.check(len(kept) < len(rows) - 20, "impacts with arm 1")
    pathlib.Path("less.csv").write_text("".join(kept))
    found = edmill("audit", "stirred.toml", "less.csv").stdout
    t.check("missed_event" in found and "with wall 5" in found, f"without arm 1: {found[-900:]}")


def body():
    if rng.random() < 0.5:
        size = [rng.choice([0, 2, 4, 8, 20, 30]) for _ in range(3)]
        size = size if any(size) else [10, 0, 0]
        text = 'size = ["{} mm", "{} mm", "{} mm"]\n'.format(*size)
    else:
        size = [rng.choice([3, 8, 20]), rng.choice([0, 2, 10, 30])]
        text = 'type = "cylinder"\ndiameter = "{} mm"\nheight = "{} mm"\n'.format(*size)
    text += f'rounding = "{min(size) / 2 * rng.choice([0, 0.5, 1])} mm"\non = "{rng.choice(["vessel", "ground"]) if tank else "vessel"}"\n'
    joints = []
    if rng.random() < 0.7:
        joints.append(
            f'{{ rotate = "{rng.choice("xyz")}", speed = "{rng.choice([60, 200, 600, -300])} rpm" }}'
        )
    joints.append('{{ translate = ["{:.1f} mm", "{:.1f} mm", "{:.1f} mm"] }}'.format(
        *(rng.uniform(-12, 12) for _ in range(3))))
    if rng.random() < 0.4:
        joints.append(
            f'{{ rotate = "{rng.choice("xyz")}", angle = "{rng.uniform(-90, 90):.0f} deg" }}')
    if rng.random() < 0.3:
        joints.append(
            f'{{ translate = "{rng.choice("xyz")}", swing = [{{ amplitude = "{rng.uniform(1, 5):.1f} mm", speed = "900 rpm" }}] }}'
        )
    copies = rng.choice([1, 1, 2, 3]) if any("rotate" in joint for joint in joints) else 1
    return f'[[body]]\n{text}joint = [{", ".join(joints)}]\nrepeat = {copies}\n'


def random_mill(t, trial):
    global tank
    mill = rng.choice([
        TANK["mill"], 'type = "spex8000"\nspeed = "900 rpm"',
        'type = "planetary"\nradius = "70 mm"\nspeed = "300 rpm"\nratio = -2',
        'type = "drum"\nspeed = "60 rpm"',
        'type = "vibratory"\namplitude = [0, "3 mm", 0]\nspeed = "1200 rpm"', 'type = "still"'
    ])
    tank = mill in (TANK["mill"], 'type = "still"')
    vessel = rng.choice([
        TANK["vessel"], 'type = "box"\nsize = ["60 mm", "60 mm", "60 mm"]',
        'type = "rounded_cylinder"\ndiameter = "60 mm"\nheight = "60 mm"\nedge_radius = "10 mm"'
    ])
    text = CASE.format(end=rng.choice(["0.1 s",
                                       "0.2 s"]), seed=rng.randint(1, 99), mill=mill, vessel=vessel,
                       bodies="".join(body() for _ in range(rng.choice([1, 1, 2, 3]))),
                       restitution=rng.choice([0.3, 0.53, 0.9]), friction=rng.choice([0, 0.3]),
                       count=rng.choice([5, 20, 60]), diameter=rng.choice([3, 5, 6]))
    pathlib.Path("case.toml").write_text(text)
    for charge in range(charges):
        done = edmill("run", "case.toml", "--quiet", "--out", "mill", "--set",
                      f"run.seed={rng.randint(1, 9999)}", timeout=300)
        t.check(done.returncode in (0, 8),
                f"mill {trial} of seed {seed}: exit code {done.returncode}: {done.stderr}\n{text}")
        result = summary("mill")
        reasons[result["end_reason"]] += 1
        closure = result["energy"]["closure_relative"]
        t.check(closure is None or abs(closure) <= 1e-11,
                f"mill {trial} of seed {seed}: energy closes to {closure} of the dose")


def borders(t):
    """A body far faster than the clock of its mill crosses the borders of its regions within a
    rounding of the clock."""
    pathlib.Path("slow.toml").write_text(
        CASE.format(
            bodies='[[body]]\nsize = ["20 mm", "8 mm", "4 mm"]\non = "ground"\n'
            'joint = [{ rotate = "y", speed = "1000 rpm" }]', **TANK |
            {"mill": 'type = "chain"\njoint = [{ rotate = "y", speed = "0.1 rpm" }]', "count": 20}))
    done = edmill("run", "slow.toml", "--quiet", "--out", "slow", timeout=120)
    t.check(done.returncode == 0, f"a slow clock: {done.stderr}")
    # A translation at constant speed is bounded by the end of the run alone.
    pathlib.Path("endless.toml").write_text(
        CASE.format(
            bodies=
            '[[body]]\nsize = ["6 mm", "6 mm", "4 mm"]\njoint = [{ translate = "x", speed = "1 mm/s" }]',
            **TANK).replace('end_time = "0.1 s"', "max_collisions = 100"))
    t.refused(edmill("check", "endless.toml"), "a translation without an end",
              "expected a run.end_time")
    # Balls that have to be pushed apart leave a shaft that goes through the lid.
    stirred = EXAMPLES / "stirred.toml"
    t.check(
        edmill("check", stirred, "--set", "balls.0.count=420").returncode == 0,
        "a crowd around a shaft")


def proof(t):
    """A ball that falls onto the middle of a cylinder's end: the distance from the axis is zero."""
    pathlib.Path("axis.toml").write_text(
        CASE.format(bodies='[[body]]\ntype = "cylinder"\ndiameter = "10 mm"\nheight = "6 mm"', **
                    TANK | {"count": 0}) +
        '[[ball]]\ndiameter = "4 mm"\nposition = [0, "20 mm", 0]\n')
    text = said("prove", "axis.toml", "--collisions", 3)
    t.check("proven: 3 events" in text, f"on the axis: {text}")


def scalars(t):
    text = said("certify", EXAMPLES / "stirred.toml", "--collisions", "200", "--out", "events.csv")
    t.check("certified: events.csv" in text and "float128 and mpfr50: 200 events in common" in text,
            f"200 events in three scalars: {text}")


with Trials() as t:
    refusals(t)
    outputs(t)
    judges(t)
    borders(t)
    scalars(t)
    proof(t)
    for trial in range(mills):
        random_mill(t, trial)
print(
    f"{mills} mills with bodies, {charges} charges each, seed {seed}, {t.checks} checks, ended by: {dict(reasons)}"
)
