"""`python -m boatsim` is `boatsim`."""

from boatsim.quiet import leave_quietly


def main() -> None:
    """Entry point of the program: until all is imported, Ctrl-C ends it without a word."""
    leave_quietly()
    from boatsim.cli import main as begin

    begin()


if __name__ == "__main__":  # processes of `--jobs` import this file too
    main()
