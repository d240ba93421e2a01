"""How a robot moves: its recordings on one clock, velocities from positions."""
