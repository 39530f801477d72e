#!/usr/bin/env python3
"""Random charges of mills that people have, eight seeds each: how many pairs of seeds have dose
rates that differ by more than their joined intervals, and how many of these have no word about it
in either run.

usage: charges.py EDMILL [CHARGES] [SEED]    by default 100 charges; an hour of one core
"""
import itertools
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "docs/examples"
SEEDS, MOST_SECONDS = 8, 60
WORDS = {
    "several_states", "transient", "wide_interval", "too_short", "too_few_collisions", "end_reason"
}


def charge(random_):
    """A case of the examples with other balls and speed: file, settings, a name."""
    mill = random_.choice(("spex", "vibrated", "planetary", "mixer", "drum"))
    e, mu = random_.choice((0.5, 0.6, 0.7, 0.8, 0.9)), random_.choice((0.1, 0.2, 0.4, 0.6))
    count = round(math.exp(random_.uniform(0, math.log(28))))
    file, diameters, speeds, start, end = {
        "spex": ("demo", (4.76, 6.35, 9.52, 12.7), ("875 rpm", "1054 rpm", "1425 rpm"), 1, 9),
        "vibrated": ("vibrated_box", (4, 6, 8), ("50 Hz", "60 Hz"), 1, 9),
        "planetary": ("planetary", (5, 8, 10), ("200 rpm", "300 rpm", "500 rpm"), 2, 10),
        "mixer": ("mixer", (5, 7, 10, 12, 15), ("20 Hz", "25 Hz", "30 Hz"), 2, 10),
        "drum": ("drum", (5, 8, 10), ("60 rpm", "80 rpm", "100 rpm"), 2, 12)}[mill]
    diameter, speed = random_.choice(diameters), random_.choice(speeds)
    room = {"spex": 12, "vibrated": 12, "planetary": 16, "mixer": 8,
            "drum": 100}[mill]  # balls of 10 mm that find a place
    count = max(1, min(count, int(room * (10 / diameter) ** 3)))
    speed_key = "mill.joint.1.speed" if mill == "drum" else "mill.speed"
    settings = [
        f"balls.0.count={count}", f"balls.0.diameter={diameter} mm", f"{speed_key}={speed}",
        f"contact.restitution={e}", f"contact.friction={mu}", f"run.start_time={start} s",
        f"run.end_time={end} s"
    ]
    return file, settings, f"{mill}, {count} of {diameter} mm, {speed}, e {e}, friction {mu}"


def run(edmill, file, settings, seed, folder):
    """Dose rate, its half-width, and whether the run has a word about it; nothing where the run
    takes too long or has no interval."""
    command = [
        edmill, "run", file, "--quiet", "--out", folder, f"--set=run.seed={seed}",
        *(f"--set={one}" for one in settings)
    ]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=MOST_SECONDS)
    except subprocess.TimeoutExpired:
        return "took too long"
    if done.returncode:
        return done.stderr.strip().splitlines()[0]
    found = json.loads((pathlib.Path(folder) / "summary.json").read_text())
    width = found["intervals"].get("milling_dose_rate")
    return "no interval" if width is None else (found["milling_dose_rate"], width,
                                                bool(WORDS & found["warnings"].keys()))


def main(edmill, charges=100, seed=1):
    random_ = random.Random(seed)
    drum = pathlib.Path(tempfile.mkdtemp()) / "drum.toml"
    subprocess.run([edmill, "new", "--mill", "drum", "--out", drum], check=True)
    pairs = apart = silent = left_out = 0
    for _ in range(charges):
        file, settings, name = charge(random_)
        file = drum if file == "drum" else EXAMPLES / f"{file}.toml"
        with tempfile.TemporaryDirectory() as folder:
            runs = [run(edmill, file, settings, s, f"{folder}/{s}") for s in range(1, SEEDS + 1)]
        failed = [one for one in runs if isinstance(one, str)]
        if failed:
            left_out += 1
            print(f"{name}: left out, {failed[0]}", flush=True)
            continue
        differ = [(a, b) for a, b in itertools.combinations(runs, 2)
                  if abs(a[0] - b[0]) > math.hypot(a[1], b[1])]
        without = [pair for pair in differ if not pair[0][2] and not pair[1][2]]
        pairs, apart, silent = pairs + SEEDS * (SEEDS -
                                                1) // 2, apart + len(differ), silent + len(without)
        print(f"{name}: {len(differ)} pairs differ, {len(without)} without a word", flush=True)
    print(
        f"seed {seed}: {charges - left_out} charges, {pairs} pairs, {100 * apart / pairs:.1f} % differ, {100 * silent / pairs:.1f} % without a word"
    )
    sys.exit(silent > 0.05 * pairs)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 4:
        sys.exit(__doc__.strip())
    main(sys.argv[1], *map(int, sys.argv[2:]))
