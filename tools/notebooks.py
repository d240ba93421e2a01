"""Run the notebooks from top to bottom and keep their outputs; with names, only those notebooks."""

import argparse
import os
import tempfile
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient

FOLDER = Path(__file__).resolve().parents[1] / "notebooks"


def run(path: Path) -> None:
    """Execute one notebook and write it back, without traces of this machine."""
    before: Any = nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
    notebook: Any = nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
    NotebookClient(
        notebook,
        timeout=600,
        kernel_name="python3",
        record_timing=False,
        coalesce_streams=True,
        resources={"metadata": {"path": str(FOLDER)}},
    ).execute()
    notebook.metadata = before.metadata
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            if output.get("name") == "stderr":
                raise SystemExit(f"{path.name} writes to stderr: {output['text']}")
    nbformat.write(notebook, path)  # type: ignore[no-untyped-call]


def main() -> None:
    """Run the requested notebooks."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="such as 01; default: all")
    names = parser.parse_args().names
    with tempfile.TemporaryDirectory() as folder:
        os.environ["IPYTHONDIR"] = folder
        for path in sorted(FOLDER.glob("*.ipynb")):
            if not names or path.name.startswith(tuple(names)):
                run(path)
                print(f"{path.name} done", flush=True)


if __name__ == "__main__":
    main()
