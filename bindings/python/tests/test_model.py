import numpy as np
import pytest

import gapilib


def test_what_a_model_has(decay):
    assert decay.name == "Decay"
    assert decay.parameters["k"]["unit"] == "1/s" and decay.parameters["k"]["min"] == 0
    assert decay.states == ["x"] and decay.outputs == ["y"]
    assert decay.experiment["stop_time"] == 2 and decay.experiment["interval"] is None
    assert decay.unit("x") == "V"
    with pytest.raises(gapilib.GapilibError):
        decay.unit("nothing")


def test_simulations_agree_with_the_exact_solution(decay):
    result = decay.simulate({"k": 3.0, "a": 2.0}, tolerance=1e-10, intervals=40)
    np.testing.assert_allclose(result["x"], 2 * np.exp(-3 * result.time), rtol=1e-7)
    np.testing.assert_allclose(result["y"], 2 * result["x"], rtol=1e-15)
    assert len(result) == 41 and result.time[-1] == 2
    assert result.units["x"] == "V" and "x" in result and "z" not in result
    assert result.statistics["steps"] > 0
    # The values of one simulation do not stay for the next.
    again = decay.simulate(tolerance=1e-10)
    np.testing.assert_allclose(again["x"][-1], np.exp(-2), rtol=1e-7)


def test_arrays_can_be_written_to_and_outlive_the_result(decay):
    result = decay.simulate()
    x = result["x"]
    x[0] = 7
    assert result["x"][0] == 1
    del result
    assert x[0] == 7


def test_results_as_frames_files_and_beginnings(decay, tmp_path):
    pandas = pytest.importorskip("pandas")
    result = decay.simulate(variables=["x"], tolerance=1e-9)
    assert result.names == ["x"]
    frame = result.to_pandas()
    assert list(frame.columns) == ["x"] and frame.index.name == "time"
    np.testing.assert_array_equal(frame["x"], result["x"])
    result.write(str(tmp_path / "r.csv"))
    read = pandas.read_csv(tmp_path / "r.csv")
    np.testing.assert_allclose(read["x"], result["x"], rtol=1e-12)
    np.testing.assert_allclose(result.at("x", [0.5, 1.0]), np.exp([-0.5, -1.0]), rtol=1e-3)
    whole = decay.simulate(tolerance=1e-9)
    rest = decay.simulate(initial=whole, initial_time=2.0, stop=3.0, tolerance=1e-9)
    assert rest.time[0] == 2
    np.testing.assert_allclose(rest["x"][-1], np.exp(-3), rtol=1e-6)


def test_what_cannot_be_is_refused(decay):
    for wrong in [
        lambda: decay.simulate({"kk": 1}),
        lambda: decay.simulate(stop=-1),
        lambda: decay.simulate(method="dasl"),
        lambda: decay.simulate(tolerance=7),
        lambda: decay.simulate()["xx"],
        lambda: decay.simulate({"k": 60}),
        lambda: decay.simulator(["k"], "nothing", [1.0]),
        lambda: decay.simulator(["nothing"], "x", [1.0]),
        lambda: decay.simulator(["k"], "x", [5.0]),
    ]:
        with pytest.raises(gapilib.GapilibError):
            wrong()
    with pytest.raises(gapilib.GapilibError, match="k is too large"):
        decay.simulate({"k": 60})
    for wrong in [
        lambda: decay.simulator(["k"], "x", []),
        lambda: decay.simulator(["k"], "x", [np.nan]),
        lambda: decay.simulator(["k"], "x", [1.0])([1.0, 2.0]),
        lambda: decay.simulator(["k"], "x", [1.0])([[1.0], [2.0]]),
        lambda: decay.simulator(["k"], "x", [1.0], tolerance=3),
    ]:
        with pytest.raises(ValueError):
            wrong()


TIMES = np.array([0.0, 0.5, 1.0, 2.0])


def test_many_simulations(decay):
    simulator = decay.simulator(["k", "a"], ["x", "y"], TIMES, tolerance=1e-10)
    values = np.column_stack([np.linspace(0.5, 3, 40), np.linspace(1, 2, 40)])
    found = simulator.many(values)
    assert found.shape == (40, 4, 2)
    exact = values[:, 1, None] * np.exp(-values[:, 0, None] * TIMES)
    np.testing.assert_allclose(found[:, :, 0], exact, rtol=1e-7)
    np.testing.assert_allclose(found[:, :, 1], 2 * exact, rtol=1e-7)
    np.testing.assert_array_equal(found[7], simulator(values[7]))
    alone = decay.simulator(["k", "a"], ["x", "y"], TIMES, tolerance=1e-10, threads=1)
    np.testing.assert_array_equal(alone.many(values), found)
    assert decay.simulator(["k"], "x", TIMES).many([[1.0]]).shape == (1, 4)
    assert simulator.many(np.zeros((0, 2))).shape == (0, 4, 2)


def test_arrays_of_any_layout_are_taken(decay, session):
    simulator = decay.simulator(["k", "a"], "x", TIMES)
    rows = np.array([[1.0, 2.0], [3.0, 4.0]])
    # Not aligned, as arrays that another process has sent.
    shifted = np.frombuffer(b" " + rows.tobytes(), dtype=np.uint8)[1:].view("f8").reshape(2, 2)
    assert not shifted.flags.aligned
    for same in [shifted, np.asfortranarray(rows), rows.astype("float32"), rows.astype(int), rows[::-1][::-1]]:
        np.testing.assert_array_equal(simulator.many(same), simulator.many(rows))
        np.testing.assert_array_equal(simulator(same[1]), simulator(rows[1]))
        session["v"] = same
        np.testing.assert_array_equal(session["v"], rows)


def test_failed_simulations_are_not_numbers(decay):
    simulator = decay.simulator(["k"], "x", TIMES)
    found, failures = simulator.many([[1.0], [60.0], [2.0]], failures=True)
    assert np.isnan(found[1]).all() and np.isfinite(found[[0, 2]]).all()
    assert failures[0] is None and "k is too large" in failures[1]
    with pytest.raises(gapilib.GapilibError, match="k is too large"):
        simulator([60.0])


def test_derivatives_agree_with_the_exact_ones(decay):
    simulator = decay.simulator(["k", "a"], ["x", "y"], TIMES, tolerance=1e-10)
    values, jacobian = simulator.jacobian([1.5, 2.0])
    assert values.shape == (4, 2) and jacobian.shape == (4, 2, 2)
    decayed = np.exp(-1.5 * TIMES)
    np.testing.assert_allclose(values[:, 0], 2 * decayed, rtol=1e-7)
    np.testing.assert_allclose(jacobian[:, 0, 0], -2 * TIMES * decayed, rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(jacobian[:, 1, 1], 2 * decayed, rtol=1e-6)


def test_scipy_fits_with_exact_derivatives(decay):
    optimize = pytest.importorskip("scipy.optimize")
    times = np.linspace(0.1, 2, 20)
    simulator = decay.simulator(["k", "a"], "x", times, tolerance=1e-9)
    measured = 1.3 * np.exp(-2.1 * times)
    fit = optimize.least_squares(
        lambda p: simulator(p) - measured, [1.0, 1.0], jac=lambda p: simulator.jacobian(p)[1]
    )
    np.testing.assert_allclose(fit.x, [2.1, 1.3], rtol=1e-6)


def test_inputs_follow_data(session):
    session.load_text(
        "model Lag input Real u; Real x(start = 0, fixed = true); equation der(x) = u - x; end Lag;"
    )
    model = session.model("Lag")
    times = np.linspace(0, 2, 21)
    result = model.simulate(inputs={"time": times, "u": times}, interpolation="linear", tolerance=1e-9)
    # The end is that of the data; the response to a ramp.
    assert result.time[-1] == 2.0 and "u" in result
    assert result["x"][-1] == pytest.approx(2 - 1 + np.exp(-2.0), rel=1e-6)
    held = model.simulate(inputs={"time": [0.0, 1.0, 2.0], "u": [1.0, 0.0, 0.0]}, interpolation="hold", tolerance=1e-9)
    assert held["x"][-1] == pytest.approx((1 - np.exp(-1.0)) * np.exp(-1.0), rel=1e-5)
    np.savetxt("u.csv", np.column_stack([times, times]), delimiter=",", header="time,u", comments="")
    by_file = model.simulate(inputs="u.csv", interpolation="linear", tolerance=1e-9)
    assert by_file["x"][-1] == result["x"][-1]
    # A later simulation has none.
    assert model.simulate(stop=1.0)["x"][-1] == 0.0
    with pytest.raises(gapilib.GapilibError, match="u"):
        model.simulate(inputs={"time": times, "v": times})
