"""Description of a robot: its links, joints and motors, from a URDF and facts."""
