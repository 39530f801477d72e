#!/usr/bin/python3
"""The claim of README.md: decks of `edmill export` in LAMMPS, LIGGGHTS and YADE, their dumps by `edmill import`, and the verdicts of
`edmill audit`; mistakes in decks; frames far apart; the limit of contacts of no duration.

usage: dem_codes.py EDMILL [decks] [mistakes] [frames] [vessels] [limit]     all but limit unless given
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
CASE = SOURCE / "docs/examples/vibrated_box.toml"
PROGRAMS = {"lammps": "lmp", "liggghts": "liggghts", "yade": "yade"}
failures = []


def check(good, text):
    print(("ok      " if good else "FAILED  ") + text, flush=True)
    if not good:
        failures.append(text)


def edmill(*arguments):
    return subprocess.run([EDMILL, *map(str, arguments)], capture_output=True, text=True)


def export(code, name, *options, case=CASE):
    done = edmill("export", case, "--to", code, "--name", name, *options)
    if done.returncode:
        sys.exit(done.stderr)
    command = next(line for line in done.stdout.splitlines() if line.startswith("run it there:"))
    return command.split(":", 1)[1].split()


def simulate(command, name, case=CASE):
    """Runs a deck while its dump is read from a pipe; gives the log of contacts and the processor time of the code."""
    deck = command[-1]
    dump, log = f"{name}.dump", f"{name}.csv"
    os.mkfifo(dump)
    reader = subprocess.Popen([EDMILL, "import", dump, "--case", str(case), "--deck", deck, "--out", log, "--quiet"])
    before = os.times()
    # LAMMPS looks for liblammps.so, which Debian's package lacks.
    environment = dict(os.environ, LD_LIBRARY_PATH=os.getcwd(), LAMMPS_POTENTIALS="")
    with open(f"{name}.out", "w") as out:
        code = subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, env=environment).returncode
    if code:
        reader.terminate()  # which may wait for a dump that nobody writes
    if reader.wait() or code:
        sys.exit(f"{name}: code {code}, import {reader.returncode}: see {os.getcwd()}/{name}.out")
    after = os.times()
    os.remove(dump)
    return log, after.children_user - before.children_user


def audit(log, case=CASE):
    file = log + ".json"
    code = edmill("audit", case, log, "--json", file, "--quiet").returncode
    return code, json.load(open(file))


def decks(codes):
    for code in codes:
        start = time.time()
        log, cpu = simulate(export(code, code, "--duration", "2 s"), code)
        result, found = audit(log)
        values = {k: v["found"] for k, v in found["values"].items()}
        check(result == 0, f"{code}: exit code {result}, {time.time() - start:.0f} s, of which {cpu:.0f} s of processor time")
        for where in ("at walls", "between balls"):
            e, mu = values[f"restitution {where}"], values[f"friction {where}"]
            check(abs(e - 0.6) <= 0.002 and abs(mu - 0.4) <= 0.01, f"{code}: restitution {e:.4f}, friction {mu:.4f} {where}")
        other = edmill("compare", "run", log, "--json", "compare.json").returncode
        ratio = 1 + json.load(open("compare.json"))["difference"]
        check(other in (0, 6), f"{code}: compare ends with {other}, dose rate over edmill's {ratio:.3f}")


#: A mistake in a deck of LAMMPS: what is replaced, the value that names it, and its truth; None where none is known.
MISTAKES = {
    "damping tsuji 0.6 as documented": ("hertz/material {young} {damping}", "hertz/material {young} 0.6", "restitution at walls", 0.716),
    "contacts that attract": (" limit_damping", "", "restitution at walls", 0.561),
    "tangential damping left on": ("mindlin NULL 0.0", "mindlin NULL 1.0", "friction at walls", 0.32),
    "amplitude 5 % too small": ("movey equal 0.011*", "movey equal 0.01045*", "mill.amplitude.y", 0.01045),
    "one axis out of phase": ("0.011*sin", "0.011*cos", "phase of mill.amplitude along y", 1.5708),
    "no gravity": ("fix weight all gravity 9.8 vector 0 -1 0\n", "", "gravity along Y", 0),
    "gravity 9.81 for 9.8 times 1.1": ("gravity 9.8 ", "gravity 10.78 ", "gravity along Y", -10.78),
    "density 7800": ("density 8000", "density 7800", "density over the case's", 0.975),
    "six steps in a contact": ("timestep 1e-06", "timestep 8e-06", "restitution at walls", 0.585),
    "friction 0.3": ("NULL 0.0 0.4", "NULL 0.0 0.3", "friction at walls", 0.3),
    "speed 1 % too large": ("376.99111843077515", "380.761", "mill.speed", 380.761),
    "one wall 0.3 mm too far": (" 0.0165 -0.0285", " 0.0168 -0.0285", "place of wall +x", 0.0003),
    "diameter 7.9 mm": ("diameter 0.008", "diameter 0.0079", "diameter over the case's", 0.9875),
}


def mistakes():
    command = export("lammps", "right", "--duration", "2 s")
    text = pathlib.Path("right.in").read_text()
    contact = next(line for line in text.splitlines() if line.startswith("pair_coeff")).split()
    known = {"young": contact[4], "damping": contact[5]}
    for number, (mistake, (old, new, key, truth)) in enumerate(MISTAKES.items()):
        old, new = old.format(**known), new.format(**known)
        if old not in text:
            sys.exit(f"the deck has no '{old}'")
        name = f"mistake{number}"
        deck = text.replace(old, new).replace("right.dump", f"{name}.dump")
        if "timestep 8e-06" in deck:
            deck = deck.replace("all custom 10 ", "all custom 2 ").replace("run 2000000", "run 250000")
        pathlib.Path(f"{name}.in").write_text(deck)
        log, _ = simulate([*command[:-1], f"{name}.in"], name)
        code, found = audit(log)
        if key in found["values"]:
            value = found["values"][key]
            named, off = not value["agrees"], abs(value["found"] - truth)
            close = off <= (0.01 if "friction" in key else max(0.01 * abs(truth), 0.003))
            shown = f"{key} {value['found']:.4g}"
        else:
            causes = sorted(found["causes"].items(), key=lambda cause: cause[1]["left"])
            named = bool(causes) and causes[0][0] == key
            close = named and abs(causes[0][1]["value"] - truth) <= max(0.003 * abs(truth), 3 * causes[0][1]["half_width"])
            shown = ", ".join(f"{k} {v['value']:.5g} +- {v['half_width']:.2g}" for k, v in causes[:2]) or "no cause"
        check(code == 6 and named and close, f"{mistake}: exit code {code}, {shown}")


def frames():
    rates = {}
    for interval in ("10 us", "100 us", "1 ms"):
        name = "frames" + interval.replace(" ", "")
        log, _ = simulate(export("lammps", name, "--duration", "10 s", "--frames", interval), name)
        code, found = audit(log)
        e = found["values"]["restitution at walls"]["found"]
        rates[interval] = found["milling_dose_rate"], found["milling_dose_rate_half_width"]
        check(code == 0 and abs(e - 0.6) <= 0.002, f"frames {interval} apart: exit code {code}, restitution {e:.4f}")
    fine, width = rates["10 us"]
    for interval, (rate, own) in rates.items():
        check(abs(rate - fine) <= width, f"frames {interval} apart: dose rate {rate:.2f} +- {own:.2f} W, {rate / fine:.4f} of that of 10 us")


SPEX = '''[run]
end_time = "2 s"
gravity = "9.8 m/s2"
[mill]
speed = "1054 rpm"
[vessel]
diameter = "38 mm"
height = "57 mm"
[contact]
restitution = 0.52
friction = 0.4
[[balls]]
count = 7
diameter = "9.52 mm"
'''
PLANETARY = '''[run]
end_time = "2 s"
gravity = "9.81 m/s2"
[mill]
type = "planetary"
radius = "75 mm"
speed = "300 rpm"
ratio = -2
[vessel]
diameter = "45 mm"
height = "40 mm"
[contact]
restitution = 0.6
friction = 0.3
[[balls]]
count = 12
diameter = "8 mm"
density = "7.8 g/cm3"
'''


def vessels(codes):
    """Vessels that turn: in LAMMPS in the vessel's frame, in the others as prisms. Contacts of 100 us; YADE is slow."""
    for mill, text, restitution in (("SPEX", SPEX, 0.52), ("planetary", PLANETARY, 0.6)):
        case = pathlib.Path(f"{mill}.toml")
        case.write_text(text)
        for code in codes:
            name = f"{mill}_{code}"
            duration = "0.1 s" if code == "yade" else "0.3 s"
            deck = export(code, name, "--duration", duration, "--contact-time", "100 us", "--frames", "20 us", case=case)
            log, cpu = simulate(deck, name, case)
            result, found = audit(log, case)
            e = found["values"]["restitution at walls"]["found"]
            unexplained = found["values"]["dose with no wall or ball"]["found"]
            check(result == 0 and abs(e - restitution) <= 0.002,
                  f"{mill} in {code}, {duration}: exit code {result}, restitution {e:.4f}, no wall or ball for {unexplained:.2%}, {cpu:.0f} s")


def limit():
    """The stiffest contacts decide the limit: theirs is the longest run. 20 steps in a contact at 4 m/s, as usual in this box."""
    logs = []
    for us, duration in ((300, 300), (150, 300), (75, 1000)):
        log, cpu = simulate(export("lammps", f"limit{us}", "--contact-time", f"{us} us", "--contact-speed", "4 m/s", "--steps", "20",
                                   "--duration", f"{duration} s", "--frames", "150 us"), f"limit{us}")
        print(f"        contacts of {us} us, {duration} s: {cpu:.0f} s of processor time", flush=True)
        logs.append(log)
    slips = audit(logs[-1])[1]["slips"]
    # A contact of LAMMPS can turn the slip by a little more than all of it, as it takes from the approach too; a law cannot.
    law = {body: [[float(ratio), max(-1.0, bin[body])] for ratio, bin in slips.items() if body in bin] for body in ("walls", "balls")}
    own = ['contact.model="restitution-by-slip"', f"contact.ball_wall.tangential_by_slip={law['walls']}",
           f"contact.ball_ball.tangential_by_slip={law['balls']}", 'run.end_time="3001 s"']
    for name, settings in (("walton_braun", ['run.end_time="3001 s"']), ("own_law", own)):
        done = edmill("run", CASE, "--quiet", "--out", name, *(f"--set={setting}" for setting in settings))
        if done.returncode:
            sys.exit(done.stderr)
        edmill("limit", *logs, "--edmill", name, "--from", "1 s", "--json", "limit.json", "--draw", "limit.svg")
        found = json.load(open("limit.json"))
        text = f"limit {found['limit']:.3f} +- {found['half_width']:.3f} W over edmill {name}: {found['ratio']:.4f} +- {found['ratio_half_width']:.4f}"
        check(name != "own_law" or abs(found["ratio"] - 1) <= found["ratio_half_width"] <= 0.006, text)


if __name__ == "__main__":
    EDMILL, *parts = sys.argv[1:]
    EDMILL = str(pathlib.Path(EDMILL).resolve())
    present = [code for code, program in PROGRAMS.items() if shutil.which(program)]
    if "lammps" not in present:
        print("skipped: needs LAMMPS")
        sys.exit(77)
    parts = parts or ["decks", "mistakes", "frames", "vessels"]
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        library = next(pathlib.Path("/usr/lib").glob("*/liblammps.so.0"), None)
        if library:
            os.symlink(library, "liblammps.so")
        edmill("run", CASE, "--quiet", "--out", "run")
        for part in parts:
            {"decks": lambda: decks(present), "mistakes": mistakes, "frames": frames, "vessels": lambda: vessels(present),
             "limit": limit}[part]()
    print(f"{len(failures)} failed")
    sys.exit(bool(failures))
