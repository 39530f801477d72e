"""Python ends normally while daemon threads are in edmill: computing, in callbacks, and waiting for
Python's lock."""
import subprocess
import sys

import pytest

PROGRAM = """
import pathlib, sys, threading, time
import edmill

case = edmill.Case.spex8000(balls=20, diameter="6 mm", end_time="100000 s", start_time="0.1 s")
short = case.with_settings("run.start_time='0 s'", "run.end_time='0.02 s'")
folder = pathlib.Path(sys.argv[2])

class Late:  # the interpreter destroys it when it ends already, and other threads get its lock
    def __del__(self, sleep=time.sleep):
        sleep(0.4)

class Law:
    def restitution(self, speed):
        return sum(0.01 for _ in range(50))
    def restitution_of_slip(self, *given):
        return Number()

class Number:  # not of C: its conversion runs Python
    def __float__(self):
        return sum(0.01 for _ in range(50))
    def __index__(self):
        return 0
    def __str__(self):
        return str(float(self))

def again(work):
    while True:
        work()

def wait(*given):
    time.sleep(0.001)

run = edmill.run(short, folder=folder / "run", events=False, report=True)
log = case.with_settings("run.start_time='0 s'", "run.end_time='0.3 s'", 'output=[{type="collisions"}]')
edmill.run(log, folder=folder / "log", events=False)
certificate = folder / "certificate"
edmill.prove(short, 1, certificate=certificate)
work = {
    "run": lambda: edmill.run(case),
    "short runs": lambda: edmill.run(short),
    "progress": lambda: edmill.run(case, progress=lambda *given: None),
    "observer": lambda: edmill.run(case, observers=[wait]),
    "wide observer": lambda: edmill.run(case, "float128", observers=[wait]),
    "law": lambda: edmill.run(case, ball_ball_law=Law(), ball_wall_law=Law()),
    "wide law": lambda: edmill.run(case, "float128", ball_wall_law=Law()),
    "digits": lambda: edmill.run(short, digits=20),
    "estimate": lambda: edmill.estimate(case, digits=20),
    "certify": lambda: edmill.certify(case, 30000),
    "shadow": lambda: edmill.shadow(case, "float128"),
    "prove": lambda: edmill.prove(case, 3000),
    "sensitivity": lambda: edmill.sensitivity(case, by=["contact.friction"], events=5000),
    "sweep": lambda: edmill.sweep({"sweep": {"case": case, "replicas": 2, "grid": {"contact.restitution": [0.5]}}}, folder / "sweep"),
    "checkpoint": lambda: edmill.run(case, folder=folder / "checkpoints", checkpoint="1 s"),
    "check": lambda: edmill.check(case),
    "check_certificate": lambda: edmill.check_certificate(short, certificate),
    "report": lambda: edmill.report(folder / "run"),
    "reports": lambda: edmill.report(folder / "run", folder / "run", out=folder / "comparison.html"),
    "audit": lambda: edmill.audit(log, folder / "log/collisions.csv"),
    "compare": lambda: edmill.compare(folder / "log/collisions.csv", folder / "log/collisions.csv"),
}[sys.argv[1]]
work_of_one = sys.argv[1] not in ("sweep", "checkpoint", "report", "reports")  # which lock their folder
for _ in range(2 if work_of_one else 1):
    threading.Thread(target=again, args=(work,), daemon=True).start()
time.sleep(0.3)
sys.late = Late()
late = Late()
print("main ends", flush=True)
"""

WORK = [
    "run", "short runs", "progress", "observer", "wide observer", "law", "wide law", "digits",
    "estimate", "certify", "shadow", "prove", "sensitivity", "sweep", "checkpoint", "check",
    "check_certificate", "report", "reports", "audit", "compare"
]


@pytest.mark.parametrize("work", WORK)
def test_python_ends_while_a_daemon_thread_is_in(work, tmp_path):
    done = subprocess.run([sys.executable, "-c", PROGRAM, work, tmp_path], capture_output=True,
                          text=True, cwd=tmp_path, timeout=120)
    assert (done.returncode, done.stdout) == (0, "main ends\n"), done.stderr[-2000:]
    assert done.stderr == ""
