"""Arguments of the compiled Kalman filter that a recording keeps and fills before each pass.

A diagnosis runs thousands of passes over the same recording. Their small arrays have fixed
addresses here, which are looked up once, so that a pass costs little more than its compiled code.
Two threads must not filter the same recording at the same time.
"""

from typing import Any

import numpy as np

from boatsim.physics.kernel.records import (
    FilterHistory,
    InitialState,
    Inputs,
    Measurements,
    VesselNumbers,
)
from boatsim.physics.native.calls import pack_named_tuple, partial_call
from boatsim.physics.program import Program
from boatsim.physics.signals import AXES, Array

# numbers of the body at the end of a run's parameter values, [kg], [m], [kg m^2], as in
# `Program.body`
BODY = ("mass", "centre_ahead", "centre_below", "roll_inertia", "pitch_inertia", "yaw_inertia")
# entries of the mass matrix at the end of the constants of a compiled pass, the diagonal first
MASS_ENTRIES = 12


class VesselArguments:
    """A vessel's parameter values and active effects as arguments of compiled functions.

    Attributes:
        numbers: The argument; `write` fills it.
    """

    def __init__(self, program: Program) -> None:
        """Reserve the arrays.

        Args:
            program: Compiled effects of the vessel.
        """
        code = program.estimation_functions
        self._values = np.zeros(len(program.values()) + len(BODY))
        self._on, self._constants = program.effect_switches().copy(), np.zeros(code.K)
        record = VesselNumbers(rigid_body_values(self._values), self._values, self._on)
        self.numbers: Any = pack_named_tuple(code, record)
        self._compute_mass_constants = partial_call(
            code, "compute_mass_constants", *record, self._constants
        )
        self._inverse = bool(code.CLOSED)  # whether the constants hold the inverse
        self._diagonal = [AXES.index(axis) for axis in AXES if axis in program.vessel.dof]

    def write(self, values: Array, on: Array) -> None:
        """Write parameter values and switches.

        Args:
            values: Parameter values of the vessel model.
            on: (effects,) 1 for the effects that act, else 0.
        """
        self._values[:] = values
        self._on[:] = on

    def inertia_with_added_mass(self) -> Array:
        """Return the mass or moment of inertia (NQ,) with added mass [kg, kg m^2]."""
        self._compute_mass_constants()
        diagonal = self._constants[-MASS_ENTRIES:][self._diagonal]
        if self._inverse:
            diagonal = 1.0 / diagonal
        return np.asarray(diagonal)


class FilterArguments:
    """Arguments of the compiled filter for one recording.

    Attributes:
        inputs: Row times and commands.
        measurements: Measurements and the variances of their noise; `write_variances` fills these.
        start: Prior of the state at the first row; `write_variances` fills its covariance.
        no_history: Placeholder for the arrays of a smoothing pass.
    """

    def __init__(
        self,
        program: Program,
        inputs: Inputs,
        measured: Array,
        codes: Array,
        start: InitialState,
    ) -> None:
        """Reserve the arrays.

        Args:
            program: Compiled effects of the vessel.
            inputs: Row times and commands of the recording.
            measured: (N, C) measurements, nan where missing.
            codes: (C,) what each channel measures, as in `Measurements`.
            start: Prior of the state at the first row, without sensor noise and latent forces.
        """
        code = program.estimation_functions
        self._codes, self._nq = codes.tolist(), program.module.NQ
        self._start, self._covariance = start, start.covariance.copy()
        self._variances = np.zeros(len(codes))
        self.inputs: Any = pack_named_tuple(code, inputs)
        measurements = Measurements(measured, codes, self._variances)
        self.measurements: Any = pack_named_tuple(code, measurements)
        self.start: Any = pack_named_tuple(code, start._replace(covariance=self._covariance))
        matrix, matrices = np.zeros((1, 1)), np.zeros((1, 1, 1))
        self.no_history: Any = pack_named_tuple(
            code, FilterHistory(matrix, matrices, matrices, matrix)
        )

    def start_about(self, rates: Array) -> InitialState:
        """Return the prior of the state, with other rates about which it is linearised.

        Args:
            rates: (NQ,) earth-axes rates.
        """
        return self._start._replace(covariance=self._covariance, rates=rates)

    def write_variances(self, sensors: Array, initial_force: Array) -> None:
        """Write the variances of sensor noise, and the covariance of the state at the first row.

        Args:
            sensors: (C,) standard deviations of the sensor noise of each channel.
            initial_force: (NQ,) rms of the latent force at the first row.
        """
        nq, covariance = self._nq, self._covariance
        self._variances[:] = sensors**2
        covariance[:] = self._start.covariance
        for variance, place in zip(self._variances, self._codes, strict=True):
            if place < nq:
                covariance[place, place] = variance
        for i in range(nq):
            covariance[2 * nq + i, 2 * nq + i] = initial_force[i] ** 2
            if covariance[nq + i, nq + i] == 0.0:
                covariance[nq + i, nq + i] = 1.0


def inertia_with_added_mass(program: Program, values: Array, on: Array) -> Array:
    """Return the mass or moment of inertia (NQ,) with added mass of each degree of freedom.

    The unit is kg or kg m^2.

    Args:
        program: Compiled effects of the vessel.
        values: Parameter values of the vessel model.
        on: (effects,) 1 for the effects that act, else 0.
    """
    arguments = VesselArguments(program)
    arguments.write(values, on)
    return arguments.inertia_with_added_mass()


def rigid_body_values(values: Array) -> Array:
    """Return mass, mass centre and inertias of the hull from a vessel model's parameter values.

    They are the last entries of the array.
    """
    return values[-len(BODY) :]
