"""Compiled models as UM-Bridge models: a server that tools for uncertainty quantification, optimisation and
Bayesian inference call over HTTP, in whatever language they are written.

    simulator = model.simulator(["k", "a"], "x", at=times)
    gapilib.umbridge.serve(SimulatorModel(simulator, [1.0, 1.0]), port=4242)

It needs the package `umbridge` (``pip install gapilib[umbridge]``). The protocol: L. Seelinger et al.,
UM-Bridge: Uncertainty quantification and modeling bridge, Journal of Open Source Software 8 (2023) 4748.
"""

from typing import Any, Dict, List, Optional, Sequence

import numpy as np
import umbridge

from ._gapilib import GapilibError, Simulator

__all__ = ["SimulatorModel", "serve"]

_Vectors = List[List[float]]
_Config = Optional[Dict[str, Any]]


class SimulatorModel(umbridge.Model):
    """A `Simulator` as a UM-Bridge model.

    Its one input vector has the parameters in their order, its output vectors are the outputs at the points,
    one vector for each output. It has a gradient and applies its Jacobian matrix if the model has exact
    derivatives. To find that out, the model is simulated at `nominal`, values for the parameters at which it
    can be simulated; a failure there raises `GapilibError`. Elsewhere derivatives can be missing, as at an
    event whose time does not depend smoothly on the parameters: the request fails then.
    """

    def __init__(self, simulator: Simulator, nominal: Sequence[float], name: str = "forward") -> None:
        super().__init__(name)
        self._simulator = simulator
        self._is_single = simulator(nominal).ndim == 1
        self._has_derivatives = _has_derivatives(simulator, nominal)

    def get_input_sizes(self, config: _Config = None) -> List[int]:
        return [len(self._simulator.parameters)]

    def get_output_sizes(self, config: _Config = None) -> List[int]:
        return [len(self._simulator.at)] * len(self._simulator.outputs)

    def __call__(self, parameters: _Vectors, config: _Config = None) -> _Vectors:
        values = self._by_output(self._simulator(parameters[0]))
        return values.T.tolist()

    def gradient(
        self, out_wrt: int, in_wrt: int, parameters: _Vectors, sens: List[float], config: _Config = None
    ) -> List[float]:
        return (np.asarray(sens) @ self._jacobian(parameters, out_wrt)).tolist()

    def apply_jacobian(
        self, out_wrt: int, in_wrt: int, parameters: _Vectors, vec: List[float], config: _Config = None
    ) -> List[float]:
        return (self._jacobian(parameters, out_wrt) @ np.asarray(vec)).tolist()

    def supports_evaluate(self) -> bool:
        return True

    def supports_gradient(self) -> bool:
        return self._has_derivatives

    def supports_apply_jacobian(self) -> bool:
        return self._has_derivatives

    def _jacobian(self, parameters: _Vectors, output: int) -> np.ndarray:
        """The derivatives of an output: points x parameters."""
        _, jacobian = self._simulator.jacobian(parameters[0])
        return self._by_output(jacobian)[:, output]

    def _by_output(self, array: np.ndarray) -> np.ndarray:
        """An array whose second axis is that of the outputs, also if there is one output."""
        return array[:, np.newaxis] if self._is_single else array


def _has_derivatives(simulator: Simulator, nominal: Sequence[float]) -> bool:
    try:
        simulator.jacobian(nominal)
    except GapilibError as error:
        if error.code != "bad-option":
            raise
        return False
    return True


def serve(*models: umbridge.Model, port: int = 4242) -> None:
    """Serves the models until the process is interrupted.

    `umbridge` listens at all addresses of the machine, without a password. A request whose simulation fails
    is answered with the status 500, for which the client raises an exception.
    """
    umbridge.serve_models(list(models), port)
