"""What tests share that run the program: calls of it, a folder of their own, small cases, and
readers of its files. The first argument of each is the program. CTest tells Python where this
module is; by hand: PYTHONPATH=tests/support python3 tests/program/cli/signals_test.py
build/ci/edmill
"""
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

EDMILL = os.path.realpath(sys.argv[1])
SOURCE = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = SOURCE / "docs/examples"

CASE = """[run]
end_time = "{end}"
gravity = "9.81 m/s2"
seed = 5
[mill]
type = "spex8000"
speed = "1060 rpm"
[vessel]
diameter = "38 mm"
height = "57 mm"
[powder]
mass = "4 g"
[contact]
restitution = 0.53
friction = 0.4
[[balls]]
count = 12
diameter = "6 mm"
"""

OUTPUTS = {
    "collisions": "", "events": "states = true", "spectra": 'file = "spectra.h5"',
    "vessel_load": 'interval = "50 ms"',
    "trends": 'interval = "50 ms"\ncolumns = [{ variable = "milling_dose", statistics = ["sum", "rate"] }]',
    "paraview": 'interval = "20 ms"', "snapshot": "start_collision = 100\ncollisions = 3",
    "animation": 'end_time = "20 ms"', "milling_dose": 'folder = "tables/doses"',
    "frequency": 'variable = "relative_normal_speed_before"\nlow = "0 m/s"\nhigh = "5 m/s"\nintervals = 20\nfolder = "tables"',
}


def case(*outputs, end="0.1 s"):
    """A case with these outputs, which takes some hundredths of a second for each 0.1 s."""
    return CASE.format(end=end) + "".join(
        f'[[output]]\ntype = "{name}"\n{OUTPUTS[name]}\n' for name in outputs)


class Trials:
    """Works in a folder of its own, which goes with it unless something failed.

    @param to_the_end  go on after what failed
    """

    def __init__(self, to_the_end=False):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="edmill-trials-"))
        self.to_the_end, self.checks, self.failures = to_the_end, 0, 0
        os.chdir(self.folder)

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None and self.failures == 0:
            os.chdir("/")
            shutil.rmtree(self.folder, ignore_errors=True)
            return
        print(f"files are in {self.folder}", file=sys.stderr, flush=True)
        if self.failures and kind in (None, SystemExit):
            sys.exit(f"{self.failures} failed")

    def check(self, good, what):
        self.checks += 1
        if not good:
            print("failed:", what, flush=True)
            self.failures += 1
            if not self.to_the_end:
                sys.exit(1)

    def refused(self, done, what, *words, code=2):
        """Exit code and one line with these words."""
        self.check(done.returncode == code, f"{what}: exit code {done.returncode}: {done.stderr}")
        self.check(
            done.stderr.count("\n") == 1 and done.stderr.startswith("edmill: "),
            f"{what}: {done.stderr!r}")
        for word in words:
            self.check(str(word) in done.stderr, f"{what}: no {word!r} in {done.stderr!r}")

    def no_partials(self, what, place="."):
        left = [p for p in pathlib.Path(place).rglob("*.partial-*")]
        self.check(not left, f"{what}: {left}")


def command(*arguments):
    return [EDMILL, *map(str, arguments)]


def edmill(*arguments, code=None, **options):
    """Runs the program to its end.

    @param code  with which it has to end
    """
    done = subprocess.run(
        command(*arguments),
        **({"capture_output": True, "text": True, "stdin": subprocess.DEVNULL} | options))
    assert code in (None, done.returncode), (arguments, done.returncode, done.stdout, done.stderr)
    return done


def said(*arguments, code=0, **options):
    """What the program prints, or says of an error."""
    done = edmill(*arguments, code=code, **options)
    return done.stdout if code == 0 else done.stderr


def start(*arguments, **options):
    return subprocess.Popen(command(*arguments), **options)


def sets(*settings):
    """Options of these settings."""
    return [word for setting in settings for word in ("--set", setting)]


def shell(command, **options):
    """A command of bash in which "edmill" is the program."""
    options = {"capture_output": True, "text": True, "stdin": subprocess.DEVNULL} | options
    return subprocess.run(["bash", "-c", f'edmill() {{ "{EDMILL}" "$@"; }}; {command}'], **options)


def results(place, without=("case_file",)):
    """Every file below a folder with its bytes, but without what times of the CPU change, and these
    keys of summaries."""
    found = {}
    for path in sorted(pathlib.Path(place).rglob("*")):
        if not path.is_file():
            continue
        content = path.read_bytes()
        if path.name == "summary.json":
            summary = json.loads(content)
            for key in ("cpu_seconds", "collisions_per_cpu_second", *without):
                summary.pop(key)
            content = json.dumps(summary).encode()
        if path.name == "report.html":
            content, times = re.subn(rb">[^<>]+ s for (?=[^<>]+ impacts<)", b">", content)
            assert times == 1, f"{path}: the time of the CPU is there {times} times"
        found[str(path.relative_to(place))] = content
    return found


def rows(file):
    """Of a CSV file, without its comments."""
    with open(file, encoding="utf-8") as stream:
        return list(csv.DictReader(line for line in stream if not line.startswith("#")))


def same(a, b):
    """The files that differ between two results."""
    return sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name))


def summary(place):
    return json.loads(pathlib.Path(place, "summary.json").read_text(encoding="utf-8"))
