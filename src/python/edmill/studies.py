"""Many runs of one case."""
from __future__ import annotations

import os
import pathlib
import tempfile
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _edmill
from .case import _toml
from .checks import place, whole
from .tables import Tables


class Study:
    """The tables of a study: `points` has a row for each point with means and intervals, `tables` all of them."""

    def __init__(self, folder: pathlib.Path, name: str, failed: bool):
        self.folder, self.failed = folder, failed  #: whether any run failed
        self.tables = Tables(folder)
        self.points: np.ndarray = self.tables[name]

    def __repr__(self) -> str:
        return f"<edmill.Study in {self.folder}: {len(self.points)} points>"


def _study(work, name: str, source: Any, folder: Any, jobs: int) -> Study:
    folder, jobs = place("folder", folder), whole("jobs", jobs, 0, 4096)

    def on(file: str) -> Study:
        code = work(file, folder, jobs)
        return Study(pathlib.Path(folder), name, code != 0)

    if not isinstance(source, Mapping):
        return on(place("source", source, "a file or a dictionary of its sections"))
    document = _toml(source)
    # Paths in a study are those from its file on: they are meant from here on.
    with tempfile.NamedTemporaryFile("w", suffix=f".{name}.toml", dir=".", encoding="utf-8") as file:
        file.write(document)
        file.flush()
        return on(file.name)


def sweep(source: Mapping | str | os.PathLike, folder: str | os.PathLike, jobs: int = 0) -> Study:
    """As `edmill sweep`: every combination of a grid. `source` is a file or a dictionary of its sections. Runs that the
    folder has already are not done again. `jobs` threads, all cores for 0."""
    return _study(_edmill.sweep, "sweep", source, folder, jobs)


def optimize(source: Mapping | str | os.PathLike, folder: str | os.PathLike, jobs: int = 0) -> Study:
    """As `edmill optimize`."""
    return _study(_edmill.optimize, "optimize", source, folder, jobs)
