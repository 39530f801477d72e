"""Numbers with their intervals."""
from __future__ import annotations

import decimal

from . import _edmill
from .checks import require


class Value(float):
    """A rate of a run, in double: a float with the half-width of its 95 % interval, or None where
    the run is too short for one."""

    half_width: float | None  #: of the 95 % interval, in the same unit

    def __new__(cls, value: float | decimal.Decimal,
                half_width: float | decimal.Decimal | None = None) -> Value:
        made = super().__new__(cls, value)
        made.half_width = None if half_width is None else float(half_width)
        return made

    def __getnewargs__(self):
        return float(self), self.half_width

    @property
    def low(self) -> float | None:
        return None if self.half_width is None else float(self) - self.half_width

    @property
    def high(self) -> float | None:
        return None if self.half_width is None else float(self) + self.half_width

    def differs(self, other: Value) -> bool | None:
        """Whether the 95 % interval of the difference leaves out zero; None where one has no
        interval."""
        require("other", other, isinstance(other, Value),
                "a rate with its interval, such as run.dose_rate")
        if self.half_width is None or other.half_width is None:
            return None
        return abs(float(self) - float(other)) > (self.half_width ** 2 +
                                                  other.half_width ** 2) ** 0.5

    def __repr__(self) -> str:
        return _edmill.with_interval(float(self), self.half_width)
