"""Prints actions and observations of the registered environments: python -m boatsim.learn."""

from boatsim.learn import registration
from boatsim.learn.environment_options import make_simulation
from boatsim.learn.tasks.names import TASKS


def main() -> None:
    """Print the actions and observations of each registered Gymnasium environment."""
    for name in registration.environment_ids():
        options = registration.environment_arguments(name)
        game = make_simulation(n=1, **options)
        print(f"{name}: {TASKS[options['task']].words}, with {options['vessel']}")
        for action, words in zip(game.controls.names, game.controls.words, strict=True):
            print(f"  action {action:21s} -1 to 1    {words}")
        for signal in game.signals:
            print(f"  observed {signal.name:19s} +- {signal.bound:<7.3g} {signal.words}")
        print()


if __name__ == "__main__":
    main()
