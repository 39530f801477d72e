#!/usr/bin/env python3
"""Inverse dose rate of the single ball of thesis chapter 4 in windows of time, for several seeds.

usage: single_ball.py EDMILL [COLLAPSE_TIME]   e.g. single_ball.py build/release/edmill "0.1 ms"
"""
import json
import pathlib
import subprocess
import sys
import tempfile

edmill, collapse_time = sys.argv[1], (sys.argv[2:] or ["0.1 ms"])[0]
case = pathlib.Path(__file__).parents[2] / "docs/examples/thesis_chapter4_ball.toml"
windows = [(0, 3), (3, 10), (10, 30), (30, 150)]

print("t_c", collapse_time, "- inverse dose rate [s/J] (cap collisions per second)")
print("seed " + "".join(f"{f'{a}-{b} s':>20}" for a, b in windows))
for seed in range(1, 7):
    cells = []
    for start, end in windows:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([edmill, "run", case, "--quiet", "--out", folder,
                            "--set", f"run.start_time={start} s", "--set", f"run.end_time={end} s",
                            "--set", f"run.seed={seed}",
                            "--set", f"contact.collapse_time={collapse_time}"], check=True)
            s = json.loads((pathlib.Path(folder) / "summary.json").read_text())
        caps = s["collision_rate"]["wall_0"] + s["collision_rate"]["wall_1"]
        cells.append(f"{s['inverse_milling_dose_rate']:.3g} ({caps:.1f})")
    print(f"{seed:<5}" + "".join(f"{cell:>20}" for cell in cells))
