"""Compares results of other codes with those of edmill and with the physics."""
from __future__ import annotations

import csv
import dataclasses
import itertools
import json
import os
from collections.abc import Iterable, Mapping
from decimal import Decimal
from typing import Any

import numpy as np

from . import _edmill
from .case import Case, case_of
from .checks import flag, number, place, require, scalar, text, whole

LARGEST = 2**63 - 1  #: largest count


class Judgement(dict):
    """The result as in its JSON file; `good` when the logs agree, or break no law."""

    _codes = {"clean": 0, "agree": 0, "agrees": 0, "violations": 6, "differ": 6, "differs": 6}

    @property
    def code(self) -> int:
        """The exit code of the command: 6 for differences or violations, 7 for too few data."""
        return self._codes.get(self["verdict"], 7)

    @property
    def good(self) -> bool:
        return self.code == 0


def _optional(check, name: str, value: Any, *bounds: Any) -> Any:
    return None if value is None else check(name, value, *bounds)


def compare(a: str | os.PathLike, b: str | os.PathLike, *, tolerance: float | None = None,
            events: int | None = None, start: float | None = None, end: float | None = None,
            batch: float | None = None, within: float | None = None) -> Judgement:
    """As `edmill compare`: two folders of runs, or logs; `a` is the reference. Times in s; `within`
    is relative."""
    a, b = place("a", a), place("b", b)
    events = _optional(whole, "events", events, 1, LARGEST)
    start, end, batch = (
        _optional(number, n, v) for n, v in (("start", start), ("end", end), ("batch", batch)))
    tolerance, within = _optional(number, "tolerance",
                                  tolerance), _optional(number, "within", within)
    return Judgement(json.loads(_edmill.compare(a, b, tolerance, events, start, end, batch,
                                                within)))


def audit(case: Case | Mapping | str | os.PathLike, log: str | os.PathLike, *,
          columns: Mapping[str, str] | None = None, tolerance: float | None = None,
          gap_tolerance: float | None = None, first_ball: int | None = None, walls: str = "",
          from_start: bool = False, identify: bool = False) -> Judgement:
    """As `edmill audit`: the log of any code, against the physics of the case. `columns` has our
    name of each of its columns and theirs, with a unit: {"time": "t [ms]"}. The result's entry
    "identified" has the single values or mistakes that explain the violations, with `identify`
    those in parts of the log and two or three together as well."""
    case, log = case_of(case), place("log", log)
    tolerance = _optional(number, "tolerance", tolerance)
    gap_tolerance = _optional(number, "gap_tolerance", gap_tolerance)
    first_ball = _optional(whole, "first_ball", first_ball, 0, 1000000000)
    walls, from_start, identify = text("walls",
                                       walls), flag("from_start",
                                                    from_start), flag("identify", identify)
    columns = {} if columns is None else columns
    require("columns", columns, isinstance(columns, Mapping), 'a dictionary {"time": "t [ms]"}')
    given = [
        f"{text('columns', ours)}={text('columns', theirs)}" for ours, theirs in columns.items()
    ]
    return Judgement(
        json.loads(
            _edmill.audit(case._case, log, given, tolerance, gap_tolerance, first_ball, walls,
                          from_start, identify)))


def check(case: Case | Mapping | str | os.PathLike) -> dict[str, str]:
    """As `edmill check`: the case in SI with its derived numbers, name by name, after all checks
    that a run makes."""
    facts: dict[str, str] = {}
    last = ""
    for name, value in _edmill.check(case_of(case)._case):
        last = name or last
        facts[last] = f"{facts[last]}\n{value}" if last in facts else value
    return facts


@dataclasses.dataclass(frozen=True)
class ProvenEvent:
    """An impact that is proven to be the next one; each true value is within the radius of the
    given number. SI."""
    index: int
    time: Decimal
    time_radius: Decimal
    ball: int
    partner_kind: str  #: "wall" or "ball"
    partner: int
    approach_speed: Decimal
    approach_speed_radius: Decimal
    slip_speed: Decimal
    slip_speed_radius: Decimal


@dataclasses.dataclass(frozen=True)
class Proof:
    """The first events of a case, proven in ball arithmetic."""
    events: list[ProvenEvent]
    bits: int  #: of the arithmetic
    bits_left: int  #: of the least known velocity after the point


@dataclasses.dataclass(frozen=True)
class Agreement:
    """The number of first events that are the same in two scalars, and the digits to which they
    agree."""
    narrow: str
    wide: str
    events: int  #: in common, from the first on
    digits: dict[
        str, float |
        None]  #: by quantity, relative to its largest magnitude; None where no digit differs


@dataclasses.dataclass(frozen=True)
class CertifiedEvent:
    """An impact on which two scalars agree. SI. Numbers have ten digits more than were asked for,
    which are certain."""
    ball: int
    partner_kind: str  #: "wall" or "ball"
    partner: int
    time: Decimal
    approach_speed: Decimal
    slip_speed: Decimal
    milling_dose: Decimal
    wall_work: Decimal


@dataclasses.dataclass(frozen=True)
class Certification:
    """The first events of a case, with the evidence that they are certain."""
    events: list[CertifiedEvent]
    evidence: list[Agreement]  #: the narrowest pair of scalars first; the last one certifies


def _event(kind: type, row: Mapping[str, Any]) -> Any:
    types = {"partner_kind": str, "index": int, "ball": int, "partner": int}
    return kind(**{name: types.get(name, Decimal)(value) for name, value in row.items()})


def certify(case: Case | Mapping | str | os.PathLike, collisions: int | None = None, *,
            digits: int = 25, file: str | os.PathLike | None = None) -> Certification:
    """As `edmill certify`: raises the precision until two scalars agree on the first events, all of
    the case unless `collisions` are given, to `digits` digits. `file` gets the sequence as the
    command writes it. Raises UndecidedError where no two scalars agree."""
    case = case_of(case)
    collisions = 0 if collisions is None else whole("collisions", collisions, 1, LARGEST)
    digits = whole("digits", digits, 1, 100_000)
    evidence, events = _edmill.certify(case._case, collisions, digits,
                                       "" if file is None else place("file", file))
    return Certification([_event(CertifiedEvent, row) for row in events],
                         [Agreement(*row) for row in evidence])


@dataclasses.dataclass(frozen=True)
class Derivative:
    """Derivatives by a parameter of a case or a number of the initial state, SI per its unit; with
    more than 17 digits Decimals."""
    by: str
    unit: str  #: of the parameter as the case has it, "rpm"; empty for a ratio
    quantities: dict[
        str,
        np.ndarray]  #: of time, approach_speed, slip_speed, milling_dose and wall_work, by event
    states: np.ndarray  #: events x 2 bodies x 9: position, velocity and spin after the impact; 0 of a wall


@dataclasses.dataclass(frozen=True)
class Sensitivities:
    """The first events of a case and their derivatives."""
    events: list[CertifiedEvent]
    derivatives: dict[str, Derivative]  #: by number
    precision: str  #: of the run


def sensitivity(case: Case | Mapping | str | os.PathLike, by: Iterable[str], events: int, *,
                digits: int = 17) -> Sensitivities:
    """As `edmill sensitivity`: derivatives of the first events with respect to parameters of the
    case, such as "contact.restitution", and of the initial state, "initial.3.vx". Raises
    UndecidedError where a rule orders two contacts."""
    case = case_of(case)
    require("by", by,
            isinstance(by, Iterable) and not isinstance(by, str),
            'a list of keys, ["contact.restitution"]')
    keys = [text("by", key) for key in by]
    precision, units, rows, found = _edmill.sensitivity(case._case, keys,
                                                        whole("events", events, 1, LARGEST),
                                                        whole("digits", digits, 1, 360))
    names = _edmill.logged_quantities
    number = np.vectorize(float if digits <= 17 else Decimal,
                          otypes=[float if digits <= 17 else object])
    derivatives = {}
    for key, unit, (quantities, states) in zip(keys, units, found):
        columns = number(np.array(quantities, dtype=object).reshape(len(rows), len(names)))
        derivatives[key] = Derivative(
            key, unit, dict(zip(names, columns.T)),
            number(np.array(states, dtype=object).reshape(len(rows), 2, 9)))
    return Sensitivities([_event(CertifiedEvent, row) for row in rows], derivatives, precision)


def estimate(case: Case | Mapping | str | os.PathLike, *, digits: int | None = None,
             precision: str | None = None) -> dict[str, Any]:
    """As `edmill run --estimate`, from trials: events, digits lost per event, precision for
    `digits`, processor time [s], memory [bytes]."""
    case = case_of(case)
    if digits is not None:
        case = case.with_settings(f"run.digits={whole('digits', digits, 1, 100_000)}")
    asked = case._case.digits is not None and precision is None
    return _edmill.estimate(
        case._case,
        "" if asked else case.precision if precision is None else scalar("precision", precision))


@dataclasses.dataclass(frozen=True)
class Shadow:
    """Two runs of a case, in two scalars side by side."""
    events: int  #: in common
    digits: dict[str, float | None]  #: to which these agree, by quantity
    digits_lost_per_event: float | None  #: None where too few events differ
    diverged: tuple[CertifiedEvent, CertifiedEvent] | None  #: the first events that differ
    text: str  #: as the command prints it


def shadow(case: Case | Mapping | str | os.PathLike, wider: str,
           precision: str | None = None) -> Shadow:
    """As `edmill run --shadow`: the case in its scalar, or `precision`, beside a wider one, to
    where they diverge."""
    case = case_of(case)
    precision = case.precision if precision is None else scalar("precision", precision)
    found = _edmill.shadow(case._case, precision, scalar("wider", wider))
    if found["diverged"]:
        found["diverged"] = tuple(_event(CertifiedEvent, row) for row in found["diverged"])
    return Shadow(**found)


def prove(case: Case | Mapping | str | os.PathLike, collisions: int, *,
          certificate: str | os.PathLike | None = None, most_bits: int = 16384) -> Proof:
    """As `edmill prove`: the first events of a case as a theorem, with a certificate that others
    can check. Raises UndecidedError where the equations do not say what comes next."""
    case = case_of(case)
    collisions, most_bits = whole("collisions", collisions, 1,
                                  LARGEST), whole("most_bits", most_bits, 128, 1048576)
    file = "" if certificate is None else place("certificate", certificate)
    rows, bits, left = _edmill.prove(case._case, collisions, most_bits, file)
    rows = csv.DictReader(itertools.dropwhile(lambda line: line.startswith("#"), rows.split("\n")))
    return Proof([_event(ProvenEvent, row) for row in rows], bits, left)


def check_certificate(case: Case | Mapping | str | os.PathLike,
                      certificate: str | os.PathLike) -> list[str]:
    """As `edmill prove --check`: where the header of a certificate differs from the case, a line
    each."""
    return _edmill.check_certificate(case_of(case)._case, place("certificate", certificate))
