"""One identification: delays taken away, zeros found, values and their conclusion."""
