"""Identification, and what came of it."""

import csv
import html
import io
import json
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Literal, Mapping, Optional, Sequence, Union

import numpy as np

from . import _gapilib, _problem, _progress

if TYPE_CHECKING:
    import pandas as _pandas

_Path = Union[str, "os.PathLike[str]"]


def identify(
    problem: Union[_Path, _problem.Problem, Mapping[str, Any]],
    *,
    session: Optional[_gapilib.Session] = None,
    folder: Optional[_Path] = None,
    out: Optional[_Path] = None,
    overwrite: bool = False,
    resume: bool = False,
    fresh: bool = False,
    profile: bool = False,
    design: bool = False,
    bootstrap: bool = False,
    posterior: bool = False,
    sensitivity: Optional[Literal["morris", "sobol"]] = None,
    samples: int = 0,
    evaluations: Optional[int] = None,
    searches: Optional[int] = None,
    libraries: Sequence[_Path] = (),
    threads: Optional[int] = None,
    allow_read: Sequence[_Path] = (),
    allow_external: bool = False,
    cache: bool = True,
    verbose: bool = False,
    progress: _progress.Progress = None,
) -> "Solution":
    """Identifies the parameters of a model from measured data, as `gapi identify` does.

    `problem` is a problem file (.toml), or its content as a dict, as in::

        gapilib.identify({
            "model": "CaseStudies.PolarizationCurve(i_max = 1.46)",
            "parameters": {"A": (0.01, 0.1)},
            "experiment": {"data": "curve.csv", "x": "i", "outputs": {"V": "V"}},
        })

    The model of a dict is the name of a class, the text of one, a `Model` or an `Fmu`; `session` has classes
    that it names. Files are looked for in `folder`, by default the working directory. The data of an
    experiment are a file (also Parquet, Feather and NetCDF, which pyarrow and xarray read), a data frame of
    pandas or polars, a table of Arrow, a dataset of xarray or a dict of columns; an index with a name or with
    dates is a column (dates in seconds from the first one), units are those of pint, of a second level of the
    headings, of ``frame.attrs["units"]`` or of headings such as ``U [mV]``.

    Nothing is written unless `out` names a folder, and nothing is printed unless `verbose` (the report and
    warnings) or `progress` (True for a line on a terminal or in a notebook, or a function of label, done,
    total and best) asks for it. `overwrite` replaces the results of another problem in `out`, `resume`
    continues a run there that was interrupted, `fresh` discards it. `profile`, `design`, `bootstrap`,
    `posterior` and `sensitivity` ("morris" or "sobol", with `samples`) ask for more than the fit;
    `evaluations` ends the search, `searches` repeats it with other seeds. `libraries`, `threads`,
    `allow_read`, `allow_external` and `cache` are those of `Session`, and not used where there is one.

    Raises `GapilibError` with all that is wrong, `KeyboardInterrupt` when interrupted; then `resume=True`
    continues it, if it has a folder `out`.
    """
    if resume and out is None:
        raise ValueError("`resume=True` continues the run in a folder: name it with `out`")
    ready = _problem.prepared(problem, folder, session)
    options: Dict[str, Any] = {
        "libraries": [os.path.abspath(one) for one in libraries],
        "threads": threads,
        "allow_read": [os.path.abspath(one) for one in allow_read],
        "allow_external": allow_external,
        "cache": cache,
    }
    engine = _gapilib.Session(**options) if ready.session is None else ready.session
    line = _progress.shown(progress or False)
    with tempfile.TemporaryDirectory(prefix="gapilib-") as temporary:
        try:
            found = _gapilib.identify(
                engine,
                ready.path,
                os.path.join(temporary, "results") if out is None else out,
                identity=ready.identity,
                given=ready.given,
                texts=ready.texts,
                overwrite=overwrite,
                resume=resume,
                fresh=fresh,
                profile=profile,
                design=design,
                bootstrap=bootstrap,
                posterior=posterior,
                sensitivity=sensitivity,
                samples=samples,
                evaluations=evaluations,
                searches=searches,
                verbose=verbose,
                progress=line,
            )
        except KeyboardInterrupt:
            how = "`resume=True` continues it" if out else "with a folder `out` it can be continued"
            raise KeyboardInterrupt(f"the identification was interrupted; {how}") from None
        finally:
            _progress.close(line)
    recipe = {
        "session": ready.session,
        "options": options,
        "texts": ready.texts,
        "folder": os.path.dirname(os.path.abspath(ready.path)),
    }
    return Solution(found, recipe, None if out is None else Path(out))


def _values(cells: List[str]) -> Any:
    """A column of a table: numbers with all their digits, NaN for empty cells, or else strings."""
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return cells


class Figure:
    """A figure as SVG. A notebook shows it."""

    def __init__(self, svg: str) -> None:
        #: The document.
        self.svg = svg

    def save(self, path: _Path) -> None:
        """Writes it."""
        Path(path).write_text(self.svg, encoding="utf-8")

    def _repr_svg_(self) -> str:
        return self.svg


class Solution:
    """The identified parameters, how well the data determine them, and the fit.

    Everything that the report shows is in `data`, as in `result.json`. A notebook shows the report. Tables are
    data frames of pandas; those of what was not asked for are None. A solution can be pickled.
    """

    def __init__(self, found: Sequence[Any], recipe: Mapping[str, Any], path: Optional[Path]) -> None:
        text_json, text, page, plots, tables, calibrated, files = found
        #: All of it, as in `result.json`.
        self.data: Dict[str, Any] = json.loads(text_json)
        #: What `gapi identify` prints.
        self.text: str = text
        #: The report, an HTML page.
        self.html: str = page
        #: Figures by their names: "fit" ("fit-2", ... for further series), "convergence", and where there
        #: are profiles "profile-" and a parameter.
        self.plots: Dict[str, Figure] = {name: Figure(svg) for name, svg in plots.items()}
        #: The folder with the results, None without `out`.
        self.path: Optional[Path] = path
        #: The calibrated model as a class of Modelica, which extends the model.
        self.modelica: str = calibrated
        self._tables: Dict[str, str] = dict(tables)
        self._recipe: Dict[str, Any] = {**recipe, "files": files}
        self._model: Union[None, _gapilib.Model, _gapilib.Fmu] = None

    def __getstate__(self) -> Dict[str, Any]:
        # A session cannot be sent to other processes.
        recipe = {**self._recipe, "session": None, "is_of_session": self._recipe.get("session") is not None}
        return {**self.__dict__, "_model": None, "_recipe": recipe}

    @property
    def parameters(self) -> Dict[str, float]:
        """The values by the names."""
        return {p["name"]: p["value"] for p in self.data["parameters"]}

    @property
    def verdicts(self) -> Dict[str, Optional[str]]:
        """Whether the data determine a parameter, by the names; None where that is unknown."""
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

    def _table(self, name: str) -> "Optional[_pandas.DataFrame]":
        import pandas

        text = self._tables.get(name)
        if text is None:
            return None
        heading, *rows = csv.reader(io.StringIO(text))
        columns = [list(column) for column in zip(*rows)] or [[] for _ in heading]
        return pandas.DataFrame({own: _values(column) for own, column in zip(heading, columns)})

    def residuals(self) -> "_pandas.DataFrame":
        """Each point: experiment, variable, use ("fit" or "validation"), x, measured, simulated, residual."""
        table = self._table("fit")
        assert table is not None
        return table.astype({"experiment": str})

    def curve(self, variable: Optional[str] = None) -> "_pandas.DataFrame":
        """The simulated curves between the points: experiment, variable, x, y; of one variable, or of all."""
        import pandas

        series = [one for one in self.data["series"] if variable in (None, one["y"][0])]
        if not series:
            known = ", ".join(sorted({one["y"][0] for one in self.data["series"]}))
            raise KeyError(f"{variable} was not compared; these were: {known}")
        rows = [(one["experiment"], one["y"][0], x, y) for one in series for x, y in one.get("curve", [])]
        return pandas.DataFrame(rows, columns=["experiment", "variable", "x", "y"])

    def bands(self) -> "Optional[_pandas.DataFrame]":
        """The 95 % bands of the curves: experiment, variable, x, y, and the half-widths of the confidence and of
        the prediction band."""
        return self._table("bands")

    def bootstrap(self) -> "Optional[_pandas.DataFrame]":
        """The estimates of each replicate: a column for each parameter. None without `bootstrap=True`."""
        return self._table("bootstrap")

    def posterior(self) -> "Optional[_pandas.DataFrame]":
        """Draws of the posterior distribution: chain, draw (both from 0), and a column for each parameter. None
        without `posterior=True`."""
        table = self._table("posterior")
        if table is not None:
            chains = int(self.data["inferred"]["posterior"]["chains"])
            chain, draw = np.divmod(np.arange(len(table)), len(table) // chains)
            table.insert(0, "draw", draw)
            table.insert(0, "chain", chain)
        return table

    def design(self) -> "Optional[_pandas.DataFrame]":
        """Proposals for the next measurement: criterion ("interval", "D", "A" or "repeat"), the parameter whose
        interval shrinks most, points of a variable from one X to another, and for each parameter the half-width
        of its 95 % interval afterwards as a fraction of its value. None without `design=True`."""
        import pandas

        found = self.data.get("inferred", {}).get("next_measurement")
        if found is None:
            return None
        names = found["parameters"]

        def row(one: Mapping[str, Any], plan: Mapping[str, Any]) -> Dict[str, Any]:
            about = one.get("parameter")
            low, high = plan["range"]
            return {
                "criterion": one["criterion"],
                "parameter": None if about is None else names[about],
                "experiment": plan["experiment"],
                "variable": plan["variable"],
                "points": plan["points"],
                "from": low,
                "to": high,
                **{f"after_{name}": half for name, half in zip(names, one["after"])},
            }

        return pandas.DataFrame([row(one, plan) for one in found["proposals"] for plan in one["plans"]])

    @property
    def model(self) -> Union[_gapilib.Model, _gapilib.Fmu]:
        """The calibrated model: the model with the values found. What an experiment sets beside them (`set`,
        `start`, inputs) is not part of it. Of a unit it is the unit, whose values `simulate` gives."""
        if self._model is None:
            if self._recipe.get("is_of_session"):
                raise RuntimeError(
                    "the model belongs to a session of another process: load `solution.modelica` in a session "
                    "that has its classes"
                )
            self._model = _problem.calibrated(self._recipe, self.modelica, str(self.data["model"]))
        return self._model

    def simulate(self, parameters: Optional[Mapping[str, float]] = None, **options: Any) -> _gapilib.SimulationResult:
        """Simulates the calibrated model, with other values for `parameters`; options are those of
        `Model.simulate`."""
        model = self.model
        values: Dict[str, Any] = dict(parameters or {})
        if isinstance(model, _gapilib.Fmu):
            # Values of single experiments are not those of the unit.
            values = {**{k: v for k, v in self.parameters.items() if "@" not in k}, **values}
        return model.simulate(values, **options)

    def to_arviz(self) -> Any:
        """The posterior with the data that it was inferred from, as ArviZ takes it. Needs `posterior=True`."""
        import arviz

        draws = self.posterior()
        if draws is None:
            raise ValueError("there is no posterior: identify with `posterior=True`")
        chains = int(draws["chain"].max()) + 1
        names = [name for name in draws.columns if name not in ("chain", "draw")]
        groups: Dict[str, Any] = {
            "posterior": {name: draws[name].to_numpy().reshape(chains, -1) for name in names},
            "observed_data": {},
        }
        for number, series in enumerate(self.data["series"], 1):
            same = sum(one["y"][0] == series["y"][0] for one in self.data["series"])
            name = series["y"][0] if same == 1 else f"{series['y'][0]} ({series['experiment'] or number})"
            groups["observed_data"][name] = np.array([point[1] for point in series["points"]], dtype=float)
        # The first argument of version 1, and keywords before.
        if int(arviz.__version__.split(".")[0]) >= 1:
            return arviz.from_dict(groups)
        return arviz.from_dict(**groups)

    def to_xarray(self) -> Any:
        """Estimates, covariance and series as a dataset of xarray. The points of series number k from 0 have the
        dimension `point_k`."""
        import xarray

        rows = self.data["parameters"]
        names = [p["name"] for p in rows]
        intervals = np.array([p.get("interval") or (np.nan, np.nan) for p in rows], dtype=float)
        dataset = xarray.Dataset(
            {
                "value": ("parameter", np.array([p["value"] for p in rows])),
                "deviation": ("parameter", np.array([p.get("deviation") for p in rows], dtype=float)),
                "interval": (("parameter", "end"), intervals),
                "unit": ("parameter", [p["unit"] for p in rows]),
                "verdict": ("parameter", [p["verdict"] or "" for p in rows]),
            },
            coords={"parameter": names, "end": ["low", "high"]},
            attrs={"model": self.data["model"], "fitness": self.fitness},
        )
        covariance = self.covariance
        if covariance is not None:
            dataset = dataset.assign_coords(other_parameter=names)
            dataset["covariance"] = (("parameter", "other_parameter"), covariance)
        for number, series in enumerate(self.data["series"]):
            points = np.array(series["points"], dtype=float).reshape(-1, 3)
            about = {"variable": series["y"][0], "experiment": series["experiment"], "units": series["y"][1]}
            dimension = f"point_{number}"
            x = {"variable": series["x"][0], "units": series["x"][1]}
            dataset = dataset.assign_coords({f"x_{number}": (dimension, points[:, 0], x)})
            dataset[f"measured_{number}"] = (dimension, points[:, 1], about)
            dataset[f"simulated_{number}"] = (dimension, points[:, 2], about)
        return dataset

    def save(self, path: _Path) -> None:
        """Writes the report."""
        Path(path).write_text(self.html, encoding="utf-8")

    def _repr_html_(self) -> str:
        page = html.escape(self.html, quote=True)
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 640px; border: 0"></iframe>'

    def __repr__(self) -> str:
        return self.text
