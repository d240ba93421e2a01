"""What a file format declares: its endings, how to open a file, and the package that it needs."""

from collections.abc import Callable

from jointid.base.values import dataclass
from jointid.recording.table import Table


@dataclass(frozen=True, kw_only=True)
class Reader:
    """How files of one format are read.

    Attributes
    ----------
    endings : tuple of str
        Endings of the file names, in lower case, with the dot.
    open : callable
        Takes a path and returns the file as a `Table`. It raises `InputError` when the file is
        damaged; the caller handles `OSError` and a missing package. With `part` it also takes the
        keywords `part` (a name, or None) and `kind` (of the joint, or None).
    package : str or tuple of str
        Packages that `open` imports and that are not installed with jointid. Default: none.
    install : str
        What pip installs to bring these packages. Default: the one that is missing.
    part : str
        The argument of `load` that names a part of such a file: ``"topic"`` or ``"group"``. Default: none.
    folder : tuple of str
        A folder with files of these endings is read as one file. Default: no folder is.
    marker : str
        A folder that holds this file, by its path inside, is read as one file. Default: no folder is.
    """

    endings: tuple[str, ...]
    open: Callable[..., Table]
    package: str | tuple[str, ...] = ""
    install: str = ""
    part: str = ""
    folder: tuple[str, ...] = ()
    marker: str = ""

    @property
    def packages(self) -> tuple[str, ...]:
        """The packages that `open` imports."""
        packages = (self.package,) if isinstance(self.package, str) else self.package
        return tuple(package for package in packages if package)
