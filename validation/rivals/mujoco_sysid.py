"""mujoco.sysid on a trial: box-bounded least squares with confidence intervals.

The toolbox fits parameters of a given structure; it selects none. Here it fits those of the vessel
and of all candidates at once, with boatsim's compiled model in place of MuJoCo's (`custom_rollout`,
the toolbox's own hook), and names an effect if the confidence interval of one of its parameters
(`sysid.calculate_intervals`) excludes the inactive value. The structure of the named effects is
fitted again. Residuals are weighted by channel, bounds are those of the effects, and the prior
spread of each parameter is a residual, because the toolbox advises to regularise ill-conditioned
problems. A recording is divided into windows whose initial states are parameters too.
"""

import contextlib
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.filter import dof_in_state_order
from boatsim.diagnosis.problem import Fit, FreeParameter
from boatsim.physics.base import Array
from validation.rivals.evidence import rms_by_channel
from validation.rivals.packages import import_package
from validation.rivals.question import Question, as_diagnosis_fit, free_parameters
from validation.rivals.windows import Windows

ALPHA = 0.05  # chance of a false alarm, divided by the number of tested parameters (Bonferroni)
ITERATIONS = 12  # of the optimizer; the residual decreases by less than 0.1 % after about ten
ROUNDS = 3  # fits of named effects, each without those whose intervals include the inactive value
MOST = 4  # largest number of effects, as for the other methods
REACH = 1.0  # [m, rad and per s] bounds of an initial state about its first estimate
FAR = 5.0  # bounds of a parameter in prior sds; the toolbox moves starts by shares of the bounds
STEP = 1e-4  # of finite differences; delays and limits act in steps that the default 1e-8 resolves
# a parameter is abrupt if this share of its prior sd changes the motion by ABRUPT of a whole sd
SMALL_STEP, ABRUPT = 1e-3, 0.1
LARGE = 1e3  # [m, rad] value of a simulated channel that has diverged


@dataclass(frozen=True)
class Estimate:
    """A fitted structure."""

    effects: tuple[str, ...]
    theta: Array  # (F,) vessel coefficients, then the parameters of the effects
    covariance: Array  # (F, F)
    half_widths: Array  # (F,) of the confidence intervals
    params: Any  # sysid.ParameterDict
    errors: tuple[Array, ...]  # (M, C) recorded minus simulated in each window


class MujocoSysid:
    """Answer of mujoco.sysid to one trial."""

    def __init__(self, question: Question, plain: bool) -> None:
        import_package("tabulate", "mujoco_sysid")  # of mujoco[sysid], which hides its absence
        self.sysid = import_package("mujoco.sysid", "mujoco_sysid")
        self.question, self.problem = question, question.problem
        self.runs = [Windows.of(t, self.problem.horizon) for t in self.problem.recordings]
        self.acting: set[tuple[str, str]] = set()  # parameters that act by themselves
        self.spec = carrier_model(self.problem.program.vessel, self.problem.recordings[0])
        self.model = self.spec.compile()
        noise = question.noise
        families = self.problem.recordings[0].families
        self.weights = np.array([1.0 / noise[f] for f in families])  # (C,)

    def answer(self) -> tuple[Fit, dict[str, float], bool]:
        """Return the fit, z^2 / 2 of each effect's surest parameter, and False: never unknown."""
        nominal = self.fit((), None)
        self.weights = 1.0 / rms_by_channel(nominal.errors)
        every = self.fit(self.candidates(nominal), nominal)
        named = self.excluding_inactive(every)
        found = self.fit(named, every)
        for _ in range(ROUNDS):
            fewer = self.excluding_inactive(found)
            if fewer == found.effects:
                break
            found = self.fit(fewer, found)
        fit = as_diagnosis_fit(self.question, found.effects, found.theta, found.covariance)
        scores = self.scores(found)
        return fit, {n: 0.5 * scores[n] ** 2 for n in found.effects}, False

    def candidates(self, nominal: Estimate) -> tuple[str, ...]:
        """Return one candidate of each law, without those that act abruptly.

        Their parameters have no derivative at the inactive value, which the toolbox needs.
        """
        found: dict[str, str] = {}
        for name in self.question.entries:
            if name_without_prefixes(name) in found:
                continue
            small = self.changes(name, nominal, SMALL_STEP)
            whole = self.changes(name, nominal, 1.0)
            self.acting |= {key for key, change in whole.items() if change > 0.0}
            if all(small[key] <= ABRUPT * whole[key] for key in whole):
                found[name_without_prefixes(name)] = name
        return tuple(found.values())

    def changes(self, name: str, nominal: Estimate, share: float) -> dict[tuple[str, str], float]:
        """Return how much each parameter of an inactive candidate changes the motion.

        Args:
            name: The candidate.
            nominal: Estimate of the vessel.
            share: Change of the parameter in prior sds.

        Returns:
            Root of the sum of squared changes of the first recording, by effect and parameter.
        """
        free = free_parameters(self.question, (name,))
        theta = np.concatenate([nominal.theta, [f.mean for f in free[len(nominal.theta) :]]])
        starts = nominal.params["start_0"].value
        base = np.vstack(self.simulate(self.runs[0], (name,), theta, starts))
        found = {}
        for j, f in enumerate(free):
            if not f.relative:
                moved, step = theta.copy(), share * f.sd
                moved[j] += step if moved[j] + step <= f.high else -step
                errors = np.vstack(self.simulate(self.runs[0], (name,), moved, starts))
                found[f.effect, f.name] = float(np.sqrt(np.nansum((errors - base) ** 2)))
        return found

    # ---- which effects are named

    def scores(self, estimate: Estimate) -> dict[str, float]:
        """Return the largest deviation from inactivity of each effect, in half-widths.

        Parameters that change nothing by themselves, such as the direction of a wind without force,
        do not count.
        """
        free = free_parameters(self.question, estimate.effects)
        scores = dict.fromkeys(estimate.effects, 0.0)
        for f, x, half in zip(free, estimate.theta, estimate.half_widths, strict=True):
            if (f.effect, f.name) in self.acting:
                scores[f.effect] = max(scores[f.effect], abs(x - f.mean) / max(half, 1e-12))
        return scores

    def excluding_inactive(self, estimate: Estimate) -> tuple[str, ...]:
        """Return the effects whose intervals exclude the inactive value, the surest first."""
        scores = self.scores(estimate)
        named = sorted(estimate.effects, key=lambda n: -scores[n])[:MOST]
        surest = {n for n in named if scores[n] > 1.0}
        return tuple(n for n in estimate.effects if n in surest)

    # ---- one fit

    def fit(self, effects: tuple[str, ...], about: Estimate | None) -> Estimate:
        """Fit the parameters of a structure and the initial states of all windows.

        Args:
            effects: Candidates that act.
            about: An estimate of another structure to start from; None: the vessel's file.
        """
        free = free_parameters(self.question, effects)
        params = self.parameter_dict(effects, about)
        residual = self.residual_function(effects)
        with contextlib.redirect_stdout(io.StringIO()):  # its progress
            fitted, result = self.sysid.optimize(
                initial_params=params,
                residual_fn=residual,
                optimizer="mujoco",
                max_iters=ITERATIONS,
                x_scale="jac",
                eps=STEP,
                verbose=False,
            )
        rows, _, _ = residual(fitted.as_vector(), fitted)
        tested = max(sum(not f.relative for f in free), 1)
        jacobian = np.asarray(result.jac)
        sigma, half = self.sysid.calculate_intervals(rows, jacobian, alpha=ALPHA / tested)
        count = len(free)
        theta = self.theta_of(fitted, effects)
        errors = []
        for i, run in enumerate(self.runs):
            errors += self.simulate(run, effects, theta, fitted[f"start_{i}"].value)
        covariance = np.asarray(sigma)[:count, :count]
        return Estimate(effects, theta, covariance, half[:count], fitted, tuple(errors))

    def parameter_dict(self, effects: tuple[str, ...], about: Estimate | None) -> Any:
        """Return the toolbox's parameters: coefficients, one vector an effect, initial states."""
        known = {}
        if about is not None:
            about_free = free_parameters(self.question, about.effects)
            known = {(f.effect, f.name): x for f, x in zip(about_free, about.theta, strict=True)}
        params = self.sysid.ParameterDict()
        for name, group in parameter_groups(free_parameters(self.question, effects)).items():
            low = np.array([max(f.low, f.mean - FAR * f.sd) for f in group])
            high = np.array([min(f.high, f.mean + FAR * f.sd) for f in group])
            nominal = np.array([f.mean for f in group])
            parameter = self.sysid.Parameter(name, nominal, low, high)
            start = [known.get((f.effect, f.name), f.mean) for f in group]
            parameter.value = np.clip(start, low, high)
            params.add(parameter)
        for i, run in enumerate(self.runs):
            guess = run.guess().ravel()
            name = f"start_{i}"
            parameter = self.sysid.Parameter(name, guess, guess - REACH, guess + REACH)
            if about is not None:
                parameter.value = about.params[name].value.copy()
            params.add(parameter)
        return params

    def theta_of(self, params: Any, effects: tuple[str, ...]) -> Array:
        """Return the free parameters (F,) of a structure from the toolbox's parameters."""
        groups = parameter_groups(free_parameters(self.question, effects))
        parts = [np.asarray(params[name].value) for name in groups]
        return np.concatenate(parts) if parts else np.zeros(0)

    def residual_function(self, effects: tuple[str, ...]) -> Any:
        """Return the residuals of all recordings and of the prior as the toolbox calls them."""
        functions = []
        for i, run in enumerate(self.runs):
            functions.append(
                self.sysid.build_residual_fn(
                    models_sequences=[self.sequences(run)],
                    build_model=lambda params, spec: self.model,
                    custom_rollout=Rollout(self, i, effects),
                    modify_residual=self.weighted_residual,
                    resample_true=False,
                    n_threads=1,
                )
            )
        free = free_parameters(self.question, effects)
        mean = np.array([f.mean for f in free])
        sd = np.array([f.sd for f in free])

        def residual(x: Array, params: Any) -> tuple[list[Array], None, None]:
            rows = []
            for function in functions:
                rows += function(x, params)[0]
            own = x[: len(mean)]
            if own.ndim == 1:
                rows.append((own - mean) / sd)
            else:
                rows.append((own - mean[:, None]) / sd[:, None])
            return rows, None, None

        return residual

    def sequences(self, run: Windows) -> Any:
        """Return the measured trajectory of one recording, the windows one after the other."""
        rows = window_rows(run)
        times = np.arange(len(rows)) * self.model.opt.timestep
        commands = run.track.commands[rows]
        measured = run.track.measured[rows]
        return self.sysid.ModelSequences(
            run.track.name,
            self.spec,
            run.track.name,
            self.sysid.create_initial_state(self.model, np.zeros(self.model.nq)),
            self.sysid.TimeSeries(times, commands),
            self.sysid.TimeSeries.from_names(times, measured, self.model),
        )

    def weighted_residual(
        self,
        params: Any,
        predicted: Any,
        measured: Any,
        model: Any,
        return_all: bool,
        *,
        state: Array,
    ) -> tuple[Array, Any, Any]:
        """Return weighted errors (M C,), 0 where nothing was recorded, and both signals."""
        errors = self.sysid.weighted_diff(predicted.data, measured.data, model, self.weights)
        return np.nan_to_num(errors).ravel(), predicted, measured

    def simulate(
        self, run: Windows, effects: tuple[str, ...], theta: Array, starts: Array
    ) -> list[Array]:
        """Return recorded minus simulated (M, C) of each window."""
        free = free_parameters(self.question, effects)
        values = self.problem.parameter_vector(run.track, free, theta)
        begun = np.asarray(starts).reshape(len(run.begins), -1)
        return run.errors(values, self.problem.program.effect_switches(effects), begun)


class Rollout:
    """Simulation of one recording by boatsim, in the form of the toolbox's rollout function."""

    def __init__(self, rival: MujocoSysid, number: int, effects: tuple[str, ...]) -> None:
        self.rival, self.number, self.effects = rival, number, effects

    def __call__(
        self,
        *,
        models: Sequence[Any],
        control_signal: Sequence[Any],
        initial_states: Sequence[Array],
        param_dicts: Sequence[Any],
        rollout_signal_mapping: Mapping[str, Any],
        **_: Any,
    ) -> list[Any]:
        """Return one trajectory for each set of parameters."""
        from mujoco.sysid import SystemTrajectory, TimeSeries

        run, times = self.rival.runs[self.number], control_signal[0].times
        measured = run.track.measured[window_rows(run)]
        states = np.zeros((len(times), models[0].nq + models[0].nv + 1))
        states[:, 0] = times
        memory: dict[bytes, Array] = {}
        found = []
        for params in param_dicts:
            data = measured - np.vstack(self.errors(run, params, memory))
            data = np.nan_to_num(data, posinf=LARGE, neginf=-LARGE).clip(-LARGE, LARGE)
            signals = TimeSeries(times, data, dict(rollout_signal_mapping))
            state = TimeSeries(times, states)
            found.append(
                SystemTrajectory(models[0], control_signal[0], signals, initial_states[0], state)
            )
        return found

    def errors(self, run: Windows, params: Any, memory: dict[bytes, Array]) -> list[Array]:
        """Return recorded minus simulated of each window; windows in memory are used again.

        Of the finite differences by initial states, each changes one window only.
        """
        theta = self.rival.theta_of(params, self.effects)
        starts = params[f"start_{self.number}"].value.reshape(len(run.begins), -1)
        keys = [theta.tobytes() + bytes([w]) + start.tobytes() for w, start in enumerate(starts)]
        new = [w for w, key in enumerate(keys) if key not in memory]
        if new:
            part = Windows(run.track, run.begins[new], run.ends[new])
            for w, errors in zip(
                new, self.rival.simulate(part, self.effects, theta, starts[new]), strict=True
            ):
                memory[keys[w]] = errors
        return [memory[key] for key in keys]


def window_rows(run: Windows) -> Array:
    """Return the rows of all windows, one window after the other."""
    return np.concatenate([np.arange(a, b + 1) for a, b in zip(run.begins, run.ends, strict=True)])


def parameter_groups(free: Sequence[FreeParameter]) -> dict[str, list[FreeParameter]]:
    """Return the free parameters by effect, those of the vessel under "vessel", in their order."""
    groups: dict[str, list[FreeParameter]] = {}
    for f in free:
        groups.setdefault("vessel" if f.relative else f.effect, []).append(f)
    return groups


def carrier_model(vessel: Any, track: Any) -> Any:
    """Return a MuJoCo model with the vessel's joints, commands and recorded signals.

    Its physics is not used: the toolbox reads from it the layout of states and sensors.
    """
    import mujoco

    spec = mujoco.MjSpec()
    hull = spec.worldbody.add_body(name="hull")
    hull.add_geom(size=[1.0, 0.0, 0.0], mass=1.0)
    axes = dof_in_state_order(vessel)
    for axis in axes:
        hull.add_joint(name=axis, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1.0, 0.0, 0.0])
    for i in range(track.commands.shape[1]):
        motor = spec.add_actuator(name=f"command_{i}", target=axes[0])
        motor.trntype = mujoco.mjtTrn.mjTRN_JOINT
    for signal, code in zip(track.signals, track.codes.tolist(), strict=True):
        rate = code >= len(axes)
        kind = mujoco.mjtSensor.mjSENS_JOINTVEL if rate else mujoco.mjtSensor.mjSENS_JOINTPOS
        sensor = spec.add_sensor(name=signal, type=kind, objname=axes[code % len(axes)])
        sensor.objtype = mujoco.mjtObj.mjOBJ_JOINT
    return spec
