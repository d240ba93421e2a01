"""Export of a joint to simulators, controllers and PLCs; one file for each target."""
