"""Other codes' results against those of edmill, and against the physics."""
from __future__ import annotations

import csv
import dataclasses
import json
import os
import pathlib
import tempfile
from collections.abc import Mapping
from decimal import Decimal
from typing import Any

from . import _edmill
from .case import Case, case_of
from .checks import flag, number, place, require, text, whole

LARGEST = 2**63 - 1  #: of counts


class Judgement(dict):
    """The result as in its JSON file; `good` when the logs agree, or break no law."""

    def __init__(self, result: dict[str, Any], code: int):
        super().__init__(result)
        self.code = code  #: the exit code of the command

    @property
    def good(self) -> bool:
        return self.code == 0


def _optional(check, name: str, value: Any, *bounds: Any) -> Any:
    return None if value is None else check(name, value, *bounds)


def _judge(call) -> Judgement:
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "result.json"
        code = call(str(file))
        return Judgement(json.loads(file.read_text(encoding="utf-8")), code)


def compare(a: str | os.PathLike, b: str | os.PathLike, *, tolerance: float = 1e-9, events: int | None = None,
            start: float | None = None, end: float | None = None, batch: float | None = None) -> Judgement:
    """As `edmill compare`: two folders of runs, or logs; `a` is the reference. Times in s."""
    a, b = place("a", a), place("b", b)
    tolerance = number("tolerance", tolerance)
    events = _optional(whole, "events", events, 1, LARGEST)
    start, end, batch = (_optional(number, n, v) for n, v in (("start", start), ("end", end), ("batch", batch)))
    return _judge(lambda file: _edmill.compare(a, b, file, tolerance, events, start, end, batch))


def audit(case: Case | Mapping | str | os.PathLike, log: str | os.PathLike, *, columns: Mapping[str, str] | None = None,
          tolerance: float | None = None, gap_tolerance: float | None = None, first_ball: int | None = None,
          walls: str = "", from_start: bool = False, identify: bool = False) -> Judgement:
    """As `edmill audit`: the log of any code, against the physics of the case. `columns` has our name of each of its
    columns and theirs, with a unit: {"time": "t [ms]"}. With `identify` the result's entry "identified" has the values or
    mistakes that explain the violations."""
    case, log = case_of(case), place("log", log)
    tolerance = _optional(number, "tolerance", tolerance)
    gap_tolerance = _optional(number, "gap_tolerance", gap_tolerance)
    first_ball = _optional(whole, "first_ball", first_ball, 0, 1000000000)
    walls, from_start, identify = text("walls", walls), flag("from_start", from_start), flag("identify", identify)
    columns = {} if columns is None else columns
    require("columns", columns, isinstance(columns, Mapping), 'a dictionary {"time": "t [ms]"}')
    given = [f"{text('columns', ours)}={text('columns', theirs)}" for ours, theirs in columns.items()]
    return _judge(lambda file: _edmill.audit(case._case, log, file, given, tolerance, gap_tolerance, first_ball,
                                             walls, from_start, identify))


@dataclasses.dataclass(frozen=True)
class ProvenEvent:
    """An impact that is proven to be the next one; each number is within its radius of what is given. SI."""
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
    bits_left: int  #: of the least known velocity behind the point


def prove(case: Case | Mapping | str | os.PathLike, collisions: int, *, certificate: str | os.PathLike | None = None,
          most_bits: int = 16384) -> Proof:
    """As `edmill prove`: the first events of a case as a theorem, with a certificate that others can check.
    Raises UndecidedError where the equations do not say what comes next."""
    case = case_of(case)
    collisions, most_bits = whole("collisions", collisions, 1, LARGEST), whole("most_bits", most_bits, 128, 1048576)
    file = "" if certificate is None else place("certificate", certificate)
    rows, bits, left = _edmill.prove(case._case, collisions, most_bits, file)
    counts = {"index", "ball", "partner"}
    rows = csv.DictReader(line for line in rows.splitlines() if not line.startswith("#"))
    events = [ProvenEvent(**{k: int(v) if k in counts else v if k == "partner_kind" else Decimal(v) for k, v in row.items()})
              for row in rows]
    return Proof(events, bits, left)
