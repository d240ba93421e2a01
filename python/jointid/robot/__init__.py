"""A whole robot from one recording: the windowed torque balance of all joints, without acceleration."""
