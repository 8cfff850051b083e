"""Tasks for learning: Gymnasium environments of one boat and of many; importing this makes their ids known.

`gymnasium.make("boatsim.learn:boatsim/Berth-v0")` imports it by itself. Needs `pip install "boatsim[gym]"`.
"""

from importlib.util import find_spec

if find_spec("gymnasium") is not None:
    from boatsim.learn.registration import register

    register()
