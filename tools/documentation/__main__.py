"""Build the documentation site: put the source together, and run Sphinx on it.

PYTHONPATH=tools python -m documentation --output build/docs
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from documentation.findings_gallery import write_gallery, write_pictures
from documentation.links import broken
from documentation.pictures import style
from documentation.public_names import check_groups
from documentation.reference import write_reference
from documentation.staging import ROOT, Stage, stage_documents


def main() -> int:
    """Build what is asked for, and return Sphinx's exit code."""
    parser = argparse.ArgumentParser(
        prog="documentation", description="Build the documentation site."
    )
    parser.add_argument(
        "--output", type=Path, default=ROOT / "build" / "docs", help="folder of site and source"
    )
    parser.add_argument(
        "--links", action="store_true", help="also ask whether links to other hosts answer"
    )
    arguments = parser.parse_args()
    source = arguments.output / "source"
    stage = Stage(source)
    check_groups()
    stage_documents(stage)
    write_pictures(stage)
    write_gallery(stage)
    write_reference(stage)
    stage.write("_static/pictures.css", style())
    stage.finish()

    from sphinx.cmd.build import main as sphinx

    site = arguments.output / "site"
    common = [
        "-c",
        str(ROOT / "docs"),
        "-d",
        str(arguments.output / "doctrees"),
        "-W",
        "--keep-going",
        "-q",
    ]
    code = sphinx(["-b", "html", *common, str(source), str(site)])
    if code == 0:
        wrong = list(broken(site))
        print(*wrong, sep="\n", end="\n" * bool(wrong), file=sys.stderr)
        code = int(bool(wrong))
    if code == 0 and arguments.links:
        code = sphinx(["-b", "linkcheck", *common, str(source), str(arguments.output / "links")])
    if code == 0:
        print(f"Open {site / 'index.html'} in a browser; the folder can be served as it is.")
    return code


if __name__ == "__main__":
    sys.exit(main())
