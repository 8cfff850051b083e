"""The public interface describes the arguments of its functions and methods."""

import inspect
from collections.abc import Callable, Iterator
from typing import Any

import pytest

import boatsim


def public_functions() -> Iterator[tuple[str, Callable[..., Any]]]:
    """Functions of the public interface, and public methods of its classes, with their names."""
    for name in boatsim.__all__:
        thing = getattr(boatsim, name)
        if inspect.isfunction(thing):
            yield name, thing
        if not inspect.isclass(thing):
            continue
        for method, _ in inspect.getmembers(thing):
            function = inspect.unwrap(getattr(thing, method))
            function = getattr(function, "__func__", function)  # of a class method
            is_own = str(getattr(function, "__module__", "")).startswith("boatsim")
            if not method.startswith("_") and inspect.isfunction(function) and is_own:
                yield f"{name}.{method}", function


FUNCTIONS = dict(public_functions())


def test_the_interface_has_functions_and_methods() -> None:
    assert {"diagnose", "Fleet.run", "Vessel.replace", "Recording.between"} <= FUNCTIONS.keys()


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_public_function_describes_its_arguments(name: str) -> None:
    """One argument may be described by a docstring of one line."""
    arguments = list(inspect.signature(FUNCTIONS[name]).parameters)
    arguments = [argument for argument in arguments if argument not in ("self", "cls")]
    text = inspect.getdoc(FUNCTIONS[name]) or ""
    if not arguments or (len(arguments) == 1 and "\n" not in text):
        return
    assert "\nArgs:\n" in text
    described = text.partition("\nArgs:\n")[2]
    for argument in arguments:
        assert f"    {argument}:" in described, argument
