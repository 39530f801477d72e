"""Rates with intervals, edits of cases, runs from folders, and tables for other libraries."""
import html
import json
import pickle

import numpy as np
import pytest

import edmill


@pytest.fixture(scope="module")
def case():
    return edmill.new("spex8000", ["6x9mm"], powder="3g", target_dose="10 kJ/g", time="2 s",
                      restitution=0.5)


def test_a_new_case_has_the_jar_and_the_filling_that_are_asked_for():
    text = edmill.new("Retsch PM 100", ["15mm"], jar="250ml", fill="50%", bpr=10).text
    assert 'diameter = "75 mm"' in text and "count = 43" in text and 'mass = "60.79 g"' in text
    with pytest.raises(edmill.InputError, match="--fill"):
        edmill.new(fill="half")


def test_rates_are_those_of_the_summary(case):
    run = edmill.run(case)
    assert run.dose_rate == run.summary["milling_dose_rate"]
    assert run.dose_rate.half_width == run.summary["intervals"]["milling_dose_rate"]
    assert run.dose_rate.low < run.dose_rate < run.dose_rate.high
    assert run.collision_rates["total"] == run.summary["collision_rate"]["total"]
    assert run.impact_rates["total"].half_width == run.summary["intervals"]["impact_rate"]["total"]
    assert run.impact_rates["total"] <= run.collision_rates["total"]
    assert run.milling_time == pytest.approx(1e7 * 3e-3 / run.dose_rate)
    assert "±" in repr(run)
    assert pickle.loads(pickle.dumps(run)).dose_rate.half_width == run.dose_rate.half_width
    other = edmill.run(case.edit(balls=[{"count": 2, "diameter": "9 mm"}]))
    assert run.dose_rate.differs(other.dose_rate) and run.dose_rate.differs(run.dose_rate) is False
    short = edmill.run(case, until="0.3 s")
    assert short.dose_rate.half_width is None and short.dose_rate.differs(
        run.dose_rate) is None and short.warnings


def test_seeds_have_one_answer(case, tmp_path):
    found = edmill.seeds(case.with_settings('run.end_time="0.6 s"'), 3, tmp_path / "seeds")
    row, runs = found.points[0], found.runs
    assert row["done"] == 3 and row["states"] == 1 and len(runs) == 3
    assert row["milling_dose_rate"] == pytest.approx(np.mean(runs["milling_dose_rate"]))
    value = edmill.Value(row["milling_dose_rate"], row["milling_dose_rate_ci95"])
    assert repr(value) in repr(found)
    assert value.half_width < min(runs["milling_dose_rate_ci95"])
    with pytest.raises(edmill.InputError, match="count"):
        edmill.seeds(case, 1, tmp_path / "one")


def test_program_page_python_and_sweep_have_the_same_numbers(case, tmp_path, program):
    file, folder = tmp_path / "a.toml", tmp_path / "a"
    file.write_text(case.text)
    run = edmill.run(edmill.Case(file))
    table = program("run", file, "--report", "--out", folder).stdout
    summary = json.loads((folder / "summary.json").read_text())
    page = (folder / "report.html").read_text()
    sweep = edmill.sweep({"sweep": {"case": str(file)}}, tmp_path / "sweep").points[0]
    assert sweep["done"] == 1 and sweep["states"] == 1
    for key, value in (("milling_dose_rate", run.dose_rate), ("specific_milling_dose_rate",
                                                              run.specific_dose_rate),
                       ("wall_work_rate", run.wall_power), ("milling_time", run.milling_time),
                       ("fast_impact_rate", run.fast_impact_rate), ("impact_rate_total",
                                                                    run.impact_rates["total"])):
        path = {"impact_rate_total": "impact_rate/total"}.get(key, key).split("/")
        if key != "milling_time":
            number, width = summary, summary["intervals"]
            for name in path:
                number, width = number[name], width[name]
            assert (number, width) == (value, value.half_width), key
            assert f"{number!r}" in page or f"{number:.17g}" in page or key in (
                "wall_work_rate", "impact_rate_total"), key
        assert sweep[key] == pytest.approx(value,
                                           rel=1e-14) and sweep[key + "_ci95"] == pytest.approx(
                                               value.half_width, rel=1e-12), key
        if key != "milling_time":
            assert repr(value) in table, key
    seeds = edmill.seeds(edmill.Case(file), 3, tmp_path / "seeds")
    replicas = edmill.sweep({"sweep": {"case": str(file), "replicas": 3}},
                            tmp_path / "replicas").points[0]
    row = seeds.points[0]
    for key in ("milling_dose_rate", "milling_dose_rate_ci95", "milling_time", "milling_time_ci95"):
        assert row[key] == replicas[key], key
    answer = program("run", file, "--seeds", "3", "--out", tmp_path / "program").stdout
    assert answer.splitlines()[0] == seeds.text.splitlines()[0]
    value = edmill.Value(row["milling_dose_rate"], row["milling_dose_rate_ci95"])
    assert repr(value) in answer and repr(value) in seeds.page.read_text()


def test_fast_impacts_are_those_of_a_table_of_speeds(case, tmp_path):
    summary = edmill.run(case).summary
    table = f'''[[output]]
type = "frequency"
variable = "relative_normal_speed_before"
low = "1 m/s"
high = "100 m/s"
intervals = 1
start_time = "{summary['start_time']} s"
'''
    file = tmp_path / "a.toml"
    file.write_text(case.text + table)
    edmill.run(edmill.Case(file), folder=tmp_path / "run")
    number = (tmp_path / "run/frequency.csv").read_text().splitlines()[-1].split(",")[-1]
    assert int(number) > 100
    assert summary["fast_impact_rate"] == pytest.approx(
        int(number) / summary["duration"], rel=1e-14)


def test_energies_of_impacts_are_those_of_the_events(case):
    run = edmill.run(case)
    events = run.events
    counted = (events["time"] >= run.summary["start_time"]) & (events["separation_speed"] != 0.01
                                                              )  # contacts at rest are left out
    dose = events["milling_dose"][counted]
    mass = 8000 * np.pi / 6 * 9e-3**3 * np.where(events["with_wall"], 1, 0.5)[counted]
    speed = np.maximum(events["approach_speed"][counted], 0)
    assert run.mean_impact_speed == pytest.approx(np.average(speed, weights=dose), rel=1e-12)
    for key, energy in (("impact_energy_by_dose", mass / 2 * speed ** 2),
                        ("dissipated_energy_by_dose", dose)):
        order = np.argsort(energy)
        below = np.cumsum(dose[order]) / dose.sum()
        for name, share in (("median", 0.5), ("90_percent", 0.9)):
            exact = energy[order][np.searchsorted(below, share)]
            assert run.summary[key][name] == pytest.approx(exact, rel=0.03), (key, name)
    rolling = edmill.run(
        edmill.new("mm400", ["1x15mm"], powder="1g", time="3 s").edit({"run.seed": 2}))
    assert rolling.summary["least_separation"]["milling_dose_share"] > 0.9
    assert rolling.impact_energy is None and rolling.mean_impact_speed is None
    assert run.impact_energy == run.summary["impact_energy_by_dose"]["median"]
    table = run.case.with_settings(
        'output=[{type="spectra", of="impact_energy", low="1e-6 J", bins_per_decade=30}]')
    assert edmill.run(
        table).summary["impact_energy_by_dose"] == run.summary["impact_energy_by_dose"]


def test_what_decides_names_every_run(case):
    found = edmill.what_decides(case, uncertainty=0.2)
    assert next(iter(found.values())) == edmill.run(case).dose_rate
    assert {
        "another seed", "half of the least separation speed", "restitution + 0.2", "friction - 0.2"
    } < set(found)
    assert "restitution - 0.2" in found.differing and "another seed" not in found.differing
    assert "the dose rate depends on: " in found.text


def test_a_run_ends_at_its_precision(case):
    run = edmill.run(case, until_precision="5%")
    assert run.summary["end_reason"] == "dose_rate_precision"
    assert run.dose_rate.half_width < 0.052 * run.dose_rate
    for wrong in (0, 1.5, "x%", True, "-1%"):
        with pytest.raises(edmill.InputError, match="until_precision"):
            edmill.run(case, until_precision=wrong)


def test_edits_name_what_is_wrong(case):
    assert case.edit({"mill.speed": "1000 rpm"}) == case.with_settings('mill.speed="1000 rpm"')
    with pytest.raises(edmill.EditError) as raised:
        case.edit({"mill.sped": 1, "contact.friction": -1})
    assert {problem["key"] for problem in raised.value.problems
           } == {"mill.sped", "contact.friction"}
    assert all(problem["found"] and problem["expected"] for problem in raised.value.problems)


@pytest.mark.parametrize("precision", ["double", "float128"])
def test_a_run_is_read_from_its_folder(case, precision, tmp_path):
    run = edmill.run(case, precision, until="0.4 s", folder=tmp_path / "run")
    again = edmill.read_run(tmp_path / "run")
    assert (again.states == run.states).all() and again.time == run.time and again.case == run.case
    assert again.dose_rate == run.dose_rate and again.precision == precision
    with pytest.raises(edmill.InputError, match="no readable file"):
        edmill.read_run(tmp_path)


def test_a_run_with_checkpoints_is_that_without(case, tmp_path):
    run = edmill.run(case, folder=tmp_path / "a", checkpoint="0.5 s simulated")
    assert (run.states == edmill.run(case).states).all()
    with pytest.raises(edmill.InputError):
        edmill.run(case, checkpoint="0.5 s simulated")
    with pytest.raises(edmill.InputError):
        edmill.resume(tmp_path / "a")


def test_events_are_tables_of_pandas_and_xarray(case):
    run = edmill.run(case, until="0.5 s")
    pandas = pytest.importorskip("pandas")
    frame = run.events.to_dataframe()
    assert isinstance(frame, pandas.DataFrame) and len(frame) == len(run.events)
    assert np.array_equal(frame["normal_y"], run.events["normal"][:, 1])
    pytest.importorskip("xarray")
    dataset = run.events.to_xarray("impact")
    assert dataset["normal"].dims == ("impact", "axis") and float(
        dataset["time"][-1]) == run.events["time"][-1]


def test_a_sweep_takes_a_case(case, tmp_path):
    edited = case.edit({"contact.friction": 0.3})
    study = edmill.sweep(
        {"sweep": {"case": edited, "replicas": 2, "grid": {"mill.speed": ["900 rpm", "1000 rpm"]}}},
        tmp_path / "out")
    assert len(study.runs) == 4 and (study.runs["status"] == "done").all()
    one = edmill.run(edited.edit({"mill.speed": "900 rpm", "run.seed": 2}))
    assert study.runs["milling_dose_rate"][1] == one.dose_rate
    assert study.page.exists() and "iframe" in study._repr_html_()


def test_a_sweep_over_keys_is_a_frame_in_si(case, tmp_path):
    pytest.importorskip("pandas")
    speeds = ["900 rpm", "1000 rpm"]
    study = edmill.sweep(case.edit({"run.end_time": "0.7 s"}),
                         over={"mill.speed": speeds,
                               "contact.friction": [0.3, np.float64(0.4)]}, seeds=2)
    frame = study.to_dataframe()
    assert list(frame["mill.speed"]) == pytest.approx(
        [30 * np.pi, 30 * np.pi, 100 / 3 * np.pi, 100 / 3 * np.pi], rel=1e-15)
    assert list(frame["contact.friction"]) == [0.3, 0.4, 0.3, 0.4] and list(
        frame["done"]) == 4 * [2]
    units = frame.attrs["units"]
    assert units["mill.speed"] == "rad/s" and "contact.friction" not in units and units[
        "milling_dose_rate_ci95"] == "W"
    assert units["impact_energy"] == "J" and (frame["impact_energy"] > 0).all()
    file = tmp_path / "a.toml"
    file.write_text(case.text)
    grid = {
        "sweep": {
            "case": str(file), "replicas": 2, "grid": {
                "run.end_time": ["0.7 s"], "mill.speed": speeds, "contact.friction": [0.3, 0.4]
            }
        }
    }
    assert np.array_equal(
        edmill.sweep(grid, tmp_path / "a").points["milling_dose_rate"], frame["milling_dose_rate"])
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = study.plot()
    assert axes.get_xlabel() == "mill.speed [rpm]" and axes.get_ylabel() == "milling_dose_rate [W]"
    assert [text.get_text() for text in axes.get_legend().get_texts()
           ] == ["contact.friction = 0.3", "contact.friction = 0.4"]
    folder = study.folder
    assert folder.is_dir()
    del study
    assert not folder.exists()
    for wrong in ({"over": {}}, {"over": {"mill.speed": "900 rpm"}}, {"seeds": 2}):
        with pytest.raises(edmill.InputError):
            edmill.sweep(case, **wrong)
    rows = dict(edmill.check(case))
    assert all(
        f">{html.escape(name)}</th>" in case._repr_html_() for name in rows) and "digest" in rows
    assert edmill.sweep(case.edit({"run.end_time": "0.3 s"}),
                        over={"mill.speed": ["900 rpm"]}).plot(axes=axes) is axes  # no intervals
    with pytest.raises(edmill.InputError, match="'balls'"):
        edmill.sweep(case.edit(balls=[{"count": 2, "diameter": "9 mm"}]),
                     over={"mill.speed": ["900 rpm"]})
    lengths = edmill.sweep(case, over={"run.end_time": ["0.7 s", "0.01 m"]}).to_dataframe()
    assert list(lengths["run.end_time"]) == ["0.7 s",
                                             "0.01 m"]  # "m" is a length, too: not converted
    other = case.edit({"run.seed": 7, "run.precision": "float128", "run.end_time": "0.6 s"})
    assert edmill.sweep(other, over={"contact.friction":
        [0.4]}).points["milling_dose_rate"][0] == pytest.approx(float(edmill.run(other).dose_rate),
                                                                rel=1e-14)


def test_machines_and_variables():
    assert edmill.machines()["pm100"]["mill.ratio"][0] == "-2"
    assert {"milling_dose", "normal_impulse"} <= {row["name"] for row in edmill.variables()}
    with pytest.raises(edmill.InputError, match="--mill"):
        edmill.new("foo")
