"""What a page is made of, as data: parts with headings, and blocks that no renderer has to know the result for."""
