"""From recordings and a joint to an estimate."""
