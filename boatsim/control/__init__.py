"""Building blocks of controllers; they use plain numbers and do not depend on the simulator."""
