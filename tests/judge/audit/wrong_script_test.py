#!/usr/bin/env python3
"""The wrong script of docs/reference-data.md: the audit finds exactly its mistakes, and each fix removes its finding
away.

usage: wrong_script_test.py EDMILL
"""
import json
import pathlib
import subprocess
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parents[3] / "docs" / "examples" / "wrong_script"
KIND_OF = {"euler": "non_ballistic", "restitution": "normal_restitution", "masses": "unequal_balls", "dose": "milling_dose",
           "spin": "lost_spin"}


def audited(edmill, scratch, fixes, *options):
    log, result = scratch / "log.csv", scratch / "result.json"
    subprocess.run([sys.executable, FOLDER / "mill.py", log, *(word for f in fixes for word in ("--fix", f))],
                   check=True)
    code = subprocess.run([edmill, "audit", FOLDER / "case.toml", log, "--json", result, "--quiet", *options],
                          check=False).returncode
    found = json.loads(result.read_text())
    print(f"fixed {', '.join(fixes) or 'nothing'}: {found['events']} impacts,",
          {kind: v["count"] for kind, v in found["violations"].items()}, *found["looks_like"])
    return code, found


def expect(good, what):
    if not good:
        sys.exit(f"not as expected: {what}")


def main():
    edmill = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        code, found = audited(edmill, scratch, [], "--gap-tolerance", "1e-4")
        expect(code == 6 and set(found["violations"]) == set(KIND_OF.values()), "exactly the mistakes are found")
        for mistake, kind in KIND_OF.items():
            code, found = audited(edmill, scratch, [mistake], "--gap-tolerance", "1e-4")
            expect(code == 6 and set(found["violations"]) == set(KIND_OF.values()) - {kind},
                   f"only {kind} is gone without the mistake '{mistake}'")
        code, found = audited(edmill, scratch, ["all"], "--gap-tolerance", "1e-4")
        expect(code == 0 and not found["violations"], "nothing is left")
        code, found = audited(edmill, scratch, ["all"])
        expect(code == 6 and set(found["violations"]) == {"late_event"} and "time_step" in found["looks_like"],
               "without a gap tolerance the time step is all that is left, and it is recognised")


main()
