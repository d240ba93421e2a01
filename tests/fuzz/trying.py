"""Cases of a reader, one after the other; the number of a case is its seed: it can be made again alone."""

import gc
import gzip
import importlib.metadata
import random
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FrameType
from typing import Any

import jointid as jid
from fuzz.damage import damaged
from fuzz.seeds import seed_of

_LONGEST = 10_000  # characters of a sentence
_HANGS = 120  # [s], also where a sanitizer and others take the processor


@contextmanager
def plugins_looked_up_once() -> Iterator[None]:
    """Keep what is installed: readers of frame logs and benches ask for it at each file, which takes ms."""
    real = importlib.metadata.entry_points

    @cache
    def entry_points(**chosen: Any) -> Any:
        return real(**chosen)

    asking = [
        module
        for module in list(sys.modules.values())
        if getattr(module, "entry_points", None) is real
    ]
    for module in asking:
        module.entry_points = entry_points  # type: ignore[attr-defined]
    try:
        yield
    finally:  # tests of what is installed come behind, in the same process
        for module in asking:
            module.entry_points = real  # type: ignore[attr-defined]


class _HangsError(BaseException):
    """No Exception: a reader makes an InputError of every one of them."""


def _give_up(_: int, __: FrameType | None) -> None:
    raise _HangsError(f"no answer within {_HANGS} s")


def faults(
    name: str, start: int, count: int, begun: Callable[[int], object] = lambda _: None
) -> list[str]:
    """Return what is wrong with how a reader takes files that are damaged at random.

    Parameters
    ----------
    name : str
        Of `seeds.readers`.
    start, count : int
        The first case, and how many.
    begun : callable, optional
        Called with the number of each case before it.
    """
    file, content, beside, use = seed_of(name)
    inside = gzip.decompress(content) if file.endswith(".gz") else b""
    memory = Path("/dev/shm")
    wrong = []
    with TemporaryDirectory(dir=memory if memory.is_dir() else None) as folder, ExitStack() as kept:
        path = Path(folder) / file
        for other, known in beside.items():
            path.with_name(other).write_bytes(known)
        path.write_bytes(content)
        use(path)  # the seed is valid
        kept.enter_context(plugins_looked_up_once())
        gc.freeze()  # what was imported is not looked through again and again
        before = signal.signal(signal.SIGALRM, _give_up)
        try:
            for case in range(start, start + count):
                begun(case)
                chance = random.Random(f"{name} {case}")
                packed = bool(inside) and case % 2 == 0  # half of them with a right checksum
                changed = damaged(inside if packed else content, chance)
                path.write_bytes(gzip.compress(changed, 1) if packed else changed)
                signal.alarm(_HANGS)
                try:
                    use(path)
                except jid.InputError as error:
                    if "\n" in str(error) or len(str(error)) > _LONGEST:
                        wrong.append(f"case {case}: {error}")
                except (Exception, _HangsError) as error:
                    wrong.append(f"case {case}: {type(error).__name__}: {error}")
        finally:
            signal.alarm(0)
            signal.signal(signal.SIGALRM, before)
            gc.unfreeze()
    return wrong
