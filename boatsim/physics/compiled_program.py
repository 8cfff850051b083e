"""The interface of a vessel's compiled program: its constants and functions with their signatures.

Arrays are contiguous and of float64, or int64 where they hold rows or places. Sizes: NQ degrees of
freedom; P parameters of all effects; E effects; K constants; HELD numbers that describe the
actuators at one time.

Arguments of many functions:

- p: (P,) parameters, `Program.values()`.
- on: (E,) 1 for each effect that acts, `Program.effect_switches()`.
- k: (K,) masses, filled by `compute_mass_constants`.
- act: (3 HELD,) actuators at the begin, in the middle and at the end of a step; `at` is the first
  of those to use.
- memory: (MEMORY,) state of the actuators.
- s, y: (2 NQ,) joint coordinates and their rates.
- force, extra: (NQ,) a further constant body force.

Units are SI.
"""

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from boatsim.physics.kernel.records import (
    FilterHistory,
    FleetArrays,
    InitialState,
    Inputs,
    LatentForce,
    Measurements,
    PassArrays,
    PassOptions,
    StepRecord,
    VesselNumbers,
    VesselState,
)
from boatsim.physics.signals import Array, MeasuredMotion, OscillatingForce

Rows = NDArray[np.int64]


class CompiledProgram(Protocol):
    """Interface of the compiled equations and filter of one vessel, generated from its effects.

    `boatsim.physics.cache` imports the package that contains them.
    """

    __name__: str
    __file__: str

    # Constants
    NQ: int  # degrees of freedom
    NZ: int  # entries of the filter's state
    K: int  # masses
    FREE: tuple[int, ...]  # places of the degrees of freedom among `AXES`
    SHOWS: tuple[int, ...]  # places of a state's entries among the fields of `MeasuredMotion`
    CLOSED: bool  # whether the last 12 masses are inverted
    HELD: int
    CANDIDATES: int  # number of effects that a switch turns on
    HAS_TIME_TO_DISCONTINUITY: (
        bool  # whether the signal of a channel may jump or bend while its command is held
    )
    HAS_AIR_WRENCH: bool  # whether an effect is a force of the air
    HAS_ADVANCE_MOTION_MEMORY: bool  # whether an effect remembers the motion of the hull
    SHORTEST: float  # [s] shortest part of a step
    ENOUGH: float  # [s] remainder of a step that is neglected

    # Mass
    def compute_mass_constants(self, body: Array, p: Array, on: Array, k: Array) -> None:
        """Fill k with the vessel's mass matrices from rigid body (6,) and effect parameters."""

    # Actuators
    def advance_actuators(
        self, commands: Array, memory: Array, dt: float, p: Array, on: Array, act: Array
    ) -> None:
        """Advance all actuators of the vessel by one step of dt [s] under commands (inputs,)."""

    def advance_memory_of_motion(
        self,
        t: float,
        s: Array,
        dt: float,
        memory: Array,
        act: Array,
        p: Array,
        on: Array,
    ) -> None:
        """Advance the states of effects that remember the motion to the state s (2 NQ,).

        A step of dt [s] begins there.
        """

    def settle_actuators(
        self, commands: Array, memory: Array, p: Array, on: Array, act: Array
    ) -> None:
        """Set all actuators of the vessel to the steady state under commands (inputs,)."""

    def substep_length(
        self, commands: Array, memory: Array, left: float, least: float, p: Array, on: Array
    ) -> float:
        """Return the length [s] of the next part of an integration step.

        The part ends where an actuator's signal jumps or has a kink. It is at least `least` and at
        most `left`, the remainder of the step.
        """

    def minimum_substep(self, part: float, before: float, least: float) -> float:
        """Return the lower limit [s] for the length of the next part of an integration step.

        It grows where the parts become ever shorter, from a part of length `before` to `part`.
        """

    # Motion
    def total_body_force(
        self, t: float, s: Array, act: Array, at: np.int64, p: Array, on: Array
    ) -> tuple[float, ...]:
        """Return the sum (NQ,) of the forces of all effects in body axes [N, N m]."""

    def air_body_force(
        self, t: float, s: Array, act: Array, at: np.int64, p: Array, on: Array
    ) -> tuple[float, ...]:
        """Return the sum (NQ,) of the forces of the air in body axes [N, N m]."""

    def acceleration_jacobian(
        self,
        t: float,
        s: Array,
        act: Array,
        p: Array,
        on: Array,
        k: Array,
        extra: Array,
        out: Array,
    ) -> None:
        """Fill out (NQ, 2 NQ) with the derivatives of the vessel's accelerations by its state.

        The accelerations are those of the joint coordinates.
        """

    def step_in_place(
        self,
        t: float,
        y: Array,
        dt: float,
        act: Array,
        p: Array,
        on: Array,
        k: Array,
        extra: Array,
    ) -> None:
        """Advance the vessel's state y by one Runge-Kutta step of dt [s]."""

    def steps(
        self, t: float, y: Array, dt: float, n: int, act: Array, p: Array, on: Array, k: Array
    ) -> None:
        """Advance the vessel's state y by n steps of dt [s] with the actuators held."""

    def rollout(
        self,
        model: VesselNumbers,
        plant: VesselState,
        commands: Array,
        t0: float,
        dt: float,
        substeps: int,
        out: Array,
    ) -> None:
        """Simulate a vessel under given commands: row i acts for `substeps` steps of dt [s].

        The commands have shape (N, inputs). Fills out (N + 1, 2 NQ) with the states and changes the
        arrays of `plant`.
        """

    def water_velocity(
        self, t: float, x: float, y: float, p: Array, on: Array, act: Array, at: Any
    ) -> tuple[float, float]:
        """Return the velocity of the water over the ground, north and east [m/s].

        Measured quantities are among the actuators act[at:].
        """

    def water_displacement(self, t: float, p: Array, on: Array) -> tuple[float, float]:
        """Return how far the water on which waves travel has moved since t = 0 [m]."""

    def pose_and_velocities(self, s: Any) -> MeasuredMotion:
        """Return position, attitude and body-axes velocities of a state of the vessel."""

    def jacobian(self, s: Any, J: Array) -> None:
        """Fill J (6, NQ) with the derivatives of body velocities by joint rates.

        J must contain zeros before.
        """

    # Many vessels
    def compute_mass_constants_of_boats(
        self, boats: Rows, body: Array, p: Array, on: Array, k: Array
    ) -> None:
        """Fill the rows `boats` of k (B, K) with the mass matrices of several vessels.

        They follow from rigid bodies (B, 6) and effect parameters (B, P).
        """

    def settle_actuators_of_boats(self, boats: Rows, fleet: FleetArrays) -> None:
        """Set all actuators of the vessels with numbers `boats` to their steady state."""

    def advance_boats(self, boats: Rows, fleet: FleetArrays, dt: float, steps: int) -> None:
        """Simulate several vessels over steps of dt [s] with their commands held."""

    def read_instruments_of_boats(self, boats: Rows, fleet: FleetArrays, felt: Array) -> None:
        """Write time and noiseless instrument readings of several vessels to felt (B, 11).

        Only the rows `boats` are written.
        """

    def record_steps(self, fleet: FleetArrays, dt: float, record: StepRecord) -> None:
        """Simulate the first vessel over the steps of its next period and record each of them.

        The steps have a length of dt [s].
        """

    # Recordings
    def kalman_filter(
        self,
        inputs: Inputs,
        measured: Measurements,
        model: VesselNumbers,
        force: LatentForce,
        start: InitialState,
        options: PassOptions,
        out: PassArrays,
        history: FilterHistory,
    ) -> float:
        """Run the Kalman filter once over a recording; return its log likelihood."""

    def smooth_states(
        self,
        history: FilterHistory,
        gains: Array,
        times: Array,
        force: LatentForce,
        p: Array,
        on: Array,
    ) -> None:
        """Smooth the filtered means and covariances of a recording in place.

        It is a fixed-interval smoother and fills its gains (N, n, n).
        """

    def mean_actuator_signals(
        self, first: Array, commands: Array, steps: Array, p: Array, on: Array, out: Array
    ) -> None:
        """Fill out (N, HELD) with the mean actuator signals along the rows of a recording.

        They begin settled to the commands `first`. Row i of the commands acts for steps[i] [s].
        """

    def total_body_forces(
        self, states: Array, held: Array, p: Array, on: Array, out: Array
    ) -> None:
        """Fill out (N, NQ) with the body forces of all effects at the states (N, 2 NQ).

        The actuators have the signals `held` (N, HELD).
        """

    def simulate_intervals(
        self,
        inputs: Inputs,
        max_step: float,
        model: VesselNumbers,
        starts: Rows,
        ends: Rows,
        states: Array,
        out: Array,
    ) -> float:
        """Simulate intervals of a recording from given states, under the recorded commands.

        Run j extends from row starts[j] to row ends[j] and begins at states[j] (2 NQ,). Fills out
        (runs, N, 2 NQ) with all channels as the recording would show them. States of all rows of
        the recording may follow those of the runs, for effects that remember the motion. Returns
        the number of integration steps.
        """

    def remove_position_errors(self, z: Array, t: float, p: Array, on: Array) -> None:
        """Replace recorded positions z[:NQ] by the true ones, inverting the measurement errors.

        They were recorded t [s] after the first row.
        """

    def oscillating_force(self, p: Array, on: Array) -> OscillatingForce:
        """Return the model of the random oscillating force on the vessel; frequency 0: none."""

    # MuJoCo
    def add_passive_forces_in_place(
        self, t: float, q: Array, qd: Array, user: Array, f: Array, M: Array
    ) -> None:
        """Add the vessel's forces to f and its added inertia to M, in MuJoCo's coordinates."""

    def compile_passive_callback(self, offsets: dict[str, int], size: int) -> Any:
        """Compile MuJoCo's passive-force callback, for models with `size` floats of `userdata`."""

    def add_force_and_inertia_to_mujoco(
        self,
        t: float,
        q: Array,
        qd: Array,
        act: Array,
        at: np.int64,
        p: Array,
        k: Array,
        force: Array,
        M: Array,
    ) -> None:
        """Add the vessel's passive force and added inertia J' M J to MuJoCo's arrays.

        `force` and `M` are arrays of MuJoCo. Only the lower triangle of J' M J is added.
        """
