"""Servos without a torque signal: identified from duty and position, and rolled out in closed loop."""
