"""Description of a file format: its endings, how to open a file, and the packages that it needs."""

from collections.abc import Callable

from jointid.base.values import dataclass
from jointid.recording.table import Table


@dataclass(frozen=True, kw_only=True)
class Reader:
    """A reader of one file format.

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
        Argument of pip that installs these packages. Default: the missing package.
    part : str
        Argument of `load` that names a part of the file: ``"topic"`` or ``"group"``. Default: none.
    folder : tuple of str
        A folder with files of these endings is read as one file. Default: none.
    marker : str
        A folder that contains this relative path is read as one file. Default: none.
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
