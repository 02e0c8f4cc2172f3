"""Identifies the parameters of Modelica models from measured data; compiles and simulates Modelica
models natively.

    >>> import gapilib
    >>> session = gapilib.Session()
    >>> session.load_text("model Decay parameter Real k = 1; Real x(start = 1, fixed = true); "
    ...                   "equation der(x) = -k*x; end Decay;")
    ['Decay']
    >>> result = session.model("Decay").simulate({"k": 2.0}, stop=1.0, tolerance=1e-8)
    >>> round(float(result["x"][-1]), 6)
    0.135335
"""

import os as _os
import pathlib as _pathlib

from . import ga
from ._gapilib import Fmu, GapilibError, Model, Session, SimulationResult, Simulator, __version__
from ._problem import Experiment, Parameter, Problem
from ._run import run
from ._solution import Figure, Solution, identify

__all__ = [
    "Experiment",
    "Figure",
    "Fmu",
    "GapilibError",
    "Model",
    "Parameter",
    "Problem",
    "Session",
    "SimulationResult",
    "Simulator",
    "Solution",
    "__version__",
    "ga",
    "identify",
    "run",
]

# The library in exported units comes with the package; a variable of the user's names another one.
for _library in _pathlib.Path(__file__).parent.glob("*gapilib_fmu.*"):
    _os.environ.setdefault("GAPILIB_FMU_RUNTIME", str(_library))
