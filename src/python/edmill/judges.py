"""Other codes' results against those of edmill, and against the physics."""
from __future__ import annotations

import json
import os
import pathlib
import tempfile
from collections.abc import Mapping
from typing import Any

from . import _edmill
from .case import Case


class Judgement(dict):
    """The result as in its JSON file; `good` when the logs agree, or break no law."""

    def __init__(self, result: dict[str, Any], code: int):
        super().__init__(result)
        self.code = code  #: the exit code of the command

    @property
    def good(self) -> bool:
        return self.code == 0


def _judge(call) -> Judgement:
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "result.json"
        code = call(str(file))
        return Judgement(json.loads(file.read_text(encoding="utf-8")), code)


def compare(a: str | os.PathLike, b: str | os.PathLike, *, tolerance: float = 1e-9, events: int | None = None,
            start: float | None = None, end: float | None = None, batch: float | None = None) -> Judgement:
    """As `edmill compare`: two folders of runs, or logs; `a` is the reference. Times in s."""
    return _judge(lambda file: _edmill.compare(os.fspath(a), os.fspath(b), file, tolerance, events, start, end, batch))


def audit(case: Case | Mapping | str | os.PathLike, log: str | os.PathLike, *, columns: Mapping[str, str] | None = None,
          tolerance: float | None = None, gap_tolerance: float | None = None, first_ball: int | None = None,
          walls: str = "", from_start: bool = False) -> Judgement:
    """As `edmill audit`: the log of any code, against the physics of the case. `columns` has our name of each of its
    columns and theirs, with a unit: {"time": "t [ms]"}."""
    given = [f"{ours}={theirs}" for ours, theirs in (columns or {}).items()]
    case = case if isinstance(case, Case) else Case(case)
    return _judge(lambda file: _edmill.audit(case._case, os.fspath(log), file, given, tolerance, gap_tolerance, first_ball,
                                             walls, from_start))
