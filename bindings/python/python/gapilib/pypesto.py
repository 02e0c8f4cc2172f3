"""Simulations in pyPESTO: an objective with residuals, gradient and Gauss-Newton Hessian.

    import pypesto
    from gapilib.pypesto import objective

    problem = pypesto.Problem(objective(simulator, measured, sigma=0.01), lb=[0.1, 0.1], ub=[10, 5])
"""

from typing import Any

import numpy as np
import pypesto
from numpy.typing import ArrayLike

from . import _gapilib

__all__ = ["objective"]


def objective(simulator: _gapilib.Simulator, measured: ArrayLike, sigma: ArrayLike = 1.0) -> Any:
    """The negative logarithm of the likelihood of normal errors with the standard deviations `sigma`, without
    its constant: half of the sum of squared residuals.

    Where a simulation fails, the objective is infinite, and derivatives are NaN.
    """
    data = np.asarray(measured, dtype=float)
    scale = np.broadcast_to(np.asarray(sigma, dtype=float), data.shape)
    used = np.isfinite(data)
    count = len(simulator.parameters)

    def residuals(values: Any) -> Any:
        try:
            return ((simulator(values) - data) / scale)[used]
        except _gapilib.GapilibError:
            return np.full(int(used.sum()), np.inf)

    def derivatives(values: Any) -> Any:
        try:
            return (simulator.jacobian(values)[1] / scale[..., None])[used]
        except _gapilib.GapilibError as error:
            if error.code != "simulation-failed":
                raise
            return np.full((int(used.sum()), count), np.nan)

    def value(values: Any) -> float:
        found = residuals(values)
        return 0.5 * float(found @ found)

    return pypesto.Objective(
        fun=value,
        grad=lambda values: residuals(values) @ derivatives(values),
        hess=lambda values: derivatives(values).T @ derivatives(values),
        res=residuals,
        sres=derivatives,
        x_names=list(simulator.parameters),
    )
