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
from .case import Case, _toml, case_of
from .checks import place, require, whole
from .tables import Records, Tables
from .values import Value


class Study:
    """The tables of a study: `points` has a row for each point with means and intervals, `tables` all of them."""

    def __init__(self, folder: pathlib.Path, name: str, failed: bool, text: str = ""):
        self.folder, self.failed = folder, failed  #: whether any run failed
        self.text = text  #: what several seeds say together: their dose rate, or each steady state with the number of its runs
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
        return self.text or f"<edmill.Study in {self.folder}: {len(self.points)} points>"


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


def seeds(case: Case, count: int, folder: str | os.PathLike, precision: str | None = None, jobs: int = 0) -> Study:
    """As `edmill run --seeds`: so many runs, with the seed of the case and the next ones. `points` has one row, whose `states` says
    in how many steady states they settle."""
    case, count = case_of(case), whole("count", count, 2, 100000)
    with tempfile.NamedTemporaryFile("w", suffix=".toml", dir=".", encoding="utf-8") as file:
        file.write(case.text)
        file.flush()
        failed, text = _edmill.seeds(file.name, list(case.settings), precision or "", count, str(place("folder", folder)),
                                     whole("jobs", jobs, 0, 4096))
    return Study(pathlib.Path(folder), "seeds", failed, text)


class Variations(dict):
    """Dose rates by what is changed, the case as it is first. `differing` are those that differ from it."""

    def __init__(self, rows, text: str):
        super().__init__({what: None if rate is None else Value(rate, half_width) for what, rate, half_width, _ in rows})
        self.differing = [what for what, *_, differs in rows if differs]
        self.text = text  #: the table of `edmill run --check`

    def __repr__(self) -> str:
        return self.text


def what_decides(case: Case, uncertainty: float = 0.1) -> Variations:
    """As `edmill run --check`: the run again with another seed, half of the least separation speed, and restitution and
    friction changed by their uncertainty."""
    require("uncertainty", uncertainty, isinstance(uncertainty, (int, float)) and 0 < uncertainty <= 1, "a number above 0, 1 at most")
    return Variations(*_edmill.vary(case_of(case)._case, float(uncertainty)))
