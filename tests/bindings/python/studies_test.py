"""Studies and judges from Python."""
from decimal import Decimal

import pytest

import edmill


def test_a_sweep_has_a_row_for_each_point(demo, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    sweep = {
        "sweep": {
            "case": str(demo), "replicas": 2, "grid": {"contact.restitution": [0.3, 0.6]},
            "point": [{"name": "short", "set": {"run.end_time": "1 s", "run.start_time": "0.2 s"}}]
        }
    }
    study = edmill.sweep(sweep, tmp_path / "sweep", jobs=2)
    assert len(study.points) == 2 and not study.failed
    rates = study.points["milling_dose_rate"]
    assert (rates > 0).all()
    again = edmill.sweep(sweep, tmp_path / "sweep")
    assert (again.points["milling_dose_rate"] == rates).all()
    with pytest.raises(edmill.InputError):
        edmill.sweep({"sweep": {"case": "no_such.toml", "grid": {"contact.restitution": [0.3]}}},
                     tmp_path / "other")


@pytest.fixture
def folders(demo, tmp_path):
    made = []
    for seed in (1, 1, 2):
        made.append(tmp_path / f"run_{len(made)}")
        edmill.run(
            edmill.Case(demo, [f"run.seed={seed}", 'output=[{type="collisions", states=true}]']),
            until="3 s", folder=made[-1], events=False)
    return made


def test_runs_are_compared(folders):
    same = edmill.compare(folders[0], folders[1], events=1000)
    assert same.good and same["verdict"] == "agree"
    other = edmill.compare(folders[0], folders[2], events=10)
    assert not other.good and other.code == 6


def test_a_log_is_audited(demo, folders):
    clean = edmill.audit(demo, folders[0])
    assert clean.good and clean["verdict"] == "clean"
    wrong = edmill.audit(edmill.Case(demo, ['mill.arm="10.05 cm"']), folders[0])
    assert not wrong.good and wrong["verdict"] == "violations"


def test_the_cause_of_a_wrong_log_is_identified(demo, folders):
    found = edmill.audit(edmill.Case(demo, ['mill.arm="10.05 cm"']), folders[0],
                         identify=True)["identified"]
    cause = found["causes"]["1"]
    arm = cause["values"]["mill.arm"]
    assert list(cause["values"]) == ["mill.arm"] and cause["explains"] == found["violations"] > 0
    assert abs(arm["value"] - 0.1) <= arm["half_width"] < 1e-12 and arm["nominal"] == 0.1005
    assert not edmill.audit(demo, folders[0], identify=True)["identified"]["causes"]


def test_events_are_proven(demo, tmp_path):
    proof = edmill.prove(demo, 10, certificate=tmp_path / "certificate")
    run = edmill.run(edmill.Case(demo, ["run.max_collisions=10"]), precision="float128")
    assert len(proof.events) == 10 and (tmp_path / "certificate").read_text().count("\n") == 12
    for proven, event in zip(proof.events, run.events):
        assert abs(proven.time - event["time"]) < Decimal("1e-30")
        assert 0 < proven.time_radius < Decimal("1e-30")
    with pytest.raises(edmill.UndecidedError, match="bits do not decide"):
        edmill.prove(demo, 400, most_bits=128)
