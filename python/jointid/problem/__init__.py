"""What is identified from what: terms, windows, the penalty they define."""
