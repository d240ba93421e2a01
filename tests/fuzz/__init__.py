"""Files that are damaged at random: whatever they hold, a reader returns or refuses in one sentence."""
