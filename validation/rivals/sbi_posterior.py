"""sbi on a trial: neural posterior estimation with boatsim as the simulator.

Two steps, both with methods of the toolbox. Structure: mixed neural posterior estimation (`MNPE`)
of the vessel's coefficients and of one binary variable for each candidate, with parameters of
acting candidates sampled from their priors; a candidate is named if its posterior probability
exceeds one half. Parameters: neural posterior estimation (`NPE`) of the named structure. A fully
connected embedding net learns the statistics from averages over parts of windows. The unknown flag
is a posterior predictive check, which the toolbox's tutorials advise after every inference.
"""

import contextlib
import io
import warnings
from typing import Any

import numpy as np

from boatsim.diagnosis.candidates import name_without_prefixes
from boatsim.diagnosis.problem import Fit, FreeParameter
from boatsim.physics.base import Array
from validation.rivals.packages import import_package
from validation.rivals.question import Question, as_diagnosis_fit, free_parameters
from validation.rivals.sbi_simulator import Hypothesis, Simulator

SEED = 1  # of samples, networks and training
STRUCTURES, PARAMETERS = 4000, 1500  # simulations for the structure and for its parameters
NUMBER_OF_EFFECTS = (0.3, 0.5, 0.2)  # prior probabilities of none, one and two
SAMPLES = 1000  # of a posterior
PREDICTED = 300  # simulations of the posterior predictive check
UNEXPLAINED = 0.01  # p-value below which the unknown flag is set
LIKELY = 0.5  # least posterior probability of a named effect
SUMMARY, HIDDEN = 40, 100  # outputs of the embedding net, and width of all networks
EPOCHS = 100  # most epochs; training ends earlier when the validation loss has not fallen for 20
MOST = 4  # largest number of effects, as for the other methods
ALMOST_ONE = 0.999  # a probability above this counts as this in the log odds


class NoTracker:
    """A tracker of training that stores nothing; the default of sbi writes to the folder."""

    log_dir = None

    def log_metric(self, name: str, value: float, step: int | None = None) -> None:
        """Ignore a figure."""

    def log_metrics(self, metrics: dict[str, float], step: int | None = None) -> None:
        """Ignore figures."""

    def log_params(self, params: dict[str, Any]) -> None:
        """Ignore settings."""

    def add_figure(self, name: str, figure: Any, step: int | None = None) -> None:
        """Ignore a plot."""

    def flush(self) -> None:
        """Do nothing."""


class SbiPosterior:
    """Answer of sbi to one trial."""

    def __init__(self, question: Question, plain: bool) -> None:
        self.torch = import_package("torch", "sbi_posterior")
        self.inference = import_package("sbi.inference", "sbi_posterior")
        self.question = question
        self.simulator = Simulator(question)
        self.candidates: list[str] = []
        for name in question.entries:
            if name_without_prefixes(name) not in {
                name_without_prefixes(n) for n in self.candidates
            }:
                self.candidates.append(name)
        self.rng = np.random.default_rng(SEED)
        self.torch.set_num_threads(1)
        self.torch.manual_seed(SEED)

    def answer(self) -> tuple[Fit, dict[str, float], bool]:
        """Return the fit, log posterior odds of each effect, and the unknown flag."""
        probabilities = self.structure()
        named = sorted(probabilities, key=lambda n: -probabilities[n])[:MOST]
        named = [n for n in named if probabilities[n] > LIKELY]
        gains = {}
        for n in named:
            p = min(probabilities[n], ALMOST_ONE)
            gains[n] = float(np.log(p / (1.0 - p)))
        effects = tuple(named)
        thetas = self.parameters(effects)
        covariance = np.atleast_2d(np.cov(thetas.T))
        fit = as_diagnosis_fit(self.question, effects, thetas.mean(axis=0), covariance)
        return fit, gains, self.is_unexplained(effects, thetas)

    # ---- priors

    def sample_effects(self) -> tuple[str, ...]:
        """Return the effects of a structure sampled from the prior."""
        count = self.rng.choice(len(NUMBER_OF_EFFECTS), p=NUMBER_OF_EFFECTS)
        chosen = self.rng.choice(len(self.candidates), size=count, replace=False)
        return tuple(self.candidates[i] for i in sorted(chosen))

    def theta(self, free: tuple[FreeParameter, ...], standard: Array) -> Array:
        """Return parameters (F,) for standard normal values (F,), reflected at their bounds."""
        low, high = np.array([(f.low, f.high) for f in free]).T
        x = np.array([f.mean + f.sd * z for f, z in zip(free, standard, strict=True)])
        x = np.where(x < low, 2.0 * low - x, x)
        x = np.where(x > high, 2.0 * high - x, x)
        return np.asarray(np.clip(x, low, high))

    # ---- structure

    def structure(self) -> dict[str, float]:
        """Return the posterior probability of each candidate."""
        common = len(free_parameters(self.question, ()))
        hypotheses, rows = [], []
        for _ in range(STRUCTURES):
            effects = self.sample_effects()
            free = free_parameters(self.question, effects)
            standard = self.rng.standard_normal(len(free))
            hypotheses.append(Hypothesis(effects, self.theta(free, standard)))
            flags = [float(n in effects) for n in self.candidates]
            rows.append(np.concatenate([standard[:common], flags]))
        x = self.simulator.summaries(hypotheses, self.rng)
        builder = self.mixed_network(x.shape[1])
        trainer = self.inference.MNPE(
            density_estimator=builder, tracker=NoTracker(), show_progress_bars=False
        )
        estimator = self.train(trainer, np.array(rows), x)
        observed = self.torch.zeros(1, x.shape[1])
        with self.torch.no_grad():
            samples = estimator.sample((SAMPLES,), condition=observed)
        flags = samples.reshape(SAMPLES, -1)[:, common:].numpy()
        return dict(zip(self.candidates, flags.mean(axis=0).tolist(), strict=True))

    def mixed_network(self, inputs: int) -> Any:
        """Return the function that builds the network of MNPE."""
        from sbi.neural_nets.net_builders.mixed_nets import build_mnpe

        categories = self.torch.full((len(self.candidates),), 2)

        def build(theta: Any, x: Any) -> Any:
            return build_mnpe(
                theta,
                x,
                num_categories_per_variable=categories,
                embedding_net=self.embedding_net(inputs),
                hidden_features=HIDDEN,
            )

        return build

    def embedding_net(self, inputs: int) -> Any:
        """Return the net that learns the summary statistics."""
        from sbi.neural_nets.embedding_nets import FCEmbedding

        return FCEmbedding(inputs, output_dim=SUMMARY, num_hiddens=HIDDEN)

    def train(self, trainer: Any, thetas: Array, x: Array) -> Any:
        """Train a network of the toolbox on simulations and return it."""
        to = self.torch.as_tensor
        quiet = contextlib.redirect_stdout(io.StringIO())
        with quiet, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            trainer.append_simulations(
                to(thetas, dtype=self.torch.float32), to(x, dtype=self.torch.float32)
            )
            return trainer.train(max_num_epochs=EPOCHS)

    # ---- parameters

    def parameters(self, effects: tuple[str, ...]) -> Array:
        """Return samples (SAMPLES, F) of the posterior of a structure's parameters."""
        from sbi.neural_nets import posterior_nn

        free = free_parameters(self.question, effects)
        standard = self.rng.standard_normal((PARAMETERS, len(free)))
        hypotheses = [Hypothesis(effects, self.theta(free, z)) for z in standard]
        x = self.simulator.summaries(hypotheses, self.rng)
        normal = self.torch.distributions.MultivariateNormal(
            self.torch.zeros(len(free)), self.torch.eye(len(free))
        )
        network = posterior_nn("maf", embedding_net=self.embedding_net(x.shape[1]))
        trainer = self.inference.NPE(
            prior=normal,
            density_estimator=network,
            tracker=NoTracker(),
            show_progress_bars=False,
        )
        estimator = self.train(trainer, standard, x)
        posterior = trainer.build_posterior(estimator)
        observed = self.torch.zeros(1, x.shape[1])
        samples = posterior.sample((SAMPLES,), x=observed, show_progress_bars=False).numpy()
        return np.array([self.theta(free, z) for z in samples])

    def is_unexplained(self, effects: tuple[str, ...], thetas: Array) -> bool:
        """Compare the recording with simulations of the posterior (predictive check)."""
        hypotheses = [Hypothesis(effects, theta) for theta in thetas[:PREDICTED]]
        x = self.simulator.summaries(hypotheses, self.rng)
        mean, sd = x.mean(axis=0), x.std(axis=0) + 1e-12
        simulated = (((x - mean) / sd) ** 2).mean(axis=1)
        recorded = float(((mean / sd) ** 2).mean())
        return float(np.mean(simulated >= recorded)) < UNEXPLAINED
