"""What the balances of a joint, a robot and a servo share: least squares, windows, resampling, held-out parts."""
