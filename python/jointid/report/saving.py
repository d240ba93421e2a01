"""The report of any result, as page text or as a file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from jointid.base.advice import Action
from jointid.base.argument_checks import require_path
from jointid.base.files import write_whole
from jointid.problem.recordings import listed
from jointid.report.page.extras import Extras
from jointid.report.pages import page_of
from jointid.report.renderers import RENDERERS, ending_of_page

if TYPE_CHECKING:
    from jointid.base.result import Result
    from jointid.estimate.rollout import Rollout
    from jointid.recording.recording import Recording


def report_page(
    result: Result,
    action: Callable[[Action], str] = str,
    recordings: Recording | Sequence[Recording] | None = None,
    rollout: Rollout | None = None,
    ending: str = ".html",
) -> str:
    """Return the report of a result as one self-contained page.

    Parameters
    ----------
    result : Result
    action, recordings, rollout
        See `save_report`.
    ending : str
        The format, by its name in `RENDERERS`. Default HTML.

    Returns
    -------
    str

    Raises
    ------
    InputError
        The argument is not a result, or the recordings are not those of the result.
    """
    extras = Extras(action, () if recordings is None else tuple(listed(recordings)), rollout)
    renderer = import_module(f"jointid.report.renderers.{RENDERERS[ending]}")
    return str(renderer.render(page_of(result, extras)))


def save_report(
    result: Result,
    path: str | Path,
    action: Callable[[Action], str] = str,
    recordings: Recording | Sequence[Recording] | None = None,
    rollout: Rollout | None = None,
) -> Path:
    """Write the report of a result as one self-contained page, completely or not at all.

    The page begins with the verdict or the answer. It contains all pictures, and can be read on phones and dark
    screens.

    Parameters
    ----------
    result : Result
        Result of `identify`, `compare`, `design`, `simulate`, `sweep` or `commission`.
    path : path
        Path that ends in .html, .md or .txt. A .md or .txt file has captions instead of pictures. An existing file
        is replaced.
    action : callable
        Function that returns the text of a finding's advice. Default: the text for a Python prompt.
    recordings : Recording or sequence of Recording, optional
        Recordings of an `Estimate`, in the order of its identification. The page then shows their signals, with
        unused parts shaded, and the residual over position. Default: a page without these pictures.
    rollout : Rollout, optional
        The rollout of a servo's or a robot's recordings. The page then shows the logged and the simulated motion
        of each run or joint. Default: a page without these pictures.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        The argument is not a result, the recordings are not those of the estimate, the file has another ending, or
        the folder does not exist.
    OSError
        The file cannot be written. An existing file is unchanged.

    Examples
    --------
    >>> jid.save_report(jid.identify(recording, joint), "report.html", recordings=recording).name
    'report.html'
    """
    target = require_path("path", path)
    # Writing the file refuses a folder.
    ending = ".html" if target.is_dir() else ending_of_page("path", target)
    write_whole(target, report_page(result, action, recordings, rollout, ending).encode())
    return target
