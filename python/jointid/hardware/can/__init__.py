"""CAN bus, CANopen frames, and logs of frames."""
