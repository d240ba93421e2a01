"""Session on any drive: control loop, guard, recording, and the order in which it stops."""
