"""Motion of a robot: its recordings on one clock, and velocities from positions."""
