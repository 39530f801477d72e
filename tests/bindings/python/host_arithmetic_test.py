"""A Python that rounds otherwise, or flushes subnormal numbers, gets the same results, and its own
arithmetic back."""
import os
import pathlib
import subprocess
import sys

import pytest

SCRIPT = '''
import ctypes, hashlib, pathlib, sys
import edmill
mode = ctypes.CDLL("libm.so.6").fegetround
before = mode()
digest = hashlib.sha256()
def take(data):
    assert mode() == before
    digest.update(data if isinstance(data, bytes) else repr(data).encode())
case = edmill.Case(sys.argv[1], settings=['run.end_time="0.2 s"', 'output=[{type="collisions", states=true}]'])
take(case.digest)
place = pathlib.Path(sys.argv[2])
run = edmill.run(case, folder=place / "run")
take(run.events.tobytes())
take((place / "run/collisions.csv").read_bytes())
edmill.certify(case, collisions=15, file=place / "certified.csv")
take((place / "certified.csv").read_bytes())
edmill.prove(case, collisions=15, certificate=place / "certificate")
take((place / "certificate").read_bytes())
verdict = edmill.audit(case, place / "run/collisions.csv")
assert verdict.good
take(verdict["verdict"])
print(digest.hexdigest())
'''


def said(case, folder, mode):
    environment = dict(os.environ, LD_PRELOAD=os.environ["EDMILL_HOST_ARITHMETIC"],
                       HOST_ARITHMETIC=mode)
    done = subprocess.run([sys.executable, "-c", SCRIPT, case, folder], capture_output=True,
                          text=True, env=environment)
    assert done.returncode == 0, (mode, done.stderr)
    return done.stdout


@pytest.mark.parametrize("mode", ["up", "down", "zero", "flush"])
def test_results_do_not_depend_on_the_host(mode, tmp_path):
    case = pathlib.Path(__file__).resolve().parents[3] / "regression/reference/three_balls.toml"
    (tmp_path / "nearest").mkdir()
    (tmp_path / mode).mkdir()
    assert said(case, tmp_path / mode, mode) == said(case, tmp_path / "nearest", "nearest")
