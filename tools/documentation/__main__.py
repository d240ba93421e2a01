"""Build the documentation site: prepare the sources, and run Sphinx on them.

PYTHONPATH=tools python -m documentation --output build/docs
"""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path

from documentation.findings_gallery import write_findings, write_pictures
from documentation.links import broken
from documentation.pictures import style
from documentation.public_names import check_groups
from documentation.reference import write_reference
from documentation.staging import ROOT, Stage, stage_documents


def main() -> int:
    """Build the site, and return Sphinx's exit code."""
    parser = argparse.ArgumentParser(
        prog="documentation", description="Build the documentation site."
    )
    parser.add_argument(
        "--output",
        type=Path,
        default=ROOT / "build" / "docs",
        help="folder of the site and its source",
    )
    parser.add_argument("--links", action="store_true", help="also check links to other hosts")
    arguments = parser.parse_args()
    source = arguments.output / "source"
    stage = Stage(source)
    check_groups()
    stage_documents(stage)
    write_pictures(stage)
    write_findings(stage)
    write_reference(stage)
    stage.write("_static/pictures.css", style())
    site = arguments.output / "site"
    if stage.finish():  # no page stays on the site without its source
        shutil.rmtree(site, ignore_errors=True)
    code = _sphinx("html", source, site)
    if code == 0:
        wrong = list(broken(site))
        print(*wrong, sep="\n", end="\n" * bool(wrong), file=sys.stderr)
        code = int(bool(wrong))
    if code == 0 and arguments.links:
        code = _sphinx("linkcheck", source, arguments.output / "links")
    if code == 0:
        # Time of the last check; an unchanged page is not written again.
        (arguments.output / "complete").touch()
        print(f"Open {site / 'index.html'} in a browser; the folder can be served as it is.")
    return code


def _sphinx(builder: str, source: Path, target: Path) -> int:
    """Run Sphinx with warnings as errors, and return its exit code."""
    from sphinx.cmd.build import main as sphinx

    options = ["-b", builder, "-c", str(ROOT / "docs"), "-d", str(source.parent / "doctrees")]
    options += ["-D", f"html_static_path={source / '_static'}"]
    options += ["-D", f"html_extra_path={source / 'as_it_is'}"]
    return sphinx([*options, "-W", "--keep-going", "-q", str(source), str(target)])


if __name__ == "__main__":
    sys.exit(main())
