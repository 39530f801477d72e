#!/usr/bin/env python3
"""When the single ball of thesis chapter 4 is captured on the cylinder, and its dose rate while it
is free.

A ball is captured from the end of the last interval of 0.05 s on in which it touched a cap; one
that touched a cap in the last 2 s of the run, 35 drive periods, was not captured by the end.

usage: capture.py EDMILL [--seeds 200] [--end "150 s"] [--jobs 2] [--least-separation "1 cm/s"]
    [--table FILE]
"""
import argparse
import concurrent.futures
import csv
import math
import pathlib
import statistics
import subprocess
import tempfile

CASE = pathlib.Path(
    __file__).resolve().parents[2] / "docs" / "examples" / "thesis_chapter4_ball.toml"
START = 1.0  # s left out of the dose rates: the ball starts at rest
QUIET = 2.0  # s without a cap up to the end of the run that tell capture
OUTPUT = """
[[output]]
type = "trends"
file = "{name}.csv"
start_time = "0 s"
interval = "0.05 s"
{only}columns = [{{ variable = "{variable}", label = "sum", statistics = ["sum"] }}]
"""
TABLES = {"dose": ("milling_dose", ""), "cap_0": ("collision", "only = { partner = 0 }\n"),
          "cap_1": ("collision", "only = { partner = 1 }\n")}


def column(place):
    """@return [(end of the interval, sum in it)]"""
    with open(place, encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    time, amount = (next(k for k, name in enumerate(rows[0]) if name.startswith(start))
                    for start in ("time", "sum"))
    return [(float(row[time]), float(row[amount] or 0)) for row in rows[1:]]


def run(args, seed):
    """@return end of the run, time of capture or None, free time after START, dose in it"""
    with tempfile.TemporaryDirectory() as folder:
        case = pathlib.Path(folder) / "case.toml"
        case.write_text(
            CASE.read_text(encoding="utf-8") + "".join(
                OUTPUT.format(name=name, variable=variable, only=only)
                for name, (variable, only) in TABLES.items()))
        settings = {"run.seed": seed, "run.start_time": "0 s", "run.end_time": args.end,
                    "contact.least_separation": args.least_separation}
        command = [args.edmill, "run", str(case), "--quiet", "--out", f"{folder}/out"]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        subprocess.run(command, check=True)
        dose, *caps = (column(f"{folder}/out/{name}.csv") for name in TABLES)
    end = dose[-1][0]
    last = max((time for cap in caps for time, impacts in cap if impacts > 0), default=0.0)
    captured = last < end - QUIET
    free = [(time, amount) for time, amount in dose if START < time <= (last if captured else end)]
    return end, last if captured else None, max(0.0, free[-1][0] - START) if free else 0.0, sum(
        d for _, d in free)


def share_interval(count, of):
    """95 % interval of Wilson for a share."""
    z, p = 1.96, count / of
    middle, half = p + z * z / (2 * of), z * math.sqrt(p * (1 - p) / of + z * z / (4 * of * of))
    return [(middle + sign * half) / (1 + z * z / of) for sign in (-1, 1)]


def inverse_rate(runs):
    """Free time over dose of all runs together, with its 95 % interval by the scatter of the
    runs."""
    times, doses = [run[2] for run in runs], [run[3] for run in runs]
    mean = sum(times) / sum(doses)
    off = sum((t - mean * d) ** 2 for t, d in zip(times, doses))
    return mean, 1.96 * math.sqrt(len(runs) / (len(runs) - 1) * off) / sum(doses)


def report(runs):
    end = runs[0][0]
    captures = sorted(math.inf if capture is None else capture for _, capture, _, _ in runs)
    shown = [
        f"{q:.3g} s" if q < math.inf else f"above {end:g} s"
        for q in (captures[math.ceil(share * len(captures)) - 1] for share in (0.25, 0.5, 0.75))
    ]
    print("capture: quartiles {0} and {2}, median {1}".format(*shown))
    for limit in (1, 3, 10, 30, 100):
        if limit > end - QUIET:
            break
        count = sum(capture <= limit for capture in captures)
        low, high = share_interval(count, len(runs))
        print(
            f"  captured by {limit:3d} s: {count} of {len(runs)}, {100 * count / len(runs):.1f} % "
            f"({100 * low:.1f} to {100 * high:.1f} %)")
    mean, half = inverse_rate(runs)
    print(
        f"inverse dose rate while free: {mean:.4f} ± {half:.4f} s/J, over {sum(run[2] for run in runs):.0f} s"
    )
    lasting = [run[2] / run[3] for run in runs if run[2] >= 5]
    if len(lasting) > 1:
        print(
            f"  of the {len(lasting)} seeds free for 5 s or more: median {statistics.median(lasting):.3f} s/J"
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("edmill")
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--end", default="150 s")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--least-separation", default="1 cm/s")
    parser.add_argument("--table", help="a CSV file with a line for each seed")
    args = parser.parse_args()
    seeds = range(1, args.seeds + 1)
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        runs = list(pool.map(lambda seed: run(args, seed), seeds))
    print(f"{args.seeds} seeds to {args.end}, least separation {args.least_separation}")
    report(runs)
    if args.table:
        with open(args.table, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(
                ["seed", "end [s]", "capture [s]", "free time [s]", "dose while free [J]"])
            writer.writerows([
                seed, end, "" if capture is None else f"{capture:.10g}", f"{free:.10g}",
                f"{dose:.10g}"
            ] for seed, (end, capture, free, dose) in zip(seeds, runs))


if __name__ == "__main__":
    main()
