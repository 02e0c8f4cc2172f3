"""The chapter of the guide and the README of the package: their examples run, one after the other."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
CHAPTER = ROOT / "docs" / "src" / "python.md"
README = ROOT / "bindings" / "python" / "README.md"

PROBLEM = """
model = "Decay"
files = ["Decay.mo"]

[parameters]
k = { min = 0.1, max = 10.0 }

[[experiment]]
data = "decay.csv"
x = { variable = "time", column = "t" }
outputs = { x = "x" }
"""


def test_the_examples_of_the_guide_run():
    for name in ["pandas", "scipy", "umbridge"]:
        pytest.importorskip(name)
    assert run(CHAPTER, {}) > 7


def test_the_examples_of_the_readme_run(own_folder):
    for name in ["pandas", "scipy"]:
        pytest.importorskip(name)
    (own_folder / "problem.toml").write_text(PROBLEM)
    (own_folder / "Decay.mo").write_text(
        "model Decay\n  parameter Real k = 1;\n  Real x(start = 1, fixed = true);\n"
        "equation\n  der(x) = -k*x;\nend Decay;\n"
    )
    (own_folder / "decay.csv").write_text("t,x\n0.1,0.82\n0.5,0.36\n1.0,0.14\n1.5,0.05\n")
    names = {}
    assert run(README, names) == 3
    assert abs(names["fit"].x[0] - 2.04) < 0.05
    assert abs(names["solution"].parameters["k"] - 2.0) < 0.1


def run(page, names):
    """Runs the examples of a page; how many there are."""
    blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.S)
    # Not the main program, which would serve models without end.
    names["__name__"] = "page"
    for number, block in enumerate(blocks):
        exec(compile(block, f"block {number + 1} of {page.name}", "exec"), names)
    return len(blocks)
