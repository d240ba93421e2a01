"""An Elmo drive and its torque sensor's converter on CANopen."""
