"""The identification problem: terms, windows, and the penalty that they define."""
