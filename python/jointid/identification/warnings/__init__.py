"""What the data and the fit show to be wrong."""
