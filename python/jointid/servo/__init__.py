"""Servos without a torque signal: identification from duty and position, and simulation in closed loop."""
