#!/usr/bin/env python3
"""Runs the benchmarks into JSON files and compares such files.

  bench.py run --binary BENCH --out A.json [--binary BENCH2 --out B.json] [--rounds 5] [--filter
  REGEX] [--core N] bench.py compare A.json B.json [--least 0.02]
  bench.py ratios A.json

`run` with several binaries runs them in turn, round by round, so that a slow hour of the machine
hits all of them alike. With --core edmill and the reference implementations of a case run
simultaneously on that core, those of all binaries, where a slow minute hits them alike, too; CPU
times then count the caches that they take from each other. `compare` exits with 1 when a figure of
B is slower than in A, with 2 on bad input.
"""
import argparse
import datetime
import json
import os
import platform
import random
import re
import statistics
import subprocess
import sys
import uuid

# Counter of the benchmark's output -> unit of the figure, whether more is better.
FIGURES = {"collisions": ("collisions per CPU second", True), "bytes_per_ball": ("bytes", False)}
FEWEST = 3  # values that a verdict needs
DRAWS = 2000


def first_line(command, where=None):
    try:
        done = subprocess.run(command, capture_output=True, text=True, cwd=where, check=True)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return done.stdout.strip().split("\n")[0]


def cache_entry(binary, key):
    """A value of the CMakeCache.txt above the binary."""
    folder = os.path.dirname(os.path.abspath(binary))
    while folder != "/":
        cache = os.path.join(folder, "CMakeCache.txt")
        if os.path.isfile(cache):
            with open(cache, encoding="utf-8") as lines:
                for line in lines:
                    if line.startswith(key + ":"):
                        return line.split("=", 1)[1].strip()
            return ""
        folder = os.path.dirname(folder)
    return ""


def machine(binary):
    model = ""
    with open("/proc/cpuinfo", encoding="utf-8") as lines:
        for line in lines:
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
                break
    source = cache_entry(binary, "CMAKE_HOME_DIRECTORY") or "."
    compiler = cache_entry(binary, "CMAKE_CXX_COMPILER")
    commit = first_line(["git", "describe", "--always", "--abbrev=12", "--dirty"], source)
    return {
        "cpu": model,
        "cores": os.cpu_count(),
        "system": platform.platform(),
        "compiler": first_line([compiler, "--version"]) if compiler else "",
        "build_type": cache_entry(binary, "CMAKE_BUILD_TYPE"),
        "flags": cache_entry(binary, "CMAKE_CXX_FLAGS"),
        "commit": commit,
        "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "load_at_start": os.getloadavg()[0],
    }


def figure_name(name):
    return re.sub(r"/(iterations|min_time|repeats|repetition):?[^/]*", "", name)


def take(output, figures):
    """Adds one run's values to the figures."""
    for row in output["benchmarks"]:
        if row.get("run_type", "iteration") != "iteration" or row.get("error_occurred"):
            continue
        name = figure_name(row["name"])
        found = False
        for counter, (unit, more) in FIGURES.items():
            if counter not in row:
                continue
            found = found or counter == "collisions"
            key = name if counter == "collisions" else name + " " + counter
            entry = figures.setdefault(key, {"unit": unit, "more_is_better": more, "values": []})
            entry["values"].append(row[counter])
        if not found:
            entry = figures.setdefault(
                name,
                {"unit": row["time_unit"] + " CPU time", "more_is_better": False, "values": []})
            entry["values"].append(row["cpu_time"])


def names_of(binary, pattern):
    command = [binary, "--benchmark_list_tests"
              ] + (["--benchmark_filter=" + pattern] if pattern else [])
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()


def run_together(binaries, results, options):
    """Benchmarks whose names differ in their first part alone run at once on one core."""
    groups = {}
    for binary, result in zip(binaries, results):
        for name in names_of(binary, options.filter):
            case = figure_name(name).split("/", 1)[-1]
            groups.setdefault(case, []).append((binary, name, result["figures"]))
    for group in groups.values():
        started = [(subprocess.Popen([
            "taskset", "-c",
            str(options.core), binary, "--benchmark_format=json",
            "--benchmark_filter=^%s$" % re.escape(name)
        ], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True), figures)
                   for binary, name, figures in group]
        for process, figures in started:
            output = process.communicate()[0]
            if process.returncode != 0:
                raise subprocess.CalledProcessError(process.returncode, process.args)
            take(json.loads(output), figures)


def run(options):
    if len(options.binary) != len(options.out):
        raise ValueError("found %d --binary and %d --out, expected as many" %
                         (len(options.binary), len(options.out)))
    # Files whose values were taken at the same time, one by one, share this name.
    together = uuid.uuid4().hex if options.core is not None else None
    results = [{"machine": machine(b), "together": together, "figures": {}} for b in options.binary]
    for turn in range(options.rounds):
        if together:
            print("round %d of %d" % (turn + 1, options.rounds), file=sys.stderr)
            run_together(options.binary, results, options)
            continue
        for binary, result in zip(options.binary, results):
            print("round %d of %d: %s" % (turn + 1, options.rounds, binary), file=sys.stderr)
            command = [binary, "--benchmark_format=json"]
            if options.filter:
                command.append("--benchmark_filter=" + options.filter)
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                  text=True, check=True)
            take(json.loads(done.stdout), result["figures"])
    for path, result in zip(options.out, results):
        with open(path + ".part", "w", encoding="utf-8") as out:
            json.dump(result, out, indent=1)
            out.write("\n")
        os.replace(path + ".part", path)
        print_figures(result)
        print_ratios(result)
    return 0


def load(path):
    with open(path, encoding="utf-8") as text:
        result = json.load(text)
    for name, figure in result["figures"].items():
        if not figure["values"] or not all(v > 0 for v in figure["values"]):
            raise ValueError(
                "%s: found values of '%s' that are not positive, expected a measurement" %
                (path, name))
    return result


def spread(values):
    """Median absolute deviation, scaled to the standard deviation of normal noise."""
    middle = statistics.median(values)
    return 1.4826 * statistics.median([abs(v - middle) for v in values])


def relative_error(values):
    """Relative error of the median of the values: 1.25 times the standard error of a mean."""
    return 1.25 * spread(values) / statistics.median(values) / len(values) ** 0.5


def bounds(statistic, samples):
    """The statistic of the samples with the bounds of its bootstrapped 99 % interval. When values
    repeat or are few the bootstrap is too sure of itself, so the interval is never narrower than
    the MADs allow."""
    draw = random.Random(20110101)
    drawn = sorted(statistic(*(draw.choices(v, k=len(v)) for v in samples)) for _ in range(DRAWS))
    found, low, high = statistic(*samples), drawn[DRAWS // 200], drawn[DRAWS - 1 - DRAWS // 200]
    error = 2.58 * sum(relative_error(v) ** 2 for v in samples) ** 0.5
    return found, min(low, found * (1 - error)), max(high, found * (1 + error))


def ratios_of(a, b):
    """Ratios of values that were taken at the same time."""
    return [y / x for x, y in zip(a, b)]


def interval(a, b):
    """Ratio of the medians b/a."""
    return bounds(lambda b, a: statistics.median(b) / statistics.median(a), (b, a))


def paired_interval(a, b):
    """Median of the ratios b/a of values that were taken at the same time."""
    return bounds(statistics.median, (ratios_of(a, b),))


def paired_range(a, b):
    """The same, with the least and the greatest."""
    ratios = ratios_of(a, b)
    return statistics.median(ratios), min(ratios), max(ratios)


def verdict(a, b, paired, least):
    """What figure b is beside a: faster, slower or no different; differences below `least` count
    for none."""
    if min(len(a["values"]), len(b["values"])) < FEWEST:
        return "too few values", None
    found = (paired_interval if paired else interval)(a["values"], b["values"])
    _, low, high = found
    if low <= 1 + least and high >= 1 / (1 + least):
        return "no difference", found
    return ("faster" if (low > 1) == a["more_is_better"] else "slower"), found


def compare(options):
    a, b = load(options.a), load(options.b)
    for key in ("cpu", "cores", "compiler", "build_type", "flags"):
        if a["machine"].get(key) != b["machine"].get(key):
            print("note: %s differs: '%s' and '%s'" %
                  (key, a["machine"].get(key), b["machine"].get(key)))
    paired = bool(a.get("together")) and a["together"] == b.get("together")
    if paired:
        print("note: both ran at once, so ratios are those of each round")
    counts = {}
    print("%-48s %12s %12s %8s %19s  %s" % ("figure", "A", "B", "B/A", "99 % interval", "verdict"))
    for name in a["figures"]:
        if name not in b["figures"]:
            print("%-48s only in A" % name)
            continue
        one, two = a["figures"][name], b["figures"][name]
        if one["unit"] != two["unit"]:
            raise ValueError("found '%s' in %s and in %s, expected one unit" %
                             (name, one["unit"], two["unit"]))
        found, ratio = verdict(one, two, paired, options.least)
        counts[found] = counts.get(found, 0) + 1
        shown = "%8.3f   [%.3f, %.3f]" % ratio if ratio else ""
        print("%-48s %12.5g %12.5g %-27s  %s" % (name, statistics.median(one["values"]),
                                                 statistics.median(two["values"]), shown, found))
    for name in b["figures"]:
        if name not in a["figures"]:
            print("%-48s only in B" % name)
    print(", ".join("%d %s" % (n, what) for what, n in sorted(counts.items())) or
          "no figure is in both")
    if not counts:
        return 2
    return 1 if counts.get("slower") else 0


def print_figures(result):
    print("%-48s %12s %8s  %s" % ("figure", "median", "MAD", "unit"))
    for name, figure in result["figures"].items():
        middle = statistics.median(figure["values"])
        print("%-48s %12.5g %6.1f %%  %s" %
              (name, middle, 100 * spread(figure["values"]) / middle, figure["unit"]))


def print_ratios(result):
    """edmill over each reference implementation, from the same run and at equal numbers of
    balls."""
    for reference in ("minimal", "peer"):
        lines = []
        for name, figure in result["figures"].items():
            other = result["figures"].get(name.replace("edmill/", reference + "/", 1))
            if not name.startswith("edmill/") or not other or " " in name:
                continue
            ratio_of = paired_range if result.get("together") else interval
            ratio, low, high = ratio_of(other["values"], figure["values"])
            enough = min(len(other["values"]), len(figure["values"])) >= FEWEST
            shown = "   [%.3f, %.3f]" % (low, high) if enough else ""
            lines.append("%-48s %8.3f%s" % (name[len("edmill/"):], ratio, shown))
        if lines:
            print("edmill / %s, collisions per CPU second" % reference)
            print("\n".join(lines))


def ratios(options):
    result = load(options.a)
    print_figures(result)
    print_ratios(result)
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    do_run = commands.add_parser("run")
    do_run.add_argument("--binary", action="append", required=True)
    do_run.add_argument("--out", action="append", required=True)
    do_run.add_argument("--rounds", type=int, default=5)
    do_run.add_argument("--filter", default="")
    do_run.add_argument("--core", type=int)
    do_run.set_defaults(action=run)
    do_compare = commands.add_parser("compare")
    do_compare.add_argument("a")
    do_compare.add_argument("b")
    do_compare.add_argument("--least", type=float, default=0.02,
                            help="relative difference that matters")
    do_compare.set_defaults(action=compare)
    do_ratios = commands.add_parser("ratios")
    do_ratios.add_argument("a")
    do_ratios.set_defaults(action=ratios)
    options = parser.parse_args()
    try:
        return options.action(options)
    except (OSError, ValueError, KeyError, TypeError, subprocess.CalledProcessError) as error:
        print("bench.py: %s" % error, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
