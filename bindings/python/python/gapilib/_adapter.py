"""What the adapters for other packages share: simulations and derivatives of batches of values."""

from typing import Tuple

import numpy as np

from . import _gapilib


def values(simulator: _gapilib.Simulator, batch: np.ndarray) -> np.ndarray:
    """The outputs for values of the parameters, along the last axis; simulations of a batch that fail are NaN."""
    batch = np.asarray(batch, dtype=float)
    if batch.ndim == 1:
        return simulator(batch)
    rows = simulator.many(batch.reshape(-1, batch.shape[-1]))
    return rows.reshape(batch.shape[:-1] + rows.shape[1:])


def jacobians(simulator: _gapilib.Simulator, batch: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The outputs and their derivatives for values of the parameters along the last axis."""
    batch = np.asarray(batch, dtype=float)
    if batch.ndim == 1:
        return simulator.jacobian(batch)
    pairs = [simulator.jacobian(row) for row in batch.reshape(-1, batch.shape[-1])]
    outputs, derivatives = (np.stack(one) for one in zip(*pairs))
    return (
        outputs.reshape(batch.shape[:-1] + outputs.shape[1:]),
        derivatives.reshape(batch.shape[:-1] + derivatives.shape[1:]),
    )
