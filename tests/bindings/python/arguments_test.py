"""Every argument of every public function, with values of wrong types: one error that names it, and
no run."""
import decimal

import numpy as np
import pytest

import edmill

CASE = edmill.Case.spex8000(balls=2, diameter="9.52 mm", end_time="0.6 s")
NOTHING = object()
WRONG = {  # of each kind of argument: values that it is not
    "case": [5, 5.5, None, [], True, NOTHING, b"x"],
    "text": [5, None, [], {}, True, NOTHING, b"x"],
    "texts": [5, None, True, NOTHING, "run.seed=2", b"x", [5], [None], [b"x"], [["run.seed=2"]]],
    "place": [5, 5.5, None, [], {}, True, NOTHING, b"x", ""],
    "flag": [5, 0, None, [], "yes", "False", NOTHING],
    "whole": [5.5, "3", None, [], {}, True, -1, NOTHING, float("nan")],
    "number": ["0.1", [], {}, True, -1, NOTHING, float("nan"), float("inf"), 1j],
    "time": [[], {}, True, NOTHING, b"2 s", 1j],
    "calls": [5, True, [5], ["f"], NOTHING],
    "law": [5, "viscoelastic", {}, NOTHING],
    "progress": [5, None, "yes", [], NOTHING],
    "columns": [5, "time=t", ["time=t"], True, {5: "t"}, {"time": 5}],
}
MAY_BE_NONE = {
    "precision", "until", "folder", "ball_ball_law", "ball_wall_law", "events", "start", "end",
    "batch", "columns", "tolerance", "gap_tolerance", "first_ball", "certificate"
}


def run(**given):
    return edmill.run(**{"case": CASE, **given})


def audit(**given):
    return edmill.audit(**{"case": CASE, "log": "no_such.csv", **given})


def compare(**given):
    return edmill.compare(**{"a": "no_such", "b": "no_such", **given})


def prove(**given):
    return edmill.prove(**{"case": CASE, "collisions": 1, **given})


ARGUMENTS = [(edmill.Case, "case", "case"),
             (lambda settings: edmill.Case({"run": {}}, settings), "settings", "texts"),
             (lambda setting: CASE.with_settings(setting), "settings", "text"),
             (edmill.Case.parse, "text", "text"),
             (lambda name: edmill.Case.parse("", name), "name", "text"),
             (lambda case: run(case=case), "case", "case"),
             (lambda precision: run(precision=precision), "precision", "text"),
             (lambda until: run(until=until), "until", "time"),
             (lambda folder: run(folder=folder), "folder", "place"),
             (lambda events: run(events=events), "events", "flag"),
             (lambda report: run(report=report), "report", "flag"),
             (lambda observers: run(observers=observers), "observers", "calls"),
             (lambda law: run(ball_ball_law=law), "ball_ball_law", "law"),
             (lambda law: run(ball_wall_law=law), "ball_wall_law", "law"),
             (lambda progress: run(progress=progress), "progress", "progress"),
             (edmill.report, "folder", "place"), (lambda a: compare(a=a), "a", "place"),
             (lambda b: compare(b=b), "b", "place"),
             (lambda tolerance: compare(tolerance=tolerance), "tolerance", "number"),
             (lambda events: compare(events=events), "events", "whole"),
             (lambda start: compare(start=start), "start", "number"),
             (lambda end: compare(end=end), "end", "number"),
             (lambda batch: compare(batch=batch), "batch", "number"),
             (lambda case: audit(case=case), "case", "case"),
             (lambda log: audit(log=log), "log", "place"),
             (lambda columns: audit(columns=columns), "columns", "columns"),
             (lambda tolerance: audit(tolerance=tolerance), "tolerance", "number"),
             (lambda tolerance: audit(gap_tolerance=tolerance), "gap_tolerance", "number"),
             (lambda ball: audit(first_ball=ball), "first_ball", "whole"),
             (lambda walls: audit(walls=walls), "walls", "text"),
             (lambda flag: audit(from_start=flag), "from_start", "flag"),
             (lambda flag: audit(identify=flag), "identify", "flag"),
             (lambda case: prove(case=case), "case", "case"),
             (lambda collisions: prove(collisions=collisions), "collisions", "whole"),
             (lambda bits: prove(most_bits=bits), "most_bits", "whole"),
             (lambda file: prove(certificate=file), "certificate", "place"),
             *((lambda source, f=f: f(source, "nowhere"), "source", "case")
               for f in (edmill.sweep, edmill.optimize)),
             *((lambda folder, f=f: f({}, folder), "folder", "place")
               for f in (edmill.sweep, edmill.optimize)),
             *((lambda jobs, f=f: f({}, "nowhere", jobs), "jobs", "whole")
               for f in (edmill.sweep, edmill.optimize)),]


@pytest.mark.parametrize("call, name, kind", ARGUMENTS)
def test_a_wrong_type_is_named_with_what_is_expected(call, name, kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for value in WRONG[kind]:
        if value is None and name in MAY_BE_NONE:
            continue
        with pytest.raises(edmill.InputError) as error:
            call(value)
        text = str(error.value)
        assert text.startswith(f"{name}: found ") and ", expected " in text and "\n" not in text, (
            value, text)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("key", [
    "balls", "diameter", "density", "speed", "vessel_diameter", "vessel_height", "restitution",
    "friction", "gravity", "end_time", "start_time", "seed", "output", "powder"
])
def test_a_wrong_value_of_a_case_is_named_by_its_key(key):
    for value in (NOTHING, True, 1j, float("nan"), b"x", "nonsense", {"nonsense": 1}, None, {5: 1}):
        with pytest.raises(edmill.InputError, match="found"):
            edmill.Case.spex8000(**{key: value})


def test_seeds_are_numbers(tmp_path, demo):
    for value in ("1", "one", [1], 1.5, -1):
        with pytest.raises(edmill.InputError, match="run.seed"):
            edmill.Case.spex8000(seed=value)
        sweep = {
            "sweep": {"case": str(demo), "seed": value, "grid": {"contact.restitution": [0.3]}}
        }
        with pytest.raises(edmill.InputError, match="sweep.seed"):
            edmill.sweep(sweep, tmp_path / "sweep")


def test_an_unknown_precision_is_told_with_those_there_are():
    for precision in ("half", "", "Double"):
        with pytest.raises(edmill.InputError, match="precision: found .*expected double, float128"):
            run(precision=precision)


@pytest.mark.parametrize("until", ["0.7 s", "700 ms", 0.7, np.float64(0.7), decimal.Decimal("0.7")])
def test_times_are_taken_as_texts_and_as_any_number(until):
    assert run(until=until).time == 0.7


@pytest.mark.parametrize(
    "until",
    ["-1 s", -1, "0.7", "abc", "0,7 s",
     float("nan"), float("inf"), "", "0.1 s"])
def test_times_that_are_none_are_told_with_the_key(until):
    with pytest.raises(edmill.InputError, match="run.end_time"):
        run(until=until)
