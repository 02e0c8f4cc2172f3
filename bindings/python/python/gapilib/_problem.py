"""Problems as Python states them, and as `gapi identify` reads them."""

import hashlib
import os
import re
from pathlib import Path
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, TypedDict, Union

from . import _data, _gapilib, _toml

_Path = Union[str, "os.PathLike[str]"]

#: Entries that do not change what is asked: how long a run lasts, and how often it is saved.
_LIMITS = ("stop", "checkpoint")
#: The end of a class: what names of files do not have.
_CLASS = re.compile(r"\bend\s+([A-Za-z_]\w*|'[^']+')\s*;\s*\Z")


class Parameter(TypedDict, total=False):
    """A parameter that is estimated, fixed, or tied to others."""

    min: float
    max: float
    scale: str
    start: float
    unit: str
    fixed: Union[float, bool, str]
    tied: str
    initial: bool
    per_experiment: bool
    prior: Union[str, Mapping[str, float]]


class Column(TypedDict, total=False):
    """A column of the data, for X, an output or an input."""

    variable: str
    column: str
    columns: Sequence[str]
    unit: str
    factor: float
    interpolation: str
    weight: Union[float, str]
    sigma: Union[float, str]
    scale: Union[str, Mapping[str, str]]
    offset: str
    error: str
    degrees_of_freedom: float
    delay: Union[float, str]


class Covariance(TypedDict, total=False):
    """That the errors of outputs at one instant are correlated."""

    outputs: Sequence[str]
    matrix: Union[str, Sequence[Sequence[float]]]
    correlation: Sequence[Sequence[float]]
    group: str


class _Measured(TypedDict):
    data: Any
    outputs: Mapping[str, Union[str, Sequence[str], Column]]


class Experiment(_Measured, total=False):
    """Measured data, and what they were measured with."""

    name: str
    x: Union[str, Column]
    inputs: Mapping[str, Union[str, Column]]
    input_time: str
    spectrum: Mapping[str, Union[str, float]]
    set: Union[str, Mapping[str, Union[float, bool, str]]]
    start: Mapping[str, Union[float, bool, str]]
    weight: float
    covariance: Union[str, Sequence[Sequence[float]], Covariance]
    validation: bool
    steady_state: bool
    rest: bool
    start_time: float
    stop_time: float
    segments: Union[str, Sequence[float]]
    tolerance: float
    integrator: str
    max_steps: int
    max_seconds: float


class _Stated(TypedDict):
    model: Union[str, _gapilib.Model, _gapilib.Fmu]
    parameters: Mapping[str, Union[Parameter, Tuple[float, float], List[float]]]
    experiment: Union[Experiment, Sequence[Experiment]]


class Problem(_Stated, total=False):
    """A problem: what the chapter *Problem files* of the guide describes, as a dict."""

    title: str
    files: Sequence[_Path]
    noise: Mapping[str, Union[float, str, Mapping[str, Any]]]
    covariance: Union[str, Sequence[Sequence[float]], Covariance]
    fitness: Union[str, Sequence[str], Mapping[str, Any]]
    method: Mapping[str, Any]
    stop: Mapping[str, float]
    seed: Sequence[float]
    searches: int
    checkpoint: Mapping[str, float]
    bands: Union[bool, Sequence[str]]
    design: Mapping[str, Any]
    constraints: Sequence[str]
    bootstrap: Mapping[str, Any]
    posterior: Mapping[str, Any]


class Prepared(NamedTuple):
    """A problem for the engine."""

    #: Its file, which may be one in memory.
    path: str
    #: What says in a folder of results whose they are.
    identity: str
    #: Files in memory.
    given: Dict[str, bytes]
    #: Names and texts of classes.
    texts: List[Tuple[str, str]]
    #: The session that has the model, if one has it.
    session: Optional[_gapilib.Session]


def is_text(model: Any) -> bool:
    """Whether this is the text of a class, not its name or that of a file."""
    return isinstance(model, str) and _CLASS.search(model) is not None


def prepared(problem: Any, folder: Optional[_Path], session: Optional[_gapilib.Session]) -> Prepared:
    """Makes a problem ready: a file stays as it is, a dict becomes one in memory."""
    if not isinstance(problem, Mapping):
        return Prepared(os.fspath(problem), os.fspath(problem), {}, [], session)
    folder = os.path.abspath(folder or ".")
    table: Dict[str, Any] = dict(problem)
    texts: List[Tuple[str, str]] = []
    model = table.get("model")
    if isinstance(model, (_gapilib.Model, _gapilib.Fmu)):
        session = model.session
        table["model"] = os.fspath(model.path) if isinstance(model, _gapilib.Fmu) else model.name
    elif is_text(model):
        texts.append(("model", str(model)))
        table["model"] = _CLASS.search(str(model)).group(1)  # type: ignore[union-attr]
    files = table.get("files") or []
    if isinstance(files, (str, os.PathLike)):
        files = [files]
    texts += [(f"files[{number}]", one) for number, one in enumerate(files) if is_text(one)]
    table["files"] = [os.fspath(one) for one in files if not is_text(one)]
    table["parameters"] = _parameters(table.get("parameters"))
    if table["parameters"] is None:
        del table["parameters"]
    given = _experiments(table, folder)
    # What the results belong to: the content.
    digest = hashlib.sha256()
    asked = {key: value for key, value in table.items() if key not in _LIMITS}
    for part in [_toml.dumps(asked).encode(), *(text.encode() for _, text in texts), *given.values()]:
        digest.update(part)
    given["problem"] = _toml.dumps(table).encode()
    in_folder = {os.path.join(folder, name): content for name, content in given.items()}
    return Prepared(
        os.path.join(folder, "problem"),
        os.path.join(folder, f"problem {digest.hexdigest()[:16]}"),
        in_folder,
        texts,
        session,
    )


def _parameters(parameters: Any) -> Any:
    """Parameters, whose ranges may be pairs."""
    if not isinstance(parameters, Mapping):
        return parameters
    return {name: _parameter(name, entry) for name, entry in parameters.items()}


def _parameter(name: str, entry: Any) -> Any:
    if isinstance(entry, (tuple, list)):
        if len(entry) != 2:
            raise ValueError(f"the range of `{name}` is a pair (min, max), not {len(entry)} values")
        try:
            return {"min": float(entry[0]), "max": float(entry[1])}
        except (TypeError, ValueError):
            raise TypeError(f"the range of `{name}` is a pair of numbers (min, max), not {entry!r}") from None
    return entry


def _experiments(table: Dict[str, Any], folder: str) -> Dict[str, bytes]:
    """Replaces data in memory by names; the files of these names."""
    experiments: Any = table.get("experiment")
    if experiments is None:
        return {}
    if isinstance(experiments, Mapping):
        experiments = [experiments]
    given: Dict[str, bytes] = {}
    changed: List[Any] = []
    for number, one in enumerate(experiments, 1):
        data: Any = one.get("data") if isinstance(one, Mapping) else None
        if data is not None and not _data.is_file(data):
            name = f"data of experiment {number}.csv"
            given[name] = _data.text_of(data).encode()
            one = {**one, "data": name}
        elif data is not None and _data.of_other_package(data):
            name = f"{os.fspath(data)}.csv"
            given[name] = _data.text_of(_data.read(os.path.join(folder, data))).encode()
            one = {**one, "data": name}
        changed.append(one)
    table["experiment"] = changed
    return given


def calibrated(recipe: Mapping[str, Any], text: str, model: str) -> Union[_gapilib.Model, _gapilib.Fmu]:
    """The model of a problem with the values found, or the unit, whose values are given when it is simulated."""
    session = recipe.get("session")
    if session is None:
        session = _gapilib.Session(**recipe["options"])
        for name, own in recipe["texts"]:
            session.load_text(own, name)
        for file in recipe["files"]:
            session.load(os.path.join(recipe["folder"], file))
    if Path(model).suffix == ".fmu":
        return session.fmu(os.path.join(recipe["folder"], model))
    session.load_text(text, "Calibrated")
    return session.model("Calibrated")
