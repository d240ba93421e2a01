"""One identification: delays removed, zeros found, values and their conclusion."""
