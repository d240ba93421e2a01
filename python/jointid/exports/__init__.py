"""Export of a joint to simulators, controllers and PLCs, with one file of this folder per target."""
