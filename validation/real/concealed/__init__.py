"""Real recordings with known alterations: `python -m validation.real.concealed`."""
