"""Simulation of a joint in closed loop, with its sensors, controllers and desired motions."""
