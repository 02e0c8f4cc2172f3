import json
import subprocess
import sys

import numpy as np
import pytest

import gapilib

MODEL = """
model Decay
  parameter Real k = 1;
  parameter Real a = 1;
  Real x(start = a, fixed = true);
equation
  der(x) = -k*x;
  annotation(experiment(StopTime = 2));
end Decay;
"""


@pytest.fixture
def problem(tmp_path):
    times = np.linspace(0.1, 2, 20)
    noise = 1e-3 * np.sin(37 * np.arange(20))
    rows = np.column_stack([times, 1.3 * np.exp(-2.1 * times) + noise])
    np.savetxt(tmp_path / "data.csv", rows, delimiter=",", header="t,x", comments="")
    (tmp_path / "Decay.mo").write_text(MODEL)
    return {
        "model": "Decay",
        "files": ["Decay.mo"],
        "seed": [1, 2, 3, 4, 5, 6],
        "parameters": {"k": {"min": 0.1, "max": 10.0}, "a": {"min": 0.1, "max": 5}},
        "experiment": [
            {
                "data": "data.csv",
                "x": {"variable": "time", "column": "t"},
                "outputs": {"x": "x"},
            }
        ],
    }


def test_a_problem_as_a_dict(problem, capsys, own_folder):
    files = sorted(own_folder.rglob("*"))
    solution = gapilib.identify(problem)
    # Nothing is written or printed unasked.
    assert sorted(own_folder.rglob("*")) == files and solution.path is None
    printed = capsys.readouterr()
    assert (printed.out, printed.err) == ("", "")
    np.testing.assert_allclose([solution.parameters["k"], solution.parameters["a"]], [2.1, 1.3], rtol=5e-3)
    assert solution.verdicts == {"k": "identifiable", "a": "identifiable"}
    covariance = solution.covariance
    deviations = [p["deviation"] for p in solution.data["parameters"]]
    np.testing.assert_allclose(np.sqrt(np.diag(covariance)), deviations, rtol=1e-9)
    # The same as by linearized least squares at the solution.
    times = np.linspace(0.1, 2, 20)
    k, a = solution.parameters["k"], solution.parameters["a"]
    jacobian = np.column_stack([-a * times * np.exp(-k * times), np.exp(-k * times)])
    variance = solution.fitness / 18
    np.testing.assert_allclose(covariance, variance * np.linalg.inv(jacobian.T @ jacobian), rtol=1e-3)
    assert "<html" in solution.html and "iframe" in solution._repr_html_()
    assert gapilib.identify(problem, verbose=True).text in capsys.readouterr().out
    pandas = pytest.importorskip("pandas")
    table = solution.table()
    assert isinstance(table, pandas.DataFrame) and table.loc["k", "low"] < k < table.loc["k", "high"]


def test_profiles_and_plots(problem, tmp_path):
    pandas = pytest.importorskip("pandas")
    solution = gapilib.identify(problem, profile=True, out=str(tmp_path / "out"), overwrite=True, progress=False)
    profiles = solution.profiles()
    written = pandas.read_csv(tmp_path / "out" / "profiles.csv")
    pandas.testing.assert_frame_equal(profiles, written)
    assert list(profiles["parameter"].unique()) == ["k", "a"]
    # Where a profile is least is the solution; where it crosses the limit ends the interval of the report.
    times = np.linspace(0.1, 2, 20)
    measured = 1.3 * np.exp(-2.1 * times) + 1e-3 * np.sin(37 * np.arange(20))
    for name, one in profiles.groupby("parameter"):
        least = one.loc[one["sum_of_squares"].idxmin()]
        assert least["value"] == pytest.approx(solution.parameters[name], rel=1e-4)
    of_k = profiles[profiles["parameter"] == "k"]
    for k, found in zip(of_k["value"], of_k["sum_of_squares"]):
        # With k held, the best a is that of linear least squares.
        shape = np.exp(-k * times)
        residuals = measured - shape * (shape @ measured) / (shape @ shape)
        assert found == pytest.approx(residuals @ residuals, rel=1e-3)

    assert list(solution.plots) == ["fit", "convergence", "profile-k", "profile-a"]
    for name, plot in solution.plots.items():
        assert plot._repr_svg_() == plot.svg and plot.svg.startswith("<svg") and plot.svg.rstrip().endswith("</svg>")
        file = tmp_path / "out" / f"{name}.svg"
        if not name.startswith("profile"):
            assert plot.svg == file.read_text()
    assert "profile of k" in solution.plots["profile-k"].svg
    solution.plots["fit"].save(tmp_path / "copy.svg")
    assert (tmp_path / "copy.svg").read_text() == solution.plots["fit"].svg


def test_without_profiles_there_are_none(problem):
    solution = gapilib.identify(problem, progress=False)
    assert solution.profiles() is None
    assert list(solution.plots) == ["fit", "convergence"]


def test_a_problem_in_a_file_gives_the_same(problem, tmp_path):
    from gapilib import _toml

    file = tmp_path / "problem.toml"
    file.write_text(_toml.dumps(problem))
    one = gapilib.identify(file, out=str(tmp_path / "one"), progress=False, threads=1)
    two = gapilib.identify(problem, progress=False, threads=2)
    assert one.parameters == two.parameters and one.data["evaluations"] == two.data["evaluations"]
    saved = json.loads((tmp_path / "one" / "result.json").read_text())
    assert saved["parameters"] == one.data["parameters"]
    assert not list(tmp_path.glob("problem-*.toml"))


def test_all_that_is_wrong_is_said(problem, tmp_path):
    problem["parameters"]["kk"] = {"min": 0, "max": 1}
    with pytest.raises(gapilib.GapilibError, match="kk"):
        gapilib.identify(problem, progress=False)
    with pytest.raises(gapilib.GapilibError):
        gapilib.identify("missing.toml", progress=False)
    with pytest.raises(TypeError, match="complex"):
        gapilib.identify({**problem, "seed": 1j}, progress=False)


def test_the_progress_is_called(problem):
    calls = []
    gapilib.identify(problem, progress=lambda *call: calls.append(call))
    label, done, total, best = calls[-1]
    assert isinstance(label, str) and done >= 0 and (best is None or best >= 0)


def test_scripts_run_unchanged(tmp_path, capsys):
    (tmp_path / "s.mos").write_text('a = {1, 2, 3};\nprint("hello");\nb = sum(a);\n')
    variables = gapilib.run(tmp_path / "s.mos")
    assert variables["b"] == 6 and list(variables["a"]) == [1, 2, 3]
    assert "hello" in capsys.readouterr().out
    (tmp_path / "bad.mos").write_text("a = 1;\nb = nothing(a);\n")
    with pytest.raises(gapilib.GapilibError) as caught:
        gapilib.run(tmp_path / "bad.mos")
    assert caught.value.diagnostics[0]["line"] == 2
    with pytest.raises(gapilib.GapilibError):
        gapilib.run(tmp_path / "missing.mos")


def test_the_command_comes_with_the_package(tmp_path):
    def gapi(*arguments):
        return subprocess.run([sys.executable, "-m", "gapilib", *arguments], capture_output=True, text=True)

    assert gapi("--version").stdout == f"gapi {gapilib.__version__}\n"
    assert gapi("run", "missing.mos").returncode == 1
    assert gapi("--nonsense").returncode == 2
    (tmp_path / "s.mos").write_text("print(\"hi\");\nexit(7);\n")
    ended = gapi("run", "s.mos")
    assert (ended.returncode, ended.stdout) == (7, "hi\n")


def test_process_noise_has_the_likelihood_of_a_kalman_filter(tmp_path):
    (tmp_path / "M.mo").write_text(
        "model M parameter Real tau = 3; Real x(start = 0, fixed = true); equation der(x) = -x/tau; end M;"
    )
    generator = np.random.default_rng(49)
    times, tau, noise, sigma = np.arange(1.0, 121.0), 3.0, 1.0, 0.3
    kept = np.exp(-1 / tau)
    spread = noise * np.sqrt(tau / 2 * (1 - kept**2))
    x, measured = 0.0, []
    for _ in times:
        x = kept * x + spread * generator.standard_normal()
        measured.append(x + sigma * generator.standard_normal())
    solution = gapilib.identify(
        {
            "model": "M",
            "files": ["M.mo"],
            "bands": False,
            "parameters": {"tau": {"min": 0.1, "max": 100.0}},
            "noise": {"x": {"min": 0.05, "max": 20.0}},
            "experiment": [
                {
                    "data": {"time": times, "x": np.array(measured)},
                    "outputs": {"x": {"column": "x", "sigma": "estimate"}},
                }
            ],
        },
        folder=tmp_path,
        out=tmp_path / "noise",
        progress=False,
    )
    found = solution.parameters
    tau, noise, sigma = found["tau"], found["noise of x"], found["sigma of x"]
    kept = np.exp(-1 / tau)
    added = noise**2 * tau / 2 * (1 - kept**2)
    mean, variance, log = 0.0, 0.0, 0.0
    for y in measured:
        mean, variance = kept * mean, kept**2 * variance + added
        total = variance + sigma**2
        log += 0.5 * ((y - mean) ** 2 / total + np.log(2 * np.pi * total))
        mean, variance = mean + variance * (y - mean) / total, variance * sigma**2 / total
    np.testing.assert_allclose(solution.fitness, log, rtol=1e-6)


def test_a_spectrum_is_fitted(tmp_path):
    (tmp_path / "Cell.mo").write_text(
        "model Cell parameter Real R = 0.1; parameter Real C = 1; input Real i(start = 0); "
        "Real v(start = 0, fixed = true); equation C*der(v) = i - v/R; end Cell;"
    )
    frequencies = np.geomspace(0.1, 100, 16)
    impedance = 0.2 / (1 + 2j * np.pi * frequencies * 0.2 * 0.5)
    solution = gapilib.identify(
        {
            "model": "Cell",
            "files": ["Cell.mo"],
            "bands": False,
            "parameters": {"R": {"min": 0.01, "max": 1.0}, "C": {"min": 0.05, "max": 5.0}},
            "experiment": [
                {
                    "data": {"frequency [Hz]": frequencies, "re": impedance.real, "im": impedance.imag},
                    "spectrum": {"input": "i", "output": "v"},
                    "outputs": {"real": "re", "imaginary": "im"},
                }
            ],
        },
        folder=tmp_path,
        out=tmp_path / "spectrum",
        progress=False,
    )
    np.testing.assert_allclose([solution.parameters["R"], solution.parameters["C"]], [0.2, 0.5], rtol=1e-6)
