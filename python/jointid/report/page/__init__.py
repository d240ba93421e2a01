"""A page as data: parts with headings, and blocks that do not depend on the kind of result."""
