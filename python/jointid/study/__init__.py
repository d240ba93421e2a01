"""Studies: many identifications over settings and seeds, in this process or an executor, saved as they finish."""
