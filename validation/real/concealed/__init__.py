"""Real recordings altered so that the right answer is known: `python -m validation.real.concealed`."""
