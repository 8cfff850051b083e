"""The interface of a vessel's compiled program: its constants and functions with their signatures.

Arrays are contiguous and of float64, or int64 where they hold rows or places. Sizes: NQ degrees of
freedom; P parameters of all effects; E effects; K constants; HELD numbers that describe the
actuators at one time.

Arguments of many functions:

- p: (P,) parameters, `Program.values()`.
- on: (E,) 1 for each effect that acts, `Program.switches()`.
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
    FilterStart,
    FleetArrays,
    Inputs,
    LatentForce,
    Measurements,
    PassArrays,
    PassOptions,
    VesselNumbers,
    VesselState,
)
from boatsim.physics.signals import Array, MeasuredMotion, OscillatingForce

Rows = NDArray[np.int64]


class CompiledProgram(Protocol):
    """Interface of the compiled package that `boatsim.physics.cache` composes for a vessel."""

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
    HAS_TIME_TO_DISCONTINUITY: (
        bool  # whether the signal of a channel may jump or bend while its command is held
    )
    SHORTEST: float  # [s] shortest part of a step
    ENOUGH: float  # [s] remainder of a step that is neglected

    # Mass
    def compute_mass_constants(self, body: Array, p: Array, on: Array, k: Array) -> None:
        """Fill k from the rigid body (6,) and the parameters."""

    # Actuators
    def advance_actuators(
        self, commands: Array, memory: Array, dt: float, p: Array, on: Array, act: Array
    ) -> None:
        """Advance all channels by one step of dt [s] under commands (inputs,)."""

    def settle_actuators(
        self, commands: Array, memory: Array, p: Array, on: Array, act: Array
    ) -> None:
        """Let the actuators reach their commands (inputs,)."""

    def substep_length(
        self, commands: Array, memory: Array, left: float, least: float, p: Array, on: Array
    ) -> float:
        """Length [s] of the next part of a step of which `left` remains; at least `least`."""

    def minimum_substep(self, part: float, before: float, least: float) -> float:
        """Least length [s] of the next part of a step, after parts of `before` and `part`."""

    # Motion
    def total_body_force(
        self, t: float, s: Array, act: Array, at: np.int64, p: Array, on: Array
    ) -> tuple[float, ...]:
        """Body force (NQ,) of all laws [N, N m]."""

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
        """Fill out (NQ, 2 NQ) with the derivatives of the joint accelerations by the state."""

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
        """Advance y by one Runge-Kutta step of dt [s]."""

    def steps(
        self, t: float, y: Array, dt: float, n: int, act: Array, p: Array, on: Array, k: Array
    ) -> None:
        """Advance y by n steps of dt [s] with the actuators held."""

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
        """Simulate: row i of commands (N, inputs) is held for `substeps` steps of dt [s].

        Fills out (N + 1, 2 NQ) with the states and changes the arrays of `plant`.
        """

    def water_velocity(self, p: Array, on: Array) -> tuple[float, float]:
        """Velocity of the water over the ground, north and east [m/s]."""

    def pose_and_velocities(self, s: Any) -> MeasuredMotion:
        """Pose and body-axes velocities of a state."""

    def jacobian(self, s: Any, J: Array) -> None:
        """Fill J (6, NQ), zeros before, with the body rates per joint rate."""

    # Many vessels
    def compute_mass_constants_of_boats(
        self, boats: Rows, body: Array, p: Array, on: Array, k: Array
    ) -> None:
        """Fill rows of k (B, K) from rigid bodies (B, 6) and parameters (B, P)."""

    def settle_actuators_of_boats(self, boats: Rows, fleet: FleetArrays) -> None:
        """Reset the actuators of vessels and let them reach their commands."""

    def advance_boats(self, boats: Rows, fleet: FleetArrays, dt: float, steps: int) -> None:
        """Advance vessels by steps of dt [s] with their commands held."""

    def read_instruments_of_boats(self, boats: Rows, fleet: FleetArrays, felt: Array) -> None:
        """Write time and readings of instruments without noise to rows of felt (B, 11)."""

    # Recordings
    def kalman_filter(
        self,
        inputs: Inputs,
        measured: Measurements,
        model: VesselNumbers,
        force: LatentForce,
        start: FilterStart,
        options: PassOptions,
        out: PassArrays,
        history: FilterHistory,
    ) -> float:
        """Run one pass of the filter; return the log likelihood."""

    def smooth_states(
        self,
        history: FilterHistory,
        gains: Array,
        times: Array,
        force: LatentForce,
        p: Array,
        on: Array,
    ) -> None:
        """Smooth the means and covariances of a pass; fill the smoother's gains (N, NZ, NZ)."""

    def simulate_intervals(
        self,
        inputs: Inputs,
        max_step: float,
        model: VesselNumbers,
        starts: Rows,
        ends: Rows,
        states: Array,
        out: Array,
    ) -> None:
        """Simulate from row starts[j] to ends[j] out of states[j] (2 NQ,).

        Fills out (runs, N, 2 NQ) with all channels as the recording would show them.
        """

    def remove_position_errors(self, z: Array, t: float, p: Array, on: Array) -> None:
        """Replace positions z[:NQ], recorded t [s] after the first row, by those of the vessel."""

    def oscillating_force(self, p: Array, on: Array) -> OscillatingForce:
        """The random oscillating force; frequency 0: none."""

    # MuJoCo
    def add_passive_forces_in_place(
        self, t: float, q: Array, qd: Array, user: Array, f: Array, M: Array
    ) -> None:
        """Add the vessel's forces to f and its added inertia to M, in MuJoCo's coordinates."""

    def compile_passive_callback(self, offsets: dict[str, int], size: int) -> Any:
        """Compile the passive-force callback for models whose `userdata` has `size` floats."""

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
        """Add the passive force and the lower triangle of J' M J; `force` and `M` are MuJoCo's."""
