"""Files that hold recordings: one reader for each format, and `load`, which picks one."""
