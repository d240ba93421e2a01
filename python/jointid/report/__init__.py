"""Reports of results: pages with sections, in several formats."""
