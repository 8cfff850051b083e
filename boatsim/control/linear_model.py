"""Linear state-space model of a vessel about a steady motion: plain numbers, without the simulator.

x' = A x + B u + E w,  y = C x + D u,  all as deviations from the steady motion
"""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, isinf, log, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from boatsim.errors import BadInput, unknown_name_message
from boatsim.physics.base import AXES, Array

if TYPE_CHECKING:
    from scipy.signal import StateSpace

FORMAT = "boatsim linear model 1"
SUFFIXES = (".json", ".npz")
# Participation of a degree of freedom in a mode from which the name of the mode contains it
NAMED_SHARE = 0.1
# Relative to scaled matrices of size 1: directions below it count as not controllable or not
# observable. Derivatives are exact to about 1e-8.
RANK_TOLERANCE = 1e-7
# Degree of freedom -> name of its zero eigenvalue, which only integrates a velocity
INTEGRATORS = {"x": "position north", "y": "position east", "psi": "heading"}


class Variable(NamedTuple):
    """A state, input or output of a linear model.

    Attributes:
        name: Name, such as "v" or "thrust_lag.thrust_port_N".
        unit: Unit, "" for none.
        value: Value in the steady motion.
        scale: Usual size of a deviation, for numerical tests that must not depend on units.
        group: Degree of freedom of a motion, name of the effect of an actuator's state.
    """

    name: str
    unit: str
    value: float
    scale: float
    group: str = ""


VARIABLE = Variable._fields


class Mode(NamedTuple):
    """A real eigenvalue or a pair of conjugate eigenvalues of a linear model.

    Attributes:
        name: What moves, such as "sway-yaw".
        eigenvalue: Eigenvalue with an imaginary part of at least 0 [1/s].
        controllable: Whether the inputs can change it.
        observable: Whether the outputs show it.
    """

    name: str
    eigenvalue: complex
    controllable: bool
    observable: bool

    @property
    def time_constant(self) -> float:
        """Time constant of the decay, or of the growth of an unstable mode [s]; may be infinite."""
        rate = abs(self.eigenvalue.real)
        if rate == 0.0:
            return inf
        return 1.0 / rate

    @property
    def frequency(self) -> float:
        """Undamped natural frequency of a pair of eigenvalues, 0 for a real one [rad/s]."""
        if not self.eigenvalue.imag:
            return 0.0
        return abs(self.eigenvalue)

    @property
    def damping_ratio(self) -> float:
        """Damping ratio of a pair of eigenvalues, negative if it grows; 1 for a real one."""
        if not self.eigenvalue.imag:
            return 1.0
        return -self.eigenvalue.real / abs(self.eigenvalue)

    @property
    def stable(self) -> bool:
        """Whether the mode decays."""
        return self.eigenvalue.real < 0.0


class Nomoto(NamedTuple):
    """Nomoto model of yaw: r / delta = K (1 + T3 s) / ((1 + T1 s)(1 + T2 s)).

    Attributes:
        K: Steady yaw rate over command [1/s for a rudder angle].
        T1: Larger time constant [s], negative for a vessel without straight-line stability.
        T2: Smaller time constant [s].
        T3: Time constant of the zero [s].
    """

    K: float
    T1: complex
    T2: complex
    T3: float

    @property
    def T(self) -> float:
        """Time constant T1 + T2 - T3 of the first-order model r / delta = K / (1 + T s) [s]."""
        return float((self.T1 + self.T2).real) - self.T3


@dataclass(frozen=True)
class LinearModel:
    """Linear state-space model of a vessel about a steady motion.

    Attributes:
        vessel: Name of the vessel.
        load: Load conditions.
        states: States x (n).
        inputs: Inputs u (m): command channels.
        outputs: Outputs y (k).
        forces: Disturbance inputs w: body forces and moments on the hull [N, N m].
        a: A, (n, n).
        b: B, (n, m).
        c: C, (k, n).
        d: D, (k, m).
        e: E, (n, number of forces).
        delay: Dead time of all commands, which is not part of the matrices [s].
        dt: Sample time of a discrete model [s]; 0 for a continuous one.
        accuracy: Largest relative change of the frequency response of the motion when the
            differences and the time interval of the linearisation are halved.
        remarks: What the model leaves out.
    """

    vessel: str
    load: tuple[str, ...]
    states: tuple[Variable, ...]
    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    forces: tuple[Variable, ...]
    a: Array
    b: Array
    c: Array
    d: Array
    e: Array
    delay: float = 0.0
    dt: float = 0.0
    accuracy: float = 0.0
    remarks: tuple[str, ...] = ()

    # Selection and conversion
    # ----------------------------------------------------------------------------------------------

    def state(self, name: str) -> int:
        """Return the index of a state.

        Args:
            name: Name of the state.

        Raises:
            BadInput: There is no such state.
        """
        return _index(f"{self.vessel}: state", name, self.states)

    def input(self, name: str) -> int:
        """Return the index of an input.

        Args:
            name: Name of a command channel.

        Raises:
            BadInput: There is no such input.
        """
        return _index(f"{self.vessel}: input", name, self.inputs)

    def with_outputs(self, names: Sequence[str]) -> "LinearModel":
        """Return the model with some of its states as outputs.

        Args:
            names: Names of the states.

        Raises:
            BadInput: There is no such state.
        """
        rows = [self.state(name) for name in names]
        c = np.eye(len(self.states))[rows]
        d = np.zeros((len(rows), len(self.inputs)))
        return replace(self, outputs=tuple(self.states[i] for i in rows), c=c, d=d)

    def discretised(self, dt: float) -> "LinearModel":
        """Return the exact discrete model for inputs that are held over each sample time.

        x(k+1) = A x(k) + B u(k) + E w(k), from the exponential of the continuous matrices.

        Args:
            dt: Sample time [s].

        Raises:
            BadInput: The sample time is not positive, or the model is discrete already.
        """
        if self.dt:
            raise BadInput(f"{self.vessel}: the model is discrete already, dt = {self.dt:g} s")
        both = held_input_matrices(self.a, np.hstack((self.b, self.e)), dt)
        m = len(self.inputs)
        return replace(self, a=both[0], b=both[1][:, :m], e=both[1][:, m:], dt=dt)

    def state_space(self) -> "StateSpace":
        """Return the model as a `scipy.signal.StateSpace`, with dt for a discrete one."""
        from scipy.signal import StateSpace

        if self.dt:
            return StateSpace(self.a, self.b, self.c, self.d, dt=self.dt)
        return StateSpace(self.a, self.b, self.c, self.d)

    # Analysis
    # ----------------------------------------------------------------------------------------------

    @property
    def continuous_a(self) -> Array:
        """A of the continuous model (n, n), also of a discrete one [1/s]."""
        if not self.dt:
            return self.a
        from scipy.linalg import logm

        return np.asarray(np.real(logm(self.a))) / self.dt

    @property
    def modes(self) -> tuple[Mode, ...]:
        """Modes of the model, from the slowest to the fastest.

        A mode is named after the degrees of freedom that participate in it (Perez-Arriaga,
        Verghese and Schweppe 1982). States of which no other state depends, such as the heading of
        a vessel in calm water, are integrators.
        """
        a = self._scaled(self.continuous_a)
        found: list[tuple[str, complex]] = []
        kept = list(range(len(self.states)))
        while (i := _integrator(a, kept)) is not None:
            name = INTEGRATORS.get(self.states[i].name, self.states[i].name)
            found.append((f"{name} (integrator)", complex(0.0)))
            kept.remove(i)
        groups = [self.states[i].group for i in kept]
        found += _named_eigenvalues(a[np.ix_(kept, kept)], groups)
        found.sort(key=lambda pair: (abs(pair[1]), pair[1].real))
        b, c = self._scaled_inputs(), self._scaled_outputs()
        modes = []
        for name, value in found:
            controllable = _reaches(a, b, value)
            modes.append(Mode(name, value, controllable, _reaches(a.T, c.T, value)))
        return tuple(modes)

    @property
    def controllable_states(self) -> int:
        """Dimension of the controllable subspace."""
        return _reachable_dimension(self._scaled(self.continuous_a), self._scaled_inputs())

    @property
    def observable_states(self) -> int:
        """Number of states less the dimension of the subspace that the outputs do not show."""
        a = self._scaled(self.continuous_a)
        return _reachable_dimension(a.T, self._scaled_outputs().T)

    def nomoto(self, command: str) -> Nomoto:
        """Return the Nomoto constants of a command, from sway and yaw alone.

        Surge, roll and other motions are held at the steady motion; actuators follow their command
        without lag.

        Args:
            command: Command channel that steers.

        Raises:
            BadInput: There is no such command, the model has no sway or yaw, or sway and yaw have
                no steady response.
        """
        v, r, j = self.state("v"), self.state("r"), self.input(command)
        a, b = self.continuous_a, self._continuous_b()
        lagged = [i for i, one in enumerate(self.states) if "." in one.name]
        held = b[[v, r], j]
        if lagged:
            settled = np.linalg.lstsq(-a[np.ix_(lagged, lagged)], b[lagged, j], rcond=None)[0]
            held = held + a[np.ix_([v, r], lagged)] @ settled
        plane = a[np.ix_([v, r], [v, r])]
        determinant = float(np.linalg.det(plane))
        # r / delta = (b_r s + n) / (s^2 - trace s + determinant)
        n = float(plane[1, 0] * held[0] - plane[0, 0] * held[1])
        if determinant == 0.0 or n == 0.0:
            raise BadInput(
                f"{self.vessel}: {command} causes no steady yaw rate about this motion, so that "
                "there are no Nomoto constants"
            )
        roots = np.linalg.eigvals(plane).astype(complex)
        times = sorted((-1.0 / roots).tolist(), key=abs, reverse=True)
        return Nomoto(n / determinant, times[0], times[1], float(held[1]) / n)

    def _continuous_b(self) -> Array:
        """B of the continuous model."""
        if not self.dt:
            return self.b
        n, m = self.b.shape
        whole = np.eye(n + m)
        whole[:n, :n], whole[:n, n:] = self.a, self.b
        from scipy.linalg import logm

        return np.asarray(np.real(logm(whole)))[:n, n:] / self.dt

    def _scaled(self, a: Array) -> Array:
        """A for states in units of their scales."""
        scales = variable_scales(self.states)
        return np.asarray(a * scales / scales[:, None])

    def _scaled_inputs(self) -> Array:
        scales, spans = variable_scales(self.states), variable_scales(self.inputs)
        return np.asarray(self._continuous_b() * spans / scales[:, None])

    def _scaled_outputs(self) -> Array:
        scales, sizes = variable_scales(self.states), variable_scales(self.outputs)
        return np.asarray(self.c * scales / sizes[:, None])

    # Files
    # ----------------------------------------------------------------------------------------------

    def to_table(self) -> dict[str, Any]:
        """Return the content of the JSON file of the model."""
        modes = []
        for mode in self.modes:
            time: float | None = mode.time_constant
            if time == inf:
                time = None
            modes.append(
                {
                    "name": mode.name,
                    "eigenvalue": [mode.eigenvalue.real, mode.eigenvalue.imag],
                    "time_constant_s": time,
                    "frequency_radps": mode.frequency,
                    "damping_ratio": mode.damping_ratio,
                    "controllable": mode.controllable,
                    "observable": mode.observable,
                }
            )
        table: dict[str, Any] = {
            "format": FORMAT,
            "vessel": self.vessel,
            "load": list(self.load),
            "dt_s": self.dt,
            "input_delay_s": self.delay,
        }
        for name in ("states", "inputs", "outputs", "forces"):
            table[name] = [one._asdict() for one in getattr(self, name)]
        for name in "abcde":
            table[name.upper()] = getattr(self, name).tolist()
        table["modes"] = modes
        table["controllable_states"] = self.controllable_states
        table["observable_states"] = self.observable_states
        table["accuracy"] = self.accuracy
        table["remarks"] = list(self.remarks)
        return table

    def write(self, path: Path | str) -> None:
        """Write the model to a file.

        Args:
            path: A .json file, or an .npz file for `numpy.load`.

        Raises:
            BadInput: The name ends in something else.
        """
        path = Path(path)
        if path.suffix not in SUFFIXES:
            raise BadInput(f"{path}: allowed are names that end in {' or '.join(SUFFIXES)}")
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix == ".json":
            text = json.dumps(self.to_table(), indent=1, allow_nan=False)
            path.write_text(text + "\n", encoding="utf-8")
            return
        arrays: dict[str, Any] = {name.upper(): getattr(self, name) for name in "abcde"}
        arrays["dt"], arrays["input_delay"] = self.dt, self.delay
        kinds = {"states": "x0", "inputs": "u0", "outputs": "y0", "forces": "w0"}
        for name, point in kinds.items():
            variables = np.array(getattr(self, name), dtype=object).reshape(-1, len(VARIABLE))
            arrays[name] = variables[:, VARIABLE.index("name")].astype(str)
            arrays[f"{name}_units"] = variables[:, VARIABLE.index("unit")].astype(str)
            arrays[point] = variables[:, VARIABLE.index("value")].astype(float)
        modes = self.modes
        arrays["eigenvalues"] = np.array([mode.eigenvalue for mode in modes])
        arrays["modes"] = np.array([mode.name for mode in modes], dtype=str)
        with path.open("wb") as file:
            np.savez(file, **arrays)


def read_linear_model(path: Path | str) -> LinearModel:
    """Read a linear model from the JSON file that `boatsim linearise --out` wrote.

    Args:
        path: The file.

    Raises:
        BadInput: One line with the file and what is wrong in it.
    """
    path = Path(path)
    try:
        table = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from None
    except ValueError:
        raise BadInput(
            f"{path}: is no JSON text; allowed is a file of boatsim linearise --out model.json"
        ) from None
    found = None
    if isinstance(table, dict):
        found = table.get("format")
    if found != FORMAT:
        raise BadInput(f"{path}: format = {found!r}; allowed is {FORMAT!r}")
    try:
        return _model_of_table(table)
    except (KeyError, TypeError, ValueError) as error:
        raise BadInput(f"{path}: an entry is missing or has a wrong type: {error}") from None


def _model_of_table(table: Mapping[str, Any]) -> LinearModel:
    parts: dict[str, Any] = {}
    for name in ("states", "inputs", "outputs", "forces"):
        parts[name] = tuple(Variable(**one) for one in table[name])
    n, sizes = len(parts["states"]), {name: len(ones) for name, ones in parts.items()}
    shapes = {
        "a": (n, n),
        "b": (n, sizes["inputs"]),
        "c": (sizes["outputs"], n),
        "d": (sizes["outputs"], sizes["inputs"]),
        "e": (n, sizes["forces"]),
    }
    for name, shape in shapes.items():
        parts[name] = np.array(table[name.upper()], dtype=float).reshape(shape)
    return LinearModel(
        table["vessel"],
        tuple(table["load"]),
        **parts,
        delay=float(table["input_delay_s"]),
        dt=float(table["dt_s"]),
        accuracy=float(table["accuracy"]),
        remarks=tuple(table["remarks"]),
    )


# Matrices
# ------------------------------------------------------------------------------------------------


def held_input_matrices(a: Array, b: Array, dt: float) -> tuple[Array, Array]:
    """Return A and B of the discrete model of x' = A x + B u with u held over each sample time.

    They are blocks of the exponential of [[A, B], [0, 0]] dt (Van Loan 1978).

    Args:
        a: A, (n, n).
        b: B, (n, m).
        dt: Sample time [s].

    Raises:
        BadInput: The sample time is not positive.
    """
    if not 0.0 < dt < inf:
        raise BadInput(f"sample time = {dt:g} s; allowed is more than 0 s")
    from scipy.linalg import expm

    n, m = b.shape
    rates = np.zeros((n + m, n + m))
    rates[:n, :n], rates[:n, n:] = a, b
    whole = np.asarray(expm(rates * dt))
    return whole[:n, :n], whole[:n, n:]


def variable_names(variables: Iterable[Variable]) -> list[str]:
    """Return the names of variables in their order.

    Args:
        variables: States, inputs, outputs or forces.
    """
    return [one.name for one in variables]


def variable_scales(variables: Iterable[Variable]) -> Array:
    """Return the scales (n,) of variables in their order.

    Args:
        variables: States, inputs, outputs or forces.
    """
    return np.array([one.scale for one in variables])


def _index(what: str, name: str, variables: Iterable[Variable]) -> int:
    names = variable_names(variables)
    if name not in names:
        raise BadInput(unknown_name_message(what, name, names))
    return names.index(name)


def _integrator(a: Array, kept: Sequence[int]) -> int | None:
    """A state of `kept` on which none of the others depends and that does not decay."""
    for i in kept:
        if not a[kept, i].any():
            return i
    return None


def _named_eigenvalues(a: Array, groups: Sequence[str]) -> list[tuple[str, complex]]:
    """Name and eigenvalue of each mode, one for a conjugate pair."""
    if not len(a):
        return []
    from scipy.linalg import eig

    values, left, right = eig(a, left=True, right=True)
    found = []
    for k, value in enumerate(values.tolist()):
        if value.imag < 0.0:
            continue
        shares = np.abs(left[:, k].conj() * right[:, k])
        if shares.sum() < RANK_TOLERANCE:  # of a multiple eigenvalue with one eigenvector
            shares = np.abs(right[:, k]) ** 2
        shares /= shares.sum()
        found.append((_mode_name(shares, groups), complex(value)))
    return found


def _mode_name(shares: Array, groups: Sequence[str]) -> str:
    """Degrees of freedom with a large participation, joined by hyphens."""
    total: dict[str, float] = {}
    for group, share in zip(groups, shares.tolist(), strict=True):
        total[group] = total.get(group, 0.0) + share
    named = [axis for axis in AXES if total.get(axis, 0.0) >= NAMED_SHARE]
    for group, share in total.items():
        if group not in AXES and share >= NAMED_SHARE:
            named.append(group)
    if not named:
        named = [max(total, key=lambda group: total[group])]
    return "-".join(named)


def _reaches(a: Array, b: Array, value: complex) -> bool:
    """Whether [A - s I, B] has full rank (Popov, Belevitch, Hautus) for scaled matrices."""
    pencil = np.hstack((a - value * np.eye(len(a)), b))
    return bool(np.linalg.svd(pencil, compute_uv=False)[-1] > RANK_TOLERANCE * _size(a))


def _reachable_dimension(a: Array, b: Array) -> int:
    """Dimension of the smallest subspace that contains b and is invariant under a."""
    a = a / _size(a)
    basis = _orthonormal(b / _size(b))
    while True:
        larger = _orthonormal(np.hstack((basis, a @ basis)))
        if larger.shape[1] <= basis.shape[1]:
            return int(basis.shape[1])
        basis = larger


def _orthonormal(columns: Array) -> Array:
    u, sizes, _ = np.linalg.svd(columns, full_matrices=False)
    return np.asarray(u[:, sizes > RANK_TOLERANCE])


def _size(matrix: Array) -> float:
    """Largest absolute entry, 1 for a matrix of zeros."""
    return float(np.abs(matrix).max(initial=0.0)) or 1.0


# Text
# ------------------------------------------------------------------------------------------------


def describe_decay(mode: Mode) -> str:
    """Return the time constant of a mode as text; of an unstable one the time in which it doubles.

    Args:
        mode: The mode.
    """
    if isinf(mode.time_constant):
        return "-"
    if mode.stable:
        return f"{mode.time_constant:.4g}"
    return f"doubles in {log(2.0) * mode.time_constant:.3g}"


def describe_period(mode: Mode) -> str:
    """Return the period of an oscillation [s] as text, "-" for a real eigenvalue.

    Args:
        mode: The mode.
    """
    if not mode.eigenvalue.imag:
        return "-"
    return f"{2.0 * pi / mode.eigenvalue.imag:.4g}"
