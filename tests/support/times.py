#!/usr/bin/env python3
"""Writes docs/test-times.md: the seconds of each test in the last `ctest --preset ci`, which keeps
them in tests.xml of its build.

usage: times.py [BUILD]    (default: build/ci)
"""
import json
import pathlib
import platform
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

SOURCE = pathlib.Path(__file__).resolve().parents[2]
build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else SOURCE / "build/ci")
listed = json.loads(
    subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], capture_output=True,
                   check=True).stdout)["tests"]
tier = {
    test["name"]: ", ".join(label for p in test["properties"] if p["name"] == "LABELS"
                            for label in p["value"]) for test in listed
}
suite = ElementTree.parse(build / "tests.xml").getroot()
cases = sorted(((float(case.get("time")), case.get("name"), tier.get(case.get("name"), ""))
                for case in suite.iter("testcase") if case.get("status") == "run"), reverse=True)
if not cases:
    sys.exit(
        f"found no tests that ran in {build / 'tests.xml'}, expected those of ctest --preset ci")
lines = [
    "---", "orphan: true", "---", "# Times of the tests", "",
    f"Seconds of each test of `ctest --preset ci` on {platform.machine()} on {suite.get('timestamp', '')[:10]}, two at a time; written by "
    "`tests/support/times.py`. Tests labelled fast are those of `ctest --preset fast`.", "",
    f"In all {sum(seconds for seconds, _, _ in cases):.0f} s, of which the fast tests {sum(s for s, _, labels in cases if 'fast' in labels):.0f} s.",
    "", "| test | seconds | tier |", "|---|---|---|"
]
lines += [f"| {name} | {seconds:.1f} | {labels} |" for seconds, name, labels in cases]
(SOURCE / "docs/test-times.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
print(f"docs/test-times.md: {len(cases)} tests")
