"""Common parts of the balances of a joint, a robot and a servo: least squares, windows, resampling, held-out data."""
