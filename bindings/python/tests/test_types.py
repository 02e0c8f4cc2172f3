"""Wrong arguments are found before a program runs."""

import subprocess
import sys

import pytest

PLANTED = """import gapilib
from pathlib import Path

problem: gapilib.Problem = {
    "model": "Decay",
    "files": [Path("Decay.mo")],
    "parameters": {"k": (0.1, 10.0), "a": {"min": 0.1, "max": 5}},
    "experiment": {"data": "data.csv", "x": "time", "outputs": {"x": "x"}},
}
solution = gapilib.identify(problem, profile=True, threads=2, sensitivity="morris", progress=True)
value: float = solution.parameters["k"]
gapilib.identify(problem, postrior=True)  # planted
gapilib.identify(problem, threads="2")  # planted
gapilib.identify(problem, sensitivity="moris")  # planted
gapilib.identify(problem, out=3)  # planted
solution.parametres  # planted
name: int = solution.text  # planted
wrong: gapilib.Problem = {"model": "Decay", "parameters": {}, "experiment": [], "titel": "t"}  # planted
more: gapilib.Parameter = {"min": "0.1", "max": 5}  # planted
gapilib.run("fit.mos", overwite=True)  # planted
gapilib.Session().model("Decay").simulate({"k": 1.0}, stop="2")  # planted
"""


@pytest.mark.parametrize("checker", ["mypy", "pyright"])
def test_planted_errors_are_found(checker, own_folder):
    pytest.importorskip(checker)
    (own_folder / "planted.py").write_text(PLANTED)
    options = {"mypy": ["--ignore-missing-imports"], "pyright": ["--pythonpath", sys.executable]}[checker]
    command = [sys.executable, "-m", checker, *options, "planted.py"]
    checked = subprocess.run(command, capture_output=True, text=True)
    lines = {int(line.split(":")[1]) for line in checked.stdout.splitlines() if "error" in line and ":" in line[:20]}
    if checker == "pyright":
        marks = [line for line in checked.stdout.splitlines() if " - error: " in line]
        lines = {int(line.split("planted.py:")[1].split(":")[0]) for line in marks}
    expected = {number for number, line in enumerate(PLANTED.splitlines(), 1) if line.endswith("# planted")}
    assert lines == expected, checked.stdout + checked.stderr
