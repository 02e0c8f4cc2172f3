"""Simulations in PyTensor and PyMC, with the exact derivatives of the model.

    import pymc
    from gapilib.pytensor import function

    simulate = function(simulator)
    with pymc.Model():
        k = pymc.Uniform("k", 0.1, 10)
        a = pymc.Uniform("a", 0.1, 5)
        pymc.Normal("x", simulate([k, a]), 0.01, observed=measured)
"""

from typing import Any, Callable, List

import numpy as np
import pytensor
import pytensor.tensor as pt
from pytensor.graph.basic import Apply
from pytensor.graph.op import Op

from . import _gapilib

__all__ = ["function"]


class _Outputs(Op):
    """The outputs of a simulator."""

    def __init__(self, simulator: _gapilib.Simulator) -> None:
        self._simulator = simulator
        self._backward = _Product(simulator)

    def make_node(self, *inputs: Any) -> Any:
        values = pt.as_tensor_variable(inputs[0]).astype("float64")
        ndim = 1 if self._simulator.is_single else 2
        return Apply(self, [values], [pt.tensor(dtype="float64", shape=(None,) * ndim)])

    def perform(self, node: Any, inputs: Any, outputs: Any) -> None:
        outputs[0][0] = self._simulator(inputs[0])

    def pullback(self, inputs: Any, outputs: Any, gradients: Any) -> List[Any]:
        return [self._backward(inputs[0], gradients[0])]

    def L_op(self, inputs: Any, outputs: Any, gradients: Any) -> List[Any]:
        # The name of `pullback` before version 3.
        return self.pullback(inputs, outputs, gradients)


class _Product(Op):
    """The product of a vector with the Jacobian matrix."""

    def __init__(self, simulator: _gapilib.Simulator) -> None:
        self._simulator = simulator

    def make_node(self, *inputs: Any) -> Any:
        values, gradient = map(pt.as_tensor_variable, inputs)
        return Apply(self, [values, gradient], [pt.dvector()])

    def perform(self, node: Any, inputs: Any, outputs: Any) -> None:
        values, gradient = inputs
        _, derivatives = self._simulator.jacobian(values)
        outputs[0][0] = np.tensordot(gradient, derivatives, axes=gradient.ndim)


def function(simulator: _gapilib.Simulator) -> Callable[[Any], Any]:
    """The outputs of a simulator as a function of the values of its parameters: a vector, or a list of numbers.

    Gradients are those of `Simulator.jacobian`; there are no second ones.
    """
    node = _Outputs(simulator)

    def called(values: Any) -> Any:
        if isinstance(values, (list, tuple)):
            values = pt.stack([pytensor.tensor.as_tensor_variable(one) for one in values])
        return node(values)

    return called
