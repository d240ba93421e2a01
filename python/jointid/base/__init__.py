"""What every other folder uses: errors, files, checks of arguments."""
