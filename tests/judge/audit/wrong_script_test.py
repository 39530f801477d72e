#!/usr/bin/env python3
"""The wrong script of docs/reference-data.md: the audit finds exactly its mistakes, and each fix
removes its finding away.

usage: PYTHONPATH=tests/support python3 wrong_script_test.py EDMILL
"""
import json
import pathlib
import subprocess
import sys

from program import EXAMPLES, Trials, edmill

FOLDER = EXAMPLES / "wrong_script"
KINDS_OF = {
    "euler": {"non_ballistic"}, "restitution": {"normal_restitution"},
    "masses": {"momentum",
               "tangential_restitution"}, "dose": {"milling_dose"}, "spin": {"lost_spin"}
}
ALL = set().union(*KINDS_OF.values())


def audited(fixes, *options):
    subprocess.run([
        sys.executable, FOLDER / "mill.py", "log.csv",
        *(word for f in fixes for word in ("--fix", f))
    ], check=True)
    code = edmill("audit", FOLDER / "case.toml", "log.csv", "--json", "result.json", "--quiet",
                  *options).returncode
    found = json.loads(pathlib.Path("result.json").read_text())
    print(f"fixed {', '.join(fixes) or 'nothing'}: {found['events']} impacts,",
          {kind: v["count"] for kind, v in found["violations"].items()})
    return code, found


with Trials() as t:
    tolerance = ("--gap-tolerance", "1e-4")
    code, found = audited([], *tolerance)
    t.check(code == 6 and set(found["violations"]) == ALL, "exactly the mistakes are found")
    named = [cause["text"] for cause in found["identified"]["causes"].values()]
    t.check(
        len(named) == 2 and named[0].startswith("contact.ball_wall.restitution = 0.6 ") and
        "as for equal masses" in named[1],
        f"those that explain what they change are named: {named}")
    t.check("first_order_step" in found["identified"]["time_stepping"], "the step is recognised")
    for mistake, kinds in KINDS_OF.items():
        code, found = audited([mistake], *tolerance)
        t.check(code == 6 and set(found["violations"]) == ALL - kinds,
                f"only {kinds} is gone without the mistake '{mistake}'")
    code, found = audited(["all"], *tolerance)
    t.check(code == 0 and not found["violations"], "nothing is left")
    code, found = audited(["all"])
    t.check(
        code == 6 and set(found["violations"]) == {"late_event"} and
        not found["identified"]["causes"] and
        "step_by_depth" in found["identified"]["time_stepping"],
        "without a gap tolerance the time step is all that is left, and it is recognised")
