"""The joystick boat as a dm_control environment: 20 s of random commands, then a picture, no display needed."""

import numpy as np
from PIL import Image

from boatsim.simulate import env

boat = env.load("joystick_boat/yaw_1")
spec = boat.action_spec()  # one number for each command channel; spec.name lists them
random = np.random.default_rng(1)
step = boat.reset()
for i in range(round(20.0 / boat.control_timestep())):
    if i % 25 == 0:  # a new command every 2 s
        action = random.uniform(spec.minimum, spec.maximum)
    step = boat.step(action)

for name, value in step.observation.items():
    print(f"{name:24s} {value:8.3f}")
Image.fromarray(boat.physics.render(720, 1280, camera_id="oblique")).save("random_commands.png")
print("random_commands.png: the boat after 20 s")
