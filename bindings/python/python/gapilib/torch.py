"""Simulations in PyTorch, with the exact derivatives of the model.

    import torch
    from gapilib.torch import function

    simulate = function(simulator)
    values = torch.tensor([1.0, 1.0], dtype=torch.float64, requires_grad=True)
    ((simulate(values) - measured)**2).sum().backward()
"""

from typing import Any, Callable

import torch

from . import _adapter, _gapilib

__all__ = ["function"]


def _backward(ctx: Any, gradient: Any) -> Any:
    (derivatives,) = ctx.saved_tensors
    count = derivatives.shape[-1]
    by_point = derivatives.reshape(*ctx.batch, -1, count)
    return (gradient.reshape(*ctx.batch, 1, -1) @ by_point).reshape(*ctx.batch, count), None


class _Outputs(torch.autograd.Function):
    """The outputs of a simulator, whose derivatives are kept for the way back."""

    @staticmethod
    def forward(ctx: Any, values: Any, simulator: _gapilib.Simulator) -> Any:
        ctx.batch = values.shape[:-1]
        rows = values.detach().cpu().numpy()
        if values.requires_grad:
            outputs, derivatives = _adapter.jacobians(simulator, rows)
            ctx.save_for_backward(torch.as_tensor(derivatives, dtype=values.dtype, device=values.device))
        else:
            outputs = _adapter.values(simulator, rows)
        return torch.as_tensor(outputs, dtype=values.dtype, device=values.device)

    #: Second derivatives are refused.
    backward: Any = staticmethod(torch.autograd.function.once_differentiable(_backward))


def function(simulator: _gapilib.Simulator) -> Callable[[Any], Any]:
    """The outputs of a simulator as a function of a tensor whose last axis has the values of its parameters.

    Gradients are those of `Simulator.jacobian`; there are no second ones. A batch without gradients is
    simulated on all cores, and failed rows are NaN.
    """
    count = len(simulator.parameters)

    def called(values: Any) -> Any:
        values = torch.as_tensor(values)
        if values.shape[-1:] != (count,):
            raise ValueError(f"the values have the shape {tuple(values.shape)}; expected {count} along the last axis")
        return _Outputs.apply(values, simulator)

    return called
