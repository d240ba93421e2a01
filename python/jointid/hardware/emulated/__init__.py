"""An emulated bus and what emulated drives share: time, devices, the joint, faults on demand."""
