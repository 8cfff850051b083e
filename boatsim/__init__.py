"""boatsim: small-boat motion and control on MuJoCo, and what a simulation of a real boat has left out."""

__version__: str


def __getattr__(name: str) -> str:
    """The version, looked up when somebody asks: the first thing the program imports should be quick."""
    if name != "__version__":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("boatsim")
    except PackageNotFoundError:  # run from a source tree that was never installed
        return "0+unknown"
