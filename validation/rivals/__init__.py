"""Two textbook ways to say what a boat leaves out, over the same library and compiled laws as the diagnosis.

They enter the benchmark as any other tool may: they read a trial's recordings and write an answer for each.
"""
