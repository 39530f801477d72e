#!/usr/bin/python3
"""A dump of 5 GB through a pipe needs no more memory than one of 0.2 GB. Twenty balls fly to and
fro between two walls, each in a lane of its own, so that the contacts are known: two for each ball
and period.

usage: large_dump_test.py EDMILL [GIGABYTES]
"""
import json
import os
import pathlib
import sys
import tempfile

EDMILL = str(pathlib.Path(sys.argv[1]).resolve())
GIGABYTES = float(sys.argv[2]) if len(sys.argv) > 2 else 5
BALLS, PERIOD, STEP = 20, 400, 1e-4  # frames in a period, 0.1 ms apart
REACH = 0.046  # the way of a centre: 50 mm less a diameter of 4 mm
SPEED = 2 * REACH / (PERIOD * STEP)
CASE = '''[run]
end_time = "1 s"
[mill]
type = "vibratory"
amplitude = ["0 mm", "0 mm", "0 mm"]
speed = "60 rpm"
[vessel]
type = "box"
size = ["50 mm", "200 mm", "50 mm"]
[contact]
restitution = 1
friction = 0
[[balls]]
count = 20
diameter = "4 mm"
'''


def rows_of(frame):
    """Balls start at other places of their way."""
    lines = []
    for ball in range(BALLS):
        phase = (frame + 0.37 + ball * PERIOD // BALLS) % PERIOD
        there = phase < PERIOD / 2
        x = -REACH / 2 + SPEED * STEP * (phase if there else PERIOD - phase)
        lines.append(
            f"{ball + 1} {x:.12g} {0.009 * (ball - BALLS / 2 + 0.5):.12g} 0 {SPEED if there else -SPEED:.12g} 0 0 0 0 0"
        )
    return "\n".join(lines) + "\n"


def imported(gigabytes, folder):
    """Contacts, frames, and the greatest memory of the reader [MB]."""
    pattern = [rows_of(frame) for frame in range(PERIOD)]
    head = f"ITEM: NUMBER OF ATOMS\n{BALLS}\nITEM: BOX BOUNDS ff ff ff\n-1 1\n-1 1\n-1 1\nITEM: ATOMS id x y z vx vy vz omegax omegay omegaz\n"
    frames = int(gigabytes * 1e9 / (len(head) + len(pattern[0]))) // PERIOD * PERIOD
    (folder / "case.toml").write_text(CASE)
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(writer)
        os.dup2(reader, 0)
        os.execv(EDMILL, [
            EDMILL, "import", "-", "--case",
            str(folder / "case.toml"), "--timestep", f"{STEP} s", "--quiet", "--out",
            str(folder / "contacts.csv")
        ])
    os.close(reader)
    written = 0
    with os.fdopen(writer, "wb", buffering=1 << 20) as out:
        for frame in range(frames):
            text = f"ITEM: TIMESTEP\n{frame}\n{head}{pattern[frame % PERIOD]}".encode()
            written += len(text)
            out.write(text)
    _, status, used = os.wait4(child, 0)
    if status:
        sys.exit(f"edmill import ended with {os.waitstatus_to_exitcode(status)}")
    with open(folder / "contacts.csv") as log:
        contacts = json.loads(log.readlines()[1][2:])["contacts"]
    return contacts, frames, used.ru_maxrss / 1e3, written / 1e9


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    failed = []
    memory = []
    for size in (0.2, GIGABYTES):
        contacts, frames, megabytes, written = imported(size, folder)
        expected = 2 * BALLS * frames / PERIOD
        print(
            f"{written:.2f} GB, {frames} frames: {contacts} contacts, {expected:.0f} expected; {megabytes:.0f} MB"
        )
        memory.append(megabytes)
        if abs(contacts - expected) > BALLS:  # those cut off by either end
            failed.append("contacts")
    if memory[1] > 1.1 * memory[0] + 5:
        failed.append("memory grows with the dump")
    print("failed: " + ", ".join(failed) if failed else "0 failed")
    sys.exit(bool(failed))
