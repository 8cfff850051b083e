"""A run in real time with somebody's hands on the sticks: a page in the browser, and what keeps it safe and on time."""
