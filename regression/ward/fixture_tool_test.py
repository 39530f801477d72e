#!/usr/bin/env python3
"""edmill-fixtures in a copy of the project: what it must find, and what it must refuse.

usage: fixture_tool_test.py EDMILL WARD_BATCHES STEPPED_MILL
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
DOUBLE = "regression/ward/fixtures/events.double.csv"
LOG = "regression/ward/UPDATES.jsonl"
failures = 0


def expect(what, good, output=""):
    global failures
    print(("ok: " if good else "FAILED: ") + what)
    if not good:
        failures += 1
        print(output)


class Copy:
    """The fixtures and their tool in a repository of their own, with a program whose physics can be
    altered."""

    def __init__(self, folder, edmill, ward_batches, stepped_mill):
        self.root = pathlib.Path(folder) / "project"
        self.build = pathlib.Path(folder) / "build"
        (self.build / "regression/ward").mkdir(parents=True)
        os.symlink(ward_batches, self.build / "regression/ward/ward_batches")
        os.symlink(stepped_mill, self.build / "regression/ward/stepped_mill")
        program = self.build / "edmill"
        program.write_text(f'''#!/bin/sh
if [ "$1" = --version ]; then
  echo "edmill 0 ($(git -C "{self.root}" rev-parse --short HEAD)$SUFFIX)"
  echo "compiler of the test"
else
  exec "{edmill}" "$@" $ALTERED
fi
''')
        program.chmod(0o755)
        shutil.copytree(SOURCE / "regression", self.root / "regression",
                        ignore=shutil.ignore_patterns("__pycache__"))
        (self.root / ".gitignore").write_text("__pycache__/\n")
        self.git("init", "-q")
        self.commit()

    def git(self, *arguments):
        subprocess.run([
            "git", "-C", self.root, "-c", "user.name=test", "-c", "user.email=test@example.org",
            *arguments
        ], check=True)

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "state")

    def restore(self):
        self.git("checkout", "-q", ".")

    def run(self, *arguments, **environment):
        done = subprocess.run(
            [self.root / "regression/edmill-fixtures", *arguments, "--build", self.build],
            text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            env={**os.environ, **environment})
        return done.returncode, done.stdout

    def edit(self, name, old, new):
        place = self.root / name
        text = place.read_text()
        assert old in text
        place.write_text(text.replace(old, new, 1))


ALTERED = {"ALTERED": "--set contact.friction=0.4000001"}


def checks(copy):
    code, output = copy.run("check")
    expect("the fixtures hold", code == 0, output)

    copy.edit(DOUBLE, "0-999,", "0-998,")
    code, output = copy.run("check")
    told = f"{DOUBLE}: changed without edmill-fixtures update" in output
    expect("a fixture edited by hand is found", code == 1 and told, output)
    copy.restore()

    copy.edit("regression/ward/cases/5g_2_5_4_76mm.toml", "friction = 0.4", "friction = 0.3")
    code, output = copy.run("check")
    expect("a case edited by hand is found", code == 1 and
           "5g_2_5_4_76mm.toml: changed without" in output, output)
    copy.restore()

    copy.edit(LOG, '"reason": "', '"reason": "not ')
    code, output = copy.run("check")
    expect("a changed line of the log is found", code == 1 and
           "lines are only ever added" in output, output)
    copy.restore()

    code, output = copy.run("check", **ALTERED)
    where = "5g_2_5_4_76mm: events in double differ from" in output and "first in events 0-99" in output
    expect("altered friction is found in double, with the place", code == 1 and where, output)
    expect("altered friction is found in mpfr50",
           re.search(r"5g_2_5_4_76mm: event \d+ in mpfr50 differs", output), output)


def refusals(copy):
    before = (copy.root / LOG).read_text()
    for reason in ([], ["--reason", " "]):
        code, output = copy.run("update", "--part", "events", *reason, **ALTERED)
        expect(f"update with {reason or 'no reason'} is refused", code == 2 and
               "--reason: not given" in output, output)
    update = ("update", "--part", "events", "--reason", "a test")
    code, output = copy.run(*update)
    expect("update is refused when nothing changed", code == 2 and "nothing changed" in output,
           output)
    code, output = copy.run(*update, **ALTERED, SUFFIX="-dirty")
    expect("a program from changed sources is refused", code == 2 and
           "built from changed sources" in output, output)
    (copy.root / "new.txt").write_text("new\n")
    code, output = copy.run(*update, **ALTERED)
    expect("a tree with changes is refused", code == 2 and "not committed" in output, output)
    (copy.root / "new.txt").unlink()
    expect("no refusal wrote anything", (copy.root / LOG).read_text() == before)


def update(copy):
    before = (copy.root / LOG).read_text()
    code, output = copy.run("update", "--part", "events", "--reason", "a test of the tool",
                            **ALTERED)
    after = (copy.root / LOG).read_text()
    expect("an update with a reason is done", code == 0 and DOUBLE in output, output)
    told = '"reason": "a test of the tool"' in after[len(before):]
    expect("it adds a line to the log", after.startswith(before) and told, after)
    code, output = copy.run("check", **ALTERED)
    expect("the new fixtures hold for the altered program", code == 0, output)


def main():
    programs = [pathlib.Path(argument).resolve() for argument in sys.argv[1:]]
    if len(programs) != 3:
        sys.exit(__doc__.strip())
    with tempfile.TemporaryDirectory() as folder:
        copy = Copy(folder, *programs)
        checks(copy)
        refusals(copy)
        update(copy)
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
