"""What a boat is: signals, kinds of effects, vessels, and the program they are composed to."""
