"""An emulated bus and the common parts of emulated drives: time, devices, faults on demand."""
