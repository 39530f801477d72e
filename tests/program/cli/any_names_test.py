#!/usr/bin/env python3
"""Names of any bytes, in paths, labels, materials and points of sweeps, give files of each kind
that every reader reads: JSON, XML, CSV and HTML, of every command that writes any.

usage: PYTHONPATH=tests/support python3 any_names_test.py EDMILL SMALL_DEM_DUMP
"""
import csv
import html.parser
import json
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

try:
    import pandas
except ImportError:
    pandas = None

from program import CASE, EXAMPLES, Trials, edmill

#: Texts in TOML: they are valid UTF-8. Those with control characters are refused.
TEXTS = [
    "plain", "label #2", "#first", '"', "  a;b  ", "{{title}}",
    'a "quoted" \' one, #]]> <![CDATA[</script><script>alert(1)</script><!-- &amp; &#0; < a\u2028b\u2029c\x85d\ufffee\uffff \\n ä é 球 \U0001f600 \u202e {} %s'
]
REFUSED = ["one\ntwo", "one\r\n#two", "a\tb", "a\x00b", "a\x01b", "a\x1b[31mb", "a\x7fb"]
#: Names of files, which can have any bytes but 0 and /.
PATHS = [
    b"a\xff\xc0\x80\xed\xa0\x80\xf4\x90\x80\x80\xc3\x01\x1b\x7f\t", b"a\n#b\r\nc",
    b"]]> &<b>\"'<|script>#,;b" + "ä\u2028\ufffe球".encode()
]

OUTPUTS = """
[[material]]
name = {text}
density = "7 g/cm3"
[[material]]
name = "other"
density = "7 g/cm3"
[[output]]
type = "trends"
interval = "20 ms"
columns = [{{ variable = "milling_dose", statistics = ["sum"], label = {text} }}]
[[output]]
type = "trends_balls"
interval = "50 ms"
columns = [{{ variable = "speed", statistics = ["maximum"], label = {text} }}]
[[output]]
type = "trends"
file = "trends.h5"
interval = "20 ms"
columns = [{{ variable = "milling_dose", statistics = ["sum"], label = {text} }}]
[[output]]
type = "trends_instant"
interval = "50 ms"
columns = [{{ variable = "ball_ball", label = {text}, true_text = {text}, false_text = "wall" }}]
[[output]]
type = "frequency"
variable = "relative_normal_speed_before"
low = "0 m/s"
high = "5 m/s"
intervals = 20
label = {text}
"""
STUDY = '[sweep]\ncase = "case.toml"\n[[sweep.point]]\nname = {text}\nset = {{ "contact.restitution" = 0.5 }}\n[[sweep.point]]\nname = "other"\nset = {{ "contact.restitution" = 0.6 }}\n[[sweep.point]]\nname = "wrong"\nset = {{ "contact.restitution" = 2 }}\n'
OPTIMIZE = (
    '[optimize]\ncase = "case.toml"\nobjective = "milling_dose_rate"\nruns_max = 4\nreplicas_first = 2\nreplicas_max = 2\npoints = 2\nrefinements = 0\n'
    '[[optimize.variable]]\nkey = "contact.restitution"\nlow = 0.4\nhigh = 0.6\n')


def in_toml(text):
    return '"' + "".join(
        c if " " < c < "\x7f" and c not in '"\\' else f"\\U{ord(c):08x}" for c in text) + '"'


class Tags(html.parser.HTMLParser):
    """The elements of a page, and its scripts."""

    def __init__(self, text):
        super().__init__()
        self.tags = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)


def columns_of(file):
    """The header, by pandas and by Python's csv, and as many cells in each row."""
    with open(file, encoding="utf-8", newline="") as stream:
        lines = list(stream)
    while lines[0].startswith("#"):
        lines.pop(0)
    cells = list(csv.reader(lines, strict=True))
    assert {len(row) for row in cells} == {len(cells[0])}, "rows of different lengths"
    if pandas:
        table = pandas.read_csv(file, comment="#", keep_default_na=False)
        assert cells[0] == list(table.columns), f"{cells[0]}, but pandas: {list(table.columns)}"
        assert len(cells) == len(table) + 1, "other rows by pandas"
    return cells


def read(file):
    """The file by its kind; raises whatever its reader does not take."""
    content = file.read_bytes()
    kind = file.suffix
    if kind in (".json", ".certificate"):
        for part in content.decode().rstrip("\n").split("\n") if kind == ".certificate" else [
                content.decode()
        ]:
            json.loads(part)
    elif kind in (".svg", ".xml", ".vtp", ".pvd", ".x3d"):
        xml.etree.ElementTree.fromstring(content)
    elif kind == ".csv":
        return columns_of(file)
    elif kind == ".html":
        text = content.decode()
        assert not set(text) & {chr(c)
                                for c in range(32) if chr(c) not in "\t\n\r"}, "control characters"
        return Tags(text).tags
    elif kind == ".h5":
        import h5py
        with h5py.File(file) as tables:
            tables.visititems(lambda name, part: [str(value) for value in part.attrs.values()])
    else:
        return None
    return True


def case_of(text):
    begin = CASE.format(end="0.12 s").replace("count = 12",
                                              f"count = 12\nmaterial = {in_toml(text)}")
    return begin + OUTPUTS.format(text=in_toml(text)) + "".join(
        f'[[output]]\ntype = "{one}"\n{more}\n' for one, more in MORE.items())


def make(t, text, path):
    """Every command with these names. @return what the readers find in each file, by its place in
    the table"""
    name = os.fsdecode(path)
    folder = pathlib.Path(name)
    folder.mkdir()
    (folder / "case.toml").write_text(case_of(text))
    case = folder / f"{name}.toml"
    case.write_bytes((folder / "case.toml").read_bytes())
    (folder / f"{name}.sweep.toml").write_text(STUDY.format(text=in_toml(text)))
    (folder / f"{name}.optimize.toml").write_text(OPTIMIZE)
    run, log = folder / f"{name}.run", folder / f"{name}.log.csv"
    dump = folder / f"{name}.dump"
    dump.write_bytes(FRAMES[50])
    box = folder / f"{name}.box.toml"
    box.write_bytes(BOX)
    contacts, longer = folder / f"{name}.contacts.csv", folder / f"{name}.longer.csv"
    longer.write_bytes(pathlib.Path("longer.csv").read_bytes())
    commands = [
        ("run", case, "--out", run, "--report"),
        ("run", case, "--out", folder / "second", "--set", "run.seed=7"),
        ("report", run, folder / "second", "--out", folder / f"{name}.html"),
        ("compare", run, folder / "second", "--json", folder / "compare.json", "--junit",
         folder / "compare.xml"),
        ("audit", case, run, "--json", folder / "audit.json", "--junit", folder / "audit.xml"),
        ("audit", case, log, "--column", "time=when", "--json", folder / "other.json", "--junit",
         folder / "other.xml"), ("check", case, "--draw", folder / f"{name}.svg"),
        ("certify", case, "--collisions", "5", "--out", folder / "certified.csv"),
        ("prove", case, "--collisions", "3", "--out", folder / "proven.csv", "--certificate",
         folder / "proof.certificate"),
        ("sensitivity", case, "--events", "5", "--by", "contact.restitution", "--out",
         folder / "derivatives.csv"),
        ("bifurcation", box, "--over", "contact.restitution", "--from", "0.5", "--to", "0.6",
         "--steps", "2", "--out", folder / "bifurcation.svg"),
        ("sweep", folder / f"{name}.sweep.toml", "--out", folder / "sweep"),
        ("optimize", folder / f"{name}.optimize.toml", "--out", folder / "optimize"),
        ("import", dump, "--case", box, "--timestep", "1 us", "--out", contacts),
        ("audit", box, contacts, "--json", folder / "contacts.json", "--junit",
         folder / "contacts.xml"),
        ("compare", contacts, contacts, "--json", folder / "both.json", "--junit",
         folder / "both.xml"),
        ("limit", contacts, longer, "--json", folder / "limit.json", "--draw",
         folder / "limit.svg"),
    ]
    if text != "plain":  # they see no name of the case
        commands = [command for command in commands if not {contacts, dump, box} & set(command)]
    for command in commands:
        if command[0] == "audit" and log in command:  # a log of another code
            log.write_bytes(
                (run / "collisions.csv").read_bytes().replace(b"index,time", b"index,when", 1))
        done = edmill(*command, *(["--quiet"] if command[0] != "check" else []), text=False)
        allowed = {"compare": (0, 6, 7), "audit": (0, 6, 7), "limit": (0, 6, 7),
                   "sweep": (5,)}.get(command[0], (0,))
        t.checks += 1
        if done.returncode not in allowed:
            PROBLEMS.append(f"{text!r} in {path!r}: {command[0]}: {done.returncode} {done.stderr}")
    found = {}
    for file in sorted(
            p for p in folder.rglob("*") if p.is_file() and not p.name.endswith(".toml")):
        try:
            found[str(file.relative_to(folder)).replace(name, "NAME")] = read(file)
        except (ValueError, AssertionError, xml.etree.ElementTree.ParseError, csv.Error) as problem:  # ValueError: of pandas and json, too
            PROBLEMS.append(
                f"{text!r} in {path!r}: {file.relative_to(folder)}: {type(problem).__name__} {problem}"
            )
    return found


def clean(text):
    """Bytes of characters that XML cannot have are replaced."""
    return "".join(3 * "\ufffd" if c in "\ufffe\uffff" else c for c in text)


OF_BOX = {
    "bifurcation.svg", "bifurcation.csv", "NAME.contacts.csv", "contacts.json", "contacts.xml",
    "both.json", "both.xml", "limit.json", "limit.svg"
}
MORE = {
    "collisions": "", "spectra": "", "vessel_load": "", "paraview": 'interval = "50 ms"',
    "snapshot": "start_collision = 10\ncollisions = 2", "animation": 'end_time = "20 ms"',
    "milling_dose": "", "bodies": "", "events": ""
}
PROBLEMS = []
SMALL_DEM = os.path.realpath(sys.argv[2])
BOX = (EXAMPLES / "vibrated_box.toml").read_bytes()
FRAMES = {
    us: subprocess.run([SMALL_DEM, str(us), "2", "100", str(us)], stdout=subprocess.PIPE,
                       check=True).stdout for us in (50, 100)
}

with Trials() as t:
    pathlib.Path("box.toml").write_bytes(BOX)
    pathlib.Path("longer.dump").write_bytes(FRAMES[100])
    edmill(*"import longer.dump --case box.toml --timestep 2us --out longer.csv --quiet".split(),
           code=0)
    kinds = {}
    expected = make(t, "plain", b"same")
    for kind in {pathlib.Path(name).suffix for name in expected}:
        kinds[kind] = sum(pathlib.Path(name).suffix == kind for name in expected)
    print("files of each kind:", kinds)
    for text in REFUSED:
        pathlib.Path("refused.toml").write_text(case_of(text))
        pathlib.Path("refused.sweep.toml").write_text(STUDY.format(text=in_toml(text)))
        for command in ("run", "sweep"):
            done = edmill(command, "refused.toml" if command == "run" else "refused.sweep.toml",
                          "--quiet", "--out", "refused")
            t.check(
                done.returncode == 2 and
                "found a text with control characters, expected a text in one line" in done.stderr,
                f"{command} {text!r}: {done.stderr}")
    for k, (text, path) in enumerate([(text, b"plain") for text in TEXTS[1:]] +
                                     [("plain", path) for path in PATHS]):
        found = make(t, text, path + str(k).encode())
        t.check(
            set(found) == {place for place in expected if text == "plain" or place not in OF_BOX} or
            PROBLEMS, f"{text!r}, {path}: other files: {set(found) ^ set(expected)}")
        for name in found.keys() & expected.keys():
            if name.endswith(".html") and found[name] != expected[name]:
                PROBLEMS.append(
                    f"{text!r} in {path!r}: {name}: {len(found[name])} elements, expected {len(expected[name])}"
                )
        for file, row in (("sweep/sweep.csv", 1), ("NAME.run/trends.csv", 0)):
            if found.get(file) and not any(clean(text) in cell for cell in found[file][row]):
                PROBLEMS.append(f"{text!r}: not in {file}: {found[file][row]}")
    print(*PROBLEMS, sep="\n")
    t.check(not PROBLEMS, f"{len(PROBLEMS)} files are not well-formed")
    print(f"{t.checks} commands and results: every name gives files that their readers read")
