"""Tables of the runs that ward_runs.py leaves: means with 95 % intervals of each case, and the
single runs."""
import csv
import io
import json
import math
import pathlib
import statistics

import intervals
import tables
import ward_runs

PARTNERS = ("wall_0", "wall_1", "wall_2", "ball_ball")


def read_runs(folder, case, short=False):
    """@return the runs of a case, by seed"""
    runs = []
    for seed in ward_runs.plan(case, short)[0]:
        run = json.loads((pathlib.Path(folder) / f"{case.name}-{seed}.json").read_text())
        batches = {name: [float(value) / run["batch_length"] for value in text.split()]
                   for name, text in run["batches"].items()}
        batches["total"] = [sum(rates) for rates in zip(*(batches[name] for name in PARTNERS))]
        runs.append({**run, "batches": batches})
    return runs


def summary(runs):
    """Estimates of a case: {quantity: (mean, half width, probability that its replicas are
    alike)}."""
    result = {}
    for name in ("milling_dose", *PARTNERS, "total"):
        key = "milling_dose_rate" if name == "milling_dose" else f"collision_rate_{name}"
        result[key] = intervals.estimate([run["batches"][name] for run in runs])
    mean, half, alike = result["milling_dose_rate"]
    # A small relative error is the same of a rate and of its inverse; a large one, of the single
    # ball, has no meaning.
    result["inverse_milling_dose_rate"] = (1 / mean, half / mean ** 2,
                                           alike) if mean > 0 else (math.inf, math.inf, alike)
    return result


def number(value):
    return f"{value:.6g}"


def csv_text(rows):
    text = io.StringIO()
    writer = csv.DictWriter(text, rows[0], lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def statistics_csv(folder):
    rows = []
    for case in tables.cases():
        runs = read_runs(folder, case)
        row = {
            "case": case.name, "powder_g": case.powder, "charge_ratio": case.charge_ratio,
            "diameter_mm": case.diameter, "balls": case.count, "restitution": case.restitution,
            "replicas": len(runs), "start_time": number(runs[0]["start_time"]),
            "end_time": number(runs[0]["end_time"]), "batch_length": number(runs[0]["batch_length"])
        }
        estimates = summary(runs)
        for name in ("inverse_milling_dose_rate", "milling_dose_rate",
                     *(f"collision_rate_{p}" for p in (*PARTNERS, "total"))):
            row[name], row[f"{name}_ci95"] = map(number, estimates[name][:2])
        row["replicas_alike_p"] = f"{estimates['milling_dose_rate'][2]:.4f}"
        row["largest_energy_closure"] = f"{max(abs(r['energy_closure']) / r['milling_dose'] for r in runs):.1e}"
        row["touched_dose_share"] = number(
            statistics.fmean(r["touched_milling_dose"] / r["milling_dose"] for r in runs))
        rows.append(row)
    return csv_text(rows)


def replicas_csv(folder):
    rows = []
    for case in tables.cases():
        for run in read_runs(folder, case):
            means = {name: statistics.fmean(values) for name, values in run["batches"].items()}
            rows.append({
                "case": case.name, "seed": run["seed"], "inverse_milling_dose_rate": number(
                    1 / means["milling_dose"]) if means["milling_dose"] else "inf", **{
                        f"collision_rate_{name}": number(means[name]) for name in PARTNERS
                    }, "energy_closure": f"{run['energy_closure'] / run['milling_dose']:.1e}"
            })
    return csv_text(rows)


def provenance(folder):
    """Commits, compiler and processor time of the runs; one compiler, and commits with the same
    core."""
    runs = [run for case in tables.cases() for run in read_runs(folder, case)]
    commits, compilers = {run["commit"] for run in runs}, {run["compiler"] for run in runs}
    if len(compilers) != 1 or not all(
            ward_runs.same_core(min(commits), commit) for commit in commits):
        raise RuntimeError(
            f"{folder}: runs of different programs: {sorted(commits)}, {sorted(compilers)}")
    return {
        "commit": min(commits), "compiler": compilers.pop(),
        "cpu_seconds": round(sum(run["cpu_seconds"] for run in runs))
    }
