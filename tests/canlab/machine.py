"""A Linux kernel with a CAN, run as an ordinary program: Debian's User Mode Linux on the host's file system."""

from __future__ import annotations

import os
import shlex
import shutil
import signal
import subprocess
from collections.abc import Sequence
from pathlib import Path

REQUIRED = "JOINTID_REQUIRE_VCAN"
"""Environment variable that makes a missing kernel a failure; otherwise the tests are skipped."""

_MEMORY = "512M"
_INIT = Path(__file__).with_name("init.sh")
# Preloaded into the guest.
_PRELOADED = [Path(__file__).with_name(f"guest_{part}.c") for part in ("clock", "registers")]
_SYSTEM = ":/usr/sbin:/sbin"  # where an ordinary user's PATH may not lead
_COMPILERS = ("cc", "gcc", "clang")
_MODULES = Path("/usr/lib/uml/modules")
_NEEDED = ("net/can/can.ko", "net/can/can-raw.ko", "drivers/net/can/vcan.ko")


def missing() -> str:
    """Return what this machine lacks; empty when a guest can be booted."""
    if not any(map(shutil.which, _COMPILERS)):
        return f"there is no C compiler: none of {', '.join(_COMPILERS)}"
    install = "apt-get install user-mode-linux kmod iproute2"
    for program in ("linux.uml", "insmod", "ip"):
        if shutil.which(program, path=os.environ.get("PATH", "") + _SYSTEM) is None:
            return f"{program} is not installed: {install}"
    kernels = [each / "kernel" for each in _MODULES.glob("*")]
    if not any(all((kernel / name).is_file() for name in _NEEDED) for kernel in kernels):
        return f"User Mode Linux has no CAN modules in {_MODULES}: {install}"
    return ""


class GuestError(Exception):
    """The guest did not do what it was booted for; with all that it wrote."""


class Guest:
    """A guest that runs one command and is gone.

    Its time is its own: it stands still while the host does other things, and jumps while the guest waits
    (`guest_clock.c`). So what happens in it is the same on a busy machine.

    Parameters
    ----------
    folder : Path
        An empty one of the host's. In the guest it is /run/out, the only place whose contents last.
    command : sequence of str
    environment : dict of str to str
    """

    def __init__(self, folder: Path, command: Sequence[str], environment: dict[str, str]) -> None:
        self.folder = folder
        exports = [f"export {name}={shlex.quote(text)}" for name, text in environment.items()]
        (folder / "job").write_text("\n".join((*exports, "cd /run/out", shlex.join(command), "")))
        arguments = (
            *("linux.uml", f"mem={_MEMORY}", f"uml_dir={folder}", "umid=guest"),
            *("root=/dev/root", "rootfstype=hostfs", "rootflags=/", "ro", "quiet"),
            *("con=null", "con0=null,fd:1", "ssl=null", f"canlab={folder}"),
            *("init=/bin/sh", "--", str(_INIT)),
        )
        self._console = (folder / "console.txt").open("wb")
        # A group of its own: it consists of many processes, which are ended together.
        self._process = subprocess.Popen(
            arguments,
            stdin=subprocess.DEVNULL,
            stdout=self._console,
            stderr=subprocess.STDOUT,
            env={**os.environ, "LD_PRELOAD": str(_preloaded(folder))},
            start_new_session=True,
        )

    def wait(self, timeout: float) -> None:
        """Return when the command has ended well.

        Parameters
        ----------
        timeout : float
            [s]; far beyond what it takes on a busy machine.

        Raises
        ------
        GuestError
            It has not ended, or not with status 0, or the kernel did not get that far.
        """
        try:
            self._process.wait(timeout)
        except subprocess.TimeoutExpired:
            raise GuestError(
                f"the guest has not ended within {timeout:g} s\n{self.said()}"
            ) from None
        finally:
            self.close()
        status = self.folder / "status"
        if not status.is_file():
            raise GuestError(f"the guest did not get to its job\n{self.said()}")
        if status.read_text().strip() != "0":
            raise GuestError(f"the job ended with status {status.read_text()}\n{self.said()}")

    def close(self) -> None:
        """End it, if it has not ended; its processes are one group."""
        if self._process.poll() is None:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
        self._console.close()

    def said(self) -> str:
        """What the guest's kernel and programs wrote."""
        texts = [
            f"--- {path.name}\n{path.read_text(errors='replace')}"
            for path in (self.folder / "console.txt", self.folder / "guest.txt")
            if path.is_file()
        ]
        return "\n".join(texts)


def _preloaded(folder: Path) -> Path:
    """Compile the guest's clock, and what its programs' registers need."""
    compiler = next(filter(None, map(shutil.which, _COMPILERS)))
    library = folder / "preloaded.so"
    subprocess.run(
        (compiler, "-shared", "-fPIC", "-O2", "-o", library, *_PRELOADED, "-ldl"), check=True
    )
    return library
