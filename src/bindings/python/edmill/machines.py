"""Commercial mills, new cases for them, and the variables of outputs."""
from __future__ import annotations

from collections.abc import Sequence

from . import _edmill
from .case import Case
from .checks import text, texts


def machines() -> dict[str, dict[str, tuple[str, str]]]:
    """Mills by name, each with the keys of its case, their values and sources."""
    return {name: {key: (value, source) for key, value, source in rows} for name, rows in _edmill.machines()}


def new(mill: str = "spex8000", balls: Sequence[str] = (), *, jar: str = "", fill: str = "", powder: str = "", bpr: float | str = "",
        target_dose: str = "", speed: str = "", restitution: float | str = "", friction: float | str = "", time: str = "10 s") -> Case:
    """A case of a mill, as `edmill new`: `balls` are "10x12.7mm", or "10x12.7mm:zirconia" (10 of 10 mm where nothing is given), or
    "12.7mm" where `fill`, "30%" of the jar, or `powder` and `bpr`, their mass over its, say how many."""
    wanted = [text("mill", mill), texts("balls", balls, '"10x12.7mm"'), text("powder", powder), text("speed", speed), str(restitution),
              str(friction), text("target_dose", target_dose), text("time", time), text("jar", jar), text("fill", fill), str(bpr)]
    return Case.parse(_edmill.new_case(*wanted), f"{mill}.toml")


def variables() -> list[dict[str, str]]:
    """The variables of an impact that outputs can show: name, unit and meaning."""
    return [{"name": name, "unit": unit, "meaning": meaning} for name, unit, meaning in _edmill.variables()]
