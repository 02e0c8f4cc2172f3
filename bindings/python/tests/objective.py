"""A fit of a simulated curve, in a module that other processes import."""

import numpy as np

import gapilib
from gapilib import ga

from conftest import DECAY

BOUNDS = [(0.1, 5.0), (0.1, 3.0)]
TIMES = np.linspace(0.1, 2, 12)
MEASURED = 1.3 * np.exp(-2.1 * TIMES)

_simulators = []


def squares(genes):
    """The sum of squares; each process has its simulator, a forked one that of its parent."""
    if not _simulators:
        session = gapilib.Session(cache=False, threads=1)
        session.load_text(DECAY)
        _simulators.append(session.model("Decay").simulator(["k", "a"], "x", TIMES, tolerance=1e-8))
    return float(np.sum((_simulators[0](genes) - MEASURED) ** 2))


def search(executor=None):
    """What is found, alone or with the processes of an executor."""
    return ga.minimize(squares, BOUNDS, generations=8, seed=[1, 2, 3, 4, 5, 6], executor=executor)
