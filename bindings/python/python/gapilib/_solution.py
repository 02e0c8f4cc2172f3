"""Identification, and what came of it."""

import html
import json
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Union

import numpy as np

from . import _data, _gapilib, _progress, _toml

if TYPE_CHECKING:
    import pandas as _pandas


def identify(
    problem: Union[str, "os.PathLike[str]", Mapping[str, Any]],
    *,
    folder: Union[None, str, "os.PathLike[str]"] = None,
    progress: _progress.Progress = None,
    **options: Any,
) -> "Solution":
    """Identifies the parameters of a model from measured data, as `gapi identify` does.

    `problem` is a problem file (.toml), or its content as a dict, as in::

        gapilib.identify({
            "model": "CaseStudies.PolarizationCurve(i_max = 1.46)",
            "parameters": {"A": {"min": 0.01, "max": 0.1}},
            "experiment": [{"data": "curve.csv", "x": "i", "outputs": {"V": "V"}}],
        })

    Files that a dict names are looked for in `folder`, by default the working directory. The data of an
    experiment can also be a data frame of pandas or a dict of columns; an index with a name or with dates is
    a column (dates in seconds from the first one), units are those of pint, of a second level of the headings,
    of ``frame.attrs["units"]`` or of headings such as ``U [mV]``. Options:
    `out` and `overwrite` (where results go), `resume` and `fresh`, `profile`, `design`, `bootstrap`,
    `posterior`, `sensitivity` ("morris" or "sobol") with `samples`, `evaluations`,
    `searches` (with how many seeds to search), `libraries`, `threads`, `allow_read`, `allow_external`, `cache`.

    Raises `GapilibError` with all that is wrong, `KeyboardInterrupt` when interrupted; then `resume=True`
    continues it.
    """
    if isinstance(problem, Mapping) and options.get("out") is None:
        # A problem without a file has no name of its own: the results of the one before give way.
        options.update(out=Path("results") / "problem", overwrite=True, fresh=not options.get("resume"))
    line = _progress.shown(progress)
    try:
        with _problem_file(problem, folder) as path:
            found = _gapilib.identify(path, progress=line, **options)
    finally:
        _progress.close(line)
    return Solution(*found)


class _problem_file:
    """A problem as a file: the one that is named, or one that is written for the time of the run."""

    def __init__(self, problem: Any, folder: Any) -> None:
        self._problem, self._folder = problem, Path(folder or ".")
        self._made: List[str] = []

    def __enter__(self) -> str:
        if not isinstance(self._problem, Mapping):
            return os.fspath(self._problem)
        descriptor, path = tempfile.mkstemp(".toml", "problem-", self._folder)
        self._made.append(path)
        try:
            with os.fdopen(descriptor, "w", encoding="utf-8") as file:
                problem, made = _data.with_files(self._problem, self._folder)
                self._made += made
                file.write(_toml.dumps(problem))
        except BaseException:
            self.__exit__()
            raise
        return path

    def __exit__(self, *_: Any) -> None:
        _data.remove(self._made)


class Figure:
    """A figure as SVG. A notebook shows it."""

    def __init__(self, svg: str) -> None:
        #: The document.
        self.svg = svg

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes it."""
        Path(path).write_text(self.svg, encoding="utf-8")

    def _repr_svg_(self) -> str:
        return self.svg


class Solution:
    """The identified parameters, how well the data determine them, and the fit.

    Everything that the report shows is in `data`, as in `result.json`. A notebook shows the report.
    """

    def __init__(self, text_json: str, text: str, page: str, plots: Mapping[str, str]) -> None:
        #: All of it, as in `result.json`.
        self.data: Dict[str, Any] = json.loads(text_json)
        #: What `gapi identify` prints.
        self.text = text
        #: The report, an HTML page.
        self.html = page
        #: Figures by their names: "fit" ("fit-2", ... for further series), "convergence", and where there
        #: are profiles "profile-" and a parameter.
        self.plots: Dict[str, Figure] = {name: Figure(svg) for name, svg in plots.items()}

    @property
    def parameters(self) -> Dict[str, float]:
        """The values by the names."""
        return {p["name"]: p["value"] for p in self.data["parameters"]}

    @property
    def verdicts(self) -> Dict[str, str]:
        """Whether the data determine a parameter, by the names."""
        return {p["name"]: p["verdict"] for p in self.data["parameters"]}

    @property
    def fitness(self) -> float:
        """The objective at the solution."""
        return self.data["fitness"]

    @property
    def covariance(self) -> Optional[np.ndarray]:
        """The covariance matrix of the parameters in their order, NaN for those that the data do not
        determine; None where there is none."""
        correlations = self.data.get("correlations")
        if not correlations:
            return None
        # None, which stands for what the data do not determine, becomes NaN.
        deviations = np.array([p.get("deviation") for p in self.data["parameters"]], dtype=float)
        return np.array(correlations, dtype=float) * np.outer(deviations, deviations)

    @property
    def findings(self) -> List[Any]:
        """What is noteworthy about the data and the fit."""
        return self.data.get("findings", [])

    def table(self) -> "_pandas.DataFrame":
        """The parameters as a data frame of pandas: value, unit, standard deviation, bounds of the 95 %
        interval, range, verdict."""
        import pandas

        def row(p: Dict[str, Any]) -> Dict[str, Any]:
            low, high = p.get("interval") or (np.nan, np.nan)
            return {
                "value": p["value"],
                "unit": p["unit"],
                "deviation": p.get("deviation"),
                "low": low,
                "high": high,
                "min": p["range"][0],
                "max": p["range"][1],
                "verdict": p["verdict"],
            }

        rows = self.data["parameters"]
        return pandas.DataFrame([row(p) for p in rows], index=[p["name"] for p in rows])

    def profiles(self) -> "Optional[_pandas.DataFrame]":
        """The profile likelihoods as a data frame of pandas: parameter, a value that it was held at, the
        smallest sum of squares there, and the limit that the sum stays below within the 95 % interval. None where
        there are none: without `profile=True`, or where the search has not ended at a minimum."""
        import pandas

        found = self.data.get("profiles")
        if found is None:
            return None
        rows = [
            (one["name"], value, smallest, one["limit"])
            for one in found["profiles"]
            for value, smallest in one["points"]
        ]
        return pandas.DataFrame(rows, columns=["parameter", "value", "sum_of_squares", "limit"])

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the report."""
        Path(path).write_text(self.html, encoding="utf-8")

    def _repr_html_(self) -> str:
        page = html.escape(self.html, quote=True)
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 640px; border: 0"></iframe>'

    def __repr__(self) -> str:
        return self.text
