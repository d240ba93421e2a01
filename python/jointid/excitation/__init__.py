"""Design of the motion that identifies a joint's parameters best."""
