#!/usr/bin/env python3
"""What a user names as a place for a result: devices, pipes and links are written through, files
are replaced whole.

usage: PYTHONPATH=tests/support python3 named_files_test.py EDMILL
"""
import gzip
import os
import pathlib
import subprocess
import threading

from program import Trials, case, edmill, results, same, shell, start

COMMANDS = {  # each writes its result where it is told by the last argument
    "compare": "compare done done --quiet --json", "audit": "audit case.toml done --quiet --json",
    "check": "check case.toml --draw", "new": "new --force --balls 3x12mm --out",
    "certify": "certify case.toml --collisions 3 --quiet --out",
    "prove": "prove case.toml --collisions 3 --quiet --out",
    "certificate": "prove case.toml --collisions 3 --quiet --certificate"
}


def into_fifo(command, place):
    """What a reader of the pipe gets."""
    got = []
    reader = threading.Thread(target=lambda: got.append(pathlib.Path(place).read_bytes()))
    reader.start()
    done = edmill(*command.split(), place)
    reader.join()
    return done, got[0]


def one_command(t, name, command):
    def write(place, what):
        done = edmill(*command.split(), place)
        t.check(done.returncode == 0, f"{name} to {what}: {done.stderr}")
        return done

    os.mkdir(name)
    os.chdir(name)
    command = command.replace("case.toml", "../case.toml").replace("done", "../done")
    write("plain", "a file")
    expected = pathlib.Path("plain").read_bytes()
    t.check(len(expected) > 100, f"{name}: the result")

    def check(place, what):
        t.check(pathlib.Path(place).read_bytes() == expected, f"{name} to {what}: content")

    write("new/deep/file", "a folder that is made")
    check("new/deep/file", "a folder that is made")
    # Links stay, and lead to the result.
    pathlib.Path("elsewhere").mkdir()
    pathlib.Path("elsewhere/target").write_text("old")
    for link, target in (("link", "elsewhere/target"),
                         ("absolute", os.path.abspath("elsewhere/target")), ("chain", "link"),
                         ("dangling", "elsewhere/absent"), ("chained", "dangling")):
        os.symlink(target, link)
        write(link, link)
        t.check(os.readlink(link) == target, f"{name}: the link {link} stays")
        check(link, link)
        check("elsewhere/absent" if "dangling" in (link, target) else "elsewhere/target",
              f"what {link} points to")
        os.remove("elsewhere/absent" if "dangling" in (link, target) else "elsewhere/target")
    # Devices and pipes stay what they are.
    null = os.stat("/dev/null")
    write("/dev/null", "/dev/null")
    t.check(os.stat("/dev/null").st_rdev == null.st_rdev, "/dev/null is a device")
    os.symlink("/dev/null", "null")
    write("null", "a link to a device")
    t.check(os.path.islink("null"), "the link to a device stays")
    os.mkfifo("pipe")
    for place in ("pipe", "to-pipe"):
        if place == "to-pipe":
            os.symlink("pipe", place)
        done, got = into_fifo(command, place)
        t.check(done.returncode == 0 and got == expected, f"{name} to {place}: {done.stderr}")
    # Standard output, as a pipe and as a file, after and in front of what else is printed there.
    for place in ("/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"):
        t.check(expected.decode() in write(place, place).stdout, f"{name} to {place} in a pipe")
        shell(f"{{ echo first; edmill {command} {place}; echo last; }} > all")
        text = pathlib.Path("all").read_text()
        t.check(
            text.startswith("first\n") and text.endswith("last\n") and expected.decode() in text,
            f"{name} to {place} in a file")
    done = shell(
        f"edmill {command} >(gzip > out.gz); while ! gzip -t out.gz 2>/dev/null; do sleep 0.02; done"
    )
    t.check(done.returncode == 0 and gzip.open("out.gz").read() == expected,
            f"{name} to a process: {done.stderr}")
    # What cannot be written is one message.
    t.refused(edmill(*command.split(), "/dev/full"), f"{name} to /dev/full",
              "/dev/full: could not be written", code=1)
    os.symlink("loop", "pool")
    os.symlink("pool", "loop")
    t.refused(edmill(*command.split(), "loop"), f"{name} to a loop",
              "loop: found a circle of symbolic links")
    t.refused(edmill(*command.split(), "elsewhere"), f"{name} to a folder",
              "elsewhere: found a folder")
    t.refused(edmill(*command.split(), "/proc/nowhere/x"), f"{name} to nowhere", "/proc/nowhere")
    t.refused(edmill(*command.split(), "/dev/fd/77"), f"{name} to a closed descriptor",
              "/dev/fd/77")
    t.no_partials(name)
    os.chdir("..")


def outputs_of_runs(t):
    """Tables, logs and frames whose places are links, pipes or devices."""
    outputs = ("collisions", "events", "spectra", "trends", "paraview", "snapshot", "milling_dose")
    pathlib.Path("all.toml").write_text(case(*outputs))
    edmill("run", "all.toml", "--quiet", "--out", "plain")
    expected = results("plain")
    for folder in ("linked", "big", "big/paraview"):
        os.mkdir(folder)
    links = {
        name: f"../big/{name}" for name in ("collisions.csv", "events.h5", "spectra.h5",
                                            "trends.csv", "paraview", "summary.json")
    }
    for name, target in links.items():
        os.symlink(target, f"linked/{name}")
    for _ in range(2):
        done = edmill("run", "all.toml", "--quiet", "--out", "linked")
        t.check(done.returncode == 0, f"a run into links: {done.stderr}")
        t.check(all(os.readlink(f"linked/{name}") == target for name, target in links.items()),
                "links stay")
        found = {
            name: pathlib.Path("linked", name).read_bytes() for name in expected
            if name != "summary.json"
        }
        t.check(same(found, {name: expected[name] for name in found}) == [], "files behind links")
    piped = ("collisions.csv", "events.h5", "trends.csv")
    os.mkdir("piped")
    for name in piped:
        os.mkfifo(f"piped/{name}")
    readers = {
        name: subprocess.Popen(["cat", f"piped/{name}"], stdout=subprocess.PIPE) for name in piped
    }
    run = start("run", "all.toml", "--quiet", "--out", "piped")
    got = {}
    threads = [
        threading.Thread(target=lambda n=name, r=reader: got.update({n: r.communicate()[0]}))
        for name, reader in readers.items()
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    t.check(run.wait() == 0 and all(got[name] == expected[name] for name in piped),
            "a run into pipes")
    t.refused(edmill("run", "all.toml", "--quiet", "--out", "piped", "--checkpoint", "1 min"),
              "a checkpoint and a pipe", "piped/collisions.csv: found a device or a pipe")
    t.no_partials("outputs")


with Trials() as t:
    pathlib.Path("case.toml").write_text(case("collisions"))
    t.check(edmill("run", "case.toml", "--quiet", "--out", "done").returncode == 0, "the case runs")
    for name, command in COMMANDS.items():
        one_command(t, name, command)
    outputs_of_runs(t)
print(f"{t.checks} checks: named places are replaced whole, or written through")
