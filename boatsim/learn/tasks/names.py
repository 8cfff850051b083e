"""Names of the learning tasks."""

from collections.abc import Mapping

from boatsim.learn.tasks.base import Task
from boatsim.learn.tasks.berth import Berth
from boatsim.learn.tasks.follow_path import FollowPath
from boatsim.learn.tasks.hold_station import HoldStation
from boatsim.learn.tasks.joystick import Joystick

TASKS: Mapping[str, type[Task]] = {
    task.task_name(): task for task in (Berth, HoldStation, FollowPath, Joystick)
}
