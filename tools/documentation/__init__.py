"""The documentation site: what `make docs` puts together before Sphinx, and what it adds to Sphinx."""
