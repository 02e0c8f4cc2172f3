"""The genetic algorithm and the other searches, for objectives of any kind.

An `Optimizer` is asked for individuals and told how good they are::

    search = gapilib.ga.Optimizer([(0, 1), (0, 1)], method="genetic", seed=[1, 2, 3, 4, 5, 6])
    for generation in range(50):
        rows = search.ask()
        if not len(rows):
            break
        search.tell([objective(row) for row in rows])
    genes, fitness = search.best

`sample`, `select`, `cross` and `mutate` are its operators on arrays; `Random` gives the random numbers of
GAPILib. Operators are named with their settings: ``"sbx(eta = 5)"``.
"""

from concurrent.futures import Executor
from typing import Any, Callable, Optional, Sequence, Tuple

import numpy as np

from ._gapilib import Optimizer, Random, cross, mutate, sample, select

__all__ = ["Optimizer", "Random", "cross", "minimize", "mutate", "sample", "select"]


def minimize(
    objective: Callable[[np.ndarray], float],
    bounds: Sequence[Tuple[float, float]],
    *,
    generations: int = 100,
    executor: Optional[Executor] = None,
    callback: Optional[Callable[[int, np.ndarray, float], Any]] = None,
    **settings: Any,
) -> Tuple[np.ndarray, float]:
    """The best genes and their objective after so many questions of a search.

    The individuals of one question are evaluated by `executor.map` where an executor is given (threads,
    processes, or those of Dask, mpi4py, Parsl, Ray), else one after the other; the result does not
    depend on it. An objective that raises `ArithmeticError` or `GapilibError`, or is not finite, is that
    of a failed individual. `callback(question, genes, objective)` is called after each question with the
    best so far. The other arguments are those of `Optimizer`.
    """
    search = Optimizer(list(bounds), **settings)
    if search.wants != "fitness":
        raise ValueError("this method needs residuals: use `Optimizer` itself, or `scipy.optimize`")
    if generations < 1:
        raise ValueError("`generations` must be 1 or more")
    each = _Guarded(objective)
    best: Optional[Tuple[np.ndarray, float]] = None
    for question in range(generations):
        rows = search.ask()
        if not len(rows):
            break
        found = executor.map(each, list(rows)) if executor is not None else map(each, rows)
        search.tell(np.fromiter(found, dtype=float, count=len(rows)))
        best = search.best
        if callback is not None and best is not None:
            callback(question + 1, *best)
        if search.wants != "fitness":
            break
    if best is None:
        raise ValueError("the search has asked for no individual")
    return best


class _Guarded:
    """An objective whose failures are those of individuals; can be sent to other processes."""

    def __init__(self, objective: Callable[[np.ndarray], float]) -> None:
        self.objective = objective

    def __call__(self, genes: np.ndarray) -> float:
        from ._gapilib import GapilibError

        try:
            return float(self.objective(genes))
        except (ArithmeticError, GapilibError):
            return float("nan")
