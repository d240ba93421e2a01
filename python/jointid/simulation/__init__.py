"""Simulation: a joint in closed loop, its sensors, controllers and desired motions."""
