#!/usr/bin/env python3
"""A folder has one writer at a time: of several runs that start at once one wins, and the others
are refused.

usage: PYTHONPATH=tests/support python3 one_writer_test.py EDMILL NO_LOCKS [TRIALS]    NO_LOCKS is a
    library that takes locks from file systems
"""
import fcntl
import os
import pathlib
import shutil
import subprocess
import sys

import h5py
from program import Trials, case, edmill, results, start, summary

no_locks = os.path.realpath(sys.argv[2])
trials = int(sys.argv[3]) if len(sys.argv) > 3 else 10

STUDY = '[{kind}]\ncase = "case.toml"\n{rest}'


def seed_of(place):
    """The one seed that all files of a folder show."""
    said = summary(place)
    with h5py.File(place / "events.h5") as file:
        seeds = {said["seed"], int(file.attrs["seed"])}
        rows = file["events/time"].shape[0]
    seeds.add(int(
        next(setting for setting in said["settings"] if "seed" in setting).split("=")[-1]))
    logged = sum(1 for _ in open(place / "collisions.csv")) - 1
    return seeds.pop(
    ) if len(seeds) == 1 and rows == logged == said["impacts_since_start"] else None


def at_once(t, trial):
    place = pathlib.Path(f"at-once-{trial}")
    checkpoint = [[], ["--checkpoint", "0.2 s simulated"]][trial % 2]
    runs = {
        seed: start("run", "long.toml", "--quiet", "--out", place, "--set", f"run.seed={seed}",
                    *checkpoint, stderr=subprocess.PIPE, text=True) for seed in (11, 12, 13)
    }
    ends = {seed: (run.communicate()[1], run.returncode) for seed, run in runs.items()}
    won = [seed for seed, (_, code) in ends.items() if code == 0]
    t.check(len(won) == 1, f"trial {trial}: one run wins: {ends}")
    for seed, (error, code) in ends.items():
        t.check(
            seed in won or (code == 2 and error.count("\n") == 1 and
                            f"{place}: another process is writing there" in error),
            f"trial {trial}: {error}")
    t.check(seed_of(place) == won[0], f"trial {trial}: files of one seed")
    t.no_partials(f"trial {trial}", place)
    shutil.rmtree(place)


def writers(place):
    """Every command that writes into a folder."""
    named = ["compare done done --json", "audit case.toml done --json", "check case.toml --draw",
             "certify case.toml --collisions 3 --out", "prove case.toml --collisions 3 --out",
             "prove case.toml --collisions 3 --certificate"]
    return [
        f"run case.toml --out {place}", f"run case.toml --checkpoint 1min --out {place}",
        f"demo --out {place}", f"report {place}", f"sweep my.sweep.toml --out {place}",
        f"optimize my.optimize.toml --out {place}",
        *(f"{command} {place}/result" for command in named)
    ]


def every_writer_is_kept_out(t):
    for place in ("done", "interrupted"):
        before = results(place)
        lock = os.open(place, os.O_RDONLY)
        fcntl.flock(lock, fcntl.LOCK_EX)
        for command in [*writers(place), *([f"resume {place}"] if place == "interrupted" else [])]:
            t.refused(edmill(*command.split()), command,
                      f"{place}: another process is writing there")
            t.check(results(place) == before, f"{command}: files of the folder")
        os.close(lock)
    before = results("interrupted")
    for command in writers("interrupted")[:6]:
        if not command.startswith("report"):
            t.refused(edmill(*command.split()), command,
                      "interrupted/checkpoint: this folder has an unfinished run")
            t.check(results("interrupted") == before, f"{command}: files beside a checkpoint")
    t.check(
        edmill("resume", "interrupted", "--quiet").returncode == 0, "the interrupted run resumes")


def file_systems_without_locks(t):
    """NFS has no locks of folders, but of files; some file systems have none at all, which is
    said."""
    def limited(what, *arguments):
        return edmill(*arguments, env=dict(os.environ, LD_PRELOAD=no_locks, NO_LOCKS=what))
    os.mkdir("nfs")
    lock = os.open("nfs/.edmill-lock", os.O_RDWR | os.O_CREAT)
    fcntl.flock(lock, fcntl.LOCK_EX)
    t.refused(limited("folders", "run", "case.toml", "--quiet", "--out", "nfs"), "NFS",
              "nfs: another process is writing there")
    os.close(lock)
    done = limited("folders", "run", "case.toml", "--quiet", "--out", "nfs")
    t.check(done.returncode == 0 and done.stderr == "", f"NFS: {done.stderr}")
    done = limited("all", "run", "case.toml", "--quiet", "--out", "none")
    t.check(done.returncode == 0 and "none: this file system has no locks" in done.stderr,
            f"no locks: {done.stderr}")
    # HDF5 locks what it writes, unless it is told not to.
    pathlib.Path("hdf5.toml").write_text(case("events", "spectra", "milling_dose"))
    pathlib.Path("hdf5.sweep.toml").write_text(
        '[sweep]\ncase = "hdf5.toml"\n[sweep.grid]\n"contact.restitution" = [0.5]\n')
    for what in ("folders", "all"):
        done = limited(what, "run", "hdf5.toml", "--quiet", "--out", f"hdf5-{what}")
        t.check(done.returncode == 0 and done.stderr.count("\n") == (what == "all"),
                f"HDF5 without locks: {done.stderr}")
        t.check(pathlib.Path(f"hdf5-{what}/events.h5").stat().st_size > 1000, "the events")
        done = limited(what, "sweep", "hdf5.sweep.toml", "--quiet", "--out", f"sweep-{what}")
        t.check(done.returncode == 0, f"a sweep without locks: {done.stderr}")


with Trials() as t:
    pathlib.Path("long.toml").write_text(
        case("collisions", "events", "spectra", "paraview", "milling_dose", end="3 s"))
    pathlib.Path("case.toml").write_text(case("collisions"))
    pathlib.Path("my.sweep.toml").write_text(STUDY.format(kind="sweep", rest="replicas = 2"))
    pathlib.Path("my.optimize.toml").write_text(
        STUDY.format(
            kind="optimize", rest=
            'objective = "milling_dose_rate"\nruns_max = 4\nreplicas_first = 2\nreplicas_max = 2\npoints = 2\n'
            'refinements = 0\n[[optimize.variable]]\nkey = "contact.restitution"\nlow = 0.4\nhigh = 0.6'
        ))
    t.check(edmill("run", "case.toml", "--quiet", "--out", "done").returncode == 0, "the case runs")
    # A file size limit ends it after its first checkpoints.
    import resource
    edmill("run", "long.toml", "--quiet", "--out", "interrupted", "--checkpoint", "0.1 s simulated",
           preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000)))
    t.check(os.path.exists("interrupted/checkpoint"), "a checkpoint is left")
    every_writer_is_kept_out(t)
    file_systems_without_locks(t)
    for trial in range(trials):
        at_once(t, trial)
print(f"{trials} trials of three runs at once, {t.checks} checks: one writer at a time")
