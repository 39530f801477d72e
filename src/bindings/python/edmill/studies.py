"""Many runs of one case."""
from __future__ import annotations

import contextlib
import html
import os
import pathlib
import tempfile
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _edmill
from .case import Case, _toml
from .checks import place, require, whole
from .tables import Records, Tables


class Study:
    """The tables of a study: `points` has a row for each point with means and intervals, `tables` all of them."""

    def __init__(self, folder: pathlib.Path, name: str, failed: bool):
        self.folder, self.failed = folder, failed  #: whether any run failed
        self.tables = Tables(folder)
        self.points: Records = self.tables[name]
        self.page = folder / f"{name}.html"  #: shows the points with their intervals

    @property
    def runs(self) -> Records:
        """A row for each run."""
        return self.tables["runs"]

    def _repr_html_(self) -> str:
        page = html.escape(self.page.read_text(encoding="utf-8"))
        return f'<iframe srcdoc="{page}" style="width:100%;height:80vh;border:0"></iframe>'

    def __repr__(self) -> str:
        return f"<edmill.Study in {self.folder}: {len(self.points)} points>"


def _study(work, name: str, source: Any, folder: Any, jobs: int) -> Study:
    folder, jobs = place("folder", folder), whole("jobs", jobs, 0, 4096)

    def on(file: str) -> Study:
        code = work(file, folder, jobs)
        return Study(pathlib.Path(folder), name, code != 0)

    if not isinstance(source, Mapping):
        return on(place("source", source, "a file or a dictionary of its sections"))
    # Paths in a study are those from its file on: they are meant from here on.
    with contextlib.ExitStack() as files:
        def written(text: str, suffix: str) -> str:
            file = files.enter_context(tempfile.NamedTemporaryFile("w", suffix=suffix, dir=".", encoding="utf-8"))
            file.write(text)
            file.flush()
            return file.name

        section = source.get(name)
        if isinstance(section, Mapping) and isinstance(section.get("case"), Case):
            case = section["case"]
            source = {**source, name: _with_settings({**section, "case": written(case.text, ".toml")}, name, case)}
        return on(written(_toml(source), f".{name}.toml"))


def _with_settings(section: dict[str, Any], name: str, case: Case) -> dict[str, Any]:
    """What is set over a case becomes values that do not vary, but for keys that the study varies."""
    settings = dict(setting.split("=", 1) for setting in case.settings)
    if not settings:
        return section
    require("case", case, name == "sweep", "a case without settings: an optimisation varies the case file alone")
    points = section.get("point", ())
    varied = {*section.get("grid", {}), *(key for point in points for key in point.get("set", {}))}
    kept = {key: [value.strip('"')] for key, value in settings.items()
            if key not in varied and key not in ("run.seed", "run.precision")}
    return {**section, "grid": {**section.get("grid", {}), **kept}}


def sweep(source: Mapping | str | os.PathLike, folder: str | os.PathLike, jobs: int = 0) -> Study:
    """As `edmill sweep`: every combination of a grid. `source` is a file or a dictionary of its sections, in which
    `case` may be a Case. Runs that the folder has already are not done again. `jobs` threads, all cores for 0."""
    return _study(_edmill.sweep, "sweep", source, folder, jobs)


def optimize(source: Mapping | str | os.PathLike, folder: str | os.PathLike, jobs: int = 0) -> Study:
    """As `edmill optimize`."""
    return _study(_edmill.optimize, "optimize", source, folder, jobs)
