"""A model that is served, and called by UM-Bridge's client."""

import re
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

umbridge = pytest.importorskip("umbridge")

import gapilib  # noqa: E402
from gapilib.umbridge import SimulatorModel  # noqa: E402

from conftest import DECAY  # noqa: E402

CHAPTER = Path(__file__).resolve().parents[3] / "docs" / "src" / "python.md"
TIMES = [0.25, 0.5, 1.0, 2.0]

DELAYED = "model Delayed parameter Real p = 1; Real x; equation x = p*delay(time, 0.1); end Delayed;"

SERVER = f"""
import sys
import gapilib
from gapilib.umbridge import SimulatorModel, serve

session = gapilib.Session(cache=False, threads=2)
session.load_text('''{DECAY}''')
model = session.model("Decay")
one = model.simulator(["k", "a"], "x", at={TIMES}, tolerance=1e-9)
two = model.simulator(["k", "a"], ["x", "y"], at={TIMES}, tolerance=1e-9)
twenty = model.simulator(["k", "a"], "x", at=[0.1*k for k in range(20)])
models = [(one, "one"), (two, "two"), (twenty, "decay")]
serve(*(SimulatorModel(simulator, [1.0, 1.0], name) for simulator, name in models), port=int(sys.argv[1]))
"""


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """The address of a server on a free port of this machine."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    log = tmp_path_factory.mktemp("server") / "log"
    with open(log, "wb") as file:
        process = subprocess.Popen([sys.executable, "-c", SERVER, str(port)], stdout=file, stderr=file)
    try:
        for _ in range(600):
            assert process.poll() is None, log.read_text()
            with socket.socket() as client:
                if client.connect_ex(("127.0.0.1", port)) == 0:
                    break
            time.sleep(0.1)
        yield f"http://127.0.0.1:{port}"
    finally:
        process.terminate()
        process.wait(60)


def test_what_the_server_has(server):
    assert umbridge.supported_models(server) == ["one", "two", "decay"]
    two = umbridge.HTTPModel(server, "two")
    assert two.get_input_sizes() == [2] and two.get_output_sizes() == [4, 4]
    assert two.supports_evaluate() and two.supports_gradient() and two.supports_apply_jacobian()
    assert not two.supports_apply_hessian()


def test_the_client_gets_what_the_simulation_gives(server, decay):
    values = {"k": 1.7, "a": 2.0}
    # The points are among those of the result: nothing is interpolated.
    result = decay.simulate(values, tolerance=1e-9, intervals=8)
    simulator = decay.simulator(["k", "a"], ["x", "y"], at=TIMES, tolerance=1e-9)
    # Binary numbers travel as decimals that are read as the same numbers.
    expected = simulator([1.7, 2.0])
    found = umbridge.HTTPModel(server, "two")([[1.7, 2.0]])
    np.testing.assert_array_equal(np.transpose(found), expected)
    np.testing.assert_allclose(found[0], result.at("x", TIMES), rtol=1e-8)
    np.testing.assert_allclose(found[1], result.at("y", TIMES), rtol=1e-8)
    np.testing.assert_array_equal(umbridge.HTTPModel(server, "one")([[1.7, 2.0]]), [expected[:, 0]])


def test_gradient_and_jacobian_are_the_exact_ones(server):
    times = np.array(TIMES)
    decayed = np.exp(-1.7 * times)
    exact = np.column_stack([-2.0 * times * decayed, decayed])
    sens, vec = np.array([1.0, -2.0, 3.0, 0.5]), np.array([0.3, -0.4])
    for name, output, factor in [("one", 0, 1), ("two", 0, 1), ("two", 1, 2)]:
        model = umbridge.HTTPModel(server, name)
        gradient = model.gradient(output, 0, [[1.7, 2.0]], sens.tolist())
        np.testing.assert_allclose(gradient, factor * sens @ exact, rtol=1e-6)
        applied = model.apply_jacobian(output, 0, [[1.7, 2.0]], vec.tolist())
        np.testing.assert_allclose(applied, factor * exact @ vec, rtol=1e-6)


def test_the_client_of_the_guide(server):
    [client] = re.findall(r"```python,file=client.py\n(.*?)```", CHAPTER.read_text(encoding="utf-8"), re.S)
    names = {}
    exec(client.replace("http://localhost:4242", server), names)
    [found] = names["model"]([[3.0, 1.0]])
    np.testing.assert_allclose(found, np.exp(-0.3 * np.arange(20)), rtol=1e-5)


def test_a_failed_simulation_is_an_error_and_the_server_stays(server):
    model = umbridge.HTTPModel(server, "one")
    with pytest.raises(Exception):
        model([[60.0, 1.0]])
    with pytest.raises(Exception, match="length"):
        model([[1.0]])
    assert len(model([[1.0, 1.0]])[0]) == 4


def test_a_model_without_derivatives_offers_none():
    session = gapilib.Session(cache=False, threads=1)
    session.load_text(DELAYED)
    simulator = session.model("Delayed").simulator(["p"], "x", at=[0.5, 1.0])
    with pytest.raises(gapilib.GapilibError, match="no exact derivatives"):
        simulator.jacobian([2.0])
    model = SimulatorModel(simulator, [2.0])
    np.testing.assert_allclose(model([[2.0]]), [[0.8, 1.8]])
    assert not model.supports_gradient() and not model.supports_apply_jacobian()


def test_values_at_which_the_model_fails_are_refused(decay):
    simulator = decay.simulator(["k"], "x", at=TIMES)
    with pytest.raises(gapilib.GapilibError, match="k is too large"):
        SimulatorModel(simulator, [60.0])
