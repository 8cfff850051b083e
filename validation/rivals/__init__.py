"""Other methods of finding missing effects, with the same candidates and laws.

Two are textbook methods written here. Three use packages as their documentation advises: PySINDy,
mujoco.sysid and sbi (extra `rivals`). They take part in the benchmark as any other tool: they read
a trial's recordings and write an answer for each trial.
"""
