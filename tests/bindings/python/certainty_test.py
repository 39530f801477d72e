"""What is certain about a case, from Python as from the program."""
import csv
import pathlib
from decimal import Decimal

import pytest

import edmill

SOURCE = pathlib.Path(__file__).resolve().parents[3]
THREE = SOURCE / "regression/reference/three_balls.toml"


def rows_of(file):
    return list(
        csv.DictReader(line for line in pathlib.Path(file).read_text().splitlines()
                       if not line.startswith("#")))


def test_certify_is_that_of_the_program(program, tmp_path):
    program("certify", THREE, "--collisions", 30, "--out", tmp_path / "theirs.csv", "--quiet")
    found = edmill.certify(THREE, 30, file=tmp_path / "ours.csv")
    assert (tmp_path / "ours.csv").read_text() == (tmp_path / "theirs.csv").read_text()
    theirs = rows_of(tmp_path / "theirs.csv")
    assert len(found.events) == len(theirs) == 30
    for event, row in zip(found.events, theirs):
        assert (str(event.ball), event.partner_kind,
                str(event.partner)) == (row["ball"], row["partner_kind"], row["partner"])
        assert abs(event.time - Decimal(row["time"])) <= Decimal("1e-24")
    last = found.evidence[-1]
    assert last.events == 30 and all(
        digits is None or digits >= 25 for digits in last.digits.values())


@pytest.mark.parametrize("name", ["a\u2028b\x85c", "a\n#b\rc", "#\ufffe"])
def test_a_case_can_have_any_name(name, tmp_path):
    file = tmp_path / f"{name}.toml"
    file.write_bytes(THREE.read_bytes())
    proof = edmill.prove(file, 3, certificate=tmp_path / "certificate")
    assert [event.ball for event in proof.events
           ] == [event.ball for event in edmill.prove(THREE, 3).events]
    assert edmill.check_certificate(file, tmp_path / "certificate") == []
    assert edmill.certify(file, 3, file=tmp_path / "certified.csv").events and len(
        rows_of(tmp_path / "certified.csv")) == 3


def test_counts_and_digits_have_bounds():
    for collisions, digits in ((0, 25), (3, 100_001), (3.5, 25)):
        with pytest.raises(edmill.InputError):
            edmill.certify(THREE, collisions, digits=digits)


def test_shadow_is_that_of_the_program(program, tmp_path):
    case = edmill.Case.spex8000(balls=3, diameter="9.52 mm", end_time="1 s")
    (tmp_path / "case.toml").write_text(case.text)
    printed = program("run", tmp_path / "case.toml", "--shadow", "float128", "--quiet", "--out",
                      tmp_path / "out").stdout
    found = edmill.shadow(case, "float128")
    assert found.text == printed and f"{found.events} events in common" in printed and found.events > 20
    assert found.digits_lost_per_event > 0 and all(digits > 0 for digits in found.digits.values())
    assert found.diverged and found.diverged[0] != found.diverged[1]
    for narrow, wide in (("float128", "double"), ("double", "double")):
        with pytest.raises(edmill.InputError, match="expected a scalar wider than"):
            edmill.shadow(case, wide, narrow)


def test_check_tells_what_the_program_prints(program, demo):
    facts = edmill.check(demo)
    printed = program("check", demo).stdout
    for name, value in facts.items():
        for line in value.split("\n"):
            assert line in printed, name
    assert sum(len(value.split("\n")) for value in facts.values()) == len(printed.splitlines()) - 1
    assert facts["digest"] == edmill.Case(demo).digest
    with pytest.raises(edmill.InputError, match="too large for the vessel"):
        edmill.check(edmill.Case.spex8000(balls=1, diameter="38 mm", end_time="1 s"))


def test_a_certificate_of_another_case_is_told(tmp_path):
    edmill.prove(THREE, 5, certificate=tmp_path / "three.certificate")
    assert edmill.check_certificate(THREE, tmp_path / "three.certificate") == []
    other = edmill.Case(THREE).with_settings("contact.restitution=0.51")
    assert any("restitution" in line
               for line in edmill.check_certificate(other, tmp_path / "three.certificate"))


def test_a_folder_with_a_checkpoint_is_refused_as_by_the_program(tmp_path):
    """One rule for leftovers, from Python too."""
    case = edmill.Case.spex8000(balls=3, diameter="9.52 mm", end_time="1 s")
    (tmp_path / "run").mkdir()
    (tmp_path / "run/checkpoint").write_text("of an unfinished run")
    with pytest.raises(edmill.InputError, match="checkpoint"):
        edmill.run(case, folder=tmp_path / "run")
    assert [p.name for p in (tmp_path / "run").iterdir() if not p.name.startswith(".")
           ] == ["checkpoint"]
