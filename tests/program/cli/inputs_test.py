#!/usr/bin/env python3
"""Cases and logs from pipes, standard input and compressed files are read as from files.

usage: PYTHONPATH=tests/support python3 inputs_test.py EDMILL
"""
import gzip
import json
import os
import pathlib
import random
import subprocess

from program import Trials, case, edmill, results, same, shell

seed = 20110101
rng = random.Random(seed)


def zstd(content):
    return subprocess.run(["zstd", "-q", "-c"], input=content, stdout=subprocess.PIPE,
                          check=True).stdout


def quoted(content):
    """As R and pandas write tables with quotes, here around numbers, too."""
    lines = content.decode().splitlines()
    return "".join((",".join(f'"{cell}"'
                             for cell in line.split(",")) if line[0] != "#" else line) + "\r\n"
                   for line in lines).encode()


def cases(t):
    plain = edmill("check", "case.toml").stdout.replace("case.toml", "NAME")
    for command in ("edmill check - < case.toml", "cat case.toml | edmill check -",
                    "cat case.toml | edmill check /dev/stdin",
                    "edmill check /dev/stdin < case.toml", "edmill check <(cat case.toml)",
                    "edmill check <(gzip -c case.toml)",
                    "edmill check fifo & cat case.toml > fifo; wait $!"):
        if "fifo" in command and not os.path.exists("fifo"):
            os.mkfifo("fifo")
        done = shell(command)
        t.check(done.returncode == 0, f"{command}: {done.stderr}")
        t.check(
            done.stdout.split("\n", 1)[1] == plain.split("\n", 1)[1], f"{command}: what it prints")
    for command, place in (
        ("cat case.toml | edmill run - --quiet",
         "out/stdin"), ("edmill run <(cat case.toml) --quiet", "out/stdin"),
        ("cat case.toml | edmill run /dev/stdin --quiet --report --out piped",
         "piped"), ("edmill run - --quiet --out resumed --checkpoint '10 ms simulated' < case.toml",
                    "resumed")):
        done = shell(command)
        t.check(done.returncode == 0, f"{command}: {done.stderr}")
        found = {
            name: content for name, content in results(place).items()
            if name in results("done") and name not in (".edmill-files", "ro-crate-metadata.json")
        }
        found = {name: content for name, content in found.items() if not name.endswith(".h5")
                }  # they name the case's file
        found["summary.json"] = found["summary.json"].replace(b'"reported": true',
                                                              b'"reported": false')
        t.check(
            len(found) >= 4 and same(found, {name: results("done")[name] for name in found}) == [],
            f"{command}: results")
    # Relative paths count from the working directory.
    text = pathlib.Path("case.toml").read_text().replace(
        "[run]\n", '[run]\ninitial_state = "done/final_state.csv"\ninitial_time = "0.1 s"\n')
    text = text.replace('end_time = "0.1 s"', 'end_time = "0.2 s"')
    os.mkdir("elsewhere")
    pathlib.Path("elsewhere/next.toml").write_text(text)
    t.check(
        shell("edmill check - < elsewhere/next.toml").returncode == 0,
        "an initial state beside the working directory")
    t.refused(edmill("check", "elsewhere/next.toml"), "one that is not beside the file",
              "elsewhere/done/final_state.csv")
    pathlib.Path("next.toml").write_text(text)
    study = pathlib.Path("elsewhere/my.sweep.toml")
    study.write_text('[sweep]\ncase = "case.toml"\nreplicas = 2\n')
    t.check(
        shell("edmill sweep - --quiet --out study < elsewhere/my.sweep.toml").returncode == 0,
        "a sweep from standard input")
    for command in ("edmill check - </dev/null", "edmill check - < .", "edmill check /dev/fd/77"):
        done = shell(command)
        t.check(done.returncode == 2 and done.stderr.count("\n") >= 1,
                f"{command}: {done.returncode} {done.stderr}")


def states(t):
    """An initial state is its content, wherever it comes from."""
    content = pathlib.Path("done/final_state.csv").read_bytes()
    plain = edmill("run", "next.toml", "--quiet", "--out", "next")
    t.check(plain.returncode == 0, plain.stderr)
    expected = results("next")["final_state.csv"]
    pathlib.Path("state.gz").write_bytes(gzip.compress(content))
    pathlib.Path("state.zst").write_bytes(zstd(content))
    pathlib.Path("state.semicolons").write_bytes(content.replace(b",", b";"))
    pathlib.Path("state.tabs").write_bytes(content.replace(b",", b"\t"))
    pathlib.Path("state.quoted").write_bytes(quoted(content))
    for source in ("state.gz", "state.zst", "state.semicolons", "state.tabs", "state.quoted",
                   "<(cat done/final_state.csv)", "/dev/stdin"):
        name = "'\"'\"" + source + "\"'\"'" if not source.startswith("<") else None
        setting = f"run.initial_state=\"'{source}'\"" if not source.startswith("<") else None
        command = (
            f"edmill run next.toml --quiet --out again --set {setting} < done/final_state.csv"
            if setting else
            f"state() {{ edmill run next.toml --quiet --out again --set \"run.initial_state='$1'\"; }}; state {source}"
        )
        done = shell(command)
        t.check(done.returncode == 0, f"an initial state from {source}: {done.stderr}")
        t.check(results("again")["final_state.csv"] == expected, f"an initial state from {source}")
    comma = content.replace(b",", b";").split(b"\n")
    comma[1] = comma[1].replace(b".", b",", 1)
    pathlib.Path("comma.csv").write_bytes(b"\n".join(comma))
    t.refused(edmill("check", "next.toml", "--set", "run.initial_state='comma.csv'"),
              "a decimal comma", "comma.csv:2:", "a decimal point in place of the comma")
    done = shell(
        "edmill run next.toml --quiet --out never --checkpoint 1min --set \"run.initial_state='/dev/stdin'\" < done/final_state.csv"
    )
    t.refused(done, "a checkpoint and an initial state from a pipe", "run.initial_state")


def logs(t):
    content = pathlib.Path("done/collisions.csv").read_bytes()
    packed = {
        "log.gz": gzip.compress(content), "log.zst": zstd(content), "misnamed.csv": zstd(content),
        "members.gz": gzip.compress(content[:1000]) + gzip.compress(content[1000:]) + bytes(512),
        "frames.zst": zstd(content[:1000]) + zstd(content[1000:]),
        "semicolons.csv": content.replace(b",", b";"), "quoted.csv": quoted(content),
        "quoted.gz": gzip.compress(quoted(content).replace(b'","', b'"; "')),
        "tabs.csv": content.replace(b",",
                                    b"\t"), "tabs.gz": gzip.compress(content.replace(b",", b"\t"))
    }
    for name, bytes_ in packed.items():
        pathlib.Path(name).write_bytes(bytes_)
    os.mkdir("packed")
    pathlib.Path("packed/collisions.csv.zst").write_bytes(packed["log.zst"])
    good = [
        *packed, "packed", "<(cat done/collisions.csv)", "<(gzip -c done/collisions.csv)", "-",
        "/dev/stdin", "fifo"
    ]
    for source in good:
        feed = "cat done/collisions.csv > fifo & " if source == "fifo" else ""
        for command in (
                f"{feed}edmill compare done {source} --json c.json < done/collisions.csv",
                f"{feed}edmill audit case.toml {source} --from-start --identify --json a.json < done/collisions.csv"
        ):
            done = shell(command)
            t.check(done.returncode == 0,
                    f"{command}: {done.returncode} {done.stdout} {done.stderr}")
        compared = json.load(open("c.json"))
        t.check(compared["event_by_event"]["agreeing"] == content.count(b"\n") - 1,
                f"{source}: events that agree")
        t.check(
            json.load(open("a.json"))["events"] == content.count(b"\n") - 1,
            f"{source}: audited events")
    # A number with a comma says what is wrong with it.
    lines = content.replace(b",", b";").split(b"\n")
    lines[3] = lines[3].replace(b".", b",", 1)
    pathlib.Path("comma.csv").write_bytes(b"\n".join(lines))
    for command in ("compare done comma.csv", "audit case.toml comma.csv"):
        t.refused(edmill(*command.split()), command, "comma.csv:4: column 2 (time)",
                  "a decimal point in place of the comma")
    return packed


def damage(t, packed):
    """Whatever bit is wrong and wherever the data end: one message, or, where the damage is in no
    data, the same events."""
    found = {"refused": 0, "read": 0}
    for name in ("log.gz", "log.zst"):
        whole = packed[name]
        for trial in range(60):
            if trial % 2:
                wrong = whole[:rng.randrange(4, len(whole))]
            else:
                at = rng.randrange(4, len(whole))
                wrong = whole[:at] + bytes([whole[at] ^ 1 << rng.randrange(8)]) + whole[at + 1:]
            pathlib.Path(name).write_bytes(wrong)
            done = edmill("compare", "done", name, "--quiet")
            if done.returncode == 0:
                found["read"] += 1
                t.check(trial % 2 == 0,
                        f"{name}, trial {trial} of seed {seed}: a file that ends early is read")
            else:
                found["refused"] += 1
                t.check(
                    done.returncode == 2 and done.stderr.count("\n") >= 1 and name in done.stderr,
                    f"{name}, trial {trial} of seed {seed}: {done.returncode} {done.stderr}")
                if trial % 2:
                    t.refused(done, f"{name}, trial {trial}", "data", "expected a complete file")
    t.check(found["refused"] > 100, f"damage is found: {found}")


with Trials() as t:
    pathlib.Path("case.toml").write_text(case("collisions", "trends", "events"))
    t.check(edmill("run", "case.toml", "--quiet", "--out", "done").returncode == 0, "the case runs")
    cases(t)
    states(t)
    damage(t, logs(t))
print(f"{t.checks} checks of inputs, seed {seed}")
