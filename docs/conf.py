"""Settings of Sphinx; `make docs` runs it on what tools/documentation puts together."""

import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tools"))

project = "jointid"
author = "The jointid developers"
version = release = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"][
    "version"
]
copyright = author  # noqa: A001  Sphinx's name of it
language = "en"
smartquotes_action = "qe"  # two hyphens begin an option

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "documentation.notebooks",
    "documentation.mathml",
]
exclude_patterns = ["repository/**", "generated/**", "as_it_is/**"]
suppress_warnings = ["ref.python"]  # a field with the name of another class's: it needs no link
default_role = "literal"  # a name in a docstring

myst_enable_extensions = ["dollarmath", "deflist", "attrs_inline", "attrs_block"]
myst_heading_anchors = 5
myst_dmath_allow_space = False

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the signature of the NumPy docstring's Parameters says it
autodoc_inherit_docstrings = False
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
python_maximum_signature_line_length = 80

html_theme = "furo"
html_title = "jointid"
# Of the folder that is put together; the command line says where it is.
html_static_path: list[str] = []
html_css_files = ["pictures.css", "site.css"]
html_show_sphinx = False
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {"navigation_with_keys": True, "footer_icons": []}
pygments_style = "a11y-high-contrast-light"
pygments_dark_style = "a11y-high-contrast-dark"

# Links to other hosts are only asked with `make docs LINKS=1`.
linkcheck_timeout = 20
linkcheck_retries = 2
linkcheck_anchors = False
