#!/usr/bin/python3
"""`export`, `import`, `audit`, `compare` and `limit` as a user calls them, with the small DEM code
of this folder; and their errors.
usage: PYTHONPATH=tests/support python3 dem_commands_test.py EDMILL SMALL_DEM_DUMP"""
import gzip
import json
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as xml

from program import EXAMPLES, SOURCE, Trials, edmill as run

DUMP = os.path.realpath(sys.argv[2])
CASE = EXAMPLES / "vibrated_box.toml"


def fails(text, *words, code=2):
    done = run(*words)
    check(done.returncode == code and text in done.stderr,
          f"{' '.join(map(str, words))}: code {done.returncode}, {done.stderr!r}, not {text!r}")


def dump_to(file, *words):
    with open(file, "wb") as out:
        subprocess.run([DUMP, *map(str, words)], stdout=out, check=True)


#: A ball that flies freely; of which no contact comes.
FLIGHT = "".join(
    f"ITEM: TIMESTEP\n{k}\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n-1 1\n-1 1\n-1 1\n"
    f"ITEM: ATOMS id x y z vx vy vz omegax omegay omegaz\n1 0 0 0 0 0 0 0 0 0\n" for k in range(5))


def facets():
    """What a deck says of the prism goes into the log; a number that can be none is refused."""
    pathlib.Path("one.toml").write_text(
        '[run]\nend_time = "1 s"\n[mill]\ntype = "still"\n[vessel]\ndiameter = "40 mm"\nheight = "40 mm"\n'
        + COMMON.replace("count = 3", "count = 1"))
    pathlib.Path("one.dump").write_text(FLIGHT)
    words = ("import", "one.dump", "--case", "one.toml", "--out", "one.csv", "--deck", "one.in",
             "--quiet")
    for code, expected in (("liggghts", 128), ("yade", 24), ("lammps", 0)):
        run("export", "one.toml", "--to", code, "--name", code)
        deck = next(
            file for file in map(pathlib.Path, (f"{code}.in", f"{code}.py")) if file.exists())
        pathlib.Path("one.in").write_text(deck.read_text())
        done = run(*words)
        check(
            done.returncode == 0 and f'"facets":{expected},' in pathlib.Path("one.csv").read_text(),
            f"facets of {code}: {done.stderr}")
    for wrong in ("2", "-8", "many", "8.5", "99999999999999"):
        pathlib.Path("one.in").write_text(f"timestep 1e-6\n# facets {wrong}\n")
        fails(f"one.in: found '{wrong}' facets, expected at least 3", *words)
    log = pathlib.Path("one.csv").read_text()
    for wrong in ("1", "-8", "8.5", "1e300"):
        pathlib.Path("wrong.csv").write_text(log.replace('"facets":0', f'"facets":{wrong}'))
        fails("wrong.csv:2: facets: found ", "audit", "one.toml", "wrong.csv")
    head = json.loads(log.splitlines()[1][2:])
    check(len(head) == 15, f"the head: {head}")
    for name in head:
        for wrong in ("null", "[8, 8]", '{"x": 1}'):
            broken = json.dumps(head).replace(
                json.dumps({name: head[name]})[1:-1], f'"{name}": {wrong}')
            pathlib.Path("wrong.csv").write_text(log.replace(log.splitlines()[1], "# " + broken))
            fails("wrong.csv:2: found ", "audit", "one.toml", "wrong.csv")


TANK = '[mill]\ntype = "chain"\njoint = [{ rotate = "y", angle = "45 deg" }]\n[vessel]\ndiameter = "40 mm"\nheight = "40 mm"\n'
ROTOR = ('[[body]]\nsize = ["10 mm", "4 mm", "4 mm"]\n{}\non = "ground"\n'
         'joint = [{{ rotate = "y", speed = "600 rpm" }}, {{ translate = ["8 mm", 0, 0] }}]\n')
MILLS = {  # a case, and the codes that cannot have it
    "box": ('[mill]\ntype = "vibratory"\namplitude = ["3 mm", "0 mm", "0 mm"]\nspeed = "3000 rpm"\n[vessel]\ntype = "box"\nsize = ["4 cm", "4 cm", "4 cm"]\n', {}),
    "spex": ('[vessel]\ndiameter = "38 mm"\nheight = "57 mm"\n', {}),
    "still": ('[mill]\ntype = "still"\n[vessel]\ntype = "box"\nsize = ["4 cm", "4 cm", "4 cm"]\n', {}),
    "planetary": ('[mill]\ntype = "planetary"\nradius = "70 mm"\nspeed = "300 rpm"\nratio = -2\n[vessel]\ndiameter = "40 mm"\nheight = "40 mm"\n', {}),
    "drum": ('[mill]\ntype = "drum"\nspeed = "60 rpm"\n[vessel]\ndiameter = "40 mm"\nheight = "40 mm"\n', {}),
    "sphere": ('[vessel]\ntype = "sphere"\ndiameter = "40 mm"\n', {"liggghts": "doubly curved walls", "yade": "doubly curved walls"}),
    "capsule": ('[vessel]\ntype = "capsule"\ndiameter = "30 mm"\nheight = "60 mm"\n',
                {"lammps": "not a single region", "liggghts": "doubly curved walls", "yade": "doubly curved walls"}),
    "stirred": (TANK + ROTOR.format(""), {}),
    "sphere inside": (TANK + '[[body]]\nsize = ["8 mm", "8 mm", "8 mm"]\nrounding = "4 mm"\n', {}),
    "sheet": (TANK + '[[body]]\nsize = ["8 mm", "0 mm", "6 mm"]\n[[body]]\ntype = "cylinder"\ndiameter = "6 mm"\nheight = "0 mm"\n'
              'joint = [{ translate = [0, "9 mm", 0] }]\n', {}),
    "shifted": ('[mill]\ntype = "chain"\njoint = [{ translate = ["50 mm", 0, 0] }]\n[vessel]\ntype = "box"\nsize = ["4 cm", "4 cm", "4 cm"]\n', {}),
    "rounded": (TANK + ROTOR.format('rounding = "1 mm"'), {"lammps": "body 0, with rounded edges"}),
    "two axes": (TANK + ROTOR.format("").replace('translate = ["8 mm", 0, 0]', 'rotate = "x", angle = "30 deg"'),
                 {"lammps": "body 0, whose joints turn about several axes"}),
    "sliding": (TANK + '[[body]]\nsize = ["9 mm", "4 mm", "4 mm"]\njoint = [{ translate = "x", swing = [{ amplitude = "5 mm", speed = "600 rpm" }] }]\n',
                {"yade": "body 0, which has no point at rest"}),
    "baffle": ('[vessel]\ndiameter = "38 mm"\nheight = "57 mm"\n[[body]]\nsize = ["2 mm", "30 mm", "6 mm"]\njoint = [{ translate = ["16 mm", 0, 0] }]\n',
               {}),
    "rotor in a drum": ('[mill]\ntype = "drum"\nspeed = "60 rpm"\n[vessel]\ndiameter = "40 mm"\nheight = "40 mm"\n' + ROTOR.format("").replace('"y"', '"z"'),
                        {"lammps": "body 0 on the ground in a vessel that turns"}),
}
COMMON = '[contact]\nrestitution = 0.6\nfriction = 0.4\n[[balls]]\ncount = 3\ndiameter = "5 mm"\n'


def exports():
    for name, (text, refused) in MILLS.items():
        pathlib.Path(f"{name}.toml").write_text('[run]\nend_time = "1 s"\ngravity = "9.8 m/s2"\n' +
                                                text + COMMON)
        for code in ("lammps", "liggghts", "yade"):
            words = ("export", f"{name}.toml", "--to", code, "--out", f"{name}_{code}")
            if code in refused:
                fails(refused[code], *words)
                check(not pathlib.Path(f"{name}_{code}").exists(),
                      f"{name} {code}: a deck that was refused")
            else:
                done = run(*words)
                check(done.returncode == 0 and done.stdout.count("wrote") >= 1,
                      f"{name} {code}: {done.stderr}")
                decks = list(pathlib.Path(f"{name}_{code}").iterdir())
                if name == "shifted" and code == "lammps":
                    check(
                        "move v_movex" in decks[0].read_text() and
                        "variable movex equal 0.05" in decks[0].read_text(),
                        "a vessel that is shifted")
                if name == "sheet" and code != "lammps":
                    triangles = [
                        deck.read_text().count("outer loop") for deck in decks
                        if "body" in deck.name
                    ]
                    check(sorted(triangles) == [2, 46], f"sheets of {code}: {triangles} triangles")
                check(
                    all("nan" not in deck.read_text() and "inf " not in deck.read_text()
                        for deck in decks), f"{name} {code}: nan")
    for law, text in {"constant": "walton-braun", "viscoelastic": "walton-braun"}.items():
        fails(f'found "{law}", expected "{text}"', "export", "box.toml", "--to", "lammps", "--set",
              f'contact.model="{law}"', "--set", "contact.restitution_tangential=0.3", "--set",
              'contact.effective_modulus="1e11 Pa"', "--set", 'contact.dissipative_time="1e-6 s"')
    fails("0.05 or more", "export", "box.toml", "--to", "yade", "--set", "contact.restitution=0.01")
    fails("allows no lower one", "export", "box.toml", "--to", "lammps", "--set",
          "contact.restitution=0.1")
    fails("reduced inertia", "export", "box.toml", "--to", "lammps", "--set",
          "balls.0.reduced_inertia=0.5")
    fails("abaqus not in", "export", "box.toml", "--to", "abaqus")
    fails("a positive time", "export", "box.toml", "--to", "lammps", "--contact-time", "0 s")
    fails("a time", "export", "box.toml", "--to", "lammps", "--contact-time", "50")


def imports():
    dump_to("right.dump", 50, 0.6, 10, 1)
    done = run("import", "right.dump", "--case", CASE, "--timestep", "1 us", "--out", "right.csv")
    check(done.returncode == 0 and "of the dose" in done.stdout, done.stderr)
    right = pathlib.Path("right.csv").read_text().split("\n", 2)[2]
    # From a pipe, compressed, and by the deck's time step.
    with open("right.dump", "rb") as frames:
        piped = run("import", "-", "--case", CASE, "--timestep", "1 us", "--out", "piped.csv",
                    stdin=frames)
    check(
        piped.returncode == 0 and pathlib.Path("piped.csv").read_text().split("\n", 2)[2] == right,
        "a pipe")
    with open("right.dump", "rb") as frames, gzip.open("right.dump.gz", "wb", 1) as packed:
        packed.write(frames.read())
    run("export", CASE, "--to", "liggghts", "--quiet")
    check(
        run("import", "right.dump.gz", "--case", CASE, "--deck", "deck.in", "--out",
            "packed.csv").returncode == 0 and
        pathlib.Path("packed.csv").read_text().split("\n", 2)[2] == right, "a compressed dump")
    pathlib.Path("list.csv").write_text(
        "particle_id,boundary_id,start_time,end_time,start_particle_velocity_x\n0,10,0.01,0.0101,0.5\n"
    )
    fails("columns without id", "import", "list.csv", "--case", CASE)
    fails("without time", "import", "right.dump", "--case", CASE)
    check(not pathlib.Path("contacts.csv").exists(), "a log of a dump that was refused")
    fails("5 balls", "import", "right.dump", "--case", CASE, "--timestep", "1 us", "--set",
          "balls.0.count=6")
    fails("no_such", "import", "no_such.dump", "--case", CASE, "--timestep", "1 us")


def verdicts():
    done = run("audit", CASE, "right.csv", "--json", "audit.json", "--junit", "audit.xml")
    found = json.load(open("audit.json"))
    check(done.returncode == 0 and found["verdict"] == "agrees", done.stdout)
    suite = xml.parse("audit.xml").getroot()
    check(
        suite.get("failures") == "0" and len(suite) == int(suite.get("tests")) > 5,
        "JUnit of a right log")
    dump_to("wrong.dump", 50, 0.6, 10, 1, 0.3)
    run("import", "wrong.dump", "--case", CASE, "--timestep", "1 us", "--out", "wrong.csv")
    done = run("audit", CASE, "wrong.csv", "--junit", "wrong.xml")
    names = {
        case.get("name") for case in xml.parse("wrong.xml").getroot()
        if case.find("failure") is not None
    }
    check(
        done.returncode == 6 and "friction at walls" in names and
        all(name.startswith("friction") for name in names), f"friction 0.3: {names}")
    dump_to("short.dump", 50, 0.01, 10, 1)
    run("import", "short.dump", "--case", CASE, "--timestep", "1 us", "--out", "short.csv")
    check(run("audit", CASE, "short.csv").returncode == 7, "too few contacts")
    fails("expected 4 balls", "audit", CASE, "right.csv", "--set", "balls.0.count=4")
    head, rest = pathlib.Path("right.csv").read_text().split("\ntime,", 1)
    pathlib.Path("headless.csv").write_text(head.split("\n")[0] + "\ntime," + rest)
    fails("expected the head", "audit", CASE, "headless.csv")
    pathlib.Path("torn.csv").write_text(pathlib.Path("right.csv").read_text()[:-40])
    fails("fields", "audit", CASE, "torn.csv")


def limits():
    run("run", CASE, "--quiet", "--out", "reference", "--set", 'run.end_time="61 s"')
    logs = []
    for us in (200, 100, 50):
        dump_to("some.dump", us, 6, 100, us)
        run("import", "some.dump", "--case", CASE, "--timestep", f"{us / 50} us", "--out",
            f"some{us}.csv")
        logs.append(f"some{us}.csv")
    os.remove("some.dump")
    done = run("compare", "reference", logs[2], "--json", "compare.json", "--junit", "compare.xml")
    found = json.load(open("compare.json"))
    off, half_width = abs(found["difference"]), found["half_width"]
    check(
        off < 0.2 and
        done.returncode == (6 if off > half_width else 0 if half_width <= 0.05 else 7), done.stdout)
    for within, code in ((off + 1.01 * half_width, 0), (off + 0.99 * half_width, 7),
                         (off - 1.01 * half_width, 6)):
        if within > 0:
            check(
                run("compare", "reference", logs[2], "--within",
                    f"{100 * within:.9f}%").returncode == code, f"{within} {done.stdout}")
    for words in (("compare", "reference", logs[2], "--events", "3"), ("compare", logs[0], logs[2],
                                                                       "--tolerance", "1e-6"),
                  ("audit", CASE, logs[2], "--identify"), ("audit", CASE, logs[2], "--first-ball",
                                                           "1", "--examples", "2")):
        fails("found a log of contacts that last, expected one of impacts", *words)
    fails("found a log of impacts, expected one of contacts that last", "compare", "reference",
          "reference", "--within", "5%")
    fails("a part of the dose rate", "compare", "reference", logs[2], "--within", "5")
    fails("edmill import right.dump", "audit", CASE, "right.dump")
    fails("edmill import right.dump", "compare", "reference", "right.dump")
    check(
        run("compare", "reference", logs[2], "--from", "1000").returncode == 2, "no time in common")
    done = run("limit", *logs, "--edmill", "reference", "--from", "1 s", "--json", "limit.json",
               "--draw", "limit.svg")
    found = json.load(open("limit.json"))
    off, half_width = abs(found["ratio"] - 1), found["ratio_half_width"]
    check(off < 2 * half_width + 0.05, done.stdout + done.stderr)
    check(done.returncode == (6 if off > half_width else 0 if half_width <= 0.05 else 7),
          f"{found['verdict']}: {done.stdout}")
    done = run("limit", *logs, "--edmill", "reference", "--from", "1 s", "--within", "50%")
    check(done.returncode == 0 and "agree within 50 %" in done.stdout, done.stdout)
    check(run("limit", *logs, "--from", "1 s").returncode == 0, "a limit beside nothing")
    check(
        xml.parse("limit.svg").getroot().tag.endswith("svg") and
        "nan" not in pathlib.Path("limit.svg").read_text(), "the drawing")
    fails("differ by more than a fifth", "limit", logs[0], logs[0])


def python():
    import edmill
    deck = edmill.export(CASE, "lammps", duration=1.0)
    check(
        deck.write("python")[0].read_text() == deck.files["deck.in"] and
        deck.command == "lmp -in deck.in", "Python's deck")
    found = edmill.import_dump(CASE, "right.dump", "python.csv", timestep=1e-6)
    check(found["classes"]["wall"][0] > 100 and found["frames"] == 60001,
          f"Python's import: {found}")
    check(
        edmill.audit(CASE, "python.csv").good and not edmill.audit(CASE, "wrong.csv").good,
        "Python's audits")
    check(
        edmill.limit(["some200.csv", "some50.csv"], "reference", start=1)["ratio"] > 0.9,
        "Python's limit")
    for call in (lambda: edmill.export(CASE, "abaqus"),
                 lambda: edmill.export(CASE, "lammps", contact_time=0),
                 lambda: edmill.limit(["some200.csv"]),
                 lambda: edmill.import_dump(CASE, "right.dump", "x.csv", units="lj")):
        try:
            call()
            check(False, "an argument that is wrong")
        except edmill.InputError as error:
            check("expected" in str(error), str(error))


with Trials(to_the_end=True) as t:
    check = t.check
    for part in (exports, facets, imports, verdicts, limits, python):
        part()
