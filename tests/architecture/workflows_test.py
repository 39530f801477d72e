#!/usr/bin/env python3
"""Workflows of continuous integration, the action and the snippets of docs/examples/ci: their
structure, their steps and the scripts that these call. A step is a script of the tree or a command
that any system has; other tests and studies run the scripts.

usage: workflows_test.py SOURCE
"""
import os
import pathlib
import re
import shlex
import subprocess
import sys

import yaml

SOURCE = pathlib.Path(sys.argv[1]).resolve()
SYSTEM = {"apt-get", "mkdir", "tar", "npx"}
CODE = {"./my_code"}  # of the reader
problems, commands = [], 0


def check(good, text):
    if not good:
        problems.append(text)


def check_command(where, line):
    global commands
    for part in re.split(r"&&|\n", line.split(" #")[0]):
        words = shlex.split(part)
        if not words:
            continue
        commands += 1
        place = SOURCE / words[0]
        known = words[0] in SYSTEM | CODE or "$GITHUB_ACTION_PATH/" in words[0]
        check(known or os.access(place, os.X_OK),
              f"{where}: {words[0]} is no script of the tree that can be executed")
        if "$GITHUB_ACTION_PATH/" in words[0]:
            check(os.access(SOURCE / words[0].split("/", 1)[1], os.X_OK),
                  f"{where}: no script {words[0]}")


def check_steps(where, steps):
    for step in steps:
        check(("uses" in step) != ("run" in step),
              f"{where}: a step has either uses or run: {step}")
        if "uses" in step:
            check(re.fullmatch(r"[\w-]+/[\w-]+@v\d+", step["uses"]),
                  f"{where}: {step['uses']} has no version")
        if "run" in step:
            check_command(where, step["run"])


def check_workflow(file):
    text = file.read_text(encoding="utf-8")
    flow = yaml.safe_load(text)
    check(set(flow) <= {"name", True, "permissions", "jobs"},
          f"{file.name}: keys {set(flow)}")  # YAML reads "on" as true
    check(flow.get(True), f"{file.name}: nothing starts it")
    for name, job in flow["jobs"].items():
        where = f"{file.name}, {name}"
        check("runs-on" in job, f"{where}: no runs-on")
        check(
            set([job.get("needs")] if isinstance(job.get("needs"), str) else job.get("needs", []))
            <= set(flow["jobs"]), f"{where}: needs an unknown job")
        for used in re.findall(r"\$\{\{ matrix\.(\w+) \}\}", yaml.safe_dump(job)):
            check(used in job.get("strategy", {}).get("matrix", {}), f"{where}: no matrix.{used}")
        check_steps(where, job["steps"])


def check_action():
    action = yaml.safe_load((SOURCE / "action.yml").read_text(encoding="utf-8"))
    check_steps("action.yml", action["runs"]["steps"])
    text = yaml.safe_dump(action["runs"])
    used = set(re.findall(r"\$\{\{ inputs\.([\w-]+) \}\}", text))
    check(used == set(action["inputs"]),
          f"action.yml: inputs {used ^ set(action['inputs'])} are not used or not declared")
    script = (SOURCE / "docs/examples/ci/judge.sh").read_text(encoding="utf-8")
    for name in action["runs"]["steps"][0]["env"]:
        check(re.search(rf"\b{name}\b", script), f"action.yml: judge.sh does not read {name}")
    flow = yaml.safe_load((SOURCE / "docs/examples/ci/github.yml").read_text(encoding="utf-8"))
    for step in flow["jobs"]["audit"]["steps"]:
        if step.get("uses", "").startswith("edmill/"):
            check(set(step["with"]) <= set(action["inputs"]), f"github.yml: inputs {step['with']}")


def check_shell():
    """Scripts that workflows and releases use, by shellcheck where it is installed, else by bash
    itself."""
    scripts = [
        *sorted((SOURCE / "release").glob("*.sh")), *sorted(
            (SOURCE / "docs/examples/ci").glob("*.sh"))
    ]
    for script in scripts:
        done = subprocess.run(["bash", "-n", script], capture_output=True, text=True)
        check(done.returncode == 0, f"{script}: {done.stderr}")
    try:
        done = subprocess.run(["shellcheck", "--severity=warning", *scripts], capture_output=True,
                              text=True)
        check(done.returncode == 0, done.stdout)
    except FileNotFoundError:
        print("shellcheck is not installed")


flows = sorted((SOURCE / ".github/workflows").glob("*.yml"))
for one in [*flows, SOURCE / "docs/examples/ci/github.yml"]:
    check_workflow(one)
gitlab = yaml.safe_load((SOURCE / "docs/examples/ci/gitlab.yml").read_text(encoding="utf-8"))
for job_name, job_of in gitlab.items():
    for script_line in job_of["script"]:
        check_command(f"gitlab.yml, {job_name}", script_line)
check_action()
check_shell()
versions = subprocess.run([SOURCE / "release/version_test.sh"], capture_output=True, text=True)
check(versions.returncode == 0, versions.stdout + versions.stderr)
print("\n".join(problems +
                [f"{len(flows)} workflows, {commands} commands, {len(problems)} problems"]))
sys.exit(1 if problems or not flows or commands < 8 else 0)
