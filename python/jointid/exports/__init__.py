"""A joint as other programs take it: simulators, controllers, PLCs; one file for each target, and the list of them."""
