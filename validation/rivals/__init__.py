"""Two textbook methods of finding missing effects, with the same candidates and laws.

They take part in the benchmark as any other tool: they read a trial's recordings and write an
answer for each trial.
"""
