"""Policy files: a network in ONNX with what it observes, what it commands and for which boat.

The file is that of the open exchange format, so that any of its runtimes evaluates the network. The
metadata entry `boatsim` describes observations, actions and vessel as JSON.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib.util import find_spec
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, NonNegativeFloat

from boatsim.errors import BadInput, unknown_name_message
from boatsim.files import Table, validate_table
from boatsim.learn.actions import Controls
from boatsim.learn.hull import Hulls, Scale
from boatsim.learn.tasks.base import Task
from boatsim.learn.tasks.names import TASKS
from boatsim.physics.signals import Array

FORMAT = 1
ENTRY = "boatsim"  # of the metadata
INPUT, OUTPUT = "observations", "actions"  # names of the network's input and output


class PolicyDescription(Table):
    """Observations, actions and vessel of a policy: the metadata of its file.

    Attributes:
        format: Version of the description.
        task: Name of the learning task.
        settings: Settings of the task.
        period: Duration of a control step [s].
        vessel: Name of the vessel of the training.
        length: Length of the vessel [m].
        beam: Beam of the vessel [m].
        speed: Speed of the vessel by which the task is scaled [m/s].
        mid_length: Distance of mid-length ahead of the origin of motion [m].
        observations: Names of the observations with their units.
        bounds: Bounds (S,) by which they are divided.
        actions: Names of the actions.
        channels: Command channels of the vessel.
        pattern: Share (A, C) of each channel in each action.
        neutral: Neutral commands (C,).
        up: From neutral to the upper end of each command (C,).
        down: From the lower end of each command to neutral (C,).
    """

    format: int = Field(ge=1, le=FORMAT)
    task: str
    settings: dict[str, float]
    period: float = Field(gt=0.0, le=10.0)
    vessel: str
    length: float = Field(gt=0.0)
    beam: float = Field(gt=0.0)
    speed: float = Field(gt=0.0)
    mid_length: float
    observations: list[str]
    bounds: list[float]
    actions: list[str]
    channels: list[str]
    pattern: list[list[float]]
    neutral: list[float]
    up: list[NonNegativeFloat]
    down: list[NonNegativeFloat]


@dataclass(frozen=True)
class Policy:
    """A trained network with its description; it turns observations into actions.

    Attributes:
        description: Observations, actions and vessel.
        task: The learning task, with its settings.
        session: Session of onnxruntime that evaluates the network.
    """

    description: PolicyDescription
    task: Task
    session: Any

    @cached_property
    def scale(self) -> Scale:
        """Length, beam and speed of the vessel, by which the task is scaled."""
        given = self.description
        return Scale(given.length, given.beam, given.speed)

    @cached_property
    def hull(self) -> Hulls:
        """Waterplane rectangle of the vessel, for one boat."""
        given = self.description
        sizes = (0.5 * given.length, 0.5 * given.beam, given.mid_length)
        return Hulls(*[np.array([size]) for size in sizes])

    @cached_property
    def controls(self) -> Controls:
        """Conversion of the actions to commands of the vessel."""
        given = self.description
        return Controls(
            names=tuple(given.actions),
            words=tuple(given.actions),
            pattern=np.array(given.pattern),
            neutral=np.array(given.neutral),
            up=np.array(given.up),
            down=np.array(given.down),
            ahead=np.zeros(len(given.actions)),
        )

    def act(self, observations: NDArray[np.float32]) -> Array:
        """Return the actions (n, A) of the network, from -1 to 1.

        Args:
            observations: Observations (n, S) in their units.

        Raises:
            BadInput: An action is nan.
        """
        (actions,) = self.session.run([OUTPUT], {INPUT: observations})
        if not np.isfinite(actions).all():
            raise BadInput("the network of the policy gives nan")
        return np.asarray(actions, dtype=float)


def load_policy(path: Path) -> Policy:
    """Read a policy file; one thread evaluates its network.

    Args:
        path: The ONNX file.

    Raises:
        BadInput: onnxruntime is not installed, or the file is missing, no ONNX file, or not a
            policy of boatsim.
    """
    if not path.is_file():
        raise BadInput(f"{path}: there is no such file; allowed is a policy (.onnx)")
    if find_spec("onnxruntime") is None:
        raise BadInput(f'{path}: a policy needs onnxruntime: pip install "boatsim[policy]"')
    import onnxruntime

    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.log_severity_level = 4  # errors are raised, not printed
    try:
        session = onnxruntime.InferenceSession(
            path.read_bytes(), options, providers=["CPUExecutionProvider"]
        )
    except Exception as error:  # onnxruntime has no common base class of its errors
        raise BadInput(f"{path}: no network in ONNX: {_first_line(error)}") from None
    entries: Mapping[str, str] = session.get_modelmeta().custom_metadata_map
    if ENTRY not in entries:
        raise BadInput(f"{path}: the metadata lack {ENTRY}; boatsim.learn.train writes them")
    description = _read_description(entries[ENTRY], f"{path}: metadata")
    try:
        policy = Policy(description, _described_task(description), session)
        _check_network(policy)
    except BadInput as error:
        raise BadInput(f"{path}: {error}") from None
    return policy


def _read_description(text: str, label: str) -> PolicyDescription:
    """The description in the metadata of a file."""
    try:
        content = json.loads(text)
    except ValueError as error:
        raise BadInput(f"{label}: {ENTRY} is no JSON: {error}") from None
    if not isinstance(content, dict):
        raise BadInput(f"{label}: {ENTRY} is no JSON object")
    return validate_table(PolicyDescription, content, label)


def _first_line(error: Exception) -> str:
    """First line of an error message, without the codes that onnxruntime writes before it."""
    line = next(iter(str(error).splitlines()), type(error).__name__)
    return line.rpartition(" : ")[2]


def _described_task(description: PolicyDescription) -> Task:
    """The learning task of a description."""
    if description.task not in TASKS:
        raise BadInput(unknown_name_message("task", description.task, TASKS))
    return TASKS[description.task].from_settings(description.settings)


def _check_network(policy: Policy) -> None:
    """Check that task, description and network agree about names and numbers.

    Raises:
        BadInput: They do not.
    """
    given = policy.description
    expected = [signal.name for signal in policy.task.signals(policy.scale)]
    expected += [f"last_{name}" for name in given.actions]
    for name, own in zip_longest(given.observations, expected, fillvalue="none"):
        if name != own:
            raise BadInput(f"observation {name!r}; {given.task} has {own!r} in its place")
    sizes = {
        "bounds": (len(given.bounds), len(given.observations)),
        "pattern": (len(given.pattern), len(given.actions)),
    }
    for name in ("neutral", "up", "down"):
        sizes[name] = (len(getattr(given, name)), len(given.channels))
    for row in given.pattern:
        sizes["pattern of an action"] = (len(row), len(given.channels))
    for (places, expected_names), tensors in (
        ((INPUT, given.observations), policy.session.get_inputs()),
        ((OUTPUT, given.actions), policy.session.get_outputs()),
    ):
        shapes = {tensor.name: tensor.shape for tensor in tensors}
        if places not in shapes:
            raise BadInput(f"the network has {', '.join(shapes)}; it needs {places}")
        width = shapes[places][-1]
        sizes[f"network's {places}"] = (width, len(expected_names))
    for name, (found, wanted) in sizes.items():
        if found != wanted:
            raise BadInput(f"{name}: {found} numbers; allowed are {wanted}")
