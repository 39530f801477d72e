#!/usr/bin/env python3
"""Runs in any number of digits, and runs that ask for right ones.

usage: PYTHONPATH=tests/support python3 digits_test.py EDMILL [whole]
"""
import pathlib
import re
import signal
import subprocess
import sys
import time
from decimal import Decimal, getcontext

from program import EXAMPLES, Trials, case, edmill, rows, start, summary

getcontext().prec = 400
WHOLE = len(sys.argv) > 2
LOG = 'output=[{type="collisions"}]'
THREE = case(end="2 s" if WHOLE else "0.3 s").replace("count = 12", "count = 3")
DEMO = (EXAMPLES / "demo.toml").read_text()
PLANETARY = (EXAMPLES / "planetary.toml").read_text()
CASES = {
    "three": THREE, "demo": DEMO.replace('start_time = "0.5 s"',
                                         "").replace('end_time = "10 s"',
                                                     f'end_time = "{0.3 if WHOLE else 0.06} s"'),
    "planetary": PLANETARY.replace('end_time = "2 s"', f'end_time = "{1 if WHOLE else 0.03} s"')
}
# A ball that falls into a corner of a box along its diagonal, and hits three walls at one time.
CORNER = """[run]
end_time = "1 s"
[mill]
type = "still"
[vessel]
type = "box"
size = ["40 mm", "40 mm", "40 mm"]
[contact]
restitution = 0.5
friction = 0
[[ball]]
diameter = "10 mm"
position = [0, 0, 0]
velocity = ["1 m/s", "1 m/s", "1 m/s"]
"""


def impacts(file):
    """Of two balls, which is the first can depend on rounding: the lower number comes first."""
    log = rows(file)
    for row in log:
        if row["partner_kind"] == "ball":
            row["ball"], row["partner"] = sorted((row["ball"], row["partner"]))
    return log


def right_digits(folder):
    return summary(folder).get("right_digits")


def log_of(t, name, *options):
    done = edmill("run", f"{name}.toml", "--out", "out", "--set", LOG, *options)
    t.check(done.returncode == 0, f"{name} {options}: {done.stderr}")
    return impacts("out/collisions.csv"), rows("out/final_state.csv"), done.stdout


def agreement(one, other):
    """Digits to which all numbers of two logs agree, each of the largest of its column."""
    least = Decimal(10) ** 9
    for name in one[0]:
        try:
            pairs = [(Decimal(a[name]), Decimal(b[name])) for a, b in zip(one, other)]
        except ArithmeticError:  # a name
            continue
        off, size = max(abs(a - b) for a, b in pairs), max(abs(b) for _, b in pairs)
        if off > 0:
            least = min(least, -(off / size).log10())
    return least


def test_digits(t, name):
    pathlib.Path(f"{name}.toml").write_text(CASES[name])
    digits = 12
    log, state, said = log_of(t, name, "--digits", str(digits))
    found = re.search(r"mpfr:(\d+) and mpfr:(\d+): all (\d+) events .* agree to (\d+) digits", said)
    t.check(found and int(found[3]) == len(log), f"{name}: {said[:300]!r}")
    t.check(
        right_digits("out") == int(found[4]) >= digits,
        f"{name}: {right_digits('out')} in the summary")
    exact, exact_state, _ = log_of(t, name, "--quiet", "--precision", f"mpfr:{2 * int(found[2])}")
    bodies = [[(r["ball"], r["partner_kind"], r["partner"]) for r in rows] for rows in (log, exact)]
    t.check(right_digits("out") is None, f"{name}: right digits of a run in a precision")
    t.check(bodies[0] == bodies[1], f"{name}: the events in order")
    for what, one, other in (("log", log, exact), ("state", state, exact_state)):
        t.check(
            agreement(one, other) >= digits, f"{name}: {what} to {agreement(one, other)} digits")
    longest = max(len(value) for row in log for value in row.values())
    t.check(longest < digits + 12, f"{name}: numbers of {longest} letters")
    print(f"{name}: {len(log)} events, {found[2]} digits")


def test_any_number(t):
    """Digits chosen at run time give the motion that fixed ones do, and twice the same."""
    for fixed in ("mpfr50", "mpfr100"):
        number = int(fixed[4:])
        one, _, _ = log_of(t, "demo", "--quiet", "--precision", fixed)
        two, _, _ = log_of(t, "demo", "--quiet", "--precision", f"mpfr:{number}")
        wide, _, _ = log_of(t, "demo", "--quiet", "--precision", f"mpfr:{2 * number}")
        t.check(len(one) == len(two) == len(wide), f"{fixed}: events")
        t.check(
            agreement(two, wide) > agreement(one, wide) - 2,
            f"{fixed}: {agreement(one, wide)}, {agreement(two, wide)} digits")
    again, _, _ = log_of(t, "demo", "--quiet", "--precision", f"mpfr:{2 * number}")
    t.check(again == wide, "the same bits twice")
    many, _, _ = log_of(t, "demo", "--quiet", "--precision", "mpfr:1500", "--set",
                        "run.max_collisions=100")
    t.check(agreement(wide[:100], many) > 195, f"1500 digits: {agreement(wide[:100], many)}")


def test_resume(t):
    """A run in chosen digits that ends in between goes on with the same bits."""
    longer = ("--quiet", "--precision", "mpfr:500", "--set", 'run.end_time="0.25 s"')
    whole, state, _ = log_of(t, "demo", *longer)
    parts = []
    done = edmill("run", "demo.toml", "--out", "parts", *longer, "--set", LOG, "--checkpoint",
                  "0.02 s simulated", preexec_fn=limit_of_cpu)
    while done.returncode not in (0, 2) and len(parts) < 200:
        parts.append(done.returncode)
        done = edmill("resume", "parts", "--quiet", preexec_fn=limit_of_cpu)
    t.check(done.returncode == 0, f"resumed {len(parts)} times: {done.stderr}")
    t.check(
        impacts("parts/collisions.csv") == whole and rows("parts/final_state.csv") == state,
        "the same log and state")
    t.check(len(parts) > 0, "it was ended in between")
    print("resumed", len(parts), "times")


def test_resume_in_right_digits(t):
    child = start("run", "demo.toml", "--digits", "12", "--set", 'run.end_time="0.3 s"', "--out",
                  "right", "--checkpoint", "0.01 s simulated", stdout=subprocess.PIPE, text=True)
    while child.poll() is None and not pathlib.Path("right", "checkpoint").exists():
        time.sleep(0.01)
    child.send_signal(signal.SIGINT)
    found = re.search(r"agree to (\d+) digits", child.communicate()[0])
    t.check(child.returncode in (130, -signal.SIGINT),
            f"interrupted after it began: {child.returncode}")
    done = edmill("resume", "right", "--quiet")
    t.check(done.returncode == 0 and found and right_digits("right") == int(found[1]),
            f"{right_digits('right')}: {done.stderr}")


def limit_of_cpu():
    import resource
    resource.setrlimit(resource.RLIMIT_CPU, (1, 60))


def test_refusals(t):
    for name in ("mpfr:", "mpfr:10", "mpfr:2000000", "mpfr:3e3", "mpfr:-50", "mpfr: 50", "mpfr:50x",
                 "mpfr"):
        t.refused(edmill("run", "demo.toml", "--precision", name), name, "mpfr:DIGITS")
        t.refused(edmill("run", "demo.toml", "--set", f'run.precision="{name}"'), name,
                  "run.precision", "mpfr:DIGITS")
    t.refused(edmill("run", "demo.toml", "--digits", "0"), "no digits", "--digits")
    t.refused(edmill("run", "demo.toml", "--digits", "12", "--precision", "double"), "both",
              "--digits")
    t.refused(
        edmill("run", "demo.toml", "--set", "run.digits=12", "--set", 'run.precision="mpfr50"'),
        "both keys", "run.digits")
    t.refused(edmill("run", "demo.toml", "--digits", "12", "--shadow", "mpfr100"), "a shadow",
              "--shadow")
    pathlib.Path("asking.toml").write_text(CASES["demo"].replace("[run]", "[run]\ndigits = 12"))
    pathlib.Path("sweep.toml").write_text(
        '[sweep]\ncase = "asking.toml"\nreplicas = 2\n[sweep.grid]\n"contact.friction" = [0.1, 0.2]\n'
    )
    t.refused(edmill("sweep", "sweep.toml", "--out", "sweep"), "a study of a run in right digits",
              "run.digits")
    pathlib.Path("corner.toml").write_text(CORNER)
    t.refused(edmill("run", "corner.toml", "--digits", "12", "--out", "corner"), "a corner",
              "a rule and not the equations", code=4)
    t.check(not pathlib.Path("corner").exists(), "nothing is written")
    estimate = edmill("run", "corner.toml", "--digits", "12", "--estimate")
    t.check(estimate.returncode == 4 and "a rule and not the equations" in estimate.stdout,
            f"estimate of a corner: {estimate.stdout}")
    t.refused(edmill("sensitivity", "corner.toml", "--by", "initial.0.x", "--events", "3"),
              "a corner", "a rule", code=4)
    for by in ("contact.nothing", "vessel.type", "initial.99.x", "initial.0.q", "initial.x"):
        t.refused(edmill("sensitivity", "demo.toml", "--by", by, "--events", "3"), by, by)
    t.refused(
        edmill("bifurcation", "demo.toml", "--over", "contact.restitution", "--from", "0.9", "--to",
               "0.2"), "backwards", "--to")


def test_estimate(t):
    done = edmill("run", "demo.toml", "--digits", "12", "--estimate", "--out", "nowhere")
    t.check(done.returncode == 0 and not pathlib.Path("nowhere").exists(),
            f"estimate: {done.stderr}")
    for word in ("events", "digits lost", "precision", "for 12 right digits", "processor time",
                 "memory"):
        t.check(word in done.stdout, f"estimate: no {word!r} in {done.stdout!r}")
    done = edmill("run", "demo.toml", "--estimate", "--set", 'run.end_time="5 s"')
    t.check("used up after" in done.stdout, f"estimate of a long run in double: {done.stdout!r}")


def test_certify_to_the_end(t):
    done = edmill("certify", "demo.toml", "--out", "all.csv", "--digits", "110")
    t.check(done.returncode == 0, f"certify: {done.stderr}")
    t.check("mpfr:" in done.stdout, f"beyond 200 digits: {done.stdout!r}")
    log, _, _ = log_of(t, "demo", "--quiet", "--precision", "mpfr200")
    t.check(len(rows("all.csv")) == len(log), "all events of the case")


def test_bifurcation(t):
    """A ball that a table throws once a period has one phase up to where its period doubles: e =
    0.46551 for 1 mm."""
    table = EXAMPLES / "oscillating_table.toml"
    for low, high in (("0.06", "0.9"), ("0.1", "0.7"), ("0.3", "0.8"), ("1e-3", "0.123456789012")):
        done = edmill("bifurcation", table, "--over", "contact.restitution", "--from", low, "--to",
                      high, "--steps", "3", "--skip", "0", "--keep", "1", "--out", "ends.svg")
        values = [float(row["value"]) for row in rows("ends.csv")]
        t.check(done.returncode == 0 and (values[0], values[-1]) == (float(low), float(high)),
                f"from {low} to {high}: {values} {done.stderr}")
    done = edmill("bifurcation", table, "--over", "contact.restitution", "--from", "0.4", "--to",
                  "0.5", "--steps", "21", "--skip", "3000", "--keep", "8", "--out", "b.svg")
    t.check(done.returncode == 0, done.stderr)
    phases = {}
    for row in rows("b.csv"):
        phases.setdefault(float(row["value"]), set()).add(round(float(row["phase"]), 5))
    for e, seen in phases.items():
        if e < 0.465:
            t.check(len(seen) == 1, f"e {e}: {seen}")
        if 0.475 < e:
            t.check(len(seen) >= 2, f"e {e}: {seen}")
    t.check("<svg" in pathlib.Path("b.svg").read_text(), "a drawing")


def test_other_ends(t):
    """What ends a run ends those that find its digits; a folder that cannot be used is told before
    they begin."""
    long = re.sub(r"end_time.*", 'end_time = "1000 s"', CASES["demo"], count=1)
    for name, rule, events in (("collisions", "max_collisions = 300", 300),
                               ("dose", 'max_milling_dose = "20 mJ"', None)):
        for end in (long, long.replace('end_time = "1000 s"', "")):
            pathlib.Path("other.toml").write_text(end.replace("[run]", f"[run]\n{rule}"))
            log, _, said = log_of(t, "other", "--digits", "12")
            found = re.search(r"all (\d+) events", said)
            t.check(found and int(found[1]) == len(log) and events in (None, len(log)),
                    f"{name}: {len(log)} events, {said[:200]!r}")
            estimate = edmill("run", "other.toml", "--digits", "12", "--estimate").stdout
            t.check(
                re.search(r"events +about (\d+)", estimate)[1] == str(len(log)),
                f"{name}: {estimate}")
    pathlib.Path("a_file").write_text("mine")
    t.refused(
        edmill("run", "demo.toml", "--digits", "12", "--set", 'run.end_time="9 s"', "--out",
               "a_file", timeout=20), "a file as folder", "a_file")
    child = start("run", "demo.toml", "--digits", "12", "--set", 'run.end_time="9 s"', "--out",
                  "interrupted", stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(1.5)
    child.send_signal(signal.SIGINT)
    out, err = child.communicate(timeout=20)
    t.check(
        child.returncode in (130, -signal.SIGINT) and
        "interrupted before the digits were found" in err, f"{child.returncode}: {err!r}")
    t.check(not pathlib.Path("interrupted").exists(), "no folder of an interrupted search")


def test_many_digits(t):
    """No more digits are taken than an estimate says, whatever is asked for."""
    for digits in (60, 150, 400):
        done = edmill("run", "demo.toml", "--digits", digits, "--set", 'run.end_time="0.01 s"',
                      "--report", "--out", "many")
        found = re.search(r"mpfr:(\d+) and .* agree to (\d+) digits", done.stdout)
        t.check(found and int(found[1]) <= digits + 30 and int(found[2]) >= digits,
                f"{digits} digits: {done.stdout[:200]!r}")
        page = pathlib.Path("many", "report.html").read_text()
        t.check(
            f"right digits</th><td>{found[2]}," in page and right_digits("many") == int(found[2]),
            f"{digits} digits: the report")


with Trials() as t:
    for name in CASES:
        test_digits(t, name)
    if not WHOLE:
        test_any_number(t)
        test_resume(t)
        test_resume_in_right_digits(t)
        test_refusals(t)
        test_other_ends(t)
        test_many_digits(t)
        test_estimate(t)
        test_certify_to_the_end(t)
        test_bifurcation(t)
print(f"{t.checks} checks of digits")
