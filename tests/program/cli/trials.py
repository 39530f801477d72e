"""What tests of the program's files share: a folder of their own, small cases, and calls of the program."""
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
SOURCE = pathlib.Path(__file__).resolve().parents[3]

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
    "collisions": "", "events": "states = true", "spectra": 'file = "spectra.h5"', "vessel_load": 'interval = "50 ms"',
    "trends": 'interval = "50 ms"\ncolumns = [{ variable = "milling_dose", statistics = ["sum", "rate"] }]',
    "paraview": 'interval = "20 ms"', "snapshot": "start_collision = 100\ncollisions = 3",
    "animation": 'end_time = "20 ms"', "milling_dose": 'folder = "tables/doses"',
    "frequency": 'variable = "relative_normal_speed_before"\nlow = "0 m/s"\nhigh = "5 m/s"\nintervals = 20\nfolder = "tables"',
}


def case(*outputs, end="0.1 s"):
    """A case with these outputs, which takes some hundredths of a second for each 0.1 s."""
    return CASE.format(end=end) + "".join(f'[[output]]\ntype = "{name}"\n{OUTPUTS[name]}\n' for name in outputs)


class Trials:
    """Works in a folder of its own, which goes with it unless something failed."""

    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="edmill-trials-"))
        self.checks = 0
        os.chdir(self.folder)

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            os.chdir("/")
            shutil.rmtree(self.folder, ignore_errors=True)

    def check(self, good, what):
        self.checks += 1
        if not good:
            print("failed:", what, "- files are in", self.folder)
            sys.exit(1)

    def refused(self, done, what, *words, code=2):
        """Exit code and one line with these words."""
        self.check(done.returncode == code, f"{what}: exit code {done.returncode}: {done.stderr}")
        self.check(done.stderr.count("\n") == 1 and done.stderr.startswith("edmill: "), f"{what}: {done.stderr!r}")
        for word in words:
            self.check(str(word) in done.stderr, f"{what}: no {word!r} in {done.stderr!r}")

    def no_partials(self, what, place="."):
        left = [p for p in pathlib.Path(place).rglob("*.partial-*")]
        self.check(not left, f"{what}: {left}")


def edmill(*arguments, **options):
    options = {"capture_output": True, "text": True, "stdin": subprocess.DEVNULL} | options
    return subprocess.run([EDMILL, *map(str, arguments)], **options)


def shell(command, **options):
    """A command of bash in which "edmill" is the program."""
    options = {"capture_output": True, "text": True, "stdin": subprocess.DEVNULL} | options
    return subprocess.run(["bash", "-c", f'edmill() {{ "{EDMILL}" "$@"; }}; {command}'], **options)


def results(place):
    """Every file below a folder with its bytes, but without what times of the CPU change."""
    found = {}
    for path in sorted(pathlib.Path(place).rglob("*")):
        if not path.is_file():
            continue
        content = path.read_bytes()
        if path.name == "summary.json":
            summary = json.loads(content)
            for key in ("cpu_seconds", "collisions_per_cpu_second", "case_file"):
                summary.pop(key)
            content = json.dumps(summary).encode()
        if path.name == "report.html":
            content = re.sub(rb">[^<>]+ s for (?=[^<>]+ impacts<)", b">", content)
        found[str(path.relative_to(place))] = content
    return found


def rows(file):
    """Of a CSV file, without its comments."""
    with open(file, encoding="utf-8") as stream:
        return list(csv.DictReader(line for line in stream if not line.startswith("#")))


def same(a, b):
    """The files that differ between two results."""
    return sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name))
