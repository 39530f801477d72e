"""Many runs of one case."""
from __future__ import annotations

import contextlib
import html
import os
import pathlib
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from . import _edmill
from .case import Case, _toml, case_of
from .checks import flag, place, require, whole
from .runs import Progress
from .tables import Records, Tables
from .values import Value


class Study:
    """The tables of a study: `points` has a row for each point with means and intervals, `tables`
    all of them."""

    def __init__(self, folder: pathlib.Path, name: str, failed: bool, text: str = ""):
        self.folder, self.failed = folder, failed  #: whether any run failed
        self._temporary: Any = None  # a folder that goes with this object
        self.text = text  #: what several seeds say together: their dose rate, or each steady state with the number of its runs
        self.tables = Tables(folder)
        self.points: Records = self.tables[name]
        self.page = folder / f"{name}.html"  #: shows the points with their intervals

    @property
    def runs(self) -> Records:
        """A row for each run."""
        return self.tables["runs"]

    def to_dataframe(self):
        """`points` as a `pandas.DataFrame`, with SI numbers for quantities that vary;
        `attrs["units"]` has the unit of each column."""
        frame = self.points.to_dataframe()
        units = {
            name: field[2].partition(" [")[2][:-1]
            for name, field in self.points.dtype.fields.items() if len(field) > 2
        }
        columns = list(frame.columns)
        for name in columns[2:columns.index("replicas")] if "replicas" in columns else ():
            values = [
                _edmill.in_si(value) if isinstance(value, str) else None for value in frame[name]
            ]
            if values and all(values) and len({unit for _, unit in values}) == 1:
                frame[name] = [number for number, _ in values]
                units[name] = values[0][1]
            elif frame[name].dtype == object:
                with contextlib.suppress(ValueError):
                    frame[name] = frame[name].astype(float)
        frame.attrs["units"] = units
        return frame

    def plot(self, quantity: str = "milling_dose_rate", axes=None):
        """A quantity with its 95 % intervals over the key that varies, in the unit of its values if
        they have one, and a curve for each value of a second key. Returns matplotlib's axes."""
        import matplotlib.pyplot

        frame, typed = self.to_dataframe(), self.points.to_dataframe()
        require("quantity", quantity, quantity in frame.columns, "a column of points")
        axes = matplotlib.pyplot.gca() if axes is None else axes
        columns = list(frame.columns)
        varied = [
            name for name in columns[2:columns.index("replicas")] if frame[name].nunique() > 1
        ] or ["point"]
        varied.sort(key=lambda name: -frame[name].nunique())
        units = frame.attrs["units"]
        parts = [str(value).split(" ", 1) for value in typed[varied[0]]]
        if units.get(varied[0]) and len({part[-1] for part in parts}) == 1:
            frame[varied[0]], units[varied[0]] = [float(part[0]) for part in parts], parts[0][-1]
        others = typed[varied[1:]].apply(
            lambda row: ", ".join(f"{name} = {value}" for name, value in row.items()), axis=1)
        for label in dict.fromkeys(others):
            curve = frame[others == label].sort_values(varied[0])
            widths = curve.get(quantity + "_ci95")
            widths = None if widths is None or widths.isna().all() else widths
            axes.errorbar(curve[varied[0]], curve[quantity], widths, label=label or None,
                          marker="o", capsize=3)
        def title(name):
            return f"{name} [{units[name]}]" if name in units else name

        axes.set(xlabel=title(varied[0]), ylabel=title(quantity))
        if len(varied) > 1:
            axes.legend()
        return axes

    def _repr_html_(self) -> str:
        page = html.escape(self.page.read_text(encoding="utf-8"))
        return f'<iframe srcdoc="{page}" style="width:100%;height:80vh;border:0"></iframe>'

    def __repr__(self) -> str:
        failed = ", some runs failed: see runs[\"message\"]" if self.failed else ""
        return self.text or f"<edmill.Study in {self.folder}: {len(self.points)} points{failed}>"


def _study(work, name: str, source: Any, folder: Any, jobs: int, progress: bool) -> Study:
    folder, jobs, progress = place("folder", folder), whole("jobs", jobs, 0,
                                                            4096), flag("progress", progress)

    def on(file: str) -> Study:
        bar: Any = None

        def show(done: int, total: int) -> None:
            nonlocal bar
            bar = bar or Progress(None if name == "optimize" else total,
                                  "runs")  # an optimisation adds runs
            bar(done)

        try:
            failed = work(file, folder, jobs, show if progress else None)
        finally:
            if bar:
                bar.close()
        return Study(pathlib.Path(folder), name, failed != 0)

    if not isinstance(source, Mapping):
        return on(place("source", source, "a file or a dictionary of its sections"))
    # Paths in a study are relative to its file, so the file is written to the working directory.
    with contextlib.ExitStack() as files:
        def written(text: str, suffix: str) -> str:
            file = files.enter_context(
                tempfile.NamedTemporaryFile("w", suffix=suffix, dir=".", encoding="utf-8"))
            file.write(text)
            file.flush()
            return file.name

        section = source.get(name)
        if isinstance(section, Mapping) and isinstance(section.get("case"), Case):
            case = section["case"]
            source = {
                **source, name: _with_settings({**section, "case": written(case.text, ".toml")},
                                               name, case)
            }
        return on(written(_toml(source), f".{name}.toml"))


def _with_settings(section: dict[str, Any], name: str, case: Case) -> dict[str, Any]:
    """Adds the settings of a case to the grid as single values, except for keys that the study
    varies."""
    settings = dict(setting.split("=", 1) for setting in case.settings)
    if not settings:
        return section
    require("case", case, name == "sweep",
            "a case without settings: an optimisation varies the case file alone")
    points = section.get("point", ())
    varied = {*section.get("grid", {}), *(key for point in points for key in point.get("set", {}))}
    kept = {key: [value.strip('"')] for key, value in settings.items()
            if key not in varied and key not in ("run.seed", "run.precision")}
    for key, (value,) in kept.items():
        require("case", case, not value.lstrip().startswith(("[", "{")),
                f"a case whose {key!r} is in its file: a sweep sets single values")
    return {"seed": int(case._case.text_of("run.seed") or 1), "precision": case.precision,
            **section, "grid": {**section.get("grid", {}), **kept}}


def sweep(source: Case | Mapping | str | os.PathLike, folder: str | os.PathLike | None = None,
          jobs: int = 0, *, over: Mapping[str, Sequence] | None = None, seeds: int | None = None,
          progress: bool = False) -> Study:
    """As `edmill sweep`: every combination of a grid. With `over`, `source` is a case, or its file,
    and `over` has the values of each key: `edmill.sweep(case, over={"mill.speed": ["200 rpm", "300
    rpm"]}, seeds=3).to_dataframe()`, each with `seeds` runs. Without it, `source` is a sweep file
    or a dictionary of its sections, in which `case` may be a Case.

    Runs that the folder has already are not done again; without a `folder` the tables are in a
    temporary one, which is removed with the result.
    `jobs` threads, all cores for 0. `progress`: a bar of tqdm, or a line of text without it."""
    if over is not None:
        require("over", over,
                isinstance(over, Mapping) and len(over) > 0,
                "values by key, {\"mill.speed\": [\"200 rpm\", \"300 rpm\"]}")
        for key, values in over.items():
            require("over", values,
                    isinstance(values, Iterable) and not isinstance(values, (str, bytes)),
                    f"a list of values of {key!r}")
        grid = {
            key: [value.item() if isinstance(value, np.generic) else value for value in values
                 ] for key, values in over.items()
        }
        case = case_of(source)
        source = {
            "sweep": {
                "case": case, "replicas": 1 if seeds is None else whole("seeds", seeds, 1, 100000),
                "grid": grid, "seed": int(case._case.text_of("run.seed") or
                                          1), "precision": case.precision
            }
        }
    else:
        require("source", source, not isinstance(source, Case),
                "a sweep file, or a case together with `over`")
        require("seeds", seeds, seeds is None, "none: a sweep file has `replicas`")
    temporary = tempfile.TemporaryDirectory(prefix="edmill-sweep-") if folder is None else None
    study = _study(_edmill.sweep, "sweep", source, temporary.name if temporary else folder, jobs,
                   progress)
    study._temporary = temporary
    return study


def optimize(source: Mapping | str | os.PathLike, folder: str | os.PathLike, jobs: int = 0, *,
             progress: bool = False) -> Study:
    """As `edmill optimize`."""
    return _study(_edmill.optimize, "optimize", source, folder, jobs, progress)


def seeds(case: Case, count: int, folder: str | os.PathLike, precision: str | None = None,
          jobs: int = 0) -> Study:
    """As `edmill run --seeds`: `count` runs from the case's seed on; the one row of `points` counts
    their steady `states`."""
    case, count = case_of(case), whole("count", count, 2, 100000)
    with tempfile.NamedTemporaryFile("w", suffix=".toml", dir=".", encoding="utf-8") as file:
        file.write(case.text)
        file.flush()
        failed, text = _edmill.seeds(file.name, list(case.settings), precision or "", count,
                                     str(place("folder", folder)), whole("jobs", jobs, 0, 4096))
    return Study(pathlib.Path(folder), "seeds", failed, text)


class Variations(dict):
    """Dose rates by the change, first the unchanged case. `differing` lists the changes whose rates
    differ from it."""

    def __init__(self, rows, text: str):
        super().__init__({
            what: None if rate is None else Value(rate, half_width)
            for what, rate, half_width, _ in rows
        })
        self.differing = [what for what, *_, differs in rows if differs]
        self.text = text  #: the table of `edmill run --check`

    def __repr__(self) -> str:
        return self.text


def what_decides(case: Case, uncertainty: float = 0.1) -> Variations:
    """As `edmill run --check`: runs with another seed, half of the least separation speed,
    uncertain restitution and friction."""
    require("uncertainty", uncertainty,
            isinstance(uncertainty, (int, float)) and 0 < uncertainty <= 1,
            "a number above 0, 1 at most")
    return Variations(*_edmill.vary(case_of(case)._case, float(uncertainty)))
