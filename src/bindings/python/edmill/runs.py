"""Runs of a case and their results, with the types of observers and laws, and progress on a
terminal or in a notebook."""
from __future__ import annotations

import csv
import decimal
import importlib
import json
import pathlib
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Protocol, Union

import numpy as np

from . import _edmill, checks
from .case import Case, case_of
from .checks import require
from .tables import Records, Tables
from .values import Value

#: float in double, with all digits a Decimal in the wider precisions
Number = Union[float, decimal.Decimal]
Vector = tuple[Number, Number, Number]


class Impact(Protocol):
    """The impact that an observer receives, in SI units. The normal points from the partner to the
    ball."""
    index: int  #: from 0
    time: Number
    ball: int
    with_wall: bool
    partner: int  #: number of a ball, or of a wall
    normal: Vector
    approach_speed: Number
    slip_speed: Number  #: before the impact
    separation_speed: Number
    restitution_tangential: Number
    normal_impulse: Number
    tangential_impulse: Number
    milling_dose: Number
    supplied_energy: Number
    wall_work: Number


class Running(Protocol):
    """The run that an observer receives."""
    time: Number  #: [s]
    ball_count: int

    def ball(self, k: int) -> tuple[Vector, Vector, Vector]:
        """Position [m], velocity [m/s] and spin [rad/s] of a ball, inertial. Raises IndexError when
        there is no such ball."""

    def stop(self) -> None:
        """Ends the run after this impact."""


class RestitutionLaw:
    """A law of one function of the approach speed [m/s], with Coulomb friction as in (2.24')."""

    def __init__(self, restitution: Callable[[Number], Number], friction: str,
                 min_tangential: str = "-1"):
        self.restitution, self._friction, self._least = restitution, friction, min_tangential

    def restitution_of_slip(self, normal_change: Number, slip_speed: Number,
                            compliance: Number) -> Number:
        kind = type(slip_speed)
        return max(kind(self._least), 1 - kind(self._friction) * compliance * normal_change /
                   slip_speed) if slip_speed > 0 else kind(0)


class ContactLaw(Protocol):
    """A contact law written in Python. Both functions are called for every impact to which the law
    applies."""

    def restitution(self, approach_speed: Number) -> Number:
        """Normal restitution, from 0 to 1, for an approach speed in m/s."""

    def restitution_of_slip(self, normal_change: Number, slip_speed: Number,
                            compliance: Number) -> Number:
        """e_t, the fraction of the slip that remains after the impact, from -1 to 1. (2.24')

        normal_change  |g_n| + g_n' [m/s]: the normal impulse over the effective mass
        slip_speed     |g_t| [m/s]
        compliance     1 + M/(m_i J_i) + M/(m_j J_j), of a wall 1 + 1/J_i"""


def _line(total: float | None, unit: str):
    """Two functions that show and end a line of text on standard error."""
    of = "" if total is None else f" of {total:g}"

    def show(done: float, collisions: int | None) -> None:
        more = "" if collisions is None else f", {collisions} collisions"
        print(f"\r{done:.3f}".removesuffix(".000") + f"{of} {unit}{more}", end="", file=sys.stderr,
              flush=True)

    return show, lambda: print(file=sys.stderr)


def _bar(module: str, total: float | None, unit: str):
    """Two functions that show and end a bar of tqdm: a widget in a notebook (tqdm.auto), or text
    (tqdm)."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of notebooks without widgets
        bar = importlib.import_module(module).tqdm(total=total, unit=unit, unit_scale=True,
                                                   desc="done")

    def show(done: float, collisions: int | None) -> None:
        bar.n = done
        bar.refresh() if collisions is None else bar.set_postfix(collisions=collisions)

    return show, bar.close


class Progress:
    """Shows what is done of a total, in the first way that works. A way that fails is replaced by
    the next; none ends the work."""

    def __init__(self, total: float | None, unit: str):
        self._ways = [
            lambda: _bar("tqdm.auto", total, unit), lambda: _bar("tqdm", total, unit),
            lambda: _line(total, unit)
        ]
        self._shown: Any = None
        self._do(lambda show, close: None)

    def _do(self, action: Callable[..., object]) -> None:
        while self._shown or self._ways:
            try:
                self._shown = self._shown or self._ways.pop(0)()
                action(*self._shown)
                return
            except Exception:  # of any kind: widgets, terminals and files have many
                self._shown = None

    def __call__(self, done: float, collisions: int | None = None) -> None:
        self._do(lambda show, close: show(done, collisions))

    def close(self) -> None:
        self._ways = []
        self._do(lambda show, close: close())


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a run; `run` holds what it had until then."""

    def __init__(self, run: Run):
        super().__init__(f"interrupted at {run.time} s")
        self.run = run

    def __reduce__(self):
        return Interrupted, (self.run,)


class Run:
    """The result of a run. The numbers of summary.json are attributes: `run.milling_dose_rate` and
    so on.

    In precisions wider than double, numbers of events and states are `decimal.Decimal` with all
    digits."""

    case: Case
    precision: str
    summary: dict[str, Any]  #: summary.json; its keys: the manual, "Files"
    events: Records  #: one row for each impact; empty unless events were asked for
    states: Records  #: position [m], velocity [m/s] and spin [rad/s] of each ball at the end
    time: float | decimal.Decimal  #: at the end [s]
    folder: pathlib.Path | None  #: of its files
    right_digits: int | None  #: of all events and of the state at the end, where digits were asked for

    def __init__(self, case: Case, precision: str, folder: pathlib.Path | None,
                 result: Mapping[str, Any]):
        self.case, self.precision, self.folder = case, precision, folder
        number = float if precision == "double" else decimal.Decimal
        self.summary = json.loads(result["summary"], parse_float=number)
        self.right_digits = self.summary.get("right_digits")
        self.time = result["time"]
        self.events = _array(result["events"], _edmill.event_dtype, number).view(Records)
        self.states = _array(result["states"], _edmill.state_dtype, number).view(Records)
        self._page: str | None = None
        self._series: dict[str, np.ndarray] | None = None
        self._laws: dict[str, Any] = {}  # of Python

    def __getstate__(self) -> dict[str, Any]:
        """Omits laws written in Python, most of which cannot be pickled."""
        return self.__dict__ | {"_laws": None if self._laws else {}}

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_") and "summary" in self.__dict__ and name in self.summary:
            return self.summary[name]
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def __dir__(self):
        return [*super().__dir__(), *self.summary]

    def _value(self, rate: str) -> Value | None:
        number = self.summary.get(rate)
        return None if number is None else Value(number, self.summary["intervals"].get(rate))

    @property
    def dose_rate(self) -> Value | None:
        """Milling dose rate with its 95 % interval [W]; None of a run that ended before its
        start_time."""
        return self._value("milling_dose_rate")

    @property
    def specific_dose_rate(self) -> Value | None:
        """Milling dose rate per mass of the powder [W/kg]; None without powder."""
        return self._value("specific_milling_dose_rate")

    @property
    def wall_power(self) -> Value | None:
        """Work of the walls per time [W]."""
        return self._value("wall_work_rate")

    @property
    def fast_impact_rate(self) -> Value | None:
        """Impacts per second that approach at more than 1 m/s."""
        return self._value("fast_impact_rate")

    @property
    def impact_energy(self) -> float | None:
        """Energy of the approach, M/2 v_n^2, below which impacts other than contacts at rest give
        half of their dose [J]; None without any."""
        return self.summary.get("impact_energy_by_dose", {}).get("median")

    def _rates(self, kind: str) -> dict[str, Value]:
        widths = self.summary["intervals"].get(kind, {})
        return {
            name: Value(rate, widths.get(name)) for name, rate in self.summary[kind].items()
            if rate is not None
        }

    @property
    def collision_rates(self) -> dict[str, Value]:
        """Collisions per second with each partner, and of all: "total". They have no intervals:
        contacts at rest come in bursts."""
        return self._rates("collision_rate")

    @property
    def impact_rates(self) -> dict[str, Value]:
        """Collisions per second that the least separation speed does not decide, with each partner
        and of all, with 95 % intervals."""
        return self._rates("impact_rate")

    @property
    def milling_time(self) -> Value | None:
        """Time to the case's `powder.target_dose` [s]; None without one."""
        target = self.summary.get("target", {})
        time = target.get("milling_time")
        return None if time is None else Value(time, target.get("milling_time_half_width"))

    @property
    def warnings(self) -> list[str]:
        """Reasons to doubt numbers of the run; empty if there are none."""
        return list(self.summary["warnings"].values())

    def _simulate_again(self, folder: str, report: bool) -> None:
        if self._laws is None:
            raise _edmill.InputError(
                "a pickled run with laws of Python is not simulated again: give run() a folder")
        case = self.case
        if self.summary["end_reason"] in ("stopped", "interrupted"):
            impacts = self.summary["impacts_since_start"]
            if impacts == 0:
                raise _edmill.InputError(
                    "the run was ended before its first impact: it has no tables and no report")
            case = case.with_settings(f"run.max_collisions={impacts}")
        run(case, precision=self.precision, folder=folder, report=report, events=False,
            **self._laws)

    @property
    def series(self) -> Mapping[str, np.ndarray]:
        """Tables of the case's outputs by the names of their files, as NumPy structured arrays. A
        run without a folder is simulated again, to the end that it had, when they are first asked
        for."""
        if self.folder is not None:
            return Tables(self.folder)
        if self._series is None:
            with tempfile.TemporaryDirectory() as folder:
                self._simulate_again(folder, False)
                self._series = dict(Tables(pathlib.Path(folder)))
        return self._series

    def report(self) -> str:
        """The run's report, a page of HTML. A run without one is simulated again, to the end that
        it had."""
        if self._page is None:
            with tempfile.TemporaryDirectory() as folder:
                self._simulate_again(folder, True)
                self._page = (pathlib.Path(folder) / "report.html").read_text(encoding="utf-8")
        return self._page

    def _repr_html_(self) -> str:
        import html

        return f'<iframe srcdoc="{html.escape(self.report())}" style="width:100%;height:80vh;border:0"></iframe>'

    def __repr__(self) -> str:
        s = self.summary
        rate = s["milling_dose_rate"]
        counted = ("ended before its start_time" if rate is None else
                   f"{s['collisions']['total']} collisions, {self.dose_rate!r} W")
        return f"<edmill.Run of {self.case!r} in {self.precision} to {self.time} s ({s['end_reason']}): {counted}>"


def _array(rows: Any, dtype: np.dtype, number: type) -> np.ndarray:
    """An array of events or states. In double the rows are an array already; wide numbers become
    objects."""
    if isinstance(rows, np.ndarray):
        return rows
    if number is not float:
        dtype = np.dtype([(name, object if dtype[name].base.kind == "f" else dtype[name].base,
                           dtype[name].shape) for name in dtype.names])
    return np.array(rows, dtype=dtype)


def _law_of(name: str, law: Any, case: Case) -> ContactLaw | None:
    """Returns a law unchanged, or makes one from a function that gives the restitution, with the
    friction of the case."""
    if law is None or all(
            callable(getattr(law, method, None))
            for method in ("restitution", "restitution_of_slip")):
        return law
    require(
        name, law, callable(law),
        "a function of the approach speed, or an object with restitution(approach_speed) and "
        "restitution_of_slip(normal_change, slip_speed, compliance)")

    def own(key: str) -> str | None:
        return case._case.text_of(
            f"contact.{name.removesuffix('_law')}.{key}") or case._case.text_of(f"contact.{key}")

    friction = own("friction")
    require(name, law, friction is not None,
            "a whole law: the case has no friction for all of these contacts")
    return RestitutionLaw(law, friction, own("min_tangential") or "-1")


def run(case: Case | Mapping | str, precision: str | None = None,
        until: str | float | decimal.Decimal | None = None, *, digits: int | None = None,
        folder: str | pathlib.Path | None = None, events: bool = True, report: bool = False,
        observers: Iterable[Callable[[Impact, Running], object]] = (),
        ball_ball_law: ContactLaw | Callable[[Any], Any] | None = None,
        ball_wall_law: ContactLaw | Callable[[Any], Any] | None = None,
        until_precision: float | str | None = None, checkpoint: str | None = None,
        progress: bool | Callable[[float, int], Any] = False) -> Run:
    """Simulates a case, without Python's lock.

    precision      double, float128, mpfr50, mpfr100, mpfr200, or mpfr:DIGITS with any number of
                   digits (default: that of the case)
    until          where the run ends, in place of the case's `end_time`: "2 s", or a number [s]
    folder         where the outputs of the case, summary.json and final_state.csv are written
    (default: nowhere) events         whether to keep each impact: 128 bytes each in double
    report         writes report.html into `folder`, with the outputs that it shows observers
    callables of an impact and the run, called after each impact: 1 us each, where the engine takes
    as long for a whole impact. `run.stop()` ends the run.
    ball_ball_law, ball_wall_law
                   a function, the restitution of an approach speed, with the friction of the case;
                   or objects with `restitution(approach_speed)` and
                   `restitution_of_slip(normal_change, slip_speed, compliance)`. In place of the
                   case's laws; slow, unlike the laws that a case names until_precision
                   ends the run when the 95 % interval of the dose rate is this part of it, 0.01 or
                   "1%"; `until` is the limit (default: 100 times the case's end_time)
    digits         every event and number correct to this many digits: the precision is chosen for
    it, and verified by a wider run checkpoint     how often to save the state in `folder`, "10 min"
    or "2 s simulated", so that `resume(folder)` can go on; such a run has no events, observers or
    laws of Python
    progress       True for a bar of tqdm, or a line of text without it; or a callable of time [s]
                   and number of collisions, ten times a second

    Raises `InputError`, `UndecidedError` when no precision decides, and `Interrupted` on Ctrl-C."""
    case = case_of(case)
    if until is not None:
        require("until", until,
                isinstance(until, str) or checks.is_number(until),
                'a time such as "2 s", or a number of seconds')
        case = case.with_settings(
            f"run.end_time={json.dumps(until if isinstance(until, str) else f'{until} s')}")
    if until_precision is not None:
        case = _until_precision(case, until_precision, until is not None)
    if digits is not None:
        require("precision", precision, precision is None, "none beside digits")
        case = case.with_settings(f"run.digits={checks.whole('digits', digits, 1, 100_000)}")
    the_case = case._case
    if precision is None and the_case.digits is not None:
        precision, the_case = _edmill.find_digits(the_case)
    precision = case.precision if precision is None else checks.scalar("precision", precision)
    folder = None if folder is None else checks.place("folder", folder)
    events, report = checks.flag("events", events), checks.flag("report", report)
    require("folder", folder, folder is not None or not report, "one to write the report into")
    require("observers", observers, isinstance(observers, Iterable), "a list of callables")
    observers = list(observers)
    for observer in observers:
        require("observers", observer, callable(observer), "callables of an impact and the run")
    ball_ball_law, ball_wall_law = _law_of("ball_ball_law", ball_ball_law,
                                           case), _law_of("ball_wall_law", ball_wall_law, case)
    require("progress", progress,
            isinstance(progress, bool) or callable(progress), "True, False or a callable")
    if checkpoint is not None:
        require("checkpoint", checkpoint, isinstance(checkpoint, str), 'a text such as "10 min"')
        require("folder", folder, folder is not None, "one for the checkpoints")
        require("observers", observers, not observers and ball_ball_law is None and
                ball_wall_law is None, "none, and no laws of Python, in a run with checkpoints")
        _edmill.run_with_checkpoints(the_case, precision, folder, report, checkpoint)
        return read_run(folder)
    show = Progress(case.end_time, "s") if progress is True else progress or None
    try:
        result = _edmill.run(the_case, precision, folder or "", events, report, observers,
                             ball_ball_law, ball_wall_law, show)
    finally:
        if isinstance(show, Progress):
            show.close()
    done = Run(case, precision, None if folder is None else pathlib.Path(folder), result)
    laws = {"ball_ball_law": ball_ball_law, "ball_wall_law": ball_wall_law}
    done._laws = {name: law for name, law in laws.items() if law is not None}
    if result["interrupted"]:
        raise Interrupted(done)
    return done


def _until_precision(case: Case, wanted: float | str, limited: bool) -> Case:
    expected = "a part of the dose rate above 0 and below 1, 0.01 or \"1%\""
    try:
        part = float(wanted[:-1]) / 100 if isinstance(
            wanted, str) and wanted.rstrip().endswith("%") else float(wanted)
    except ValueError:
        part = 0.0
    require("until_precision", wanted, not isinstance(wanted, bool) and 0 < part < 1, expected)
    settings = [f"run.dose_rate_precision={part}"]
    if not limited and case.end_time is not None:
        settings.append(f'run.end_time="{100 * case.end_time} s"')
    return case.with_settings(*settings)


def read_run(folder: str | pathlib.Path) -> Run:
    """A run from the folder that it was written into, by this module or by `edmill run`; without
    events."""
    place = pathlib.Path(checks.place("folder", folder))
    files = [place / name for name in ("summary.json", "case.toml", "final_state.csv")]
    try:
        summary, case, table = (file.read_text(encoding="utf-8") for file in files)
    except OSError as error:
        raise _edmill.InputError(
            f"{error.filename}: no readable file, expected one of a run's folder") from None
    facts = json.loads(summary)
    number = float if facts["precision"] == "double" else decimal.Decimal
    states = list(csv.DictReader(table.splitlines()))
    rows = [
        tuple([number(state[f"{field}_{axis}"]) for axis in "xyz"]
              for field in _edmill.state_dtype.names) for state in states
    ]
    made = Case.parse(case, str(files[1]), facts["settings"])
    time = number(json.loads(summary, parse_float=str)["end_time"])
    return Run(
        made, facts["precision"], place, {
            "summary": summary, "time": time, "events": np.empty(0, dtype=_edmill.event_dtype),
            "states": rows
        })


def resume(folder: str | pathlib.Path, checkpoint: str | None = None) -> Run:
    """Continues a run from its checkpoint, as `edmill resume`. `checkpoint`: how often to save
    (default: as before)."""
    place = checks.place("folder", folder)
    require("checkpoint", checkpoint, checkpoint is None or isinstance(checkpoint, str),
            'a text such as "10 min"')
    _edmill.resume(place, checkpoint or "")
    return read_run(place)


def report(folder: str | pathlib.Path, *others: str | pathlib.Path,
           out: str | pathlib.Path = "comparison.html") -> pathlib.Path:
    """As `edmill report`: makes the page of a run's folder; of several, the page `out` that
    compares them. Returns its path."""
    places = [checks.place("folder", one) for one in (folder, *others)]
    if len(places) == 1:
        return pathlib.Path(_edmill.report(places[0]))
    page = checks.place("out", out)
    _edmill.report_of_runs(places, page)
    return pathlib.Path(page)
