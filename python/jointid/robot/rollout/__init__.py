"""Simulation of a robot's estimate: logged torques move the arm, and its positions are compared with the log."""
