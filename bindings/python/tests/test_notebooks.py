"""The worked notebooks: executed, and compared with the results that they hold."""

import re
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("ipykernel")
nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")

FOLDER = Path(__file__).resolve().parents[3] / "docs" / "notebooks"
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?(?![\w.])")

#: Notebook, the packages that it needs, and the largest relative difference of a number. Those of a Markov
#: chain depend on versions: standard deviations of 2,000 effective draws differ by some percent.
NOTEBOOKS = [
    ("least_squares", ["scipy", "matplotlib"], 1e-3),
    ("pypesto", ["pypesto", "matplotlib"], 0.02),
    ("posterior", ["emcee", "arviz", "matplotlib"], 0.15),
    ("pymc", ["pymc", "arviz", "matplotlib"], 0.15),
    ("gradient_descent", ["jax", "matplotlib"], 1e-3),
]


def printed(notebook):
    """What each cell has printed or shown as text."""
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    shown = []
    for cell in cells:
        streams = [output.text for output in cell.outputs if output.get("name") == "stdout"]
        values = [output.data.get("text/plain", "") for output in cell.outputs if "data" in output]
        shown.append("\n".join([*streams, *values]))
    return shown


def figures(notebook):
    """The number of figures."""
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    return sum("image/svg+xml" in output.get("data", {}) for output in outputs)


@pytest.mark.parametrize("name, packages, tolerance", NOTEBOOKS, ids=[one[0] for one in NOTEBOOKS])
def test_a_notebook_gives_the_results_that_it_holds(name, packages, tolerance):
    for package in packages:
        pytest.importorskip(package)
    file = FOLDER / f"{name}.ipynb"
    kept = nbformat.read(file, as_version=4)
    executed = nbformat.read(file, as_version=4)
    resources = {"metadata": {"path": str(FOLDER)}}
    nbclient.NotebookClient(executed, timeout=600, kernel_name="python3", resources=resources).execute()
    assert figures(kept) == figures(executed) == 1
    compared = 0
    for ours, theirs in zip(printed(executed), printed(kept)):
        assert NUMBER.sub("#", ours).split() == NUMBER.sub("#", theirs).split()
        found, expected = (np.array(NUMBER.findall(text), dtype=float) for text in (ours, theirs))
        np.testing.assert_allclose(found, expected, rtol=tolerance)
        compared += len(found)
    assert compared > 10


@pytest.mark.parametrize("file", sorted(FOLDER.glob("*.ipynb")), ids=lambda file: file.stem)
def test_a_notebook_is_small_and_known(file):
    assert file.stem in [name for name, _, _ in NOTEBOOKS]
    assert file.stat().st_size < 60_000
    nbformat.validate(nbformat.read(file, as_version=4))
