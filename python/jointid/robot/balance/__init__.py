"""The torque balance of all joints over windows, and its solution."""
