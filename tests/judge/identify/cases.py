#!/usr/bin/env python3
"""`edmill audit --identify` where there is little to go by: few lines, lines that cannot be read,
balls that come to rest, a log that begins at a saved state, numbers far off, other laws, joints
that are ahead of others, and a signal.

usage: PYTHONPATH=tests/support python3 cases.py EDMILL [EVERY]    EVERY: one pair of a mill and a
    vessel in so many (default: all)"""
import csv
import itertools
import json
import math
import pathlib
import random
import signal
import subprocess
import sys
import time

from program import Trials, edmill, sets, start

EVERY = int(sys.argv[2]) if len(sys.argv) > 2 else 1
DEMO = """[run]
end_time = "100 s"
gravity = "9.8 m/s2"
[mill]
type = "spex8000"
arm = "100 mm"
[vessel]
type = "cylinder"
diameter = "38 mm"
height = "57 mm"
[contact]
friction = 0.4
restitution = 0.53
[[balls]]
count = 28
diameter = "4.76 mm"
"""
REST = """[run]
end_time = "1 s"
[mill]
type = "still"
[vessel]
type = "box"
size = ["60 mm", "60 mm", "60 mm"]
[contact]
friction = 0.4
restitution = 0.9
[[balls]]
count = 6
diameter = "5 mm"
"""


def write_case(text):
    pathlib.Path("case.toml").write_text(text, encoding="utf-8")


def run(case, *settings, states=True):
    write_case(case)
    output = "output=[{type=\"collisions\", states=" + ("true" if states else "false") + "}]"
    edmill("run", "case.toml", "--quiet", "--out", "out", *sets(output, *settings), code=0)
    with open("out/collisions.csv", encoding="utf-8") as file:
        return list(csv.reader(file))


def write(rows):
    with open("log.csv", "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows(rows)


def few_columns(rows):
    kept = [rows[0].index(name) for name in ("time", "ball", "partner_kind", "partner")]
    return [[row[k] for k in kept] for row in rows]


def audit(*options):
    done = edmill("audit", "case.toml", "log.csv", "--identify", "--examples", "0", *options,
                  timeout=200)
    assert done.returncode in (0, 6, 7), (done.returncode, done.stderr)
    return done.stdout


def few_lines():
    rows = run(DEMO, "run.max_collisions=8", 'mill.arm="100.5 mm"')
    write(rows)
    said = audit()
    assert "no cause sought: too few impacts" in said and "looks like" not in said, said


def unreadable_lines():
    rows = run(DEMO, "run.max_collisions=300", 'mill.arm="100.5 mm"')
    for row in rows[1:51]:
        row[rows[0].index("vx_before")] = "nan"
    rows[1][rows[0].index("time")] = "nan"
    write(rows)
    said = audit()
    assert "looks like   mill.arm = 100.5" in said, said


def balls_at_rest():
    """The case has no gravity, so that its balls never move; the log was made with gravity."""
    rows = run(REST, 'run.gravity="9.8 m/s2"', "run.max_collisions=200", states=False)
    write(few_columns(rows))
    said = audit("--from-start")
    assert "reproduces the first 0 impacts" in said or "gravity" in said, said


def saved_state():
    run(DEMO, 'run.end_time="0.2073 s"')
    pathlib.Path("out/final_state.csv").rename("state.csv")
    case = DEMO.replace("[run]\n", "[run]\ninitial_state = \"state.csv\"\n")
    rows = run(case, "run.max_collisions=400", states=False)
    write(few_columns(rows))
    said = audit("--from-start")
    assert "no cause: a run of the case reproduces the log" in said, said


def other_vessels():
    """Each mill and vessel against a log of another speed, diameter or size: an assumption may have
    other walls than the log."""
    vessels = {
        'type = "rounded_cylinder"\ndiameter = "40 mm"\nheight = "40 mm"\nedge_radius = "8 mm"': 'vessel.edge_radius="7 mm"',
        'type = "capsule"\ndiameter = "38 mm"\nheight = "60 mm"': 'vessel.height="61 mm"',
        'type = "box"\nsize = ["40 mm", "50 mm", "60 mm"]': 'vessel.size=["40 mm", "50.2 mm", "60 mm"]',
        'type = "sphere"\ndiameter = "50 mm"': 'vessel.diameter="50.1 mm"',
        'type = "cylinder"\ndiameter = "38 mm"\nheight = "57 mm"': 'vessel.diameter="38.1 mm"'
    }
    mills = {
        'type = "planetary"\nradius = "75 mm"\nspeed = "300 rpm"\nratio = -2': 'mill.speed="360 rpm"',
        'type = "spex8000"': 'mill.speed="1000 rpm"',
        'type = "vibratory"\namplitude = ["5 mm", "0 mm", "1 mm"]\nspeed = "1500 rpm"': 'mill.speed="1600 rpm"'
    }
    right = tried = 0
    for mill, vessel in list(itertools.product(mills, vessels))[::EVERY]:
        case = f"""[run]
end_time = "1 s"
max_collisions = 300
[mill]
{mill}
[vessel]
{vessel}
[contact]
friction = 0.4
restitution = 0.53
[[balls]]
count = 6
diameter = "6 mm"
"""
        for setting in (mills[mill], vessels[vessel]):
            run(case, setting)
            done = edmill("audit", "case.toml", "out", "--identify", "--examples", "0", code=6)
            named = [line for line in done.stdout.splitlines() if "looks like" in line]
            key = setting.split("=")[0]
            assert all(key in line for line in named), (mill, vessel, setting, named)
            right += len(named) > 0
            tried += 1
    assert right > 0.8 * tried, (right, tried)


def causes_of(*options):
    edmill("audit", "case.toml", "out", "--identify", "--quiet", "--json", "found.json", *options,
           code=6)
    return json.loads(
        pathlib.Path("found.json").read_text(encoding="utf-8"))["identified"]["causes"]


def is_named(causes, key, value):
    found = causes["1"]["values"] if causes else {}
    return list(found) == [key] and abs(found[key]["value"] - value) <= found[key]["half_width"]


def numbers_far_off():
    """A number of the log that the case has far from it, or not at all: (setting of the log, of the
    case, key, value in SI)."""
    rpm = math.pi / 30
    wrong = (('mill.arm="130 mm"', None, "mill.arm",
              0.13), ('mill.speed="2108 rpm"', None, "mill.speed",
                      2108 * rpm), ('mill.speed="600 rpm"', None, "mill.speed", 600 * rpm),
             ('mill.speed="1500 rpm"', None, "mill.speed",
              1500 * rpm), ('contact.least_separation="2 cm/s"', None, "contact.least_separation",
                            0.02), (None, "contact.restitution=0", "contact.restitution", 0.53),
             (None, 'contact.least_separation="0 m/s"', "contact.least_separation",
              0.01), ("contact.friction=4", None, "contact.friction", 4))
    for theirs, ours, key, value in wrong[::EVERY]:
        case = DEMO.replace('type = "spex8000"', 'type = "spex8000"\nspeed = "1054 rpm"')
        run(case, "run.max_collisions=800", *([theirs] if theirs else []))
        causes = causes_of(*(["--set", ours] if ours else []))
        assert is_named(causes, key,
                        value), (theirs, ours, causes["1"]["text"] if causes else "no cause")


def other_laws():
    """Logs made with another contact law than the case's, of all contacts or of one kind, with
    random numbers: the law and its number."""
    seed = 20261127
    numbers = random.Random(seed)
    laws = {
        "constant": ("restitution_tangential", "", lambda: numbers.uniform(-0.9, 0.9),
                     "restitution = 0.53"),
        "viscoelastic": ("dissipative_time", " s", lambda: 10 ** numbers.uniform(-7.5, -5.5),
                         'effective_modulus = "113 GPa"\nfriction = 0.4'),
        "elastic-plastic": ("yield_pressure", " Pa", lambda: 10 ** numbers.uniform(8.7, 10),
                            'effective_modulus = "113 GPa"\nfriction = 0.4')
    }
    mills = ('type = "spex8000"',
             'type = "planetary"\nradius = "75 mm"\nspeed = "300 rpm"\nratio = -2')
    walton = "restitution = 0.53\nfriction = 0.4"
    case = """[run]
end_time = "20 s"
max_collisions = 600
[mill]
{}
[vessel]
type = "cylinder"
diameter = "38 mm"
height = "57 mm"
[[balls]]
count = 8
diameter = "6 mm"
[contact]
{}
[contact.ball_ball]
{}
[contact.ball_wall]
{}
"""
    for mill, (law, (key, unit, draw, rest)), section in list(
            itertools.product(mills, laws.items(), ("", ".ball_ball", ".ball_wall")))[::EVERY]:
        value = draw()
        number = f"{value!r}" if not unit else f'"{value!r}{unit}"'
        other = f'model = "{law}"\n{key} = {number}\n{rest}'
        run(
            case.format(mill, "", other if section != ".ball_wall" else walton,
                        other if section != ".ball_ball" else walton))
        write_case(case.format(mill, "", walton, walton))
        causes = causes_of()
        name = f'contact{section}, law "{law}": {key}'
        assert is_named(causes, name, value), (seed, mill, section, law, value,
                                               causes["1"]["text"] if causes else "no cause")
    # The other way round, and together with a number that both laws have.
    of_case = 'model = "viscoelastic"\neffective_modulus = "113 GPa"\ndissipative_time = "1 us"\nfriction = 0.4'
    run(case.format(mills[0], "", walton, walton))
    write_case(case.format(mills[0], "", of_case, of_case))
    causes = causes_of()
    assert is_named(causes, 'contact, law "walton-braun": restitution',
                    0.53), causes["1"]["text"] if causes else "no cause"
    constant = 'model = "constant"\nrestitution = 0.53\nrestitution_tangential = 0.2\nleast_separation = "2 cm/s"'
    run(case.format(mills[0], "", constant, constant))
    write_case(case.format(mills[0], "", walton, walton))
    found = causes_of()["1"]["values"]
    wanted = {
        'contact, law "constant": restitution_tangential': 0.2, "contact.least_separation": 0.02
    }
    assert set(found) == set(wanted), found
    assert all(
        abs(found[key]["value"] - value) <= found[key]["half_width"]
        for key, value in wanted.items()), found


def joint_phases():
    """A swing or a rotation that is ahead of the others, of a chain and of a SPEX 8000."""
    joints = """[mill]
type = "chain"
[[mill.joint]]
rotate = "y"
speed = "300 rpm"
[[mill.joint]]
translate = ["75 mm", "0 m", "0 m"]
[[mill.joint]]
rotate = "y"
angle = "{} deg"
speed = "-600 rpm"
"""
    box = '[vessel]\ntype = "box"\nsize = ["40 mm", "50 mm", "60 mm"]\n'
    case = DEMO.replace('[mill]\ntype = "spex8000"\narm = "100 mm"\n',
                        "{}").replace("count = 28", "count = 8")
    chain = case.replace(case[case.index("[vessel]"):case.index("[contact]")], box)
    swing = '[[mill.joint.swing]]\namplitude = "15 deg"\nspeed = "1054 rpm"\nphase = "{} deg"\n'
    spex = ('[mill]\ntype = "chain"\n[[mill.joint]]\nrotate = "z"\nangle = "90 deg"\n' +
            swing.format(90) +
            '[[mill.joint]]\ntranslate = ["100 mm", "0 m", "0 m"]\n[[mill.joint]]\nrotate = "x"\n' +
            swing)
    for theirs, ours, key, degrees in (
        (chain.format(joints.format(20)), chain.format(joints.format(0)), "mill.joint.2.angle",
         20), (case.format(spex.format(-100)),
               case.format('[mill]\ntype = "spex8000"\nspeed = "1054 rpm"\n'),
               "mill, phase of joint 2, a swing about x", -100)):
        run(theirs, "run.max_collisions=600")
        write_case(ours)
        causes = causes_of()
        assert is_named(causes, key,
                        math.radians(degrees)), (key, causes["1"]["text"] if causes else "no cause")


def density_of_equal_balls():
    """Ratios of masses have no slope by it but rounding, which an exact log has nowhere else."""
    write(run(DEMO, "run.max_collisions=800", 'balls.0.density="7 g/cm3"'))
    said = audit()
    assert "looks like   balls.0.density = 7000" in said, said


def parts_of_the_log():
    """A restitution of 0.6 in a part of the contacts: at walls of one material, at flat walls, at
    one wall, in impacts of one entry."""
    materials = '[[material]]\nname = "steel"\ndensity = "8 g/cm3"\n[[material]]\nname = "liner"\n'
    box = DEMO.replace('type = "cylinder"\ndiameter = "38 mm"\nheight = "57 mm"',
                       'type = "box"\nsize = ["38 mm", "57 mm", "40 mm"]')
    balls = 'count = 28\ndiameter = "4.76 mm"\n'
    case = DEMO.replace(balls, 'count = 8\ndiameter = "6 mm"\nmaterial = "steel"\n') + materials
    two_entries = case.replace(
        "count = 8", "count = 5"
    ) + '[[balls]]\ncount = 4\ndiameter = "6 mm"\ndensity = "8 g/cm3"\nmaterial = "liner"\n'
    in_box = box.replace(balls, 'count = 8\ndiameter = "6 mm"\nmaterial = "steel"\n') + materials
    parts = ((in_box, 'vessel.materials={"wall -x"="liner", "wall +y"="liner", "wall -z"="liner"}',
              "at walls of liner"), (case, 'vessel.materials={"cap -y"="liner", "cap +y"="liner"}',
                                     "at flat walls"),
             (case, 'vessel.materials={"cylinder"="liner"}',
              "at the cylinder"), (two_entries, 'vessel.material="steel"', "in impacts of balls.1"))
    for text, walls, part in parts[::EVERY]:
        pairs = ", ".join(
            f'{{materials=["{other}", "liner"], restitution=0.6}}' for other in ("steel", "liner"))
        run(text, "run.max_collisions=1000", walls, f"contact.pair=[{pairs}]")
        causes = causes_of("--set", walls)
        named = list(causes["1"]["values"].items()) if causes else []
        assert any(part in key and abs(value["value"] - 0.6) <= value["half_width"]
                   for key, value in named), (part, causes and causes["1"]["text"])


def interrupted():
    rows = run(DEMO, "run.max_collisions=20000", 'mill.arm="100.5 mm"', "contact.restitution=0.55")
    write(rows)
    with start("audit", "case.toml", "log.csv", "--identify", stdout=subprocess.PIPE,
               text=True) as process:
        time.sleep(2)
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=60)[0]
    assert "interrupted before a cause was found" in said and "looks like" not in said, said


for test in (few_lines, unreadable_lines, balls_at_rest, saved_state, other_vessels,
             numbers_far_off, other_laws, joint_phases, density_of_equal_balls, parts_of_the_log,
             interrupted):
    with Trials():
        test()
    print(f"{test.__name__}: right")
