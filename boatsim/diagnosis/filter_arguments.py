"""Arguments of the compiled Kalman filter that a recording keeps and fills before each pass.

A diagnosis runs thousands of passes over the same recording. Their small arrays have fixed
addresses here, which are looked up once, so that a pass costs little more than its compiled code.
Two threads must not filter the same recording at the same time.
"""

import numpy as np

from boatsim.physics.kernel.records import (
    FilterHistory,
    InitialState,
    Inputs,
    LatentForce,
    Measurements,
    PassArrays,
    PassOptions,
    VesselNumbers,
)
from boatsim.physics.native.calls import BoundCall, PackedArgument, partial_call
from boatsim.physics.program import Program
from boatsim.physics.signals import AXES, Array

# numbers of the body at the end of a run's parameter values, [kg], [m], [kg m^2], as in
# `Program.body`
BODY = ("mass", "centre_ahead", "centre_below", "roll_inertia", "pitch_inertia", "yaw_inertia")
# places of the arguments of the compiled filter that change from pass to pass
FORCE, START, OPTIONS, ARRAYS, HISTORY = 3, 4, 5, 6, 7
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
        self.numbers = VesselNumbers(rigid_body_values(self._values), self._values, self._on)
        self._compute_mass_constants = partial_call(
            code, "compute_mass_constants", *self.numbers, self._constants
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
        whitened: (N, C) receives the whitened prediction errors of passes with the gains of others.
    """

    def __init__(
        self,
        program: Program,
        inputs: Inputs,
        measured: Array,
        codes: Array,
        start: InitialState,
        numbers: VesselNumbers,
    ) -> None:
        """Reserve the arrays.

        Args:
            program: Compiled effects of the vessel.
            inputs: Row times and commands of the recording.
            measured: (N, C) measurements, nan where missing.
            codes: (C,) what each channel measures, as in `Measurements`.
            start: Prior of the state at the first row, without sensor noise and latent forces.
            numbers: The vessel's numbers, which are written before each pass.
        """
        code = program.estimation_functions
        nq = program.module.NQ
        self._nq, self._start, self._covariance = nq, start, start.covariance.copy()
        self._diagonal = self._covariance.reshape(-1)[:: len(self._covariance) + 1]  # a view
        self._position_channels = np.flatnonzero(codes < nq)
        self._places = codes[self._position_channels]
        rates = self._diagonal[nq : 2 * nq]
        rates[rates == 0.0] = 1.0
        self._variances = np.zeros(len(codes))
        self._force = LatentForce(np.zeros(nq), 1.0, np.zeros(nq))
        self.whitened = np.zeros(measured.shape)
        self._gains = np.zeros((*measured.shape, program.module.NZ))
        self._scale = np.zeros(measured.shape)
        matrix, matrices = np.zeros((1, 1)), np.zeros((1, 1, 1))
        usual_start = start._replace(covariance=self._covariance)
        no_history = FilterHistory(matrix, matrices, matrices, matrix)
        self._call = BoundCall(
            code,
            "kalman_filter",
            inputs,
            Measurements(measured, codes, self._variances),
            numbers,
            self._force,
            usual_start,
            PassOptions(1.0, True, True, False),
            PassArrays(matrices, np.zeros(1), matrices, matrix, matrix),
            no_history,
        )
        self._usual_start = self._call.pack(START, usual_start)
        self._no_history = self._call.pack(HISTORY, no_history)
        self._options: dict[PassOptions, PackedArgument] = {}

    def pack_arrays(self, arrays: PassArrays) -> PackedArgument:
        """Return the arrays of a pass as an argument of `run`."""
        return self._call.pack(ARRAYS, arrays)

    def pack_arrays_for_likelihood(self, transitions: Array, steps: Array) -> PackedArgument:
        """Return the arrays of a pass of which only the log likelihood is needed.

        Args:
            transitions: (N, 3 NQ, 3 NQ) linearised transitions of another pass.
            steps: (N,) its integration steps [s].
        """
        return self.pack_arrays(
            PassArrays(transitions, steps, self._gains, self._scale, self.whitened)
        )

    def pack_start(self, rates: Array) -> PackedArgument:
        """Return the prior of the state with other rates about which it is linearised.

        Args:
            rates: (NQ,) earth-axes rates.
        """
        start = self._start._replace(covariance=self._covariance, rates=rates)
        return self._call.pack(START, start)

    def pack_history(self, history: FilterHistory) -> PackedArgument:
        """Return the arrays of a smoothing pass as an argument of `run`."""
        return self._call.pack(HISTORY, history)

    def run(
        self,
        options: PassOptions,
        arrays: PackedArgument,
        start: PackedArgument | None = None,
        history: PackedArgument | None = None,
    ) -> float:
        """Run the compiled filter, which fills or uses the arrays; return the log likelihood.

        Args:
            options: What the pass computes.
            arrays: Arrays of the pass, by `pack_arrays`.
            start: Prior of the state, by `pack_start`; None: the usual one.
            history: Arrays of a smoothing pass, by `pack_history`; None: no such pass.
        """
        call = self._call
        if options not in self._options:
            self._options[options] = call.pack(OPTIONS, options)
        call.replace(OPTIONS, self._options[options])
        call.replace(ARRAYS, arrays)
        call.replace(START, start or self._usual_start)
        call.replace(HISTORY, history or self._no_history)
        return float(call())

    @property
    def force(self) -> LatentForce:
        """Model of the latent force of the last pass that computed gains."""
        return self._force

    def write_force(self, rms: Array, time_constant: float, white: Array) -> None:
        """Write the model of the latent force.

        Args:
            rms: (NQ,) rms of the latent force.
            time_constant: [s] its correlation time.
            white: (NQ,) spectral density of the noise of measured forces.
        """
        np.multiply(rms, rms, out=self._force.variances)
        self._force.white[:] = white
        self.write_time_constant(time_constant)

    def write_time_constant(self, time_constant: float) -> None:
        """Write the correlation time [s] of the latent force."""
        if time_constant != self._force.time_constant:
            self._force = self._force._replace(time_constant=time_constant)
            self._call.replace(FORCE, self._call.pack(FORCE, self._force))

    def write_variances(self, sensors: Array, initial_force: Array) -> None:
        """Write the variances of sensor noise, and the covariance of the state at the first row.

        Args:
            sensors: (C,) standard deviations of the sensor noise of each channel.
            initial_force: (NQ,) rms of the latent force at the first row.
        """
        nq, diagonal = self._nq, self._diagonal
        self._variances[:] = sensors**2
        diagonal[self._places] = self._variances[self._position_channels]
        diagonal[2 * nq :] = initial_force**2


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
