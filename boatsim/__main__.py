"""Entry point of `boatsim` and `python -m boatsim`."""

from boatsim.quiet import exit_on_signals


def main() -> None:
    """Run boatsim's command line; during the imports Ctrl-C ends the program without a message."""
    exit_on_signals()
    from boatsim.cli import main as run_command_line

    run_command_line()


if __name__ == "__main__":  # processes of `--jobs` import this file too
    main()
