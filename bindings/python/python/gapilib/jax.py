"""Simulations in JAX: `grad`, `jit`, `vmap`, forward and reverse mode, with the exact derivatives of the model.

    import jax
    from gapilib.jax import function

    jax.config.update("jax_enable_x64", True)
    simulate = function(simulator)
    gradient = jax.grad(lambda p: ((simulate(p) - measured)**2).sum())

Without 64 bits the results are rounded to 32.
"""

from typing import Any, Callable

import jax
import jax.numpy as jnp
import numpy as np

from . import _adapter, _gapilib

__all__ = ["function"]


def function(simulator: _gapilib.Simulator) -> Callable[[Any], Any]:
    """The outputs of a simulator as a function of the values of its parameters.

    Derivatives are those of `Simulator.jacobian`, in forward mode by a rule of its own and in reverse mode by
    its transpose; there are no second ones. `vmap` simulates all rows on all cores, and failed ones are NaN.
    """
    points = (len(simulator.at),)
    count = len(simulator.parameters)

    def shape() -> Any:
        return points if simulator.is_single else (*points, len(simulator.outputs))

    def simulated(values: Any) -> Any:
        answer = jax.ShapeDtypeStruct(shape(), values.dtype)

        def host(batch: Any) -> Any:
            return np.asarray(_adapter.values(simulator, np.asarray(batch)), dtype=batch.dtype)

        return jax.pure_callback(host, answer, values, vmap_method="broadcast_all")

    def derived(values: Any) -> Any:
        dtype = values.dtype
        answers = (jax.ShapeDtypeStruct(shape(), dtype), jax.ShapeDtypeStruct((*shape(), count), dtype))

        def host(batch: Any) -> Any:
            outputs, derivatives = _adapter.jacobians(simulator, np.asarray(batch))
            return np.asarray(outputs, dtype=batch.dtype), np.asarray(derivatives, dtype=batch.dtype)

        return jax.pure_callback(host, answers, values, vmap_method="broadcast_all")

    @jax.custom_jvp
    def outputs(values: Any) -> Any:
        return simulated(values)

    @outputs.defjvp
    def _(primals: Any, tangents: Any) -> Any:
        (values,), (direction,) = primals, tangents
        at, derivatives = derived(values)
        return at, derivatives @ direction

    def called(values: Any) -> Any:
        values = jnp.asarray(values, dtype=jnp.result_type(float))
        if values.shape != (count,):
            raise ValueError(f"the values have the shape {values.shape}; expected ({count},), or `vmap` over rows")
        return outputs(values)

    return called
