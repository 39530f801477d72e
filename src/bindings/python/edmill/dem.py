"""Decks for DEM codes, their dumps, and the limit of contacts of no duration."""
from __future__ import annotations

import dataclasses
import json
import os
import pathlib
from collections.abc import Iterable, Mapping
from typing import Any

from . import _edmill
from .case import Case, case_of
from .checks import flag, number, place, require, text, whole

CODES = ("lammps", "liggghts", "yade")


@dataclasses.dataclass(frozen=True)
class Deck:
    """A case as the input of a DEM code."""
    files: dict[str, str]  #: name and text; the first is the one to run
    command: str  #: that runs it
    notes: list[str]  #: differences from the case

    def write(self, folder: str | os.PathLike = ".") -> list[pathlib.Path]:
        """Writes the files into a folder, which is made when absent."""
        root = pathlib.Path(place("folder", folder))
        root.mkdir(parents=True, exist_ok=True)
        paths = [root / name for name in self.files]
        for path, content in zip(paths, self.files.values()):
            path.write_text(content)
        return paths


def export(case: Case | Mapping | str | os.PathLike, to: str, *, name: str = "deck",
           contact_time: float = 50e-6, contact_speed: float = 1.0, duration: float | None = None,
           frames: float | None = None, steps: int = 50, facets: int | None = None) -> Deck:
    """As `edmill export`: a deck for "lammps", "liggghts" or "yade". Times in s, the speed in
    m/s."""
    case = case_of(case)
    require("to", to, to in CODES, '"lammps", "liggghts" or "yade"')
    name = text("name", name)
    require("name", name, bool(name) and not set(name) & set("/ \t'\""), "a plain file name")
    times = {
        "contact_time": contact_time, "contact_speed": contact_speed, "duration": duration,
        "frames": frames
    }
    for key, value in times.items():
        require(key, value, value is None or number(key, value) > 0, "a number above 0")
    files, command, notes = _edmill.deck(case._case, to, name, contact_time, contact_speed,
                                         duration, frames, whole("steps", steps, 10, 10000),
                                         0 if facets is None else whole("facets", facets, 8, 4096))
    return Deck(dict(files), command, notes)


def import_dump(case: Case | Mapping | str | os.PathLike, dump: str | os.PathLike,
                out: str | os.PathLike, *, deck: str | os.PathLike | None = None,
                timestep: float | None = None, units: str | None = None,
                in_vessel: bool = False) -> dict[str, Any]:
    """As `edmill import`: the frames of a dump become the log of contacts `out`, which `audit`,
    `compare` and `limit` read. The result has `frames`, `contacts`, `first`, `last` [s],
    `milling_dose` [J] and `classes`, each with its number and dose."""
    if timestep is not None:
        require("timestep", timestep, number("timestep", timestep) > 0, "a number above 0")
    if units is not None:
        require("units", units, units in ("si", "cgs", "micro", "nano"),
                '"si", "cgs", "micro" or "nano"')
    return _edmill.import_dump(
        case_of(case)._case, place("dump", dump), place("out", out),
        "" if deck is None else place("deck", deck), timestep, units, flag("in_vessel", in_vessel))


def limit(logs: Iterable[str | os.PathLike], edmill: str | os.PathLike | None = None, *,
          start: float = 0.0) -> dict[str, Any]:
    """As `edmill limit`: the dose rate of contacts of no duration, from logs of several contact
    times; as the command's JSON."""
    listed = [place("logs", log) for log in logs]
    require("logs", listed, len(listed) >= 2, "two logs or more")
    return json.loads(
        _edmill.limit(listed, "" if edmill is None else place("edmill", edmill),
                      number("start", start)))
