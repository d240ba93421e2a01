"""Shared basis of all other folders: errors, files, checks of arguments."""
