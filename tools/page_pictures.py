"""Take the pictures of reports for docs/reports.md, in a browser: `make browser` installs it."""

import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from browser import browser, missing  # noqa: E402
from report_pages import Shown, of_a_comparison, of_a_joint, of_a_session, page  # noqa: E402

FOLDER = ROOT / "docs" / "pictures"
# By the file's name: the page, its width and height in pixels, and the background.
SHOTS: dict[str, tuple[Callable[[], Shown], int, int, str]] = {
    "report_of_a_joint.png": (of_a_joint, 800, 1180, "light"),
    "report_of_a_comparison.png": (of_a_comparison, 390, 760, "dark"),
    "report_of_a_session.png": (of_a_session, 800, 1000, "dark"),
}


def main() -> None:
    """Take the pictures and save them."""
    if lacking := missing():
        sys.exit(lacking)
    with TemporaryDirectory() as folder, browser(Path(folder)) as shown:
        for name, (make, width, height, scheme) in SHOTS.items():
            shown.open(page(make), width, scheme, height)
            shown.picture(FOLDER / name)
            few_colours = Image.open(FOLDER / name).convert("RGB").quantize(200)
            few_colours.save(FOLDER / name, optimize=True)  # half the size


if __name__ == "__main__":
    main()
