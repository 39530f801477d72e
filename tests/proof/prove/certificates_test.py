#!/usr/bin/env python3
"""Proofs and their certificates: short proofs are made and checked by the independent checker,
which must reject every kind of tampering; the certificates that are shipped are checked. With --all
the shipped ones are made again and must be the same.

usage: PYTHONPATH=tests/support python3 certificates_test.py EDMILL CHECKER REFERENCE FOLDER [--all
    | --without-arb]
--without-arb: CHECKER has the arithmetic by integers of its own"""
import copy
import hashlib
import json
import lzma
import os
import pathlib
import re
import shutil
import subprocess
import sys
from decimal import Decimal, getcontext

from program import edmill, rows

getcontext().prec = 60
WITHOUT_ARB = "--without-arb" in sys.argv
CHECKER, REFERENCE, FOLDER = sys.argv[2], pathlib.Path(sys.argv[3]), pathlib.Path(sys.argv[4])
SHIPPED = {
    "one_ball": 500, "three_balls": 500, "balls_28": 2000, "planetary": 500, "box": 500,
    "stirred": 500
}
SHORT = {
    "one_ball": 20, "three_balls": 40, "balls_28": 60, "planetary": 40, "box": 40, "stirred": 60
}


def fail(text):
    sys.exit("failed: " + text)


def prove(case, events, name, *more):
    return edmill("prove", case, "--collisions", events, "--certificate", name, *more)


def checked(file):
    """Exit code and text of the checker."""
    done = subprocess.run([CHECKER, file], text=True, capture_output=True, check=False)
    return done.returncode, (done.stdout + done.stderr).strip()


def verdict(lines):
    """Exit code and text of the checker for these lines."""
    pathlib.Path("tampered").write_text("".join(line + "\n" for line in lines))
    return checked("tampered")


def scaled(text, midpoint=0, radius=0):
    """An enclosure with this many units more in its midpoint or its radius."""
    m, e, r, f = text.split()
    hexadecimal = lambda t, more: format(int(t, 16) + more, "x")
    return " ".join([hexadecimal(m, midpoint), e, hexadecimal(r, radius), f])


def half(text):
    """An enclosure with half the radius."""
    m, e, r, f = text.split()
    return " ".join([m, e, r, format(int(f, 16) - 1, "x")])


def moved(text):
    """An enclosure whose midpoint is two radii farther."""
    m, e, r, f = (int(part, 16) for part in text.split())
    low = min(e, f)
    return " ".join(
        format(part, "x") for part in ((m << (e - low)) + 2 * (r << (f - low)), low, r, f))


def tamperings(lines):
    """Name and lines of each: `lines` are the header, the events and the last line, as objects."""
    def changed(name, how, *places):
        new = copy.deepcopy(lines)
        how(*[new[p] for p in places]) if places else how(new)
        return name, new
    events = range(1, len(lines) - 1)
    wall = next(k for k in events if k > 5 and "wall" in lines[k])
    pair = next((k for k in events if k > 2 and "partner" in lines[k]), None)
    deep = next(k for k in events
                if k > 3 and any(re.search(r"[prf][1-9].*f", t) for t in lines[k]["windows"][0]))
    balls = len(lines[0]["balls"])

    def renumbered(new):
        for k in range(1, len(new) - 1):
            new[k]["event"] = k - 1
        new[0]["events"] = new[-1]["end"] = len(new) - 2

    def left_out(new):
        del new[wall]
        renumbered(new)

    def swapped(new):
        new[wall], new[wall + 1] = new[wall + 1], new[wall]

    def exchanged(new):
        swapped(new)
        renumbered(new)

    def at(part, component, how):
        def change(line):
            line["states"][0][part][component] = how(line["states"][0][part][component])
        return change

    def coarse(line):  # also where the ball begins or ends its flight at that wall
        line["windows"][0] = ["p0" for _ in line["windows"][0]]

    def cut(line):
        k = next(k for k, t in enumerate(line["windows"][0]) if re.search(r"[prf][1-9]", t))
        line["windows"][0][k] = re.sub(r"[prf]\d+$", "", line["windows"][0][k])

    def claimed(line):
        k = next(k for k, t in enumerate(line["windows"][0]) if "p" in t)
        line["windows"][0][k] = line["windows"][0][k].replace("p", "f")

    def put(key, value):
        return lambda line: line.__setitem__(key, value)

    yield changed("an event left out, its line alone", lambda new: new.__delitem__(wall))
    yield changed("an event left out, and the others numbered anew", left_out)
    yield changed("two events swapped", swapped)
    yield changed("two events swapped and numbered anew", exchanged)
    yield changed("the velocity's enclosure too narrow by one unit",
                  at("v", 0, lambda t: scaled(t, radius=-1)), wall)
    yield changed("the position's enclosure too narrow by one unit",
                  at("r", 1, lambda t: scaled(t, radius=-1)), wall)
    yield changed("the spin's enclosure too narrow by one unit",
                  at("s", 2, lambda t: scaled(t, radius=-1)), wall)
    yield changed("an enclosure with half the radius", at("v", 1, half), wall)
    yield changed("an enclosure beside the true one", at("v", 0, moved), wall)
    yield changed("a bracket beside the true one", lambda line: put("time", moved(line["time"]))
                  (line), wall)
    yield changed("a bracket with half the radius", lambda line: put("time", half(line["time"]))
                  (line), wall)
    yield changed("another wall",
                  lambda line: put("wall", (line["wall"] + 1) % len(lines[0]["walls"]))(line), wall)
    if balls > 1:
        yield changed("another ball", lambda line: put("ball", (line["ball"] + 1) % balls)(line),
                      wall)
        yield changed("last line without a ball", lambda line: line["windows"].popitem(), -1)
    if pair:
        def turned(line):
            line["ball"], line["partner"] = line["partner"], line["ball"]
            line["states"].reverse(), line["windows"].reverse()
        yield changed("ball and partner in the other order", turned, pair)
    if pair and balls > 2:
        other = next(
            b for b in range(balls) if b not in (lines[pair]["ball"], lines[pair]["partner"]))
        yield changed("another partner", put("partner", other), pair)
        yield changed("the states of two balls exchanged", lambda line: line["states"].reverse(),
                      pair)
    yield changed("windows that do not leave out the contacts at the ends", coarse, deep)
    yield changed("windows that leave the end of a flight out", cut, deep)
    yield changed("windows that claim a contact that is none", claimed, deep)
    yield changed("windows of one wall left out", lambda line: line["windows"][0].pop(), wall)
    yield changed("another case: friction",
                  put("laws", [{**law, "friction": "41/100"} for law in lines[0]["laws"]]), 0)
    yield changed("another case: restitution",
                  put("laws", [{**law, "restitution": "51/100"} for law in lines[0]["laws"]]), 0)
    yield changed("another case: gravity", put("gravity", ["0", "-981/100", "0"]), 0)
    yield changed("another case: start", put("start", "1/1000"), 0)
    yield changed("another case: a ball's place",
                  lambda h: put("position", ["1/1000", "1/1000", "1/1000"])(h["balls"][0]), 0)
    yield changed("another case: radius of a ball", lambda h: put("radius", "1/251")(h["balls"][0]),
                  0)
    yield changed("another case: a negative restitution",
                  put("laws", [{**law, "restitution": "-2"} for law in lines[0]["laws"]]), 0)
    yield changed("another case: a density below zero", lambda h: put("density", "-1")
                  (h["balls"][0]), 0)
    yield changed("another case: a law that creates slip",
                  put("laws", [{**law, "min_tangential": "2"} for law in lines[0]["laws"]]), 0)
    round_solids = [k for k, w in enumerate(lines[0]["walls"]) if w.get("solid") == "cylinder"]
    solid = next((lines[k]["wall"] for k in events if lines[k].get("wall") in round_solids), None)
    if round_solids:
        a, b, _ = lines[0]["walls"][solid]["half"]
        def in_solid(key, value):
            return lambda h: put(key, value)(h["walls"][solid])

        yield changed("another case: a solid of another size",
                      in_solid("half", ["7/1000", b, "7/1000"]), 0)
        yield changed("another case: a cylinder with two radii", in_solid("half", [a, b, "7/1000"]),
                      0)
        yield changed("another case: a solid of negative size",
                      in_solid("half", ["-" + a, b, "-" + a]), 0)
        yield changed("another case: the rounding of a solid", in_solid("rounding", "1/1000"), 0)
        yield changed("another case: a negative rounding", in_solid("rounding", "-1/1000"), 0)
        yield changed("another case: a box in place of a cylinder", in_solid("solid", "box"), 0)
        yield changed("another case: a solid of an unknown kind", in_solid("solid", "cone"), 0)
        yield changed("another case: a solid at rest", lambda h: put("joints", [])
                      (h["walls"][solid]), 0)
        yield changed("another case: a solid left out", lambda h: h["walls"].pop(), 0)
        yield changed("another case: a version without solids", put("version", 1), 0)
    yield changed("numbers with what a reader does not see", put("start", "0\0/7"), 0)
    yield changed("fewer bits than the enclosures were computed with",
                  lambda h: put("bits", h["bits"] - 32)(h), 0)
    yield changed("more events announced than there are", lambda h: put("events", h["events"] + 1)
                  (h), 0)
    yield changed("a key of the header that no page names", put("note", "1"), 0)
    yield changed("a key of an event that no page names", put("note", "1"), wall)
    yield changed("last line left out", lambda new: new.pop())
    yield changed("a line after the last one", lambda new: new.append(new[1]))


def check_headers(name, case, text):
    """Whether header and case agree: every number of the header counts, and nothing else does."""
    def says(line, *more):
        pathlib.Path("header").write_text(line + "\n")
        done = edmill("prove", "--check", "header", case, *more)
        return done.returncode, (done.stdout + done.stderr).strip()
    header = json.loads(text[0])
    for what, line in (("as proven", text[0]),
                       ("another name", json.dumps({**header, "case": "b.toml", "digest": "0"}))):
        code, said = says(line)
        if code != 0:
            fail(f"{name}: prove --check, {what}: exit code {code}: {said}")
    changed = 0
    def places(value, path=()):
        if isinstance(value, dict):
            for key, part in value.items():
                yield from places(part, (*path, key))
        elif isinstance(value, list):
            for key, part in enumerate(value):
                yield from places(part, (*path, key))
        else:
            yield path
    for path in places(header):
        if path[0] in ("format", "version", "case", "digest", "events", "bits"):
            continue
        if path[0] in ("law_of_balls", "balls") and isinstance(path[1], int) and path[1] > 2:
            continue  # the others are alike
        tampered = copy.deepcopy(header)
        at = tampered
        for key in path[:-1]:
            at = at[key]
        old = at[path[-1]]
        at[path[-1]] = not old if isinstance(
            old, bool) else old + 1 if isinstance(old, int) else "7/11" if old != "7/11" else "1"
        code, said = says(json.dumps(tampered))
        if code != 6 or "/" + "/".join(map(str, path)) not in said:
            fail(f"{name}: prove --check with another {path}: exit code {code}: {said}")
        changed += 1
    code, said = says(text[0], "--set", "contact.restitution=0.51")
    if code != 6:
        fail(
            f"{name}: prove --check with another restitution in the case: exit code {code}: {said}")
    for line in ("", "{}", "no json", text[1], text[0][:-1], json.dumps({**header, "version": 3}),
                 text[0].replace('"bits"', '"bits":1,"bits"')):
        code, said = says(line)
        if code != 2 or said.count("\n") or "header: the first line" not in said:
            fail(f"{name}: prove --check of {line[:40]!r}: exit code {code}: {said}")
    print(f"claim {name}: prove --check names each of {changed} other numbers of the header")


def check_short(name, events):
    case = str(REFERENCE / f"{name}.toml")
    done = prove(case, events, f"{name}.cert", "--out", f"{name}.csv", "--quiet")
    if done.returncode:
        fail(f"prove {name}: {done.stderr}")
    text = pathlib.Path(f"{name}.cert").read_text().splitlines()
    code, said = verdict(text)
    if code != 0 or not said.startswith(f"accepted: {events} events"):
        fail(f"{name}: the checker says {said}")
    # What is proven holds what two scalars agree on.
    for one, two in zip(rows(f"{name}.csv"), rows(REFERENCE / f"{name}.events.csv")):
        if (one["ball"], one["partner_kind"], one["partner"]) != (two["ball"], two["partner_kind"],
                                                                  two["partner"]):
            fail(f"{name}: event {one['index']} is another one in {name}.events.csv")
        for column in ("time", "approach_speed", "slip_speed"):
            off = abs(Decimal(one[column]) - Decimal(two[column]))
            if off > Decimal(one[column + "_radius"]) + Decimal("1e-24") * 10:
                fail(f"{name}: event {one['index']}: {column} is off by {off}")
    rejected = 0
    for what, lines in tamperings([json.loads(line) for line in text]):
        if WITHOUT_ARB and "by one unit" in what:
            continue  # sharper roundings may still prove it
        code, said = verdict([json.dumps(line) for line in lines])
        # A mill that cannot be is no certificate at all.
        no_mill = code == 2 and said.startswith("check_certificate: ") and "another case" in what
        if not no_mill and (code != 1 or not said.startswith("rejected: ")):
            fail(f"{name}: {what}: exit code {code}: {said}")
        rejected += 1
    for what, key in (("the header", '"gravity"'), ("a ball of the header", '"radius"'),
                      ("an event", '"time"'), ("a state", '"v"')):
        k = next(k for k, line in enumerate(text) if key + ":" in line)
        twice = re.sub(f"({key}:(\\[[^]]*\\]|[^,}}]*))", r"\1,\1", text[k], count=1)
        code, said = verdict([*text[:k], twice, *text[k + 1:]])
        if twice == text[k] or code != 1 or "twice the key" not in said:
            fail(f"{name}: a key twice in {what}: exit code {code}: {said}")
        rejected += 1
    check_headers(name, case, text)
    print(
        f"claim {name}: {events} events proven and accepted, {rejected} of {rejected} kinds of tampering rejected"
    )
    return rejected


SLIDING = """[run]
end_time = "1 s"
gravity = "9.8 m/s2"
[mill]
type = "chain"
[[mill.joint]]
translate = [2, -1, 2]
speed = "-1.5 m/s"
[[mill.joint]]
rotate = "z"
speed = "60 rpm"
[vessel]
type = "box"
size = ["33 mm", "57 mm", "36 mm"]
[contact]
friction = 0.4
restitution = 0.53
[[balls]]
count = 2
diameter = "9 mm"
"""


def check_sliding(events):
    """A translation at constant speed, which no case of the reference files has."""
    pathlib.Path("sliding.toml").write_text(SLIDING)
    done = prove("sliding.toml", events, "sliding.cert", "--quiet")
    if done.returncode:
        fail(f"prove sliding: {done.stderr}")
    text = pathlib.Path("sliding.cert").read_text()
    code, said = verdict(text.splitlines())
    if code != 0 or not said.startswith(f"accepted: {events} events"):
        fail(f"sliding: the checker says {said}")
    for speed in ("", '"speed":"-3/4",'):
        code, said = verdict(text.replace('"speed":"-3/2",', speed).splitlines())
        if code != 1:
            fail(f"sliding with {speed or 'no speed'}: exit code {code}: {said}")
    print(f"claim sliding: {events} events proven and accepted")


def check_hostile():
    """Lines on which a parser would spend minutes, or the stack."""
    header = pathlib.Path("one_ball.cert").read_text().splitlines()[0]
    for what, line in (("deep", '{"event":' + "[" * 100000 + "]" * 100000 + "}"),
                       ("deep in objects", '{"event":' + '{"a":' * 100000 + "0" + "}" * 100001),
                       ("wide", '{"event":[' + "{}," * 400000 + "{}]}")):
        code, said = verdict([header, line])
        if code != 2 or "too much" not in said:
            fail(f"a {what} line: exit code {code}: {said[:200]}")


def check_shipped(name, events, again):
    packed = (REFERENCE / f"{name}.certificate.xz").read_bytes()
    digest = hashlib.sha256(packed).hexdigest()
    if f"`{digest}`" not in (REFERENCE / "README.md").read_text():
        fail(
            f"{name}.certificate.xz has the digest {digest}, which regression/reference/README.md does not name"
        )
    pathlib.Path("shipped").write_bytes(lzma.decompress(packed))
    code, said = checked("shipped")
    if code != 0 or not said.startswith(f"accepted: {events} events"):
        fail(f"{name}.certificate.xz: {said}")
    told = edmill("check", REFERENCE / f"{name}.toml", code=0).stdout
    header = json.loads(pathlib.Path("shipped").open().readline())
    if header["digest"] not in told:
        fail(f"{name}.certificate.xz is of another case: edmill check prints\n{told}")
    if again:
        done = prove(str(REFERENCE / f"{name}.toml"), events, "again")
        if done.returncode or pathlib.Path("again").read_bytes() != pathlib.Path(
                "shipped").read_bytes():
            fail(f"{name}: another certificate than the one that is shipped: {done.stderr}")
        print(done.stdout.splitlines()[-1])
    print(f"claim {name}.certificate.xz: {said}")


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    os.chdir(FOLDER)
    if "--all" not in sys.argv:
        check_sliding(40)
        kinds = max(check_short(name, events) for name, events in SHORT.items())
        check_hostile()
        if kinds < 20:
            fail(f"{kinds} kinds of tampering were tried")
    for name, events in SHIPPED.items():
        check_shipped(name, events, "--all" in sys.argv)


if __name__ == "__main__":
    main()
