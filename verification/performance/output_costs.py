#!/usr/bin/env python3
"""What outputs cost on the demo case: the table of docs/performance.md.

Instructions of the first simulated second by callgrind, CPU time of the whole case as the median
ratio of alternated runs, and bytes an event of the HDF5 logs.

usage: output_costs.py EDMILL
"""
import json
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

DEMO = pathlib.Path(__file__).resolve().parents[2] / "docs" / "examples" / "demo.toml"
SUMS = [{"variable": "collision", "statistics": ["sum", "rate"]},
        {"variable": "milling_dose", "statistics": ["sum", "rate"]}]
OUTPUTS = {
    "none": [],
    "statistics, frequency, trends": [{"type": "statistics", "columns": SUMS},
                                      {"type": "trends", "interval": "0.5 s", "columns": SUMS}, {
                                          "type": "frequency",
                                          "variable": "relative_normal_speed_before",
                                          "low": "0 m/s", "high": "7 m/s", "intervals": 10
                                      }], "events": [{"type": "events"}],
    "events with states": [{"type": "events", "states": True}],
    "spectra, rates_above, vessel_load, coverage": [{"type": "spectra"}, {
        "type": "spectra", "of": "speed", "file": "speeds.csv"
    }, {"type": "rates_above"}, {"type": "vessel_load"}, {"type": "coverage"}],
}


def toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def command(edmill, case):
    return [edmill, "run", case, "--quiet", "--out", case.with_suffix("")]


def instructions(edmill, case):
    printed = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
                              *command(edmill, case), "--set", "run.end_time=1 s"],
                             capture_output=True, text=True, check=True).stderr
    return int(re.search(r"Collected : (\d+)", printed)[1])


def cpu_seconds(edmill, case):
    before = os.times()
    subprocess.run(command(edmill, case), check=True)
    after = os.times()
    return after.children_user - before.children_user + after.children_system - before.children_system


def bytes_an_event(folder):
    log = folder / "events.h5"
    if not log.exists():
        return ""
    return f"{log.stat().st_size / json.loads((folder / 'summary.json').read_text())['impacts_since_start']:.0f}"


def main(edmill):
    with tempfile.TemporaryDirectory() as scratch:
        cases = {}
        for number, (name, outputs) in enumerate(OUTPUTS.items()):
            cases[name] = pathlib.Path(scratch) / f"{number}.toml"
            entries = ("[[output]]\n" + "".join(f"{key} = {toml(value)}\n"
                                                for key, value in output.items())
                       for output in outputs)
            cases[name].write_text(DEMO.read_text() + "".join(entries))
        counts = {name: instructions(edmill, case) for name, case in cases.items()}
        rounds = [
            {name: cpu_seconds(edmill, case) for name, case in cases.items()} for _ in range(9)
        ]
        print(
            "outputs                                        instructions     CPU time   bytes an event"
        )
        for name, case in cases.items():
            ratio = statistics.median(times[name] / times["none"] for times in rounds)
            more = 100 * (counts[name] / counts["none"] - 1)
            print(
                f"{name:45} {counts[name] / 1e6:6.1f}e6 {more:+4.0f} %   {ratio:8.2f}   {bytes_an_event(case.with_suffix('')):>8}"
            )


if __name__ == "__main__":
    main(str(pathlib.Path(sys.argv[1]).resolve()))
