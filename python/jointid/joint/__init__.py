"""Joints: what is known of one, its parameters, and the file that holds them."""
