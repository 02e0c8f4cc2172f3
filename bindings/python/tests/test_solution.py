"""What an identification gives: tables, the calibrated model, objects of other packages; and where its
model comes from."""

import pickle
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
import multiprocessing

import numpy as np
import pytest

import gapilib

pandas = pytest.importorskip("pandas")

TEXT = """model Decay
  parameter Real k = 1;
  parameter Real a = 1;
  Real x(start = a, fixed = true);
equation
  der(x) = -k*x;
end Decay;
"""
TIMES = np.linspace(0.1, 2, 20)


def problem(number=0, **more):
    noise = 0.01 * np.random.default_rng(number).normal(size=20)
    data = {"time": TIMES, "x": 1.3 * np.exp(-2.1 * TIMES) + noise}
    return {
        "model": TEXT,
        "parameters": {"k": (0.1, 10.0), "a": [0.1, 5]},
        "experiment": {"data": data, "x": "time", "outputs": {"x": "x"}},
        **more,
    }


def fitted(number):
    return gapilib.identify(problem(number), threads=1)


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_fits_in_a_pool_of_processes(method, own_folder):
    context = multiprocessing.get_context(method)
    with ProcessPoolExecutor(2, mp_context=context) as pool:
        found = list(pool.map(fitted, range(4)))
    # Solutions come back whole, and every fit is that of its data.
    assert [one.parameters for one in found] == [fitted(number).parameters for number in range(4)]
    assert len({one.parameters["k"] for one in found}) == 4
    assert found[0].simulate({"k": 0.0}, stop=1.0)["x"][-1] == pytest.approx(found[0].parameters["a"])
    assert list(own_folder.iterdir()) == []


def test_fits_in_a_pool_of_threads():
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(fitted, range(8)))
    assert len({one.parameters["k"] for one in found}) == 8


def test_the_same_content_is_the_same_problem(tmp_path):
    first = gapilib.identify(problem(1), out="out")
    assert first.path is not None and (first.path / "result.json").is_file()
    again = gapilib.identify(problem(1, stop={"generations": 500}), out="out", resume=True)
    assert again.parameters == first.parameters
    with pytest.raises(gapilib.GapilibError, match="results of another problem") as error:
        gapilib.identify(problem(2), out="out")
    # In the words of Python.
    assert "overwrite=True" in str(error.value) and "--" not in str(error.value)
    assert gapilib.identify(problem(2), out="out", overwrite=True).parameters != first.parameters


def test_one_call_for_text_files_sessions_models_and_units(tmp_path):
    by_text = gapilib.identify(problem())
    (tmp_path / "Decay.mo").write_text(TEXT)
    by_file = gapilib.identify(problem(model="Decay", files=["Decay.mo"]))
    by_texts = gapilib.identify(problem(model="Decay", files=[TEXT]))
    session = gapilib.Session(cache=False)
    session.load_text(TEXT)
    by_session = gapilib.identify(problem(model="Decay"), session=session)
    by_model = gapilib.identify(problem(model=session.model("Decay")))
    for other in [by_file, by_texts, by_session, by_model]:
        assert other.parameters == by_text.parameters and other.verdicts == by_text.verdicts
    assert isinstance(by_model.model, gapilib.Model)
    assert by_model.model.session.eval("1 + 1") == 2
    with pytest.raises(RuntimeError, match="another process"):
        pickle.loads(pickle.dumps(by_model)).model


def test_the_calibrated_model():
    solution = gapilib.identify(problem())
    result = solution.simulate(stop=2.0, tolerance=1e-9)
    expected = solution.parameters["a"] * np.exp(-solution.parameters["k"] * 2.0)
    assert result["x"][-1] == pytest.approx(expected, rel=1e-6)
    assert solution.simulate({"k": 0.0}, stop=2.0)["x"][-1] == pytest.approx(solution.parameters["a"])
    assert "extends Decay(" in solution.modelica
    values = pickle.loads(pickle.dumps(solution))
    assert values.parameters == solution.parameters
    assert values.simulate(stop=2.0, tolerance=1e-9)["x"][-1] == result["x"][-1]


def test_residuals_and_curves_are_those_of_the_model():
    solution = gapilib.identify(problem())
    k, a = solution.parameters["k"], solution.parameters["a"]
    residuals = solution.residuals()
    np.testing.assert_allclose(residuals["simulated"], a * np.exp(-k * residuals["x"]), rtol=1e-6)
    np.testing.assert_array_equal(residuals["residual"], residuals["measured"] - residuals["simulated"])
    assert (residuals["residual"] ** 2).sum() == pytest.approx(solution.fitness)
    curve = solution.curve("x")
    assert len(curve) > 50
    np.testing.assert_allclose(curve["y"], a * np.exp(-k * curve["x"]), rtol=1e-5)
    with pytest.raises(KeyError, match="these were: x"):
        solution.curve("y")
    for missing in [solution.posterior, solution.bootstrap, solution.design, solution.profiles]:
        assert missing() is None


def test_what_is_inferred():
    solution = gapilib.identify(problem(), posterior=True, bootstrap=True, design=True)
    posterior, k = solution.posterior(), solution.data["parameters"][0]
    assert list(posterior.columns) == ["chain", "draw", "k", "a"]
    assert set(posterior.groupby("chain")["draw"].max()) == {len(posterior) // 4 - 1}
    assert posterior["k"].mean() == pytest.approx(k["value"], abs=0.2 * k["deviation"])
    assert posterior["k"].std() == pytest.approx(k["deviation"], rel=0.3)
    # Each block is one chain, which has the whole distribution.
    for _, chain in posterior.groupby("chain"):
        assert chain["k"].mean() == pytest.approx(k["value"], abs=0.5 * k["deviation"])
    assert solution.bootstrap()["k"].std() == pytest.approx(k["deviation"], rel=0.4)
    design = solution.design()
    assert {"D", "A"} <= set(design["criterion"]) and (design["after_k"] > 0).all()
    bands = solution.bands()
    assert list(bands.columns) == ["experiment", "variable", "x", "y", "confidence_95", "prediction_95"]


def test_to_arviz():
    arviz = pytest.importorskip("arviz")
    solution = gapilib.identify(problem(), posterior=True)
    inferred = solution.to_arviz()
    posterior = inferred["posterior"]
    assert dict(posterior.sizes)["chain"] == 4
    summary = arviz.summary(inferred)
    assert float(summary.loc["k", "mean"]) == pytest.approx(solution.parameters["k"], abs=0.1)
    np.testing.assert_array_equal(inferred["observed_data"]["x"], solution.residuals()["measured"])
    with pytest.raises(ValueError, match="posterior=True"):
        gapilib.identify(problem()).to_arviz()


def test_to_xarray():
    pytest.importorskip("xarray")
    solution = gapilib.identify(problem())
    dataset = solution.to_xarray()
    assert float(dataset["value"].sel(parameter="k")) == solution.parameters["k"]
    np.testing.assert_array_equal(dataset["covariance"], solution.covariance)
    np.testing.assert_array_equal(dataset["measured_0"], solution.residuals()["measured"])


def test_messages_are_about_what_was_written():
    with pytest.raises(gapilib.GapilibError) as error:
        gapilib.identify(problem(parameters={"k": "0.1 to 10"}))
    assert "expected a range" in str(error.value) and "struct" not in str(error.value)
    with pytest.raises(ValueError, match="pair"):
        gapilib.identify(problem(parameters={"k": (1, 2, 3)}))
    with pytest.raises(TypeError, match="range of `k`"):
        gapilib.identify(problem(parameters={"k": ("a", 2)}))
    wrong = problem()
    wrong["experiment"]["x"] = "t"
    wrong["experiment"]["data"] = {"t": TIMES, "x": TIMES}
    with pytest.raises(gapilib.GapilibError, match='variable = "time"'):
        gapilib.identify(wrong)
    wrong["experiment"]["outputs"] = {"x": "X"}
    with pytest.raises(gapilib.GapilibError, match="data of experiment 1|`X`"):
        gapilib.identify({**wrong, "experiment": {**wrong["experiment"], "x": {"variable": "time", "column": "t"}}})
