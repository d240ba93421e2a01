"""A drive, a converter and a bus that are not there: the same frames and refusals, and faults on demand."""
