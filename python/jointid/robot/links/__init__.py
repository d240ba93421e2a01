"""What a robot is: its links, joints and motors, from a URDF and facts."""
