#!/usr/bin/env python3
"""`edmill audit --identify` in random trials: logs of cases with one value or mistake other than
the audited case's, with two, with none, and with rounding alone. The right cause must come first,
with its value within its interval.

usage: PYTHONPATH=tests/support python3 trials.py EDMILL FOLDER [--trials N] [--pairs N] [--clean N]
    [--jobs J] [--only TEXT] [--every K] [--seed S]
N trials of each parameter, by 0.1 % and by 5 %, of each mistake, and of logs with `time, ball,
partner` alone; N trials of two at once; N clean and N rounded logs. A log that does not tell a
change from others is drawn again."""
import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import random
import shutil
import sys
import zlib

from program import edmill, sets

EVENTS = 2000
RAD = math.pi / 180
RPM = 2 * math.pi / 60
#   key of the cause               setting of the run               value, unit, SI of the unit
PARAMETERS = {
    "mill.arm": ("mill.arm", 100, "mm", 1e-3),
    "mill.theta_max": ("mill.theta_max", 15, "deg", RAD),
    "mill.gamma_max": ("mill.gamma_max", 15, "deg", RAD),
    "mill.speed": ("mill.speed", 1054, "rpm", RPM),
    "phase of the drive": (None, 0, "s", 1),
    "vessel.diameter": ("vessel.diameter", 38, "mm", 1e-3),
    "vessel.height": ("vessel.height", 57, "mm", 1e-3),
    "run.gravity": ("run.gravity", 9.8, "m/s2", 1),
    "run.gravity, tilted towards.x": ("tilt", 0, "rad", 1),
    "run.gravity, tilted towards.z": ("tilt", 0, "rad", 1),
    "balls.0.diameter": ("balls.0.diameter", 6, "mm", 1e-3),
    "balls.0.density": ("balls.0.density", 8, "g/cm3", 1e3),
    "balls.0.reduced_inertia": ("balls.0.reduced_inertia", 0.4, "", 1),
    "contact.restitution": ("contact.restitution", 0.53, "", 1),
    "contact.ball_ball.restitution": ("contact.ball_ball.restitution", 0.53, "", 1),
    "contact.ball_wall.restitution": ("contact.ball_wall.restitution", 0.53, "", 1),
    "contact.friction": ("contact.friction", 0.4, "", 1),
    "contact.ball_ball.friction": ("contact.ball_ball.friction", 0.4, "", 1),
    "contact.ball_wall.friction": ("contact.ball_wall.friction", 0.4, "", 1),
    "contact.min_tangential": ("contact.min_tangential", -0.8, "", 1),
    "contact.least_separation": ("contact.least_separation", 10, "mm/s", 1e-3),
    "contact.ball_ball.least_separation": ("contact.ball_ball.least_separation", 10, "mm/s", 1e-3),
    "contact.ball_wall.least_separation": ("contact.ball_wall.least_separation", 10, "mm/s", 1e-3),
}
SPEX = """[mill]
type = "spex8000"
speed = "1054 rpm"
arm = "100 mm"
theta_max = "15 deg"
gamma_max = "15 deg"
"""
SWING_Z = '[[mill.joint]]\nrotate = "z"\nangle = "90 deg"\n[[mill.joint.swing]]\namplitude = "{} deg"\nspeed = "{} rpm"\nphase = "90 deg"\n'
BACK_Z = '[[mill.joint]]\nrotate = "z"\nangle = "-90 deg"\n[[mill.joint.swing]]\namplitude = "-15 deg"\nspeed = "1054 rpm"\nphase = "90 deg"\n'
ARM = '[[mill.joint]]\ntranslate = ["100 mm", "0 m", "0 m"]\n'
ROLL = '[[mill.joint]]\nrotate = "x"\n[[mill.joint.swing]]\namplitude = "{} deg"\nspeed = "1054 rpm"\n'
CHAIN = '[mill]\ntype = "chain"\n'
#   key of the cause, part of its text, [mill] of the run, settings of the run, change of the log
MISTAKES = {
    "order of rotations": (CHAIN + SWING_Z.format(15, 1054) + ARM + BACK_Z + ROLL.format(15) +
                           SWING_Z.format(15, 1054), [], None),
    "sign of gamma": (CHAIN + SWING_Z.format(15, 1054) + ARM + ROLL.format(-15), [], None),
    "spins: in degrees": (SPEX, [], "degrees"), "columns of the partner": (SPEX, [], "exchanged"),
    "times: in ms": (SPEX, [], "ms"), "positions: in mm": (SPEX, [], "mm"), "velocities: in mm/s":
        (SPEX, [], "mm/s"), "energies: in mJ": (SPEX, [], "mJ"), "numbers of balls: balls 0 and 2":
            (SPEX, [], "numbers"), "diameter: 76 mm": (SPEX, ['vessel.diameter="76 mm"'], None),
    "diameter: 3 mm": (SPEX, ['balls.0.diameter="3 mm"'], None), "density: 8 kg":
        (SPEX, ['balls.0.density="8 kg/m3"'], None), "arm: 1000":
            (SPEX, ['mill.arm="100 m"', 'run.max_collisions=300'], None), "theta_max: 0.2617":
                (SPEX, [f'mill.theta_max="{15 * RAD} deg"'], None),
}


def case_text(mill, balls, seed, sizes=None):
    entries = "".join(f'[[balls]]\ncount = {n}\ndiameter = "{d} mm"\ndensity = "8 g/cm3"\n'
                      for n, d in sizes or [(balls, 6)])
    return f"""[run]
seed = {seed}
end_time = "100 s"
max_collisions = {EVENTS}
gravity = "9.8 m/s2"
{mill}[vessel]
type = "cylinder"
diameter = "38 mm"
height = "57 mm"
[contact]
model = "walton-braun"
restitution = 0.53
friction = 0.4
min_tangential = -0.8
least_separation = "10 mm/s"
{entries}[[output]]
type = "collisions"
states = true
"""


def changed_log(file, how, random_numbers):
    """The log as another code would write it: other units, other columns, other numbers, fewer
    digits."""
    rows = list(csv.reader(file.open()))
    header, rows = rows[0], rows[1:]
    at = {name: k for k, name in enumerate(header)}

    def scale(names, factor):
        for row in rows:
            for k in names:
                if row[k]:
                    row[k] = repr(float(row[k]) * factor)

    def columns(*beginnings):
        return [k for name, k in at.items() if name.startswith(beginnings)]
    kind, amount = how if isinstance(how, tuple) else (how, None)
    places = [
        k for name, k in at.items()
        if name in ("x", "y", "z", "partner_x", "partner_y", "partner_z")
    ]
    if kind == "degrees":
        scale(columns("wx", "wy", "wz", "partner_wx", "partner_wy", "partner_wz"), 180 / math.pi)
    elif kind == "ms":
        scale([at["time"]], 1e3)
    elif kind == "mm":
        scale(places, 1e3)
    elif kind == "mm/s":
        scale(columns("vx", "vy", "vz", "partner_vx", "partner_vy", "partner_vz"), 1e3)
    elif kind == "mJ":
        scale([at["milling_dose"], at["wall_work"]], 1e3)
    elif kind == "phase":
        for row in rows:
            row[at["time"]] = repr(float(row[at["time"]]) - amount)
    elif kind == "exchanged":
        own = [k for name, k in at.items() if "partner_" + name in at and name != "kind"]
        for row in rows:
            if row[at["partner_kind"]] == "ball":
                for k in own:
                    other = at["partner_" + header[k]]
                    row[k], row[other] = row[other], row[k]
    elif kind == "numbers":
        names = {"0": "2", "2": "0"}
        for row in rows:
            row[at["ball"]] = names.get(row[at["ball"]], row[at["ball"]])
            if row[at["partner_kind"]] == "ball":
                row[at["partner"]] = names.get(row[at["partner"]], row[at["partner"]])
    elif kind == "few":
        header = ["time", "ball", "partner_kind", "partner"]
        rows = [[row[at[name]] for name in header] for row in rows]
    elif kind == "rounded":
        digits = random_numbers.choice([6, 7, 8, 9, 10, 12])
        for row in rows:
            for name, k in at.items():
                if row[k] and name not in ("ball", "partner", "partner_kind"):
                    row[k] = f"{float(row[k]):.{digits}g}"
    with file.open("w", newline="") as out:
        csv.writer(out, lineterminator="\n").writerows([header, *rows])


def run(folder, text, settings, change, random_numbers, audited):
    """Makes a log and has it searched. @return the entry `identified` of the audit's document."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "run.toml").write_text(text)
    (folder / "case.toml").write_text(audited)
    edmill("run", "run.toml", "--quiet", "--out", "out", *sets(*settings), cwd=folder, code=0)
    for how in change:
        changed_log(folder / "out" / "collisions.csv", how, random_numbers)
    done = edmill("audit", "case.toml", "out/collisions.csv", "--identify", "--quiet", "--json",
                  "found.json", *(["--from-start"] if "few" in change else []), cwd=folder)
    if done.returncode not in (0, 6, 7):
        raise RuntimeError(done.stderr)
    found = json.loads((folder / "found.json").read_text())["identified"]
    if len(
            settings
    ) == 2 and "run.max_collisions=300" not in settings:  # what each of two changes does beside the other
        found["without"] = {}
        for setting in settings:
            one = edmill("audit", "case.toml", "out/collisions.csv", "--quiet", "--json",
                         "one.json", "--set", setting, cwd=folder)
            if one.returncode in (0, 6):
                kinds = json.loads((folder / "one.json").read_text())["violations"]
                found["without"][setting] = sum(v["count"] for v in kinds.values())
    shutil.rmtree(folder)
    return found


def other_value(key, share):
    """Setting of the run, change of the log, and the value in SI."""
    setting, value, unit, si = PARAMETERS[key]
    if key == "phase of the drive":
        delay = share * 60 / 1054
        return None, ("phase", delay), delay
    if setting == "tilt":  # by that share of a right angle
        angle = share * math.pi / 2
        g = [0.0, -9.8 * math.cos(angle), 0.0]
        g[0 if key.endswith("x") else 2] = 9.8 * math.sin(angle)
        return "run.gravity=[" + ", ".join(f'"{x!r} m/s2"' for x in g) + "]", None, angle
    other = value * (1 + share)
    text = f"{other:.12g}"
    return (f'{setting}="{text} {unit}"' if unit else f"{setting}={text}"), None, float(text) * si


def shows(found):
    """Whether the log has impacts that tell the change from others: none does where no two balls
    meet slowly, for one."""
    told = not any(cause["alike"] for cause in found["causes"].values())
    return found["violations"] > 0 and told and all(
        n > 0 for n in found.get("without", {}).values())


def right(found, truths):
    """Whether the first cause has these values and no others."""
    causes = found["causes"]
    if not causes:
        return "no cause"
    first = causes["1"]
    if set(first["values"]) != set(truths) or first["mistakes"]:
        return first["text"]
    for key, truth in truths.items():
        value = first["values"][key]
        if not abs(value["value"] - truth) <= value["half_width"]:
            return f"{first['text']}: off by {value['value'] - truth:.2g}, half width {value['half_width']:.2g}"
    return ""


def trial(job):
    """@return name of the trial, and what is wrong or nothing"""
    place, kind, name, share, number, seed = job
    rng = random.Random(zlib.crc32(f"{seed} {kind} {name} {share} {number}".encode()))
    folder = pathlib.Path(place) / f"{zlib.crc32(repr(job).encode()):08x}"
    # Laws of two balls, and slow impacts, need many of them to show.
    balls = rng.choice([14, 28] if "ball_ball" in name or "separation" in name else [3, 7, 14, 28])
    sizes = [(2, 6), (1, 5), (max(1, balls - 3), 7)] if "numbers" in name else None
    audited = case_text(SPEX, balls, rng.randrange(1, 10**6), sizes)
    settings, change, truths = [], [], {}
    text = audited
    if kind == "mistake":
        mill, settings, how = MISTAKES[name]
        text = audited.replace(SPEX, mill)
        change = [how] if how else []
    elif kind in ("clean", "rounded"):
        change = ["rounded"] if kind == "rounded" else []
    elif name == "none":
        change = ["few"]
    else:
        for key in name.split(" + "):
            amount = rng.choice([-1, 1]) * (share or 10**rng.uniform(-3, math.log10(0.05)))
            setting, how, truth = other_value(key, amount)
            settings += [setting] if setting else []
            change += [how] if how else []
            truths[key] = truth
        change += ["few"] if kind == "few" else []
    try:
        found = run(folder, text, settings, change, rng, audited)
        silent = not found["violations"] if kind == "mistake" else kind in (
            "value", "pair") and not shows(found)
        if silent and number < 20000:
            return trial((place, kind, name, share, number + 1000, seed))
    except (RuntimeError, AssertionError) as error:
        return kind, name, share, str(error)
    if kind == "few" and name == "none":
        wrong = found["causes"]["1"]["text"] if found["causes"] else ""
    elif kind in ("clean", "rounded"):
        wrong = found["causes"]["1"]["text"] if found["causes"] else ""
    elif kind == "mistake":
        first = found["causes"].get("1")
        told = " | ".join([first["text"], *first["alike"].values()]) if first else "no cause"
        wrong = "" if first and name in told and not first["values"] else told
    else:
        wrong = right(found, truths)
    return kind, name, share, wrong


FEW = ("none", "mill.arm", "mill.theta_max", "mill.gamma_max", "mill.speed", "contact.friction",
       "contact.restitution", "contact.ball_wall.restitution", "balls.0.reduced_inertia",
       "phase of the drive")


def jobs_of(a):
    rng = random.Random(a.seed)
    for name in PARAMETERS:
        for share in (0.001, 0.05):
            for number in range(a.trials):
                yield (a.folder, "value", name, share, number, a.seed)
    for name in MISTAKES:
        for number in range(a.trials):
            yield (a.folder, "mistake", name, 0, number, a.seed)
    for number in range(a.pairs):
        while True:  # a number for both kinds of contact, and one of a kind of the same name, overlap
            one, two = rng.sample(sorted(PARAMETERS), 2)
            laws = one.startswith("contact") and two.startswith("contact") and one.split(
                ".")[-1] == two.split(".")[-1]
            if not laws and not (one.startswith("run.gravity") and two.startswith("run.gravity")):
                break
        yield (a.folder, "pair", f"{one} + {two}", 0, number, a.seed)
    for name in FEW:
        for number in range(a.trials):
            yield (a.folder, "few", name, 0.001 if name != "none" else 0, number, a.seed)
    for kind in ("clean", "rounded"):
        for number in range(a.clean):
            yield (a.folder, kind, "", 0, number, a.seed)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("edmill")
    parser.add_argument("folder")
    parser.add_argument("--trials", type=int, default=1)
    parser.add_argument("--pairs", type=int, default=5)
    parser.add_argument("--clean", type=int, default=3)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="")
    parser.add_argument("--every", type=int, default=1, help="only every so many of these trials")
    parser.add_argument("--seed", type=int, default=20110101)
    parser.add_argument("--verbose", action="store_true")
    a = parser.parse_args()
    a.folder = str(pathlib.Path(a.folder).resolve())
    jobs = [job for job in jobs_of(a) if a.only in f"{job[2]} {job[3]}"][::a.every]
    print(f"seed {a.seed}, {len(jobs)} logs of {EVENTS} impacts")
    tally = {}
    with concurrent.futures.ProcessPoolExecutor(a.jobs) as pool:
        for kind, name, share, wrong in pool.map(trial, jobs):
            key = (kind, name if kind in ("value", "mistake", "few") else "", share)
            good, all_of, said = tally.get(key, (0, 0, []))
            tally[key] = (good + (not wrong), all_of + 1,
                          said + ([f"{name}: {wrong}"] if wrong else []))
    failed = 0
    for (kind, name, share), (good, all_of, said) in tally.items():
        least = {"value": 0.95, "mistake": 0.95, "few": 0.9, "pair": 0.8}.get(kind, 1.0)
        by = f" off by {share * 100:g} %" if share else ""
        print(f"claim identify, {kind} {name}{by}: {good} of {all_of}")
        if good < least * all_of:
            failed += 1
        if said and (good < least * all_of or a.verbose):
            print("  " + "\n  ".join(said[:5]))
    if failed:
        sys.exit(f"failed: {failed} kinds of trials")


if __name__ == "__main__":
    main()
