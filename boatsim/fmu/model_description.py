"""The file modelDescription.xml of an FMU: its variables and abilities, for FMI 3.0 and 2.0."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from math import isinf
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from boatsim.fmu.units import base_unit
from boatsim.fmu.variables import Variable
from boatsim.version import version

# Characters that XML does not allow
FORBIDDEN = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd]")
# Ability of both kinds of FMU, in FMI 3.0
STATE_ABILITIES = {"canGetAndSetFMUState": "true", "canSerializeFMUState": "true"}
DEFAULT_DURATION = 60.0  # [s] proposed length of a simulation: some lengths of a small boat


@dataclass(frozen=True)
class ModelInformation:
    """Facts of an FMU that its description states in addition to the variables.

    Attributes:
        name: Name of the vessel.
        identifier: Name of the binary, a C identifier.
        about: Description of the vessel.
        token: Instantiation token.
        step: Integration step [s].
    """

    name: str
    identifier: str
    about: str
    token: str
    step: float


def xml_text(root: Element) -> str:
    """Return an XML document as text."""
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(root, "unicode")}\n'


def plain_text(text: str) -> str:
    """Return a text in one line without characters that XML does not allow."""
    return " ".join(FORBIDDEN.sub("?", text).split())


def fmi3_description(model: ModelInformation, variables: Sequence[Variable]) -> str:
    """Return the modelDescription.xml of FMI 3.0 for co-simulation and model exchange.

    Args:
        model: Facts that the description states in addition to the variables.
        variables: All variables in the order of their value references.
    """
    root = _root(model, "3.0", "instantiationToken")
    same = {"modelIdentifier": model.identifier, **STATE_ABILITIES}
    SubElement(root, "ModelExchange", same)
    SubElement(
        root,
        "CoSimulation",
        same
        | {
            "canHandleVariableCommunicationStepSize": "true",
            "fixedInternalStepSize": repr(model.step),
        },
    )
    _add_units(root, variables)
    _add_categories_and_experiment(root, model)
    references = {variable.name: str(i) for i, variable in enumerate(variables)}
    table = SubElement(root, "ModelVariables")
    for variable in variables:
        given = _attributes(variable) | {"valueReference": references[variable.name]}
        given |= _value_attributes(variable)
        if variable.derivative_of:
            given["derivative"] = references[variable.derivative_of]
        SubElement(table, "Float64", given)
    structure = SubElement(root, "ModelStructure")
    for variable in variables:
        if variable.causality == "output":
            SubElement(structure, "Output", {"valueReference": references[variable.name]})
    for variable in variables:
        if variable.derivative_of:
            given = {"valueReference": references[variable.name]}
            SubElement(structure, "ContinuousStateDerivative", given)
    for variable in variables:
        if variable.initial == "calculated":
            SubElement(structure, "InitialUnknown", {"valueReference": references[variable.name]})
    return xml_text(root)


def fmi2_description(model: ModelInformation, variables: Sequence[Variable]) -> str:
    """Return the modelDescription.xml of FMI 2.0 for co-simulation, without derivatives.

    Args:
        model: Facts that the description states in addition to the variables.
        variables: All variables in the order of their value references.
    """
    root = _root(model, "2.0", "guid")
    abilities = {
        "modelIdentifier": model.identifier,
        "canHandleVariableCommunicationStepSize": "true",
        "canGetAndSetFMUstate": "true",
        "canSerializeFMUstate": "true",
    }
    files = SubElement(SubElement(root, "CoSimulation", abilities), "SourceFiles")
    SubElement(files, "File", {"name": "fmi2.c"})
    _add_units(root, variables)
    _add_categories_and_experiment(root, model)
    table = SubElement(root, "ModelVariables")
    outputs, unknowns = list[str](), list[str]()
    place = 0  # FMI 2.0 counts from 1
    for reference, variable in enumerate(variables):
        if variable.derivative_of:
            continue
        place += 1
        given = _attributes(variable) | {"valueReference": str(reference)}
        initial = given.pop("initial", "")
        if initial:
            given["initial"] = initial
        SubElement(SubElement(table, "ScalarVariable", given), "Real", _value_attributes(variable))
        if variable.causality == "output":
            outputs.append(str(place))
        if variable.initial == "calculated":
            unknowns.append(str(place))
    structure = SubElement(root, "ModelStructure")
    for name, places in (("Outputs", outputs), ("InitialUnknowns", unknowns)):
        parent = SubElement(structure, name) if places else structure
        for one in places:
            SubElement(parent, "Unknown", {"index": one})
    return xml_text(root)


def build_description(identifier: str, flags: Sequence[str]) -> str:
    """Return the buildDescription.xml of FMI 3.0, by which tools compile the source.

    Args:
        identifier: Name of the binary.
        flags: Flags of the compiler that the numbers depend on.
    """
    root = Element("fmiBuildDescription", {"fmiVersion": "3.0"})
    build = SubElement(root, "BuildConfiguration", {"modelIdentifier": identifier})
    options = " ".join(flags)
    files = SubElement(
        build, "SourceFileSet", {"language": "C11", "compiler": "gcc", "compilerOptions": options}
    )
    SubElement(files, "SourceFile", {"name": "fmi3.c"})
    SubElement(build, "Library", {"name": "m"})
    return xml_text(root)


def _root(model: ModelInformation, fmi_version: str, token: str) -> Element:
    return Element(
        "fmiModelDescription",
        {
            "fmiVersion": fmi_version,
            "modelName": plain_text(model.name),
            token: model.token,
            "description": plain_text(model.about),
            "generationTool": f"boatsim {version()}",
            "variableNamingConvention": "structured",
        },
    )


def _add_units(root: Element, variables: Sequence[Variable]) -> None:
    """Add the definition of each unit that a variable has."""
    table = SubElement(root, "UnitDefinitions")
    for unit in dict.fromkeys(variable.unit for variable in variables):
        if not unit:
            continue
        base = base_unit(unit)
        given = {name: str(exponent) for name, exponent in base.exponents.items()}
        if base.factor != 1.0:
            given["factor"] = repr(base.factor)
        SubElement(SubElement(table, "Unit", {"name": unit}), "BaseUnit", given)


def _add_categories_and_experiment(root: Element, model: ModelInformation) -> None:
    categories = SubElement(root, "LogCategories")
    SubElement(categories, "Category", {"name": "logStatusError", "description": "errors"})
    SubElement(
        root,
        "DefaultExperiment",
        {
            "startTime": "0.0",
            "stopTime": repr(DEFAULT_DURATION),
            "stepSize": repr(model.step),
        },
    )


def _attributes(variable: Variable) -> dict[str, str]:
    """Name, description and role of a variable."""
    given = {
        "name": variable.name,
        "description": plain_text(variable.words),
        "causality": variable.causality,
        "variability": variable.variability,
    }
    if variable.initial:
        given["initial"] = variable.initial
    return given


def _value_attributes(variable: Variable) -> dict[str, str]:
    """Unit, bounds and start value of a variable."""
    given = {}
    if variable.unit:
        given["unit"] = variable.unit
    for key, bound in (("min", variable.low), ("max", variable.high)):
        if not isinf(bound):
            given[key] = repr(float(bound))
    if variable.start is not None:
        given["start"] = repr(float(variable.start))
    return given
