"""Writes a trained network as a policy file in ONNX; needs the package onnx."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import onnx
from numpy.typing import NDArray
from onnx import TensorProto, helper, numpy_helper

from boatsim.files import replace_file
from boatsim.learn.hull import Hulls
from boatsim.learn.play import TaskSimulation
from boatsim.learn.policy import ENTRY, FORMAT, INPUT, OUTPUT, PolicyDescription

OPSET = 17  # operators of ONNX 1.12 (2022), which all current runtimes evaluate
IR_VERSION = 8  # that of the same release
Layer = tuple[NDArray[np.float32], NDArray[np.float32]]  # weights (out, in), bias (out,)


def describe_policy(play: TaskSimulation) -> PolicyDescription:
    """Return the description of policies that are trained in a simulation of a task.

    The hull is that of the first vessel of the variation.

    Args:
        play: The simulation.
    """
    task, controls, vessel = play.task, play.controls, play.vessel
    return PolicyDescription(
        format=FORMAT,
        task=type(task).task_name(),
        settings={name: getattr(task, name) for name in type(task).params()},
        period=play.period,
        vessel=vessel.name,
        length=play.scale.length,
        beam=play.scale.beam,
        speed=play.scale.speed,
        mid_length=float(Hulls.from_vessels([vessel]).middle[0]),
        observations=[signal.name for signal in play.signals],
        bounds=[signal.bound for signal in play.signals],
        actions=list(controls.names),
        channels=list(vessel.commands),
        pattern=controls.pattern.tolist(),
        neutral=controls.neutral.tolist(),
        up=controls.up.tolist(),
        down=controls.down.tolist(),
    )


def write_policy(path: Path, layers: Sequence[Layer], description: PolicyDescription) -> None:
    """Write a policy: dense layers with tanh between them, and actions limited to -1 and 1.

    The network of the file takes observations in their units; it divides them by their bounds and
    limits them to -1 and 1 before the first layer, as in the training.

    Args:
        path: The file.
        layers: Weights (outputs, inputs) and biases (outputs,) of the layers.
        description: Observations, actions and vessel.
    """
    constants = []
    for name, limit in (("least", -1.0), ("most", 1.0)):
        constants.append(numpy_helper.from_array(np.array(limit, np.float32), name))
    bounds = np.array(description.bounds, np.float32)
    constants.append(numpy_helper.from_array(bounds, "bounds"))
    nodes = [
        helper.make_node("Div", [INPUT, "bounds"], ["shares"]),
        helper.make_node("Clip", ["shares", "least", "most"], ["limited"]),
    ]
    value = "limited"
    for number, (weights, bias) in enumerate(layers):
        names = [f"weights_{number}", f"bias_{number}"]
        for name, array in zip(names, (weights, bias), strict=True):
            constants.append(numpy_helper.from_array(np.asarray(array, np.float32), name))
        nodes.append(helper.make_node("Gemm", [value, *names], [f"sum_{number}"], transB=1))
        value = f"sum_{number}"
        if number < len(layers) - 1:
            nodes.append(helper.make_node("Tanh", [value], [f"layer_{number}"]))
            value = f"layer_{number}"
    nodes.append(helper.make_node("Clip", [value, "least", "most"], [OUTPUT]))
    graph = helper.make_graph(
        nodes,
        description.task,
        [_matrix(INPUT, layers[0][0].shape[1])],
        [_matrix(OUTPUT, layers[-1][0].shape[0])],
        constants,
    )
    model = helper.make_model(
        graph, opset_imports=[helper.make_opsetid("", OPSET)], producer_name="boatsim"
    )
    model.ir_version = IR_VERSION
    helper.set_model_props(model, {ENTRY: description.model_dump_json()})
    onnx.checker.check_model(model)
    with replace_file(path) as temporary:
        temporary.write_bytes(model.SerializeToString())


def _matrix(name: str, width: int) -> Any:
    """Input or output of the network, with any number of rows."""
    return helper.make_tensor_value_info(name, TensorProto.FLOAT, ["boats", width])
