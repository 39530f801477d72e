#!/usr/bin/env python3
"""All impacts of docs/examples/demo.toml, ten seconds, certified to 25 digits: their digest, every
1000th of them and statistics.

usage: whole_demo.py EDMILL [--events FILE] [--write]

Certifies the case, which takes 11 minutes of processor time, or takes the FILE of `edmill certify
docs/examples/demo.toml --out FILE`, and compares with whole_demo.csv and whole_demo.json beside
this script; --write makes these anew.
"""
import argparse
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
CASE = HERE.parent.parent / "docs" / "examples" / "demo.toml"
BEGIN, END = 0.5, 10.0  # of the case's statistics [s]
EVERY = 1000
DIGITS = 25


def certified(edmill, folder):
    file = pathlib.Path(folder) / "events.csv"
    subprocess.run([edmill, "certify", CASE, "--digits", str(DIGITS), "--out", file], check=True)
    return file


def summary_of(file):
    """The lines to keep, and the statistics. The digest is of bodies and times to 18 digits, which
    every certified run has."""
    digest = hashlib.sha256()
    kept, evidence = [], []
    count = {"wall": 0, "ball": 0}
    dose = work = 0.0
    counted = 0
    with open(file, encoding="utf-8") as lines:
        for line in lines:
            if line.startswith("#"):
                evidence.append(line.rstrip("\n"))
                continue
            if line.startswith("index"):
                kept.append(line.rstrip("\n"))
                continue
            index, time, ball, kind, partner, *values = line.rstrip("\n").split(",")
            digest.update(
                f"{index},{ball},{kind},{partner},{time[:20]}{time[time.index('e'):]}\n".encode())
            if int(index) % EVERY == 0:
                kept.append(line.rstrip("\n"))
            if float(time) >= BEGIN:
                counted += 1
                count[kind] += 1
                dose += float(values[2])
                work += float(values[3])
    statistics = {
        "events": int(index) + 1, "digest": digest.hexdigest(), "impacts_from_0.5_s": counted,
        **{f"with_{k}s": n for k, n in count.items()}, "dose_rate": dose / (END - BEGIN),
        "wall_work_rate": work / (END - BEGIN)
    }
    return kept, statistics, [line for line in evidence if "events in common" in line]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("edmill")
    parser.add_argument("--events")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        kept, statistics, evidence = summary_of(options.events or certified(options.edmill, folder))
    print(json.dumps(statistics, indent=1))
    files = {HERE / "whole_demo.csv": "\n".join(evidence + kept) + "\n",
             HERE / "whole_demo.json": json.dumps(statistics, indent=1) + "\n"}
    if options.write:
        for file, text in files.items():
            file.write_text(text, encoding="utf-8")
        return 0
    published = json.loads((HERE / "whole_demo.json").read_text(encoding="utf-8"))
    same = published == statistics
    print("as published" if same else f"found other events than published: {published}")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
