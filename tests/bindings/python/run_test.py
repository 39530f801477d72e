"""Runs from Python against those of the program."""
import decimal
import json
import os
import pickle
import signal
import threading

import numpy as np
import pytest

import edmill


@pytest.fixture
def small():
    return edmill.Case.spex8000(balls=5, diameter="9.52 mm", end_time="1 s")


def test_a_run_is_that_of_the_program(program, demo, tmp_path):
    program("run", demo, "--quiet", "--out", tmp_path / "out", "--set", 'run.end_time="2 s"',
            "--set", 'output=[{type="collisions", file="collisions.csv"}]')
    theirs = edmill.tables.read_table(tmp_path / "out/collisions.csv")
    run = edmill.run(demo, until="2 s")
    assert len(run.events) == len(theirs) > 5000
    for name in ("time", "ball", "approach_speed", "slip_speed", "milling_dose"):
        assert np.array_equal(run.events[name], theirs[name]), name
    summary = json.loads((tmp_path / "out/summary.json").read_text())
    for key, value in run.summary.items():
        if not key.startswith(("cpu", "collisions_per_cpu", "case", "settings")):
            assert value == summary[key], key
    states = edmill.tables.read_table(tmp_path / "out/final_state.csv")
    for k, axis in enumerate("xyz"):
        assert np.array_equal(run.states["position"][:, k], states[f"position_{axis}"])


def test_the_numbers_of_a_run_are_attributes(small):
    run = edmill.run(small)
    assert run.time == 1
    assert run.milling_dose_rate == run.summary["milling_dose_rate"] > 0
    assert run.events["time"][-1] <= 1
    counted = run.events[run.events["time"] >= 0.5]
    assert len(counted) == run.summary["collisions"]["total"]
    assert counted["milling_dose"].sum() == pytest.approx(run.milling_dose, rel=1e-12)
    with pytest.raises(AttributeError):
        run.no_such_number
    assert "collisions" in repr(run)


def test_events_are_not_copied(small):
    events = edmill.run(small).events
    assert not events.flags.owndata and events.base is not None
    assert events.dtype.itemsize == 128 and events.dtype["normal"].shape == (3,)


def test_a_dictionary_is_a_case(demo):
    case = edmill.Case({
        "run": {"start_time": "0.5 s", "end_time": "10 s", "seed": 1,
                "gravity": "9.8 m/s2"}, "mill": {
                    "type": "spex8000", "speed": "1054 rpm", "arm": "10 cm", "theta_max": "15 deg",
                    "gamma_max": "15 deg"
                }, "vessel": {"type": "cylinder", "diameter": "38 mm", "height": "57 mm"},
        "powder": {"mass": "5 g"}, "contact": {
            "model": "walton-braun", "restitution": 0.53, "friction": 0.4,
            "least_separation": "1 cm/s"
        }, "balls": [{"count": 28, "diameter": "4.76 mm", "density": "8 g/cm3"}],
    })
    assert case == edmill.Case(demo)
    assert case.digest == edmill.Case(demo).digest
    assert case != edmill.Case(demo, ["run.seed=2"])


def test_problems_are_told_together():
    with pytest.raises(edmill.InputError) as problems:
        edmill.Case({"run": {"end_time": "2 parsecs"}, "contact": {"friction": -1}})
    assert "parsecs" in str(problems.value) and "friction" in str(problems.value)
    assert issubclass(edmill.InputError, ValueError)
    with pytest.raises(edmill.InputError, match="no_such_file"):
        edmill.Case("no_such_file.toml")
    with pytest.raises(edmill.InputError, match="precision"):
        edmill.run(edmill.Case.spex8000(), precision="half")


def test_runs_and_cases_are_pickled(small):
    run = pickle.loads(pickle.dumps(edmill.run(small)))
    again = edmill.run(pickle.loads(pickle.dumps(small)))
    assert np.array_equal(run.events, again.events) and np.array_equal(run.states, again.states)
    assert run.milling_dose == again.milling_dose


def test_wide_numbers_keep_their_digits(small):
    small = small.with_settings('run.start_time="0 s"')
    double = edmill.run(small, until="0.1 s")
    for precision, digits in (("float128", 33), ("mpfr50", 50)):
        wide = edmill.run(small, precision, until="0.1 s")
        assert isinstance(wide.events["time"][0], decimal.Decimal)
        assert isinstance(wide.milling_dose, (decimal.Decimal, int))
        assert max(len(t.as_tuple().digits) for t in wide.events["time"]) >= digits
        assert float(wide.events["time"][0]) == pytest.approx(double.events["time"][0], rel=1e-13)
        assert np.array_equal(wide.events["ball"][:20], double.events["ball"][:20])


def test_observers_see_each_impact_and_can_stop(small):
    seen = []

    def observe(impact, run):
        seen.append((impact.index, impact.time))
        assert run.time == impact.time and len(run.ball(impact.ball)[0]) == 3
        if len(seen) == 100:
            run.stop()

    run = edmill.run(small, observers=[observe])
    assert run.end_reason == "stopped"
    assert [index for index, _ in seen] == list(range(100))
    assert [time for _, time in seen] == list(run.events["time"])


def test_what_an_observer_raises_is_raised(small):
    def fail(impact, run):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        edmill.run(small, observers=[fail])


class Constant:
    def restitution(self, approach_speed):
        return 0.53

    def restitution_of_slip(self, normal_change, slip_speed, compliance):
        largest = 0.4 * normal_change * compliance / slip_speed if slip_speed > 0 else 2
        return max(1 - largest, 0.4)


def test_laws_are_called(small):
    """The Walton-Braun law with a least tangential restitution of 0.4, as a formula in Python."""
    named = edmill.Case.spex8000(
        balls=5, diameter="9.52 mm", end_time="0.3 s", start_time="0 s", contact={
            "model": "walton-braun", "restitution": 0.53, "friction": 0.4, "min_tangential": 0.4
        })
    ours = edmill.run(named, ball_ball_law=Constant(), ball_wall_law=Constant())
    theirs = edmill.run(named)
    first = 20  # the formula rounds in another order, and differences grow
    assert np.allclose(ours.events["time"][:first], theirs.events["time"][:first], rtol=1e-9,
                       atol=0)
    assert np.allclose(ours.events["milling_dose"][:first], theirs.events["milling_dose"][:first],
                       rtol=1e-6)


@pytest.mark.parametrize("precision", ["double", "float128"])
def test_a_law_of_one_function_has_the_friction_of_the_case(small, precision):
    speeds = []
    def restitution(speed):
        speeds.append(speed)
        return type(speed)("0.53")

    ours = edmill.run(small, precision, until="0.6 s", ball_ball_law=restitution,
                      ball_wall_law=restitution)
    theirs = edmill.run(small, precision, until="0.6 s")
    first = min(20, len(theirs.events))
    assert first > 5 and len(speeds) >= len(ours.events)
    for key in ("time", "milling_dose", "restitution_tangential"):
        assert np.allclose(np.array(ours.events[key][:first], float),
                           np.array(theirs.events[key][:first], float), rtol=1e-6, atol=1e-15), key


def test_a_law_of_one_function_has_the_friction_of_its_contact(small):
    rough = small.edit(
        {"contact.ball_wall.friction": 0.7, "contact.ball_wall.min_tangential": -0.5})
    ours, theirs = edmill.run(rough, until="0.6 s",
                              ball_wall_law=lambda speed: 0.53), edmill.run(rough, until="0.6 s")
    assert np.allclose(ours.events["milling_dose"][:20], theirs.events["milling_dose"][:20],
                       rtol=1e-6)
    assert not np.allclose(ours.events["milling_dose"][:20],
                           edmill.run(small, until="0.6 s").events["milling_dose"][:20], rtol=1e-6)


def test_a_case_has_its_numbers(small):
    assert small["contact.friction"] == "0.4" and small["balls.0.diameter"] == "9.52 mm"
    assert small.edit({"mill.speed": "900 rpm"})["mill.speed"] == "900 rpm"
    with pytest.raises(KeyError):
        small["no.such"]
    assert "mill.speed" in small and "no.such" not in small
    assert small.radii == pytest.approx(5 * [4.76e-3], rel=1e-15)
    assert small.masses == pytest.approx(5 * [8000 * np.pi / 6 * 9.52e-3 ** 3], rel=1e-15)
    with pytest.raises(edmill.InputError, match="^setting contact.friction=-1"):
        small.with_settings("contact.friction=-1")


def test_progress_is_told(small):
    told = []
    edmill.run(small, until="60 s", events=False, progress=lambda time, collisions: told.append(
        (time, collisions)))
    assert told and told == sorted(told) and 0 < told[0][0] < 60


def test_control_c_ends_a_run_with_its_results(small):
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(edmill.Interrupted) as interrupted:
        edmill.run(small, until="100000 s", events=False)
    assert isinstance(interrupted.value, KeyboardInterrupt)
    assert 0 < interrupted.value.run.time < 100000 and interrupted.value.run.end_reason == "interrupted"


def test_other_threads_go_on(small):
    turns = 0
    done = threading.Event()

    def count():
        nonlocal turns
        while not done.wait(0.001):
            turns += 1

    thread = threading.Thread(target=count)
    thread.start()
    edmill.run(small, until="60 s", events=False)
    done.set()
    thread.join()
    assert turns > 20


def test_a_folder_holds_the_files_of_a_run(program, tmp_path):
    case = edmill.Case.spex8000(
        balls=5, diameter="9.52 mm", end_time="1 s", output=[{
            "type": "trends", "interval": "0.1 s",
            "columns": [{"variable": "milling_dose", "statistics": ["rate"]}]
        }])
    run = edmill.run(case, folder=tmp_path / "ours", report=True)
    assert {"trends", "final_state"} <= set(run.series)
    assert len(run.series["trends"]) > 5
    page = (tmp_path / "ours/report.html").read_text()
    assert "<html" in page and run.report()
    (tmp_path / "case.toml").write_text(case.text)
    program("run", tmp_path / "case.toml", "--quiet", "--out", tmp_path / "theirs")
    for name in ("trends.csv", "final_state.csv"):
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" /
                                                           name).read_bytes(), name


def test_series_of_a_run_without_a_folder(small):
    class Soft:
        def restitution(self, approach_speed):
            return 0.2

        def restitution_of_slip(self, normal_change, slip_speed, compliance):
            return 0

    plain = edmill.run(small, until="0.6 s", events=False)
    run = edmill.run(small, until="0.6 s", events=False, ball_ball_law=Soft(), ball_wall_law=Soft())
    for each in (plain, run):
        ends = np.stack([
            each.series["final_state"][name] for name in ("position_x", "position_y", "position_z")
        ], axis=-1)
        assert np.array_equal(ends, each.states["position"])
    assert not np.array_equal(plain.states, run.states)
    assert set(pickle.loads(pickle.dumps(plain)).series) == set(plain.series)
    with pytest.raises(edmill.InputError, match="folder"):
        pickle.loads(pickle.dumps(edmill.run(small, until="0.6 s", ball_wall_law=Soft()))).series


def test_series_of_a_run_that_an_observer_ended():
    case = edmill.Case.spex8000(balls=5, diameter="9.52 mm", end_time="1 s", start_time="0 s",
                                output=[{"type": "collisions"}])
    run = edmill.run(case, observers=[lambda impact, run: impact.index == 300 and run.stop()])
    assert len(run.events) == 301 == len(run.series["collisions"])
    assert run.series["collisions"]["time"][-1] == run.events["time"][-1]


def test_a_run_that_ends_before_its_start_time(small):
    run = edmill.run(small.with_settings("run.max_collisions=50"))
    assert "ended before its start_time" in repr(run)
    assert len(run.series["final_state"]) == 5
    assert "<html" in run.report()


def test_control_c_in_callbacks_keeps_the_run(small):
    class Law:
        def __init__(self, at):
            self.calls, self.at = 0, at

        def restitution(self, approach_speed):
            self.calls += 1
            if self.calls == self.at:
                raise KeyboardInterrupt
            return 0.5

        def restitution_of_slip(self, normal_change, slip_speed, compliance):
            return 0.1

    def observe(impact, run):
        if impact.index == 200:
            raise KeyboardInterrupt

    for given in ({"observers": [observe]}, {"ball_wall_law": Law(100)}, {"ball_ball_law": Law(30)
                                                                         }):
        with pytest.raises(edmill.Interrupted) as interrupted:
            edmill.run(small, until="100000 s", **given)
        assert len(interrupted.value.run.events) > 29
        again = pickle.loads(pickle.dumps(interrupted.value))
        assert again.run.time == interrupted.value.run.time


@pytest.mark.parametrize("answer, expected", [(float("nan"), "expected (0 to 1|a number)"),
                                              (-0.3, "expected 0 to 1"), (5.0, "expected 0 to 1"),
                                              (None, "found None, expected a number"),
                                              ("a", "found 'a', expected a number")])
@pytest.mark.parametrize("precision", ["double", "float128"])
def test_laws_that_are_none_are_refused(small, answer, expected, precision):
    class Law:
        def restitution(self, approach_speed):
            return answer

        def restitution_of_slip(self, normal_change, slip_speed, compliance):
            return 0.1

    with pytest.raises(edmill.InputError, match=expected):
        edmill.run(small, precision, ball_ball_law=Law(), ball_wall_law=Law())


def test_a_run_shows_its_report_in_notebooks(small):
    assert edmill.run(small, until="0.6 s")._repr_html_().startswith("<iframe srcdoc=")


def test_the_types_of_callbacks_are_those_that_runs_hand_over(small):
    def names(owner):
        return {name for name in dir(owner) if not name.startswith("_")}

    def promised(protocol):
        return set(protocol.__annotations__) | names(protocol)

    class Law:
        def restitution(self, approach_speed):
            return 0.5

        def restitution_of_slip(self, normal_change, slip_speed, compliance):
            return 0.5

    for precision in ("double", "float128"):
        seen = []
        edmill.run(small, precision, ball_ball_law=Law(), ball_wall_law=Law(),
                   observers=[lambda impact, run: (seen.append((impact, run)), run.stop())])
        impact, run = seen[0]
        assert names(impact) == promised(edmill.Impact)
        assert names(run) == promised(edmill.Running)
    assert names(Law) == promised(edmill.ContactLaw)
