"""Reports of results: pages made of sections, in several formats."""
