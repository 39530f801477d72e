"""Checks of arguments; their messages name the argument, what was found and what is expected."""
from __future__ import annotations

import decimal
import math
import numbers
import operator
import os
from collections.abc import Iterable
from typing import Any

from . import _edmill


def require(name: str, value: Any, good: bool, expected: str) -> None:
    if not good:
        raise _edmill.InputError(f"{name}: found {value!r}, expected {expected}")


def text(name: str, value: Any) -> str:
    require(name, value, isinstance(value, str), "a text")
    return value


def texts(name: str, values: Any, each: str) -> list[str]:
    """A list of texts, but not a single text. `each` describes one of them, for messages."""
    good = isinstance(values, Iterable) and not isinstance(values, (str, bytes))
    require(name, values, good, f"a list of {each}")
    listed = list(values)
    for value in listed:
        require(name, value, isinstance(value, str), f"a text {each}")
    return listed


def place(name: str, value: Any, expected: str = "a path") -> str:
    """The path of a file or folder."""
    path = os.fspath(value) if isinstance(value, (str, os.PathLike)) else None
    require(name, value, isinstance(path, str) and path != "", expected)
    return str(path)


def flag(name: str, value: Any) -> bool:
    require(name, value,
            isinstance(value, bool) or type(value).__name__ in ("bool_", "bool"), "True or False")
    return bool(value)


def whole(name: str, value: Any, low: int, high: int) -> int:
    good = not isinstance(value, bool) and hasattr(
        type(value), "__index__") and low <= operator.index(value) <= high
    require(name, value, good, f"a whole number from {low} to {high}")
    return operator.index(value)


def number(name: str, value: Any) -> float:
    """A finite number, 0 or above."""
    good = is_number(value) and math.isfinite(value) and value >= 0
    require(name, value, good, "a number, 0 or above")
    return float(value)


def is_number(value: Any) -> bool:
    return isinstance(value, (numbers.Real, decimal.Decimal)) and not isinstance(value, bool)


def scalar(name: str, value: Any) -> str:
    """The name of a scalar."""
    require(name, value,
            isinstance(value, str) and _edmill.is_precision(value),
            f"{', '.join(_edmill.precisions)} or mpfr:DIGITS")
    return value
