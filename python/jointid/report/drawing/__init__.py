"""Draw the pictures of a report as SVG without a plotting library."""
