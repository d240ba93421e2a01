"""A robot's estimate rolled out: the arm moves by the logged torques, and its positions are held against the log."""
