"""From a log of many streams, each with a clock of its own, to one recording."""
