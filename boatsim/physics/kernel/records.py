"""Named tuples in which related arrays travel between Python and compiled functions.

Sizes: NQ degrees of freedom; NZ entries of the filter's state; P parameters of all effects; E
    effects; C measured
channels; N rows of a recording; M changes of the commands; B boats of a batch.
"""

from typing import Any, NamedTuple

from boatsim.physics.signals import Array, InstrumentDrift, OscillatingForce


class VesselNumbers(NamedTuple):
    """Numbers of a vessel for its compiled program: rigid body, parameters and active effects."""

    body: Array  # (6,) as in `Program.body`
    p: Array  # (P,) parameters of all effects, in SI units
    on: Any  # (E,) 1 for an effect that acts


class LawArguments(NamedTuple):
    """Effect parameters, switches of effects, and mass constants for the equations of motion."""

    p: Array  # (P,) parameters of all effects, in SI units
    on: Any  # (E,) 1 for an effect that acts
    k: Array  # (K,) masses, see `inertia.compute_mass_constants`


class VesselState(NamedTuple):
    """State of one simulated vessel: coordinates, rates, actuators and a constant extra force.

    `step_in_place` and `advance_actuators` change the arrays.
    """

    y: Array  # (2 NQ,) joint coordinates and their rates
    memory: Array  # (MEMORY,) state of the actuators
    act: Array  # (3 HELD,) actuators at the begin, in the middle and at the end of a step
    force: Array  # (NQ,) further constant body force [N, N m]


class FleetArrays(NamedTuple):
    """States, commands and parameters of many simulated vessels, one row each.

    `advance_boats` changes the arrays.
    """

    t: Array  # (B,) [s]
    y: Array  # (B, 2 NQ) joint coordinates and their rates
    commands: Array  # (B, inputs)
    memory: Array  # (B, MEMORY) state of the actuators
    act: Array  # (B, 3 HELD) actuators at the begin, in the middle and at the end of a step
    p: Array  # (B, P) parameters
    on: Any  # (E,) 1 for an effect that acts, the same for all
    k: Array  # (B, K) masses
    force: Array  # (NQ,) further constant body force [N, N m], the same for all


class StepRecord(NamedTuple):
    """Record of consecutive steps of one vessel, which `record_steps` fills row by row.

    N steps are divided into periods with constant commands.
    """

    done: Any  # (2,) steps and periods that are recorded
    ends: Any  # (periods,) number of steps until the end of each period
    logged: Any  # (N,) 1 for a step of which forces and the velocity of the water are recorded too
    states: Array  # (N, 13) time and `MeasuredMotion` at the end of the step
    mean: Array  # (N, actuators) mean actuator positions over the step
    force: Array  # (N, NQ) body force of all effects at the end of the step [N, N m]
    air: Array  # (N, NQ) body force of the air [N, N m]
    water: Array  # (N, 2) velocity of the water over the ground, north and east [m/s]


class Inputs(NamedTuple):
    """Row times of a recording and the commands that act on the vessel during it."""

    times: Array  # (N,) [s]
    change_times: Array  # (M,) [s]
    commands: Array  # (M, K) in force from the change time of the same row on


class Measurements(NamedTuple):
    """Measured values of a recording's channels, with the noise variances of their sensors."""

    values: Array  # (N, C), nan where missing
    codes: Any  # (C,) 0 .. NQ - 1: a position; NQ .. 2 NQ - 1: a body-axes rate
    variances: Array  # (C,) of the sensors' noise


class LatentForce(NamedTuple):
    """Model of the force of unmodelled effects in the Kalman filter.

    It is an Ornstein-Uhlenbeck process per axis, and white noise where a force was measured.
    """

    variances: Array  # (NQ,) [N^2, N^2 m^2]
    time_constant: float  # [s]
    white: Array  # (NQ,) two-sided spectral density of the white noise [N^2 s, N^2 m^2 s]


class InitialState(NamedTuple):
    """Prior mean and covariance of the Kalman filter's state at the first row of a recording.

    The state holds the positions, their rates in earth axes and the latent forces, which are the
    unknown forces that the filter estimates.
    """

    mean: Array  # (3 NQ,)
    covariance: Array  # (3 NQ, 3 NQ) without sensor noise and latent forces
    rates: Array  # (NQ,) earth-axes rates about which the first interval is linearised


class PassOptions(NamedTuple):
    """Options of one run of the Kalman filter over a recording: what it computes or reuses."""

    max_step: float  # [s] longest integration step
    gains: bool  # compute the gains; else reuse those of the last pass that did
    linearise: bool  # linearise about the estimate; else reuse the last transitions and steps
    history: bool  # store what the smoother needs


class PassArrays(NamedTuple):
    """Results of one run of the Kalman filter for each row of a recording.

    They are computed or reused according to the options of the run.
    """

    transitions: Array  # (N, 3 NQ, 3 NQ) of motion and latent forces
    # (N,) [s] longest integration step before each row that follows the quickest motion; the first
    # entry is the number of steps
    steps: Array
    gains: Array  # (N, C, NZ)
    scale: Array  # (N, C) inverse sd of the prediction errors, 0 where missing, less for an outlier
    whitened: Array  # (N, C) prediction errors in standard deviations


class FilterHistory(NamedTuple):
    """Filtered means, covariances and transition matrices of a recording, for the smoother.

    The smoother overwrites the means and covariances. The arrays hold at least the n entries of the
    state that are in use.
    """

    means: Array  # (N, n)
    covariances: Array  # (N, n, n)
    transitions: Array  # (N, n, n)
    predicted: Array  # (N, n) means before the row's measurements


# Inside the filter
# ------------------------------------------------------------------------------------------------


class ProcessNoise(NamedTuple):
    """Process noise of the Kalman filter's state, and the numbers of state entries in use."""

    force: LatentForce
    oscillating_force: OscillatingForce
    instrument_drift: InstrumentDrift
    m: Any  # entries of motion, latent forces and oscillators
    n: Any  # the same with the errors of instruments


class StateEstimate(NamedTuple):
    """Mean and covariance of the Kalman filter's state, changed in place."""

    z: Array  # (NZ,)
    P: Array  # (NZ, NZ)
    n: Any  # entries in use


class Measurement(NamedTuple):
    """One scalar measurement in an update of the Kalman filter.

    It holds the prediction error, its row of the measurement matrix and the noise variance.
    """

    error: float  # less what was expected
    row: Array  # its row of the measurement matrix
    variance: float  # of the sensor's noise
    ny: Any  # entries of `row` that may differ from zero: the motion
    own: Any  # place in the state of its instrument's error; -1: none


class MeasurementResults(NamedTuple):
    """Arrays that receive the results of one scalar measurement in the Kalman filter.

    The first entry of `outliers`, `scale` and `white` belongs to the measurement.
    """

    outliers: Array  # consecutive outliers so far
    gain: Array  # (NZ,)
    scale: Array
    white: Array


class FilterWorkspace(NamedTuple):
    """Preallocated work arrays of one run of the Kalman filter."""

    F: Array  # (NZ, NZ) transition
    A: Array  # (NZ, NZ)
    B: Array  # (NZ, NZ)
    row: Array  # (NZ,)
    Ph: Array  # (NZ,)
    H: Array  # (C, 2 NQ) rows of the measurement matrix
    outliers: Array  # (C,)
    memory: Array  # (MEMORY,) state of the actuators at the begin of an interval


class SmootherWorkspace(NamedTuple):
    """Preallocated work arrays of the smoother."""

    ahead: Array  # (NZ, NZ) predicted covariance of the next row
    cross: Array  # (NZ, NZ) covariance of the next row's state with the row's own
    G: Array  # (NZ, NZ) gains
    B: Array  # (NZ, NZ)
    off: Array  # (NZ,) correction of the next row's mean


class FilterPass(NamedTuple):
    """Inputs that are common to all time steps of one run of the Kalman filter."""

    inputs: Inputs
    laws: LawArguments
    delay: float  # [s] of the recorded motion behind the recorded commands
    noise: ProcessNoise
    plant: VesselState
    work: FilterWorkspace
