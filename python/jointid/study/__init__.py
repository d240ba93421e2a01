"""Many identifications: over options and seeds, here or on many machines, kept as they are done."""
