"""When and why runs end, and how far they are, whatever shows it."""
import builtins
import os
import signal
import sys
import threading
import types

import pytest

import edmill


@pytest.fixture
def small():
    return edmill.Case.spex8000(balls=5, diameter="9.52 mm", end_time="1 s", start_time="0.1 s")


@pytest.mark.parametrize("speed", ["1054 rpm", "17 Hz", "100 rad/s", "1 Hz"])
@pytest.mark.parametrize("until", [2, 0.3, 1.1, 0.7000001])
def test_a_run_ends_exactly_where_it_is_told_to(speed, until):
    case = edmill.Case.spex8000(balls=2, diameter="9.52 mm", speed=speed, end_time="1 s",
                                start_time="0.1 s")
    run = edmill.run(case, until=f"{until} s", events=True)
    assert (run.time, run.end_reason) == (until, "end_time")
    assert (run.summary["start_time"], run.summary["end_time"]) == (0.1, until)
    assert run.events["time"][-1] <= until


def test_other_rules_end_a_run_before(small):
    run = edmill.run(small.with_settings("run.max_collisions=100"), until="2 s")
    assert run.end_reason == "max_collisions" and run.time == run.events["time"][-1]


def test_a_run_that_control_c_ends_says_so(small, tmp_path):
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(edmill.Interrupted) as interrupted:
        edmill.run(small, until="100000 s", events=False, folder=tmp_path / "run")
    assert interrupted.value.run.end_reason == "interrupted"
    assert '"end_reason": "interrupted"' in (tmp_path / "run/summary.json").read_text()

    def observe(impact, run):
        if impact.index == 200:
            raise KeyboardInterrupt

    with pytest.raises(edmill.Interrupted) as interrupted:
        edmill.run(small, until="100000 s", observers=[observe])
    run = interrupted.value.run
    assert run.end_reason == "interrupted" and len(run.events) == 201
    assert set(run.series) == {"final_state"}  # simulated again, to the same end


class Failing:
    """A bar that fails when it is made, at a show, or when it is closed."""

    def __init__(self, at):
        self.at = at

    def __call__(self, **options):
        if self.at == "made":
            raise ImportError("IProgress not found")
        self.n = 0
        return self

    def set_postfix(self, **values):
        if self.at == "shown":
            raise BrokenPipeError

    refresh = set_postfix

    def close(self):
        if self.at == "closed":
            raise RuntimeError("no widget")


@pytest.mark.parametrize("auto", ["made", "shown", "closed", "absent"])
@pytest.mark.parametrize("plain", ["made", "shown", "absent"])
def test_progress_falls_back_to_text_and_loses_no_run(small, auto, plain, monkeypatch, capsys):
    for name, at in (("tqdm.auto", auto), ("tqdm", plain)):
        module = types.ModuleType(name)
        module.__path__ = []
        module.tqdm = Failing(at)
        monkeypatch.setitem(sys.modules, name, None if at == "absent" else module)
    run = edmill.run(small, until="120 s", events=False, progress=True)
    assert (run.time, run.end_reason) == (120, "end_time")
    if "closed" not in (auto, plain):
        assert " of 120 s, " in capsys.readouterr().err
    rates = edmill.sweep(small, over={"contact.restitution": [0.4, 0.5, 0.6]}, seeds=2,
                         progress=True).points["milling_dose_rate"]
    assert len(rates) == 3 and (rates > 0).all()
    if "closed" not in (auto, plain):
        assert "\r6 of 6 runs\n" in capsys.readouterr().err


def test_progress_without_a_terminal_loses_no_run(small, monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setattr(sys, "stderr", None)
    assert edmill.run(small, until="120 s", events=False, progress=True).time == 120

    def broken(*arguments, **options):
        raise OSError("no device")

    monkeypatch.setattr(builtins, "print", broken)
    assert edmill.run(small, until="120 s", events=False, progress=True).time == 120


def test_what_a_callable_of_ones_own_raises_is_raised(small):
    def fail(time, collisions):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        edmill.run(small, until="120 s", events=False, progress=fail)
