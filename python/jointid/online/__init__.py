"""Online identification: estimates of a joint while it runs."""
