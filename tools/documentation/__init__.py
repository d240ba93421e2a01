"""The documentation site: preparation of the sources for Sphinx in `make docs`, and extensions of Sphinx."""
