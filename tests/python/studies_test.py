"""Studies and judges from Python."""
import pytest

import edmill


def test_a_sweep_has_a_row_for_each_point(demo, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    sweep = {"sweep": {"case": str(demo), "replicas": 2, "grid": {"contact.restitution": [0.3, 0.6]},
                       "point": [{"name": "short", "set": {"run.end_time": "1 s", "run.start_time": "0.2 s"}}]}}
    study = edmill.sweep(sweep, tmp_path / "sweep", jobs=2)
    assert len(study.points) == 2 and not study.failed
    rates = study.points["milling_dose_rate"]
    assert (rates > 0).all()
    again = edmill.sweep(sweep, tmp_path / "sweep")
    assert (again.points["milling_dose_rate"] == rates).all()
    with pytest.raises(edmill.InputError):
        edmill.sweep({"sweep": {"case": "no_such.toml", "grid": {"contact.restitution": [0.3]}}}, tmp_path / "other")


@pytest.fixture
def folders(demo, tmp_path):
    made = []
    for seed in (1, 1, 2):
        made.append(tmp_path / f"run_{len(made)}")
        edmill.run(edmill.Case(demo, [f"run.seed={seed}", 'output=[{type="collisions", states=true}]']), until="3 s", folder=made[-1],
                   events=False)
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
