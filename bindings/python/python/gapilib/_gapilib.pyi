import os
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Literal, Mapping, Optional, Sequence, Tuple, Union, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Progress = Optional[Callable[[str, int, int, Optional[float]], Any]]
_Path = Union[str, "os.PathLike[str]"]

__all__ = [
    "Fmu",
    "GapilibError",
    "Model",
    "Optimizer",
    "Random",
    "Session",
    "SimulationResult",
    "Simulator",
    "__version__",
    "_restored",
    "command",
    "cross",
    "identify",
    "mutate",
    "run",
    "sample",
    "select",
]

__version__: str

class GapilibError(Exception):
    code: str
    diagnostics: List[Dict[str, Any]]
    result: Optional["SimulationResult"]

def command(arguments: Sequence[str]) -> int: ...
def run(
    script: _Path,
    *,
    out: Optional[_Path] = None,
    overwrite: bool = False,
    resume: bool = False,
    libraries: Sequence[_Path] = ...,
    threads: Optional[int] = None,
    allow_read: Sequence[_Path] = ...,
    allow_write: bool = False,
    allow_system: bool = False,
    allow_external: bool = False,
    cache: bool = True,
    progress: _Progress = None,
) -> Dict[str, Any]: ...
def identify(
    session: Session,
    problem: _Path,
    out: _Path,
    *,
    identity: _Path,
    given: Mapping[str, bytes] = ...,
    texts: Sequence[Tuple[str, str]] = ...,
    overwrite: bool = False,
    resume: bool = False,
    fresh: bool = False,
    profile: bool = False,
    design: bool = False,
    bootstrap: bool = False,
    posterior: bool = False,
    sensitivity: Optional[str] = None,
    samples: int = 0,
    evaluations: Optional[int] = None,
    searches: Optional[int] = None,
    verbose: bool = False,
    progress: _Progress = None,
) -> Tuple[str, str, str, Dict[str, str], Dict[str, str], str, List[Path]]: ...

@final
class Session:
    def __new__(
        cls,
        *,
        libraries: Sequence[_Path] = ...,
        threads: Optional[int] = None,
        allow_read: Sequence[_Path] = ...,
        allow_write: bool = False,
        allow_external: bool = False,
        cache: bool = True,
        dialogue: bool = False,
        progress: _Progress = None,
    ) -> Session: ...
    def load(self, path: _Path) -> List[str]: ...
    def load_text(self, text: str, name: str = "text") -> List[str]: ...
    def execute(self, text: str, name: str = "input") -> None: ...
    def run(self, path: _Path) -> None: ...
    def eval(self, expression: str) -> Any: ...
    def variables(self) -> Dict[str, Any]: ...
    def check(self, name: str) -> List[Dict[str, Any]]: ...
    def flatten(self, name: str) -> str: ...
    def model(self, name: str) -> Model: ...
    def fmu(self, path: _Path, *, co_simulation: bool = False) -> Fmu: ...
    def allow_read(self, path: _Path) -> None: ...
    def complete(self, beginning: str) -> List[str]: ...
    def help(self, name: str) -> Optional[str]: ...
    @property
    def output(self) -> Path: ...
    def interrupt(self) -> None: ...
    def __getitem__(self, key: str, /) -> Any: ...
    def __setitem__(self, key: str, value: Any, /) -> None: ...
    def __contains__(self, key: str, /) -> bool: ...

@final
class Model:
    @property
    def name(self) -> str: ...
    @property
    def session(self) -> Session: ...
    @property
    def parameters(self) -> Dict[str, Dict[str, Any]]: ...
    @property
    def outputs(self) -> List[str]: ...
    @property
    def states(self) -> List[str]: ...
    @property
    def names(self) -> List[str]: ...
    @property
    def experiment(self) -> Dict[str, Optional[float]]: ...
    def unit(self, variable: str) -> str: ...
    def simulate(
        self,
        parameters: Optional[Mapping[str, float]] = None,
        *,
        start: Optional[float] = None,
        stop: Optional[float] = None,
        intervals: Optional[int] = None,
        interval: Optional[float] = None,
        tolerance: Optional[float] = None,
        method: Optional[str] = None,
        step: Optional[float] = None,
        variables: Optional[Sequence[str]] = None,
        initial: Optional[SimulationResult] = None,
        initial_time: Optional[float] = None,
        inputs: Any = None,
        interpolation: Optional[str] = None,
    ) -> SimulationResult: ...
    def simulator(
        self,
        parameters: Sequence[str],
        outputs: Union[str, Sequence[str]],
        at: ArrayLike,
        *,
        x: str = "time",
        tolerance: Optional[float] = None,
        threads: Optional[int] = None,
    ) -> Simulator: ...

    def export_fmu(
        self,
        path: _Path,
        parameters: Optional[Mapping[str, float]] = None,
        *,
        version: int = 3,
        kind: str = "both",
    ) -> None: ...

@final
class Fmu:
    @property
    def name(self) -> str: ...
    @property
    def path(self) -> Path: ...
    @property
    def session(self) -> Session: ...
    @property
    def parameters(self) -> Dict[str, Dict[str, Any]]: ...
    @property
    def outputs(self) -> List[str]: ...
    @property
    def names(self) -> List[str]: ...
    def simulate(
        self,
        parameters: Optional[Mapping[str, Union[float, str]]] = None,
        *,
        start: Optional[float] = None,
        stop: Optional[float] = None,
        intervals: Optional[int] = None,
        interval: Optional[float] = None,
        tolerance: Optional[float] = None,
        method: Optional[str] = None,
        variables: Optional[Sequence[str]] = None,
        inputs: Any = None,
        interpolation: Optional[str] = None,
    ) -> SimulationResult: ...

@final
class SimulationResult:
    @property
    def time(self) -> NDArray[np.float64]: ...
    @property
    def names(self) -> List[str]: ...
    @property
    def units(self) -> Dict[str, str]: ...
    @property
    def descriptions(self) -> Dict[str, str]: ...
    @property
    def statistics(self) -> Dict[str, int]: ...
    def __getitem__(self, key: str, /) -> NDArray[np.float64]: ...
    def __contains__(self, key: str, /) -> bool: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[str]: ...
    def at(self, name: str, times: ArrayLike) -> NDArray[np.float64]: ...
    def to_pandas(self, names: Optional[Sequence[str]] = None) -> Any: ...
    def to_arrow(self, names: Optional[Sequence[str]] = None) -> Any: ...
    def to_xarray(self, names: Optional[Sequence[str]] = None) -> Any: ...
    def write(self, path: _Path) -> None: ...

@final
class Simulator:
    @property
    def parameters(self) -> List[str]: ...
    @property
    def outputs(self) -> List[str]: ...
    @property
    def is_single(self) -> bool: ...
    @property
    def at(self) -> NDArray[np.float64]: ...
    def __call__(self, values: ArrayLike) -> NDArray[np.float64]: ...
    def many(self, values: ArrayLike, *, failures: bool = False) -> Any: ...
    def jacobian(self, values: ArrayLike) -> Tuple[NDArray[np.float64], NDArray[np.float64]]: ...

@final
class Optimizer:
    def __new__(
        cls,
        bounds: Sequence[Tuple[float, float]],
        *,
        method: str = "genetic",
        seed: Optional[Sequence[float]] = None,
        start: Optional[Sequence[float]] = None,
        budget: Optional[int] = None,
        objectives: int = 1,
        data_norm: float = 1.0,
        settings: Mapping[str, Union[float, str]] = ...,
    ) -> Optimizer: ...
    @staticmethod
    def methods() -> List[str]: ...
    def ask(self) -> NDArray[np.float64]: ...
    def tell(
        self,
        fitness: ArrayLike,
        residuals: Optional[ArrayLike] = None,
        jacobians: Optional[ArrayLike] = None,
    ) -> None: ...
    @property
    def wants(self) -> Literal["fitness", "residuals", "jacobians"]: ...
    @property
    def best(self) -> Optional[Tuple[NDArray[np.float64], float]]: ...
    @property
    def phase(self) -> str: ...

@final
class Random:
    def __new__(cls, seed: Optional[Sequence[float]] = None) -> Random: ...
    def uniform(self, count: int) -> NDArray[np.float64]: ...
    def normal(self, count: int) -> NDArray[np.float64]: ...
    @property
    def state(self) -> List[float]: ...

_Bounds = Sequence[Tuple[float, float]]

def sample(bounds: _Bounds, count: int, *, method: str = "uniform", random: Random) -> NDArray[np.float64]: ...
def select(fitness: Sequence[float], count: int, *, method: str = "tournament", random: Random) -> List[int]: ...
def cross(parents: ArrayLike, bounds: _Bounds, *, method: str = "one_point", random: Random) -> NDArray[np.float64]: ...
def mutate(
    population: ArrayLike,
    bounds: _Bounds,
    rate: float,
    *,
    method: str = "uniform",
    generation: int = 0,
    random: Random,
) -> NDArray[np.float64]: ...
def _restored(
    model: str,
    time: NDArray[np.float64],
    series: Sequence[Tuple[str, str, str, Any]],
    numbers: Sequence[int],
) -> SimulationResult: ...
