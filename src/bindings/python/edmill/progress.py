"""Progress of runs and studies on a terminal or in a notebook."""
from __future__ import annotations

import importlib
import sys
import warnings
from collections.abc import Callable
from typing import Any


def _line(total: float | None, unit: str):
    """Two functions that show and end a line of text on standard error."""
    of = "" if total is None else f" of {total:g}"

    def show(done: float, collisions: int | None) -> None:
        more = "" if collisions is None else f", {collisions} collisions"
        print(f"\r{done:.3f}".removesuffix(".000") + f"{of} {unit}{more}", end="", file=sys.stderr, flush=True)

    return show, lambda: print(file=sys.stderr)


def _bar(module: str, total: float | None, unit: str):
    """Two functions that show and end a bar of tqdm: a widget in a notebook (tqdm.auto), or text (tqdm)."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of notebooks without widgets
        bar = importlib.import_module(module).tqdm(total=total, unit=unit, unit_scale=True, desc="done")

    def show(done: float, collisions: int | None) -> None:
        bar.n = done
        bar.refresh() if collisions is None else bar.set_postfix(collisions=collisions)

    return show, bar.close


class Progress:
    """Shows what is done of a total, in the first way that works. A way that fails is replaced by the next; none ends the work."""

    def __init__(self, total: float | None, unit: str):
        self._ways = [lambda: _bar("tqdm.auto", total, unit), lambda: _bar("tqdm", total, unit), lambda: _line(total, unit)]
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
