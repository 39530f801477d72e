#!/usr/bin/env python3
"""Statistics of a case by edmill; with --write, statistics.csv of a case that has no closed form.

usage: edmill_statistics.py EDMILL CASE FOUND.csv [--short] [--write]

FOUND.csv gets name,value,uncertainty for check.py. --short makes few and short runs with other
seeds; their uncertainties are those of statistics.csv, scaled by the root of the time that was
simulated. Runs are made below ./CASE."""
import argparse
import csv
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tomllib
from decimal import Decimal

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "ward")]
sys.dont_write_bytecode = True
import gas_theory  # noqa: E402
import intervals  # noqa: E402
from closed_forms import mass, number, vector, write_statistics  # noqa: E402

REPLICAS = 32
PERIOD = 60 / 1054  # of the SPEX [s]


def table(file):
    with open(file, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(line for line in stream if not line.startswith("#")))


def numbers(row):
    return {
        k: float(v) for k, v in row.items()
        if v and k not in ("variable", "statistic", "unit", "partner_kind")
    }


def collisions(folder):
    return [numbers(row) for row in table(folder / "collisions.csv")]


def by_partner(folder, variable):
    return next(
        numbers(row) for row in table(folder / "statistics.csv") if row["variable"] == variable)


def summary(folder):
    return json.loads((folder / "summary.json").read_text())


def slipping_particle(folder, case):
    rows, reach = collisions(folder), 7 * float(case["contact"]["friction"])
    sticks = next(row for row in rows if row["slip_speed"] <= reach * row["approach_speed"])
    begin = float(vector(case["ball"][0]["position"])[0])
    return {
        "slip_end_time": sticks["time"], "slip_distance": sticks["x"] - begin,
        "rolling_speed": rows[-1]["vx_after"], "rolling_spin": -rows[-1]["wz_after"],
        "dissipated_energy": sum(row["milling_dose"] for row in rows)
    }


def stacked_particles(folder, _):
    force = by_partner(folder, "normal_impulse")
    return {"floor_less_ceiling_force": force["wall_0"] - force["wall_1"],
            "ball_less_ceiling_force": force["ball_ball"] - force["wall_1"]}


def drum_detachment(folder, case):
    rows = collisions(folder)
    last = next((a for a, b in zip(rows, rows[1:]) if b["time"] > a["time"] + 0.02), rows[-1])
    x, y, vx, vy = (last[k] for k in ("x", "y", "vx_after", "vy_after"))
    return {
        "detachment_angle": math.degrees(math.acos(-y / math.hypot(x, y))),
        "detachment_speed": math.hypot(vx, vy),
        "highest_point": y + vy ** 2 / 2 / float(number(case["run"]["gravity"]))
    }


def elastic_gas(folder, case):
    ball = case["balls"][0]
    m, sigma, size = (
        float(v) for v in (mass(ball), number(ball["diameter"]), number(case["vessel"]["size"][0])))
    rate, impulse = by_partner(folder, "collision"), by_partner(folder, "normal_impulse")
    above = numbers(table(folder / "rates_above.csv")[0])
    pairs_above = above["ball_ball rate [1/s]"]
    energy, side, force = summary(
        folder)["energy"]["kinetic_end"], size - sigma, impulse["walls"] / 6
    return {
        "kinetic_energy": energy, "mean_speed": statistics.mean(
            float(row["speed average [m/s]"]) for row in table(folder / "trends_balls.csv")
        ), "wall_force": force, "pressure": force / side ** 2, "wall_rate": rate["walls"],
        "pair_rate": rate["ball_ball"],
        "wall_approach_speed": impulse["walls"] / (2 * m * rate["walls"]),
        "pair_approach_speed": impulse["ball_ball"] / (m * rate["ball_ball"]), "wall_share_above_1":
            (above["total rate [1/s]"] - pairs_above) / rate["walls"],
        "pair_share_above_1": pairs_above / rate["ball_ball"], "virial_ratio":
            (3 * force * side - 2 * energy) / (sigma * impulse["ball_ball"])
    }


def spex(folder, _):
    run = summary(folder)
    rate, dose = run["collision_rate"], {
        k: v / run["duration"] for k, v in run["milling_dose_by_partner"].items()
    }
    walls = {
        "rate": rate["total"] - rate["ball_ball"], "dose": sum(dose.values()) - dose["ball_ball"]
    }
    found = {
        "milling_dose_rate": run["milling_dose_rate"],
        "milling_dose_rate_ball_ball": dose["ball_ball"],
        "milling_dose_rate_walls": walls["dose"], **{
            f"collision_rate_{k}": v for k, v in rate.items()
        }, "energy_per_impact": run["milling_dose_rate"] / rate["total"],
        "energy_per_impact_ball_ball": dose["ball_ball"] / rate["ball_ball"],
        "energy_per_impact_walls": walls["dose"] / walls["rate"]
    }
    for row in map(numbers, table(folder / "rates_above.csv")):
        end, pairs, total = f"above_{row['cutoff [m/s]']:g}_m_s", row["ball_ball rate [1/s]"], row[
            "total rate [1/s]"]
        found |= {
            f"collision_rate_ball_ball_{end}": pairs, f"collision_rate_walls_{end}": total - pairs,
            f"energy_per_impact_{end}": row["total dose_rate [W]"] / total
        }
    return found


# Case: what makes its quantities, begin and end of the record of a full and end of a short run [s],
# replicas of a short one (0: the case is deterministic), settings.
STATISTICS = '{{type="statistics",start_time="{start} s",columns=[{columns}]}}'.replace(
    "{columns}",
    '{{variable="collision",statistics=["rate"]}},{{variable="normal_impulse",statistics=["rate"]}}'
)
ABOVE = '{{type="rates_above",start_time="{start} s",cutoffs=[%s]}}'
SPEEDS = '{{type="trends_balls",start_time="{start} s",interval="50 ms",columns=[' \
    '{{variable="speed",statistics=["average"]}}]}}'
SPEX = ["output=[" + ABOVE % '"0.1 m/s","1 m/s"' + "]"]
CASES = {
    "slipping_particle": (slipping_particle, 0, 0.2, 0.2, 0, []),
    "stacked_particles": (stacked_particles, 0, 50, 50, 0, [
        'contact.least_separation="1 cm/s"', "run.max_collisions=1000000000",
        f"output=[{STATISTICS}]"
    ]), "drum_detachment": (drum_detachment, 0, 0.4, 0.4, 0, []),
    "elastic_gas": (elastic_gas, 1, 21, 3, 4,
                    ["output=[" + ",".join((STATISTICS, ABOVE % '"1 m/s"', SPEEDS)) + "]"]),
    "spex_3": (spex, 10 * PERIOD, 1010 * PERIOD, 160 * PERIOD, 6, SPEX), "spex_28":
        (spex, 10 * PERIOD, 610 * PERIOD, 50 * PERIOD, 4, SPEX),
}
MEANINGS = {
    "kinetic_energy": ("J", "of all balls"), "mean_speed":
        ("m/s", "of the balls at equal times; Maxwell's distribution at constant energy"),
    "wall_approach_speed": ("m/s", "mean approach speed of the impacts on walls"),
    "pair_approach_speed": ("m/s", "the same between balls"), "wall_share_above_1":
        ("1", "share of the impacts on walls that approach at more than 1 m/s"),
    "pair_share_above_1": ("1", "the same between balls"), "virial_ratio": (
        "1",
        "(3 F a - 2 E)/(sigma P): F wall_force; a edge of the centres' cube; P normal impulses of pairs per "
        "time"), "wall_force": ("N", "mean normal force on one of the six walls"), "pressure":
            ("Pa", "wall_force over the area that the centres can reach"), "wall_rate":
                ("1/s", "impacts on all walls per time"), "pair_rate":
                    ("1/s", "impacts between balls per time"),
    "milling_dose_rate": ("W", "mean milling dose per time"), "collision_rate":
        ("1/s", "impacts per time"), "energy_per_impact": ("J", "mean milling dose of an impact")
}


def meaning(name):
    """Unit and meaning of a quantity."""
    unit, text = next(MEANINGS[key] for key in MEANINGS if name.startswith(key))
    if "above_" in name and name not in MEANINGS:
        text += "; impacts that approach at this speed or faster"
    elif name.startswith(("collision_rate", "energy_per")):
        text += "; depends on the least separation speed"
    return unit, text


def command(name, seed, short):
    """The case file and the settings of a run."""
    _, start, end, short_end, _, settings = CASES[name]
    start, end = f"{start:.9f}", f"{short_end if short else end:.9f}"
    case = HERE / name / json.loads((HERE / name / "suite.json").read_text())["case"]
    return case.resolve(), [
        *(s.format(start=start) for s in settings), f"run.seed={seed}",
        f'run.start_time="{start} s"', f'run.end_time="{end} s"'
    ]


def write(name, runs, version):
    """statistics.csv of a case."""
    theory = gas_theory.elastic_gas() if name == "elastic_gas" else {}
    t, rows, count = intervals.student95(len(runs) - 1), [], len(runs)
    for label in runs[0]:
        values, (unit, text), (stated, kind) = [run[label] for run in runs
                                               ], meaning(label), theory.get(label, ("", ""))
        mean, error = statistics.mean(values), statistics.stdev(values) / math.sqrt(count)
        if label == "kinetic_energy":  # scatters by rounding alone
            row = [
                f"{float(stated):.16e}", "0", "0",
                str(count), f"{1e-9 * mean:.1e}", f"{float(stated):.16e}"
            ]
        else:
            places = max(0, math.ceil(math.log10(abs(mean) / error)) + 1)
            row = [f"{mean:.{places}e}", f"{error:.2e}", f"{t * error:.2e}", str(count), "0",
                   f"{float(stated):.{places}e}" if stated else ""]
        rows.append([label, unit, *row, kind, text])
    case, settings = command(name, "SEED", False)
    quoted = " ".join(f"--set '{text}'" for text in settings)
    start, end = (f"{v:.9f}" for v in CASES[name][1:3])
    write_statistics(HERE / name / "statistics.csv", [
        f"{name}: means over {count} runs, seeds 1 to {count}, each from {start} s to {end} s; schema 1, SI, CC0 1.0",
        f"edmill {version}, double; with SEED = 1 to {count}:",
        f"edmill run {case.relative_to(HERE.parents[2])} --quiet --out {name}/SEED {quoted}",
        f"all of them: python3 regression/reference/suite/edmill_statistics.py EDMILL {name} found.csv --write"
    ], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("edmill")
    parser.add_argument("case", choices=CASES)
    parser.add_argument("found", type=pathlib.Path)
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--write", action="store_true")
    a = parser.parse_args()
    quantities, start, end, short_end, short_runs, _ = CASES[a.case]
    seeds = [1] if not short_runs else range(1001, 1001 +
                                             short_runs) if a.short else range(1, REPLICAS + 1)
    runs = []
    for seed in seeds:
        folder, (case, settings) = pathlib.Path(a.case) / str(seed), command(a.case, seed, a.short)
        subprocess.run([a.edmill, "run", str(case), "--quiet", "--out", str(folder),
                        *(part for text in settings for part in ("--set", text))], check=True)
        runs.append(quantities(folder, tomllib.loads(case.read_text(), parse_float=Decimal)))
    if a.write and short_runs and not a.short:
        write(a.case, runs, summary(folder)["version"])
    known = {
        row["name"]: float(row["standard_uncertainty"])
        for row in table(HERE / a.case / "statistics.csv")
    }
    longer, more = (end - start) / ((short_end if a.short else end) - start), REPLICAS / len(seeds)
    with open(a.found, "w", encoding="utf-8") as file:
        print("name,value,uncertainty", file=file)
        for label in runs[0]:
            # the virial is off by the two ends of a run alone
            scale = math.sqrt(more) * (longer if label == "virial_ratio" else math.sqrt(longer))
            mean = statistics.mean(run[label] for run in runs)
            print(f"{label},{mean!r},{scale * known[label]:.3e}", file=file)
    return 0


if __name__ == "__main__":
    sys.exit(main())
