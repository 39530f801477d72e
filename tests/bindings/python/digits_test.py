"""Runs that ask for right digits, and derivatives of events."""
from decimal import Decimal, getcontext

import numpy as np
import pytest

import edmill

getcontext().prec = 120
CASE = edmill.Case.spex8000(balls=3, diameter="9.52 mm", start_time="0 s", end_time="0.3 s")


def test_a_run_has_the_digits_that_it_is_asked_for():
    run = edmill.run(CASE, digits=15)
    assert run.precision.startswith("mpfr:") and run.right_digits >= 15
    assert run.summary["right_digits"] == run.right_digits
    assert edmill.run(CASE, events=False).right_digits is None
    wide = edmill.run(CASE, f"mpfr:{2 * int(run.precision[5:])}")
    assert len(run.events) == len(wide.events)
    for name in ("time", "approach_speed", "milling_dose"):
        largest = max(abs(x) for x in wide.events[name])
        off = max(abs(a - b) for a, b in zip(run.events[name], wide.events[name]))
        assert off <= largest * Decimal("1e-15"), name
    with pytest.raises(edmill.InputError, match="digits"):
        edmill.run(CASE, "float128", digits=12)
    with pytest.raises(edmill.InputError, match="digits"):
        edmill.run(CASE, digits=0)


def test_an_estimate_runs_nothing():
    found = edmill.estimate(CASE, digits=12)
    assert found["precision"].startswith(
        "mpfr:") and found["cpu_seconds"] > 0 and found["verifying_cpu_seconds"] > 0
    events = len(edmill.run(CASE).events)
    assert found["events"] == events
    assert edmill.estimate(CASE)["precision"] == "double"


def test_derivatives_are_those_of_differing_runs():
    case = CASE.with_settings("contact.restitution=0.6")
    found = edmill.sensitivity(case, by=["contact.restitution", "initial.1.vx"], events=20)
    assert len(found.events) == 20
    derivative = found.derivatives["contact.restitution"]
    assert derivative.states.shape == (20, 2, 9) and derivative.unit == ""
    assert found.derivatives["initial.1.vx"].unit == "m/s"
    step = Decimal("1e-30")
    up, down = (edmill.run(
        CASE.with_settings(f"contact.restitution={Decimal('0.6') + sign * step}"),
        "mpfr:100").events[:20] for sign in (1, -1))
    for name, values in derivative.quantities.items():
        exact = np.array([float((a - b) / (2 * step)) for a, b in zip(up[name], down[name])])
        assert np.allclose(values, exact, rtol=1e-12, atol=1e-14 * np.abs(exact).max()), name
    wide = edmill.sensitivity(case, by=["contact.restitution"], events=20,
                              digits=40).derivatives["contact.restitution"]
    assert isinstance(wide.quantities["time"][-1],
                      Decimal) and len(wide.quantities["time"][-1].as_tuple().digits) > 30
    assert abs(wide.quantities["time"][-1] - (up["time"][-1] - down["time"][-1]) /
               (2 * step)) < Decimal("1e-30")
    assert np.allclose(wide.states.astype(float), derivative.states, rtol=1e-14)
    with pytest.raises(edmill.InputError, match="digits"):
        edmill.sensitivity(CASE, by=["contact.restitution"], events=3, digits=400)
    # Settings of whole tables go before what the file has.
    edited = CASE.edit({"contact": {"restitution": 0.7, "friction": 0.2}})
    first = edmill.sensitivity(edited, by=["contact.restitution"],
                               events=20).derivatives["contact.restitution"].quantities["time"]
    up, down = (edmill.run(
        CASE.edit({"contact": {"restitution": 0.7 + sign * 1e-6, "friction": 0.2}}),
        "mpfr50").events[:20]["time"] for sign in (1, -1))
    assert np.allclose(first, [float(a - b) / 2e-6 for a, b in zip(up, down)], rtol=1e-4, atol=1e-7)
    with pytest.raises(edmill.InputError, match="contact.nothing"):
        edmill.sensitivity(CASE, by=["contact.nothing"], events=3)
    with pytest.raises(edmill.InputError, match="by"):
        edmill.sensitivity(CASE, by="contact.restitution", events=3)
