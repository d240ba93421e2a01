"""Several joints identified from one recording, each for itself, and what each residual owes to the others."""
