"""An emulated bus and what emulated drives share: time, devices, faults on demand."""
