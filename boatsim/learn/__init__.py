"""Gymnasium environments of one boat and of many boats; importing the package registers them.

`gymnasium.make("boatsim.learn:boatsim/Berth-v0")` imports the package. Gymnasium is installed with
`pip install "boatsim[gym]"`.
"""

from importlib.util import find_spec

if find_spec("gymnasium") is not None:
    from boatsim.learn.registration import register

    register()
