"""The estimation problem: mapped recordings, free parameters with priors, and fits."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from functools import cached_property
from typing import NamedTuple

import numpy as np

from boatsim.diagnosis import priors
from boatsim.diagnosis.command_range import largest_command
from boatsim.diagnosis.config import DEFAULT, DiagnosisConfig
from boatsim.diagnosis.filter import FilterPass, MappedRecording, NoiseLevels
from boatsim.diagnosis.filter_arguments import BODY
from boatsim.diagnosis.work import WorkCount
from boatsim.errors import BadInput
from boatsim.physics.base import (
    Array,
    ChannelEffect,
    CoefficientRelease,
    DriftingMeasurement,
    Effect,
    Force,
    Param,
)
from boatsim.physics.groups import group_of, name_in_group, without_group
from boatsim.physics.program import Program
from boatsim.physics.vessel import Vessel

# side of the actuator to which a parameter of a channel effect belongs, by its name
SIDES = {"port": -1, "middle": 0, "starboard": 1}
REFERENCE_MASS = 4.6  # [kg] of the hull for which effects specify their priors
# dimensions of a unit: powers of mass, length and time; electric units do not grow with the hull
SYMBOLS = {
    "N": (1, 1, -2),
    "kg": (1, 0, 0),
    "m": (0, 1, 0),
    "s": (0, 0, 1),
    "rad": (0, 0, 0),
    "V": (0, 0, 0),
    "A": (0, 0, 0),
    "1": (0, 0, 0),
    "": (0, 0, 0),
}


@dataclass(frozen=True)
class FreeParameter:
    """A parameter that a diagnosis fits, its normal prior and bounds, and the model values it sets.

    It belongs to a candidate effect, or is a coefficient of the nominal vessel model. A coefficient
    scales the specified value: `relative` is true and the prior mean is 1. An effect that releases
    coefficients of the vessel scales, shifts or sets several numbers.
    """

    effect: str
    name: str
    at: tuple[int, ...]  # places in the parameter values of a run
    mean: float
    sd: float
    low: float
    high: float
    relative: bool = False
    # without a gradient: it changes the spectrum of a stochastic force, not the expected motion
    searched: bool = False
    how: str = "sets"  # or "scales" or "shifts"
    weights: tuple[float, ...] = (1.0,)  # of a shift, one for each place
    group: str = ""  # of recordings, in which alone it acts; "": in all

    def write_value(self, values: Array, x: float) -> None:
        """Write a value of the free parameter into the array of a vessel model's parameter values.

        Args:
            values: Parameter values of the vessel model for one recording, changed in place.
            x: Value of this parameter.
        """
        for at, weight in zip(self.at, self.weights, strict=True):
            if self.how == "scales":
                values[at] *= x
            elif self.how == "shifts":
                values[at] += weight * x
            else:
                values[at] = x


@dataclass(frozen=True)
class Fit:
    """A fitted hypothesis: the vessel model with a set of candidate effects, and its posterior.

    It holds parameter values, their covariance, the noise levels and the log evidence.
    """

    effects: tuple[str, ...]  # candidates that act, in the order in which they were added
    free: tuple[FreeParameter, ...]
    theta: Array  # (F,) fitted values
    covariance: Array  # (F, F)
    levels: NoiseLevels
    evidence: float  # log of the Laplace evidence [nats]

    def values(self) -> dict[tuple[str, str], float]:
        """Return the fitted parameter values by pairs of effect name and parameter name."""
        found = {}
        for parameter, x in zip(self.free, self.theta, strict=True):
            found[parameter.effect, parameter.name] = float(x)
        return found

    def value(self, effect: str, name: str) -> tuple[float, float]:
        """Return the fitted value and the posterior standard deviation of one parameter.

        Args:
            effect: Name of an effect of this fit.
            name: Name of one of its fitted parameters.
        """
        i = self._index(effect, name)
        return float(self.theta[i]), float(np.sqrt(self.covariance[i, i]))

    def prior_mean(self, effect: str, name: str) -> float:
        """Return the prior mean: the value without the effect, or for a limit the usual value.

        A dimensional value follows Froude's law from the reference hull to the vessel.

        Args:
            effect: Name of an effect of this fit.
            name: Name of one of its fitted parameters.
        """
        return self.free[self._index(effect, name)].mean

    def _index(self, effect: str, name: str) -> int:
        """Place of a parameter of an effect among the free parameters."""
        names = [("" if f.relative else f.effect, f.name) for f in self.free]
        return names.index((effect, name))


class Priors(NamedTuple):
    """Prior means, standard deviations and bounds of free parameters, each an array (F,)."""

    mean: Array
    sd: Array
    low: Array
    high: Array


def prior_arrays(free: Sequence[FreeParameter]) -> Priors:
    """Return the prior means, standard deviations and bounds of free parameters as arrays.

    Args:
        free: Free parameters of a hypothesis.
    """
    rows = [(f.mean, f.sd, f.low, f.high) for f in free]
    return Priors(*np.array(rows, dtype=float).reshape(-1, 4).T.copy())


def free_parameter_values(
    free: Sequence[FreeParameter], values: Mapping[tuple[str, str], float]
) -> Array:
    """Return an array (F,) of parameter values from a dictionary.

    Parameters that the dictionary does not contain have their prior mean.

    Args:
        free: Free parameters of a hypothesis.
        values: Values by effect and name of the parameter.
    """
    theta = prior_arrays(free).mean
    for i, parameter in enumerate(free):
        theta[i] = values.get((parameter.effect, parameter.name), theta[i])
    return theta


@dataclass(frozen=True)
class FilterPasses:
    """Results of the Kalman filter for one hypothesis, one pass for each recording."""

    passes: tuple[FilterPass, ...]

    @cached_property
    def log_likelihood(self) -> float:
        """Log likelihood of all recordings together, by the extended Kalman filter."""
        return sum(one.log_likelihood for one in self.passes)

    @cached_property
    def whitened(self) -> Array:
        """Whitened prediction errors of the Kalman filter for all recordings in one array."""
        return np.concatenate([one.whitened for one in self.passes])

    @property
    def log_density_at_predictions(self) -> float:
        """Log density of measurements that would be equal to the filter's predictions.

        The sum over all recordings depends on the predicted covariances only, and is known up to a
        constant.
        """
        return sum(one.log_density_at_predictions for one in self.passes)


def froude_scale(unit: str, vessel: Vessel) -> float:
    """Return the factor between a quantity on a vessel and on the reference hull, by Froude's law.

    Args:
        unit: Unit of the quantity, such as "N s/m".
        vessel: Vessel whose mass and length set the scale.
    """
    numerator, _, denominator = unit.partition("/")
    powers = np.zeros(3)
    for part, sign in ((numerator, 1), (denominator, -1)):
        for factor in part.split():
            symbol, _, power = factor.partition("^")
            powers += sign * int(power or 1) * np.array(SYMBOLS[symbol])
    mass, length = vessel.body.mass / REFERENCE_MASS, vessel.length / priors.REFERENCE_LENGTH
    return float(mass ** powers[0] * length ** (powers[1] + 0.5 * powers[2]))


def check_uncertain_coefficients(
    vessel: Vessel, specified: Mapping[str, float], where: str
) -> None:
    """Check that a vessel has coefficients of every kind for which an uncertainty is specified.

    An example of a kind is "damping"; the uncertainty is that of the prior.

    Args:
        vessel: Vessel of the recordings.
        specified: Relative standard deviation by kind of coefficient.
        where: File that specifies them, for the message.

    Raises:
        BadInput: The vessel has no coefficient of a kind.
    """
    found = set()
    for effect in vessel.effects:
        for param in type(effect).params().values():
            if param.axis in ("", *vessel.dof):
                found.add(param.calibrates)
    kinds = sorted(found - {""})
    for kind, sd in specified.items():
        if kind in kinds:
            continue
        near = get_close_matches(kind, kinds, n=1, cutoff=0.5)
        hint = f"; did you mean {near[0]!r}" if near else ""
        raise BadInput(
            f"{where}: coefficient_uncertainty.{kind} = {sd:g}, but {vessel.name} has no "
            f"coefficient of {kind}{hint}; allowed are {', '.join(kinds) or 'none'}"
        )


class _Target(NamedTuple):
    """Places in the parameter values of a run that a parameter changes, and their weights."""

    at: tuple[int, ...]
    weights: tuple[float, ...]


class _Candidates(dict[str, Effect]):
    """Candidates by name, with those of groups that only other recordings of a vessel have."""

    def __missing__(self, name: str) -> Effect:
        if not group_of(name):
            raise KeyError(name)
        return replace(self[without_group(name)], name=name)


@dataclass(frozen=True, eq=False)
class Problem:
    """The estimation problem of a diagnosis: recordings, compiled vessel program and priors.

    All candidate effects are compiled into the program; each hypothesis switches some of them on.
    """

    recordings: Sequence[MappedRecording]
    ambient: NoiseLevels  # prior levels
    uncertainty: Mapping[str, float]  # relative prior sd of coefficients, by kind
    specified_horizon: float | None = None  # [s] length of free runs, if not the usual one
    config: DiagnosisConfig = DEFAULT
    # prior sd of the coefficients of described terms, by the name of the effect
    spreads: Mapping[str, float] = field(default_factory=dict)
    program: Program = field(init=False)
    horizon: float = field(init=False)  # [s] length of free runs
    # coefficients of the vessel's own effects that are refitted with every hypothesis
    nominal_coefficients: tuple[FreeParameter, ...] = field(init=False)
    # (to, from) places in the values of a run: unset parameters inherit the vessel's value
    links: tuple[tuple[int, int], ...] = field(init=False)
    # groups to which some of the recordings belong, but not all; each set of recordings once
    groups: tuple[str, ...] = field(init=False)
    # further groups of exactly the same recordings, by the name in `groups`
    same_recordings: Mapping[str, tuple[str, ...]] = field(init=False)

    def __post_init__(self) -> None:
        program = self.recordings[0].program
        usual = priors.default_free_run_horizon(program.vessel, self.config.load)
        object.__setattr__(self, "program", program)
        object.__setattr__(self, "horizon", self.specified_horizon or usual)
        object.__setattr__(self, "nominal_coefficients", self._nominal_coefficients())
        object.__setattr__(self, "links", self._inherited_places())
        object.__setattr__(self, "same_recordings", self._groups())
        object.__setattr__(self, "groups", tuple(self.same_recordings))

    def with_recordings(self, recordings: Sequence[MappedRecording]) -> "Problem":
        """Return the same estimation problem for other recordings.

        Args:
            recordings: Recordings mapped to a program of the same vessel.
        """
        other = copy(self)
        object.__setattr__(other, "recordings", recordings)
        return other

    def with_spread(self, effect: str, sd: float) -> "Problem":
        """Return the same estimation problem with a prior of the coefficient of a described term.

        Args:
            effect: Name of the effect that has the term.
            sd: Prior standard deviation of its coefficient.
        """
        other = copy(self)
        object.__setattr__(other, "spreads", {**self.spreads, effect: sd})
        return other

    def _groups(self) -> dict[str, tuple[str, ...]]:
        """Groups to which some of the recordings belong, but not all; each set of runs once.

        The first name in alphabetical order stands for further groups of the same recordings.
        """
        members = defaultdict[str, list[int]](list)
        for i, mapped in enumerate(self.recordings):
            for group in mapped.groups:
                members[group].append(i)
        names = defaultdict[tuple[int, ...], list[str]](list)
        for group, runs in sorted(members.items()):
            if len(runs) < len(self.recordings):
                names[tuple(runs)].append(group)
        return {first: tuple(others) for first, *others in names.values()}

    def are_separate_and_complete(self, groups: Sequence[str]) -> bool:
        """Return whether each fitted recording belongs to exactly one of some groups.

        Args:
            groups: Names of the groups.
        """
        return all(len(set(groups) & set(mapped.groups)) == 1 for mapped in self.recordings)

    @property
    def work_count(self) -> WorkCount:
        """Count of the integration steps and matrix operations of the diagnosis so far."""
        return self.recordings[0].filtered

    @cached_property
    def candidates(self) -> Mapping[str, Effect]:
        """All candidate effects compiled into the vessel program, by name.

        Where recordings form groups, each deterministic effect may also act in one group alone, as
        a further candidate. It is compiled once.
        """
        found = _Candidates((effect.name, effect) for effect in self.program.candidates)
        for effect in self.program.candidates:
            if type(effect).random or type(effect).described:
                continue
            for group in self.groups:
                name = name_in_group(effect.name, group)
                found[name] = replace(effect, name=name)
        return found

    def candidates_in_single_groups(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return the candidates that act in one group of recordings alone.

        Args:
            names: Names of the candidates that may act in one group; without groups there are none.
        """
        found = []
        for name in names:
            for group in self.groups:
                if name_in_group(name, group) in self.candidates:
                    found.append(name_in_group(name, group))
        return tuple(found)

    def free_parameters(self, effects: Sequence[str]) -> tuple[FreeParameter, ...]:
        """Return the free parameters of the vessel model with some candidate effects.

        The uncertain coefficients of the vessel come first, then the parameters of the effects, in
        the order of the effects.

        Args:
            effects: Names of the candidates that act.
        """
        free = list(self.nominal_coefficients)
        for name in effects:
            free += self._parameters_of(self.candidates[name])
        return tuple(free)

    def _parameters_of(self, effect: Effect) -> list[FreeParameter]:
        """The parameters of a candidate that may be fitted."""
        free = []
        for name, param in type(effect).params().items():
            applies = not param.axis or param.axis in self.program.vessel.dof
            if not param.fit or not applies or not self._has_actuator(effect, name):
                continue
            target = self._target(effect, name)
            if target is None:
                continue
            scale = self.scale_from_reference_hull(effect, name)
            low, high = self._bounds(param)
            free.append(
                FreeParameter(
                    effect.name,
                    name,
                    target.at,
                    mean=param.prior_mean * scale,
                    sd=self.spreads.get(effect.name, param.spread * scale),
                    low=low,
                    high=high,
                    searched=type(effect).random,
                    how=param.how,
                    weights=target.weights,
                    group=group_of(effect.name),
                )
            )
        return free

    def parameter_vector(
        self, mapped: MappedRecording, free: Sequence[FreeParameter], theta: Array
    ) -> Array:
        """Return all parameter values of the vessel program for a recording, given free parameters.

        Args:
            mapped: The mapped recording, with its nominal parameter values.
            free: Free parameters of a hypothesis.
            theta: (F,) their values.
        """
        values = mapped.values.copy()
        own = []  # they act on what is common to all groups
        for parameter, x in zip(free, theta, strict=True):
            if not parameter.group:
                parameter.write_value(values, float(x))
            elif parameter.group in mapped.groups:
                own.append((parameter, float(x)))
        for parameter, x in own:
            parameter.write_value(values, x)
        for to, source in self.links:
            values[to] = values[source]
        return values

    def _target(self, effect: Effect, name: str) -> _Target | None:
        """Places that a parameter of a candidate changes: its own, or those that it releases."""
        if not isinstance(effect, CoefficientRelease):
            owner = without_group(effect.name)
            return _Target((self.program.parameter_index(owner, name),), (1.0,))
        at, weights = list[int](), list[float]()
        for change in effect.changes(self.program.vessel):
            if change.parameter == name:
                at.append(self.index_of_parameter(change.owner, change.key))
                weights.append(change.weight)
        if not at:
            return None
        return _Target(tuple(at), tuple(weights))

    def index_of_parameter(self, owner: str, key: str) -> int:
        """Return the index of a number in the array of a vessel model's parameter values.

        Args:
            owner: Name of an effect, or "body".
            key: Name of its parameter, or one of `BODY`.
        """
        if owner == "body":
            return len(self.program.values()) + BODY.index(key)
        return self.program.parameter_index(owner, key)

    def filter(
        self,
        free: Sequence[FreeParameter],
        theta: Array,
        on: Array,
        levels: NoiseLevels,
        about: FilterPasses | None = None,
    ) -> FilterPasses:
        """Run the Kalman filter over all recordings for one hypothesis.

        A hypothesis is the vessel model with a set of candidate effects, at given parameter values.

        Args:
            free: Free parameters of the hypothesis.
            theta: (F,) their values.
            on: (effects,) 1 for the effects that act, else 0.
            levels: Levels of sensor noise and of the latent (unmodelled) force.
            about: Passes whose linearisation is used again; None: linearise.
        """
        before = about.passes if about else [None] * len(self.recordings)
        found = []
        for mapped, one in zip(self.recordings, before, strict=True):
            acting = self.switches_in(mapped, free, on)
            found.append(
                mapped.filter(self.parameter_vector(mapped, free, theta), acting, levels, one)
            )
        return FilterPasses(tuple(found))

    def log_likelihood(
        self,
        free: Sequence[FreeParameter],
        theta: Array,
        on: Array,
        levels: NoiseLevels,
        about: FilterPasses | None = None,
    ) -> float:
        """Return only the log likelihood of all recordings for one hypothesis.

        It costs less than complete passes by `filter`, which takes the same arguments.
        """
        before = about.passes if about else [None] * len(self.recordings)
        found = 0.0
        for mapped, one in zip(self.recordings, before, strict=True):
            values = self.parameter_vector(mapped, free, theta)
            acting = self.switches_in(mapped, free, on)
            found += mapped.log_likelihood(values, acting, levels, one)
        return found

    def switches_in(
        self, mapped: MappedRecording, free: Sequence[FreeParameter], on: Array
    ) -> Array:
        """Return 1 for each effect that acts on a recording, 0 for those of other groups.

        Effects of other groups have zero size; without them no work is repeated.

        Args:
            mapped: The mapped recording.
            free: Free parameters of a hypothesis.
            on: (effects,) 1 for the effects of this hypothesis, else 0.
        """
        if not any(parameter.group for parameter in free):
            return on
        elsewhere, here = set[str](), set[str]()
        for parameter in free:
            if parameter.group:
                elsewhere.add(without_group(parameter.effect))
            if parameter.group in ("", *mapped.groups):
                here.add(without_group(parameter.effect))
        acting = on
        for i, effect in enumerate(self.program.effects):
            if effect.name in elsewhere - here:
                acting = acting.copy()
                acting[i] = 0.0
        return acting

    def whitened_errors(
        self,
        free: Sequence[FreeParameter],
        theta: Array,
        on: Array,
        levels: NoiseLevels,
        about: FilterPasses,
    ) -> Array:
        """Return the whitened prediction errors of all recordings, with the gains of other passes.

        Fixed gains make the errors a smooth function of the parameters, as Gauss-Newton steps need.

        Args:
            free: Free parameters of the hypothesis.
            theta: (F,) their values.
            on: (effects,) 1 for the effects that act, else 0.
            levels: Levels of sensor noise and of the latent (unmodelled) force.
            about: Passes whose gains are used.
        """
        found = []
        for mapped, one in zip(self.recordings, about.passes, strict=True):
            values, acting = (
                self.parameter_vector(mapped, free, theta),
                self.switches_in(mapped, free, on),
            )
            found.append(mapped.whitened_errors(values, acting, levels, one))
        return np.concatenate(found)

    def whitened_errors_within(
        self,
        free: Sequence[FreeParameter],
        theta: Array,
        on: Array,
        levels: NoiseLevels,
        about: FilterPasses,
        most: float,
    ) -> Array | None:
        """Return whitened errors as `whitened_errors`, if the sum of their squares is small enough.

        The recordings are filtered one after another until the sum exceeds the limit, so that a
        hypothesis that is far from the recordings costs little.

        Args:
            free: Free parameters of the hypothesis.
            theta: (F,) their values.
            on: (effects,) 1 for the effects that act, else 0.
            levels: Levels of sensor noise and of the latent (unmodelled) force.
            about: Passes whose gains are used.
            most: Largest sum of squares.

        Returns:
            (rows,) errors; None if the sum of their squares is larger or not finite.
        """
        found, total = [], 0.0
        for mapped, one in zip(self.recordings, about.passes, strict=True):
            values, acting = (
                self.parameter_vector(mapped, free, theta),
                self.switches_in(mapped, free, on),
            )
            errors = mapped.whitened_errors(values, acting, levels, one)
            total += float(errors @ errors)
            if not total <= most:
                return None
            found.append(errors)
        return np.concatenate(found)

    def scale_from_reference_hull(self, effect: Effect, name: str) -> float:
        """Return the ratio of a candidate effect's parameter to its value on the reference hull.

        Quantities follow Froude's law. The force of a wind follows the area of the hull above the
        water, because a wind is as fast for a small boat as for a large one. The threshold of a
        command scales with the largest command recorded, because the full thrust of the reference
        hull is 1 N. The drift of an instrument scales with its noise.

        Args:
            effect: A candidate.
            name: Name of its parameter.
        """
        unit = type(effect).params()[name].unit
        if isinstance(effect, DriftingMeasurement):
            noise = {"m": "position_sd_m", "rad": "heading_sd_rad"}
            return self.ambient.sensors[noise[unit]] if unit in noise else 1.0
        if name in type(effect).thresholds and unit != "rad":
            largest = largest_command(self.recordings, effect, self.config.load)
            if largest:
                return largest
        if isinstance(effect, Force) and type(effect).of_air and unit in ("N", "s/m"):
            return priors.area_scale(self.program.vessel) if unit == "N" else 1.0
        return froude_scale(unit, self.program.vessel)

    def _bounds(self, param: Param) -> tuple[float, float]:
        """Bounds of a parameter: those of the file format and those of a hull of this size."""
        scale = froude_scale(param.unit, self.program.vessel)
        low, high = param.within
        return max(low * scale, param.low), min(high * scale, param.high)

    def _has_actuator(self, effect: Effect, parameter: str) -> bool:
        """Whether the vessel has an actuator on the side to which a parameter belongs, if any."""
        if not isinstance(effect, ChannelEffect) or parameter not in SIDES:
            return True
        vessel = self.program.vessel
        return SIDES[parameter] in {vessel.side(name) for name in vessel.target_actuators(effect)}

    @property
    def is_stiff(self) -> bool:
        """Whether the fastest motion of the hull decays within one sample of any recording."""
        return any(mapped.is_stiff for mapped in self.recordings)

    def nominal_hypothesis(self) -> Fit:
        """Return the hypothesis that the vessel is as specified, with nothing added or fitted."""
        free = self.nominal_coefficients
        count = len(free)
        return Fit((), free, np.ones(count), np.zeros((count, count)), self.ambient, -np.inf)

    def _nominal_coefficients(self) -> tuple[FreeParameter, ...]:
        """Coefficients of the vessel that are uncertain; those of several instances are one."""
        vessel = self.program.vessel
        shared = defaultdict[tuple[str, str, float], list[tuple[str, int]]](list)
        params: dict[tuple[str, str], Param] = {}
        for effect in vessel.effects:
            for name, param in type(effect).params().items():
                sd = self.uncertainty.get(param.calibrates, 0.0)
                at = self.program.parameter_index(effect.name, name)
                applies = not param.axis or param.axis in vessel.dof
                used = self.recordings[0].values[at] != 0.0 and applies
                if param.calibrates and sd > 0 and used:
                    shared[type(effect).type_name(), name, sd].append((effect.name, at))
                    params[type(effect).type_name(), name] = param
        found = []
        for (idea, name, sd), places in shared.items():
            owner = idea if len(places) > 1 else places[0][0]
            low, high = self._allowed_factors(params[idea, name], [at for _, at in places])
            found.append(
                FreeParameter(
                    owner,
                    name,
                    tuple(at for _, at in places),
                    mean=1.0,
                    sd=sd,
                    low=low,
                    high=high,
                    relative=True,
                    how="scales",
                    weights=(1.0,) * len(places),
                )
            )
        return tuple(found)

    def _allowed_factors(self, param: Param, places: Sequence[int]) -> tuple[float, float]:
        """Return the range of the factor on a coefficient, within its range in a vessel file."""
        low, high = self.config.fit.coefficient_range
        for mapped in self.recordings:
            used = mapped.values[list(places)]
            for value in used[used != 0.0]:
                ends = sorted((param.low / value, param.high / value))
                low, high = max(low, ends[0]), min(high, ends[1])
        return min(low, 1.0), max(high, 1.0)

    def _inherited_places(self) -> tuple[tuple[int, int], ...]:
        """Places of unset parameters, and of the vessel's numbers that they inherit."""
        links = []
        owners = {e.name for e in self.program.effects} | {"body"}
        for effect in self.program.effects:
            for name in sorted(effect.filled):
                source = type(effect).params()[name].follows
                owner, _, key = source.removesuffix("?").removeprefix("vessel.").partition(".")
                if owner in owners:
                    to = self.program.parameter_index(effect.name, name)
                    links.append((to, self.index_of_parameter(owner, key)))
        return tuple(links)
