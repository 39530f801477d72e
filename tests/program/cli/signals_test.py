#!/usr/bin/env python3
"""Signals that batch systems and terminals send: the run saves, and resumes with identical results.

usage: PYTHONPATH=tests/support python3 signals_test.py EDMILL
"""
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import time

from program import Trials, case, edmill, results, same, start, summary

SAVING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGXCPU, signal.SIGUSR1)
OUTPUTS = ("collisions", "events", "trends", "paraview")


def begun(place, *options, **settings):
    """A run that has simulated for some time."""
    process = start("run", "case.toml", "--quiet", "--out", place, *options, stderr=subprocess.PIPE,
                    text=True, **settings)
    log = None
    while log is None or log.stat().st_size == 0:
        log = next(iter(pathlib.Path(place).glob("collisions.csv.partial-*")),
                   None) if os.path.isdir(place) else None
        time.sleep(0.005)
    return process


def until_taken(process):
    """No signal waits."""
    status = pathlib.Path(f"/proc/{process.pid}/status")
    while re.search(r"^S\w\wPnd:\s*0*[1-9a-f]", status.read_text(), re.M):
        time.sleep(0.005)
    time.sleep(0.02)


def ended(process):
    error = process.communicate(timeout=60)[1]
    return process.returncode, error


def saves(t, number, expected):
    for options in ((), ("--checkpoint", "0.5 s simulated")):
        process = begun("run", *options)
        process.send_signal(number)
        if number not in (signal.SIGINT,
                          signal.SIGTERM):  # batch systems repeat them, and lose patience
            for _ in range(20):
                process.send_signal(number)
            until_taken(process)  # of two that wait, the later one would be handled first
            process.send_signal(signal.SIGTERM)
        code, error = ended(process)
        t.check(code == 128 + number and error == "",
                f"{number.name} {options}: exit code {code} {error}")
        t.check(summary("run")["end_reason"] == "interrupted", f"{number.name}: results")
        t.check(
            os.path.exists("run/checkpoint") == bool(options),
            f"{number.name} {options}: checkpoint")
        t.no_partials(number.name)
        if options:
            t.check(edmill("resume", "run", "--quiet").returncode == 0, f"{number.name}: resume")
            t.check(same(results("run"), expected) == [], f"{number.name}: results after a resume")
        shutil.rmtree("run")


def other_commands(t):
    pathlib.Path("my.sweep.toml").write_text('[sweep]\ncase = "case.toml"\nreplicas = 8\n')
    for command in ("sweep my.sweep.toml --out study --jobs 1 --quiet",
                    "certify case.toml --collisions 100000 --quiet"):
        process = start(*command.split(), stderr=subprocess.PIPE, text=True)
        time.sleep(0.7)
        process.send_signal(signal.SIGUSR1)
        code, error = ended(process)
        t.check(code == 128 + signal.SIGUSR1, f"{command}: exit code {code} {error}")
    t.check(os.path.exists("study/runs.csv"), "tables of an interrupted sweep")
    t.no_partials("other commands")


def waits_for_input(t):
    """A log that nobody writes, or goes on writing: one request ends the wait."""
    os.mkfifo("silent")
    log = pathlib.Path("whole/collisions.csv").read_text()
    for command in ("audit case.toml LOG", "compare LOG whole", "compare whole LOG",
                    "import LOG --case case.toml"):
        for source in ("silent", "-"):
            for beginning in ("", log[:3000]) if source == "-" else ("",):
                process = start(*command.replace("LOG", source).split(), "--quiet",
                                stdin=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                process.stdin.write(beginning)
                process.stdin.flush()
                time.sleep(0.3)
                begin = time.time()
                process.send_signal(signal.SIGTERM)
                try:
                    code = process.wait(timeout=10)
                except subprocess.TimeoutExpired:
                    process.kill()
                    code = None
                t.check(code in (128 + signal.SIGTERM, -signal.SIGTERM),
                        f"{command} from {source}: exit code {code}")
                t.check(time.time() - begin < 5, f"{command} from {source}: ends at once")
                t.no_partials(command)


with Trials() as t:
    pathlib.Path("case.toml").write_text(case(*OUTPUTS, end="6 s"))
    t.check(
        edmill("run", "case.toml", "--quiet", "--out", "whole").returncode == 0, "the whole run")
    expected = results("whole")
    for number in SAVING:
        saves(t, number, expected)
    # A limit of CPU time, whose signal comes again each second.
    process = begun("run", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (1, 30)))
    code, error = ended(process) if process.poll() is None else (process.returncode, "")
    t.check(code in (0, 128 + signal.SIGXCPU), f"a limit of CPU time: {code} {error}")
    shutil.rmtree("run")
    # nohup: a SIGHUP that is ignored at the start stays so.
    process = begun("run", preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    process.send_signal(signal.SIGHUP)
    t.check(ended(process) == (0, ""), "nohup")
    t.check(same(results("run"), expected) == [], "results with nohup")
    # A second request ends it at once.
    pathlib.Path("case.toml").write_text(case(*OUTPUTS, end="600 s"))
    process = begun("twice")
    os.kill(process.pid, signal.SIGSTOP)
    process.send_signal(signal.SIGTERM)
    process.send_signal(signal.SIGINT)
    os.kill(process.pid, signal.SIGCONT)
    t.check(ended(process)[0] in (128 + signal.SIGTERM, 128 + signal.SIGINT), "two requests")
    shutil.rmtree("twice")
    # A file that is too large is a message, and no signal.
    for ignored in (False, True):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN if ignored else signal.SIG_DFL)
        for name in OUTPUTS:
            setting = "output=[{type=\"%s\"%s}]" % (
                name, ',interval="1 ms",columns=[{variable="milling_dose",statistics=["sum"]}]'
                if name == "trends" else "")
            done = edmill("run", "case.toml", "--quiet", "--out", f"limit-{name}", "--set", setting,
                          preexec_fn=limit)
            t.refused(done, f"a file size limit and {name}",
                      "could not be written: the file size limit is reached", code=1)
    other_commands(t)
    pathlib.Path("case.toml").write_text(case(*OUTPUTS, end="6 s"))
    waits_for_input(t)
print(f"{t.checks} checks of signals")
