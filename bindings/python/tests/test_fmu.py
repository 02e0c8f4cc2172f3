"""Functional mock-up units: needs the library in exported ones, in the package (`bindings/python/runtime`)
or in the variable GAPILIB_FMU_RUNTIME."""

import os

import numpy as np
import pytest

import gapilib

needs_runtime = pytest.mark.skipif(
    "GAPILIB_FMU_RUNTIME" not in os.environ, reason="the package has no library of units, and GAPILIB_FMU_RUNTIME names none"
)


@needs_runtime
@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("co_simulation", [False, True])
def test_a_model_as_a_unit_gives_the_same(decay, tmp_path, version, co_simulation):
    path = tmp_path / "decay.fmu"
    decay.export_fmu(path, {"k": 3.0}, version=version)
    session = gapilib.Session(allow_external=True)
    unit = session.fmu(path, co_simulation=co_simulation)
    assert unit.name == "decay.fmu" and unit.outputs == ["y"] and "x" in unit.names
    assert unit.parameters["k"]["unit"] == "1/s"
    result = unit.simulate(tolerance=1e-9, stop=1.0)
    np.testing.assert_allclose(result["x"], np.exp(-3 * result.time), rtol=1e-6)
    other = unit.simulate({"k": 1.0, "a": 2.0}, tolerance=1e-9, variables=["x"])
    np.testing.assert_allclose(other["x"], 2 * np.exp(-other.time), rtol=1e-6)
    assert other.names == ["x"]
    with pytest.raises(gapilib.GapilibError, match="has no variable `kk`"):
        unit.simulate({"kk": 1.0})


@needs_runtime
def test_a_unit_is_fitted(decay, tmp_path):
    decay.export_fmu(tmp_path / "decay.fmu")
    t = np.linspace(0, 1, 21)
    data = {"time": t, "x": np.exp(-2.5 * t) + 1e-4 * np.sin(37 * t)}
    problem = {
        "model": "decay.fmu",
        "parameters": {"k": {"min": 0.1, "max": 10.0}},
        "experiment": [{"data": data, "outputs": {"x": "x"}}],
    }
    fit = gapilib.identify(problem, folder=tmp_path, allow_external=True)
    assert fit.parameters["k"] == pytest.approx(2.5, abs=1e-2)
    # The unit of a session is fitted there, and simulated with the values found.
    unit = gapilib.Session(allow_external=True).fmu(tmp_path / "decay.fmu")
    of_session = gapilib.identify({**problem, "model": unit})
    assert of_session.parameters == fit.parameters
    for own in [fit, of_session]:
        assert own.simulate(stop=1.0)["x"][-1] == pytest.approx(np.exp(-own.parameters["k"]), rel=1e-4)


@needs_runtime
def test_what_was_computed_until_a_failure_is_kept(tmp_path):
    session = gapilib.Session(allow_external=True)
    text = "model Limited Real x(start = 0, fixed = true); equation der(x) = 1; " \
           "assert(x < 0.5, \"x too large\"); end Limited;"
    (tmp_path / "Limited.mo").write_text(text)
    session.load(tmp_path / "Limited.mo")
    model = session.model("Limited")
    model.export_fmu(tmp_path / "limited.fmu")
    for own in [model, session.fmu(tmp_path / "limited.fmu")]:
        with pytest.raises(gapilib.GapilibError, match="x too large") as raised:
            own.simulate(stop=1.0)
        result = raised.value.result
        assert 0.4 < result.time[-1] <= 0.51
        np.testing.assert_allclose(result["x"], result.time, atol=1e-6)
    with pytest.raises(gapilib.GapilibError) as raised:
        model.simulate({"k": 1.0})
    assert getattr(raised.value, "result", None) is None


def test_units_need_permission_and_words_that_there_are(decay, tmp_path):
    with pytest.raises(ValueError, match="there is no FMI 1"):
        decay.export_fmu(tmp_path / "x.fmu", version=1)
    with pytest.raises(ValueError, match="there is no kind"):
        decay.export_fmu(tmp_path / "x.fmu", kind="se")
    with pytest.raises(gapilib.GapilibError):
        gapilib.Session().fmu(tmp_path / "none.fmu")
