"""Pictures of a report, drawn as SVG without a plotting library."""
