"""Cases, everything that a run depends on; commercial mills, new cases for them, and the variables
of outputs."""
from __future__ import annotations

import html
import json
import math
import os
import pathlib
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import _edmill
from .checks import place, require, text as checked_text, texts


def _text_of(value: Any, name: str = "") -> str:
    """A value as TOML. `name` is its key, for messages."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(k)} = {_text_of(v, name)}" for k, v in value.items()) + "}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(_text_of(v, name) for v in value) + "]"
    if isinstance(value, os.PathLike):
        return _text_of(os.fspath(value), name)
    if hasattr(value, "tolist"):  # of NumPy
        return _text_of(value.tolist(), name)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise _edmill.InputError(f"{name}: found {value}, expected a finite number")
        return repr(value)
    return _text_of(str(value))  # a Decimal, a Fraction's text, ...


def _key(key: str) -> str:
    require("key", key, isinstance(key, str), "a text")
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _text_of(key)


def _toml(tree: Mapping[str, Any], path: str = "") -> str:
    """A dictionary as a TOML document: a section for each dictionary in it, a list of sections for
    a list of them."""
    lines, sections = [], []
    for key, value in tree.items():
        name = f"{path}.{_key(key)}" if path else _key(key)
        if isinstance(value, Mapping):
            sections.append(f"\n[{name}]\n{_toml(value, name)}")
        elif isinstance(value,
                        (list, tuple)) and value and all(isinstance(v, Mapping) for v in value):
            sections += [f"\n[[{name}]]\n{_toml(v, name)}" for v in value]
        else:
            lines.append(f"{_key(key)} = {_text_of(value, name)}\n")
    return "".join(lines + sections)


class EditError(_edmill.InputError):
    """Raised for changes that do not give a valid case."""

    def __init__(self, text: str):
        super().__init__(text)
        found = re.finditer(r"key '([^']*)': (?:found (.*?)|missing), expected (.*)", text)
        self.problems = [{"key": m[1], "found": m[2] or "nothing", "expected": m[3]} for m in found]


class Case:
    """A case as its file states it, in exact quantities.

    `source` is a case file's path, or a dictionary of its sections and keys:

        Case({"run": {"end_time": "2 s"}, "mill": {"type": "spex8000"}, "vessel": {...}, ...})

    `settings` are "section.key=value" over it, as `edmill run --set`. Raises `InputError` with
    every problem.
    """

    def __init__(self, source: Mapping[str, Any] | str | os.PathLike, settings: Sequence[str] = ()):
        if isinstance(source, Mapping):
            text, name = _toml(source), "case"
        else:
            path = pathlib.Path(place("case", source, "a file, a dictionary of sections or a Case"))
            try:
                text, name = path.read_text(encoding="utf-8"), str(path)
            except (OSError, UnicodeDecodeError) as error:
                raise _edmill.InputError(f"{path}: {error}") from None
        self._set(text, name, settings)

    @classmethod
    def parse(cls, text: str, name: str = "case.toml", settings: Sequence[str] = ()) -> Case:
        """A case from the text of a case file; `name` is the name of the file in messages."""
        made = cls.__new__(cls)
        made._set(checked_text("text", text), checked_text("name", name), settings)
        return made

    @classmethod
    def spex8000(cls, balls: int = 28, diameter: str = "4.76 mm", *, density: str = "8 g/cm3",
                 speed: str = "1054 rpm", vessel_diameter: str = "38 mm",
                 vessel_height: str = "57 mm", restitution: float | Mapping = 0.53,
                 friction: float = 0.4, gravity: Any = "9.8 m/s2", end_time: str = "10 s",
                 start_time: str = "0.5 s", seed: int = 1, **sections: Any) -> Case:
        """Equal balls in the vial of a SPEX 8000. `sections` are further ones of the case file,
        such as `output`."""
        return cls({
            "run": {
                "seed": seed, "start_time": start_time, "end_time": end_time, "gravity": gravity
            }, "mill": {"type": "spex8000", "speed": speed},
            "vessel": {"type": "cylinder", "diameter": vessel_diameter, "height": vessel_height},
            "contact": {"restitution": restitution, "friction": friction},
            "balls": [{"count": balls, "diameter": diameter, "density": density}], **sections,
        })

    def _set(self, text: str, name: str, settings: Sequence[str]) -> None:
        self._text, self._name, self._settings = text, name, tuple(
            texts("settings", settings, '"section.key=value"'))
        try:
            self._case = _edmill.Case.parse(text, name, list(self._settings))
        except _edmill.InputError as error:
            raise _edmill.InputError(str(error).replace("--set ", "setting ")) from None

    def with_settings(self, *settings: str) -> Case:
        """A copy of the case to which settings "section.key=value" are applied."""
        return Case.parse(self._text, self._name, [*self._settings, *settings])

    def edit(self, changes: Mapping[str, Any] | None = None, **keys: Any) -> Case:
        """The case with other values: `case.edit({"mill.speed": "1000 rpm"}, balls=[{"count": 10,
        "diameter": "12.7 mm"}])`. Raises `EditError`, whose `problems` name each key, what was
        found and what was expected."""
        settings = []
        for key, value in {**(changes or {}), **keys}.items():
            require("key", key,
                    isinstance(key, str) and "=" not in key, "a text such as \"mill.speed\"")
            settings.append(f"{key}={value if isinstance(value, str) else _text_of(value, key)}")
        try:
            return self.with_settings(*settings)
        except _edmill.InputError as error:
            raise EditError(str(error)) from None

    def __contains__(self, key: object) -> bool:
        return isinstance(key, str) and self._case.text_of(key) is not None

    __iter__ = None  # the keys of a case are those of its file: not listed here

    def __getitem__(self, key: str) -> str:
        """The text of a number as the case gives it, with its unit: `case["mill.speed"]` is "1054
        rpm"."""
        value = self._case.text_of(key)
        if value is None:
            raise KeyError(
                f"{key}: the case gives no such number; keys are as in its file, \"mill.speed\", \"balls.0.diameter\""
            )
        return value

    @property
    def text(self) -> str:
        """The case file, without `settings`."""
        return self._text

    @property
    def settings(self) -> tuple[str, ...]:
        return self._settings

    @property
    def digest(self) -> str:
        """SHA-256 of the canonical text: in one precision, cases with the same digest give the same
        bits."""
        return self._case.digest

    @property
    def precision(self) -> str:
        """The scalar in which a run computes, unless it names another."""
        return self._case.precision

    @property
    def ball_count(self) -> int:
        return self._case.ball_count

    @property
    def radii(self) -> np.ndarray:
        """Radii of the balls, in the order of their numbers [m]."""
        return np.array(self._case.balls)[:, 0]

    @property
    def masses(self) -> np.ndarray:
        """Masses of the balls, in the order of their numbers [kg]."""
        return np.array(self._case.balls)[:, 1]

    @property
    def end_time(self) -> float | None:
        """The time at which a run ends [s]; None where other rules end it."""
        return self._case.end_time

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th style='text-align:left'>{html.escape(name)}</th><td style='text-align:left'>{html.escape(value)}</td></tr>"
            for name, value in _edmill.check(self._case))
        return f"<table>{rows}</table>"

    def __repr__(self) -> str:
        return f"<edmill.Case {self._name}: {self.ball_count} balls, digest {self.digest[:12]}>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Case) and self.digest == other.digest

    def __hash__(self) -> int:
        return hash(self.digest)

    def __reduce__(self):
        return Case.parse, (self._text, self._name, self._settings)


def case_of(given: Case | Mapping[str, Any] | str | os.PathLike) -> Case:
    """Returns a case unchanged, or makes one from a file or dictionary."""
    return given if isinstance(given, Case) else Case(given)


def machines() -> dict[str, dict[str, tuple[str, str]]]:
    """Mills by name, each with the keys of its case, their values and sources."""
    return {
        name: {key: (value, source) for key, value, source in rows
              } for name, rows in _edmill.machines()
    }


def new(mill: str = "spex8000", balls: Sequence[str] = (), *, jar: str = "", fill: str = "",
        powder: str = "", bpr: float | str = "", target_dose: str = "", speed: str = "",
        restitution: float | str = "", friction: float | str = "", time: str = "10 s") -> Case:
    """A case of a mill, as `edmill new`: `balls` are "10x12.7mm", or "10x12.7mm:zirconia" (10 of 10
    mm where nothing is given), or "12.7mm" where `fill`, "30%" of the jar, or `powder` and `bpr`,
    their mass over its, say how many."""
    wanted = [
        checked_text("mill", mill),
        texts("balls", balls, '"10x12.7mm"'),
        checked_text("powder", powder),
        checked_text("speed", speed),
        str(restitution),
        str(friction),
        checked_text("target_dose", target_dose),
        checked_text("time", time),
        checked_text("jar", jar),
        checked_text("fill", fill),
        str(bpr)
    ]
    return Case.parse(_edmill.new_case(*wanted), f"{mill}.toml")


def variables() -> list[dict[str, str]]:
    """The variables of an impact that outputs can show: name, unit and meaning."""
    return [{"name": name, "unit": unit, "meaning": meaning}
            for name, unit, meaning in _edmill.variables()]
