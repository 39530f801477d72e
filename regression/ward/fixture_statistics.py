"""The statistics of the 24 cases as fixtures, and runs against them."""
import csv
import io
import math
import tempfile

import emulation
import tables
import ward_runs
import ward_table

STATISTICS, REPLICAS = "regression/reference/ward.statistics.csv", "regression/reference/ward.replicas.csv"
EMULATION = "regression/ward/fixtures/emulation.csv"
SINGLE_BALL = "2g_2_5_9_52mm"  # ill-conditioned: docs/theory.md, section 6
# Compared; by symmetry the caps have equal rates, but each is checked.
QUANTITIES = ("milling_dose_rate", "collision_rate_wall_0", "collision_rate_wall_1",
              "collision_rate_wall_2", "collision_rate_ball_ball")
# Times the root of the sum of squares of both 95 % intervals: about 3.9 standard errors, which of
# the short check's 50 and the full one's 115 comparisons of good runs less than one in a hundred
# times any exceeds.
ALLOWED = 2.0


def make(root, ward_batches, folder, jobs):
    ward_runs.run_all(str(ward_batches), folder, jobs)
    return ({
        STATISTICS: ward_table.statistics_csv(folder), REPLICAS: ward_table.replicas_csv(folder)
    }, ward_table.provenance(folder))


def make_emulation(stepped_mill, folder, jobs):
    return {EMULATION: emulation.study(str(stepped_mill), folder, jobs)}


def wanted_rows(root):
    return {
        row["case"]: row for row in csv.DictReader(io.StringIO((root / STATISTICS).read_text()))
    }


def compare(case, row, estimates):
    problems = []
    for name in QUANTITIES:
        mean, half = estimates[name][:2]
        wanted, wanted_half = float(row[name]), float(row[f"{name}_ci95"])
        limit = ALLOWED * math.hypot(half, wanted_half)
        if abs(mean - wanted) > limit:
            problems.append(
                f"{case.name}: {name} {mean:.6g}, {STATISTICS} has {wanted:.6g}, allowed ±{limit:.2g}"
            )
    return problems


def short_problems(root, ward_batches):
    with tempfile.TemporaryDirectory() as folder:
        return run_problems(root, ward_batches, folder, 1, short=True)


def full_problems(root, ward_batches, folder, jobs):
    return run_problems(root, ward_batches, folder, jobs, short=False)


def run_problems(root, ward_batches, folder, jobs, short):
    ward_runs.run_all(str(ward_batches), folder, jobs, short, quiet=short)
    wanted, problems = wanted_rows(root), []
    for case in tables.cases():
        if case.name == SINGLE_BALL or not len(ward_runs.plan(case, short)[0]):
            continue
        runs = ward_table.read_runs(folder, case, short)
        problems += compare(case, wanted[case.name], ward_table.summary(runs))
        closure = max(abs(run["energy_closure"]) / run["milling_dose"] for run in runs)
        if closure > 1e-9:
            problems.append(f"{case.name}: energy closure {closure:.1e} of the dose, allowed 1e-9")
    return problems
